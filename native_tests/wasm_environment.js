// SPDX-License-Identifier: MIT
// Hands the process's own settings to the tests as wasm; Emscripten starts with an environment of its own.
Module.preRun = function () {
  for (const name of Object.keys(process.env)) {
    if (/^(QUADMARK|GTEST)_/.test(name)) ENV[name] = process.env[name];
  }
};
