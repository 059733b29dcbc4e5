#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Computes the switching slab by geometric and by classical Euler, and by RKMK4 as the reference,
# all with equal steps, and draws the three runs in one picture. Usage: bash demo/run.sh BUILD_DIR
set -euo pipefail

[ $# -eq 1 ] || { echo "usage: bash demo/run.sh BUILD_DIR" >&2; exit 2; }
program=$1/bin/cayspin_demo
[ -x "$program" ] || { echo "demo: there is no program $program" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$root/build/demo
mkdir -p "$out"

# A hundred spins are too few for threads, which would wait for each other on a busy machine.
OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} "$program" "$out"
PYTHONDONTWRITEBYTECODE=1 "${PYTHON:-python3}" "$root/python/plot_demo.py" \
  "$out/geometric.h5" "$out/classical.h5" --reference "$out/reference.h5" \
  --output "$out/demo.png" >/dev/null
echo "demo: the picture: $out/demo.png"
