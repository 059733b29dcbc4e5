#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# The switching slab by geometric and by classical Euler with the same step, beside an accurate run,
# and one picture of the three. Usage: bash scenes/demo.sh BUILD_DIR
set -euo pipefail

[ $# -eq 1 ] || { echo "usage: bash scenes/demo.sh BUILD_DIR" >&2; exit 2; }
program=$1/bin/cayspin
[ -x "$program" ] || { echo "demo: there is no program $program" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$root/build/demo
mkdir -p "$out"

# simulate NAME METHOD
simulate() {
  echo "demo: scenes/slab_switching.toml, $2"
  "$program" run "$root/scenes/slab_switching.toml" --set "integrator.method=\"$2\"" \
    --set integrator.dt=0.01 --set output.every=2 --output "$out/$1.h5" --overwrite
}

simulate geometric euler
simulate classical classical_euler
simulate reference rkmk4
PYTHONDONTWRITEBYTECODE=1 "${PYTHON:-python3}" "$root/python/plot_demo.py" \
  "$out/geometric.h5" "$out/classical.h5" --reference "$out/reference.h5" \
  --output "$out/demo.png" >/dev/null
echo "demo: the picture: $out/demo.png"
