#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets everything up, builds natively, with sanitizers and as wasm, and runs all tests. Exits non-zero when anything
# fails. Logs are left in build/logs/.
#
#   scripts/test.sh          everything (about 20 minutes on two cores, from a fresh clone)
#   scripts/test.sh --quick  without the sanitizer build and the fuzzers
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quick=no
for argument in "$@"; do
  case $argument in
    --quick) quick=yes ;;
    *) echo "test: unknown argument $argument" >&2; exit 2 ;;
  esac
done

logs=build/logs
mkdir -p $logs
rm -f $logs/*.log
summary=()
failed=0

# step NAME FUNCTION: runs it with its output in a log, shows the end of that log when it fails. (Functions chain by &&:
# bash ignores set -e in a condition.)
step() {
  local name=$1 action=$2 log started seconds
  log=$logs/$(basename "${action//_/-}" .sh).log
  started=$SECONDS
  printf '== %s ... ' "$name"
  if $action >"$log" 2>&1; then
    seconds=$((SECONDS - started))
    printf 'ok (%d s)\n' $seconds
    summary+=("ok      $name ($seconds s)")
    return 0
  fi
  seconds=$((SECONDS - started))
  printf 'FAILED (%d s), end of %s:\n' $seconds "$log"
  tail -n 80 "$log" | cut -c1-400
  summary+=("FAILED  $name ($seconds s): $log")
  failed=1
  return 1
}

skip() {
  printf '== %s ... not run: %s\n' "$1" "$2"
  summary+=("NOT RUN $1: $2")
  failed=1
}

build() {
  cmake --preset "$1" && cmake --build --preset "$1" --parallel "$(nproc)"
}
build_native() { build release; }
build_asan() { build asan; }
build_wasm() { build wasm; }
readme_demo() { scripts/demo.sh --no-serve; }
native_tests() { ctest --preset release --parallel "$(nproc)"; }
asan_tests() {
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 \
    ctest --preset asan --parallel "$(nproc)"
}
fuzz_short() { scripts/fuzz.sh --short; }
wasm_tests() {
  # Emscripten 3.1.6 mistakes Node's fetch for a browser's.
  node --no-experimental-fetch build/wasm/native_tests/quadmark_tests.js --gtest_brief=0
}
javascript() { node --test --test-reporter=spec --test-timeout=900000 "$@"; }
package_tests() {
  local file files=()
  for file in js_tests/*.test.mjs; do
    case $file in js_tests/page*) ;; *) files+=("$file") ;; esac
  done
  javascript "${files[@]}"
}
page_tests() {
  npm run build --workspace web && javascript js_tests/page*.test.mjs
}

step "set up" scripts/setup.sh || { echo "Setting up failed: nothing was tested."; exit 1; }
. build/deps/env.sh

# Before anything else is built: in a fresh clone it must find all it needs by itself. The wasm build goes on from it.
step "the demo of the README" readme_demo
if step "build natively" build_native; then native=yes; else native=no; fi
if step "build as wasm" build_wasm; then wasm=yes; else wasm=no; fi
if [ $native = yes ]; then step "native tests" native_tests; else skip "native tests" "not built"; fi
if [ $wasm = yes ]; then
  step "the same tests as wasm under Node" wasm_tests
  step "package, command line and parity" package_tests
  if compgen -G 'js_tests/page*.test.mjs' >/dev/null; then
    step "page in Chromium and Firefox" page_tests
  else
    skip "page in Chromium and Firefox" "js_tests/page*.test.mjs does not exist"
  fi
else
  skip "the same tests as wasm under Node" "not built"
  skip "package, command line and parity" "not built"
  skip "page in Chromium and Firefox" "not built"
fi
if [ $quick = no ]; then
  if step "build with sanitizers" build_asan; then step "native tests with sanitizers" asan_tests; else skip "native tests with sanitizers" "not built"; fi
  step "fuzzers, a short run" fuzz_short
fi

echo
echo "Summary"
printf '  %s\n' "${summary[@]}"
[ $quick = no ] || echo "  (--quick: no sanitizers, no fuzzers)"
untested=$(grep -hsE 'real models? .* was not tested|is not in .*QUADMARK_MODELS' $logs/*.log | sort -u | wc -l)
[ "$untested" = 0 ] || echo "  Note: $untested parts with real models were not tested: set QUADMARK_MODELS to their folder"
if [ $failed = 0 ]; then echo "All tests passed in $((SECONDS / 60)) min $((SECONDS % 60)) s."; else echo "There were failures."; fi
exit $failed
