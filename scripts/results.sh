#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/results.md: every attack on every model, three keys each. About five minutes on two cores.
# Real models are taken from $QUADMARK_MODELS (default ../shared/models); absent ones are left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
models=${QUADMARK_MODELS:-../shared/models}
tool=build/native/bench/quadmark_experiment
cmake --preset release >build/experiment.log
cmake --build --preset release --target quadmark_experiment >>build/experiment.log

here() { local name; for name in "$@"; do [ -f "$models/$name" ] && printf '%s\n' "$models/$name"; done; return 0; }
table() { echo; echo "    quadmark_experiment $*" | sed "s|$models/||g"; echo; "$tool" "$@"; }

{
  cat <<'TEXT'
# Results

Made by `scripts/results.sh`. Bit error rates after each attack, means over three keys; an unread bit counts one half;
"exact" = no wrong and no unread bit with any key; "no match" = with some key the verdict is not `match`. Attacks are
those of `core/lab/include/quadmark/lab/attacks.h`: R, NS, RE, S, SH, CB are the paper's affine maps in float32; amplitudes
are fractions of the bounding-box diagonal; "simplify" is meshoptimizer's, "QEM" quadric edge collapse with optimal
placement, 30 % removed. SNR as defined in `core/include/quadmark/metrics.h`.

## 24 x 24 pixels (576 bits), L = 2, H = 3
TEXT
  table --keys 3 $(here bunny.ply rocker-arm.ply nefertiti.ply ogre.ply beast-quads.ply igea-tristrips.ply Duck.glb \
    CesiumMan.glb clothFolds.glb SheenCloth.glb) sculpture:20000
  echo
  echo "## 24 x 24 pixels on CAD models, L = 3, H = 4"
  table --keys 3 --L 3 $(here fandisk.ply) part:8000
  echo
  echo "## 90 x 90 pixels (8100 bits), L = 2, H = 4"
  table --keys 3 --side 90 --attacks exact $(here bunny.ply) sculpture:35000
  echo
  echo "## 90 x 90 pixels on CAD models, L = 3, H = 5"
  table --keys 3 --side 90 --L 3 --attacks exact $(here fandisk.ply) part:12000
} >docs/results.md.new
mv docs/results.md.new docs/results.md
