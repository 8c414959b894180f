#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One marked copy of a model for every recipient of a list; later, whose copy a leaked one is.
#
#   recipients.sh MODEL.glb RECIPIENTS.csv KEY.json OUT_FOLDER
#   recipients.sh --trace LEAKED.glb KEY.json OUT_FOLDER
set -euo pipefail

if [ "$1" = --trace ]; then
  exec quadmark trace "$2" --registry "$4/registry.jsonl" --key "$3" --jobs 0
fi
mkdir -p "$4"
# Runs again for a longer list mark only who is new: what was done before is in the registry.
quadmark embed "$1" --recipients "$2" --out-dir "$4" --registry "$4/registry.jsonl" --key "$3" --jobs 0
