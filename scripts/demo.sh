#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets everything up, marks a generated model with a small logo, damages it in several ways, reads the logo back, and
# builds the page. Results are left in build/demo/.
#
#   scripts/demo.sh             serves the page at the end when standard output is a terminal
#   scripts/demo.sh --serve     serves it in any case, until Ctrl-C
#   scripts/demo.sh --no-serve  ends after the numbers
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [ -t 1 ]; then serve=yes; else serve=no; fi
for argument in "$@"; do
  case $argument in
    --serve) serve=yes ;;
    --no-serve) serve=no ;;
    *) echo "demo: unknown argument $argument" >&2; exit 2 ;;
  esac
done

# quietly NAME COMMAND...: one line, and the output only when it fails.
mkdir -p build/logs
quietly() {
  local name=$1 log=build/logs/demo.log started=$SECONDS
  shift
  printf 'demo: %s ... ' "$name" >&2
  if "$@" >"$log" 2>&1; then
    printf '%d s\n' $((SECONDS - started)) >&2
  else
    printf 'failed:\n' >&2
    tail -n 40 "$log" >&2
    exit 1
  fi
}

scripts/setup.sh --no-browser
. build/deps/env.sh
quietly "configuring the wasm build" cmake --preset wasm
quietly "building the wasm modules (minutes, the first time)" \
  cmake --build --preset wasm --parallel "$(nproc)" --target quadmark_package
node scripts/demo.mjs
quietly "building the page" npm run build --workspace web
if [ $serve = yes ]; then
  exec node web/serve.mjs
fi
echo
echo "The page is in web/dist. To serve it with its strict content security policy: node web/serve.mjs"
