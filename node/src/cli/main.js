#!/usr/bin/env node
// SPDX-License-Identifier: MIT
// The command `quadmark`.
import { run } from './program.js';

// A reader that closes early (`| head`) is no failure of ours.
process.stdout.on('error', (error) => {
  if (error.code === 'EPIPE') process.exit(process.exitCode ?? 0);
  throw error;
});

process.exitCode = await run(process.argv.slice(2));
