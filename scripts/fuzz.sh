#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Feeds damaged files to the readers, under sanitizers, until they have had RUNS of them. What breaks something is left in
# build/fuzz/found/<target>/; keep it, fixed, in native_tests/fuzz/found/<target>/, where an ordinary test replays it.
#
#   scripts/fuzz.sh                        every target, 10 million runs in all, from the inputs of earlier runs
#   scripts/fuzz.sh --runs N [TARGET...]   N runs of each (of these) targets
#   scripts/fuzz.sh --short                some seconds per target, the same inputs every time: part of scripts/test.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

runs= short=no targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --runs) runs=${2:?fuzz: --runs needs a number}; shift ;;
    --short) short=yes ;;
    -*) echo "fuzz: unknown argument $1" >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done

# Runs by default, in all 10 million; the short ones take about ten seconds each.
default_runs() {
  case $1 in
    gltf) [ $short = yes ] && echo 6000 || echo 4000000 ;;
    ply) [ $short = yes ] && echo 6000 || echo 3000000 ;;
    drc) [ $short = yes ] && echo 6000 || echo 1000000 ;;
    key) [ $short = yes ] && echo 50000 || echo 1000000 ;;
    png) [ $short = yes ] && echo 10000 || echo 990000 ;;
    mesh) [ $short = yes ] && echo 300 || echo 10000 ;;
    *) echo "fuzz: no target $1" >&2; return 1 ;;
  esac
}
[ ${#targets[@]} -gt 0 ] || targets=(gltf ply drc key png mesh)

cmake --preset fuzz >build/fuzz.log
cmake --build --preset fuzz --parallel "$(nproc)" >>build/fuzz.log 2>&1 || { tail -n 40 build/fuzz.log; exit 1; }
bin=build/fuzz/native_tests/fuzz
rm -rf build/fuzz/seeds
$bin/quadmark_fuzz_seeds build/fuzz/seeds

total=0 failed=0
for target in "${targets[@]}"; do
  count=${runs:-$(default_runs "$target")}
  # New inputs go to the first folder.
  corpus=build/fuzz/corpus/$target
  [ $short = no ] || corpus=build/fuzz/short/$target
  [ $short = no ] || rm -rf "$corpus"
  mkdir -p "$corpus" "build/fuzz/found/$target"
  # Marking searches and repairs for long where a tangled mesh has hardly room for the mark: up to two minutes with
  # sanitizers. Nothing else may take that long.
  slowest=20
  [ "$target" != mesh ] || slowest=400
  options=(-runs="$count" -max_len=8192 -timeout=$slowest -rss_limit_mb=2048 -print_final_stats=1
           -artifact_prefix="build/fuzz/found/$target/")
  # Compared values may be addresses, which differ from run to run.
  [ $short = no ] || options+=(-seed=1 -use_cmp=0 -max_total_time=40)
  dictionary=native_tests/fuzz/$target.dict
  [ ! -f "$dictionary" ] || options+=(-dict="$dictionary")
  folders=("$corpus" "build/fuzz/seeds/$target")
  [ ! -d "native_tests/fuzz/found/$target" ] || folders+=("native_tests/fuzz/found/$target")
  log=build/fuzz/$target.log
  UBSAN_OPTIONS=print_stacktrace=1 "$bin/fuzz_$target" "${options[@]}" "${folders[@]}" >"$log" 2>&1 || {
    failed=1
    echo "$target: an input broke it, see $log and build/fuzz/found/$target/"
    tail -n 30 "$log" | cut -c1-200
  }
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  total=$((total + ${executed:-0}))
  echo "$target: ${executed:-0} runs, $(find "$corpus" -type f | wc -l) inputs kept"
done
echo "$total runs in all"
exit $failed
