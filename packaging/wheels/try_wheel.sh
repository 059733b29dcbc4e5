#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Usage: bash packaging/wheels/try_wheel.sh WHEEL [PYTHON]
# Installs a wheel into a new environment of PYTHON. Then, for each level of x86-64 that this
# processor has, computes from Python and with the command `cayspin`, and draws a plot. Needs no
# clone, only try_wheel.py in the same folder.
set -euo pipefail
wheel=$1
python=${2:-python3}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$python" -m venv "$work/venv"
"$work/venv/bin/python" -m pip install --quiet "$wheel[plots]"
cd "$work"
# try LEVEL SETTINGS: with the settings, the loader takes the libraries of this level, even if the
# processor has a higher one.
try() {
  GLIBC_TUNABLES=$2 "$work/venv/bin/python" "$here/try_wheel.py" "$1"
}
without_avx512=-AVX512F,-AVX512BW,-AVX512CD,-AVX512DQ,-AVX512VL
try x86-64 "glibc.cpu.hwcaps=$without_avx512,-AVX2"
if grep -qw avx2 /proc/cpuinfo; then try x86-64-v3 "glibc.cpu.hwcaps=$without_avx512"; fi
if grep -qw avx512vl /proc/cpuinfo; then try x86-64-v4 ""; fi
