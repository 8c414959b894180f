#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Marks all models of a folder with one ID, in as many threads as there are processors, and keeps the reports.
#
#   build.sh MODELS_FOLDER KEY.json ID OUT_FOLDER
set -euo pipefail
models=$1 key=$2 id=$3 out=$4

mkdir -p "$out"
quadmark embed "$models/**/*.glb" --out-dir "$out" --key "$key" --id "$id" --jobs 0 --force --json >"$out/report.jsonl"
quadmark extract "$out/*.glb" --key "$key" --jobs 0 --json >"$out/check.jsonl"  # status 3 or 4 if one mark does not read
