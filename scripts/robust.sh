#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the tables of docs/robust.md: every attack on every model, five keys each, in less than an hour of one core. Results
# are appended to build/robust.csv; what is in there is not done again, so a run may be stopped and started anew. Delete the
# file after a change of what is written or read. (Real tools: bench/evaluate --experiment tools.)
#
#   scripts/robust.sh [--keys N] [--jobs N] [--tables]     --tables: only make the tables of what there is
#
# Real models are taken from $QUADMARK_MODELS (default ../shared/models); absent ones are left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
models=${QUADMARK_MODELS:-../shared/models} keys=5 jobs=1 only_tables=
while [ $# -gt 0 ]; do
  case $1 in
    --keys) keys=$2; shift ;;
    --jobs) jobs=$2; shift ;;
    --tables) only_tables=1 ;;
    *) echo "usage: scripts/robust.sh [--keys N] [--jobs N] [--tables]" >&2; exit 2 ;;
  esac
  shift
done
results=build/robust.csv

here() { local name; for name in "$@"; do [ -f "$models/$name" ] && printf '%s\n' "$models/$name"; done; return 0; }
real=$(here bunny.glb fandisk.glb rocker-arm.glb nefertiti.glb ogre.glb beast.glb igea-tristrips.ply Duck.glb SheenCloth.glb clothFolds.glb)
scans="sculpture:8000:1 sculpture:12000:4 sculpture:20000:2 sculpture:30000:7 sculpture:40000:3 sculpture:60000:6@0.2"
parts="part:6500:1 part:12000:2 part:30000:3 part:30000:5@0.2"
grids="bumpy-grid:10000:1~60 bumpy-grid:40000:2~60 bumpy-grid:22500:3~10"
subdivisions="quad-sphere:6146 quad-sphere:24578 icosphere:10242 icosphere:40962"
coarse="sculpture:3000:1 sculpture:60000:6@0.05 part:30000:5@0.05"
pictures=$(here bunny.glb nefertiti.glb ogre.glb igea-tristrips.ply)

if [ -z "$only_tables" ]; then
  cmake --preset release >build/robust.log
  cmake --build --preset release --target quadmark_robust >>build/robust.log
  # One model and key at a time, all models of the first key first: an interrupted run has whole keys.
  list() {  # PAYLOAD STRENGTH ROWS KEY MODEL...
    local model
    for model in "${@:5}"; do echo "--payload $1 --strength $2 --rows $3 --keys $4 --results $results $model"; done
  }
  {
    for key in $(seq "$keys"); do
      list id standard attacks "$key" $real $scans $parts $grids $subdivisions $coarse
      list image standard attacks "$key" $pictures
      list id invisible none "$key" $real
    done
  } | xargs -P "$jobs" -L 1 build/native/bench/quadmark_robust >/dev/null 2>>build/robust.log
fi
node bench/robust_table.mjs "$results" docs/robust.md
