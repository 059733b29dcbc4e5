#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# compilers.sh KOKKOS_SOURCE BUILD_FOLDER [THREADS] compiles test_contracted with g++ and with
# clang, for AVX2 and for AVX-512, and runs it. Both compilers contract across expressions; clang is
# also tested with contraction only within an expression. Kokkos is built for each compiler and
# architecture, with THREADS jobs (2 by default). Status 1 if a combination fails, 77 if none fails
# but one cannot be tried here.
set -uo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
kokkos=$1 build=$2 threads=${3:-2}
failed=0 skipped=0

first_of() {
  local name
  for name; do
    if command -v "$name" >/dev/null; then
      echo "$name"
      return
    fi
  done
}

# combination COMPILER NAME KOKKOS_ARCHITECTURE FLAG_OF_PROCESSOR CONTRACTION
combination() {
  local name="$2, $3, -ffp-contract=$5" folder=$build/$2-$3 reason=""
  if [ -z "$1" ]; then
    reason="there is no $2"
  elif ! grep -qw "$4" /proc/cpuinfo 2>/dev/null; then
    reason="the processor has no $4"
  elif ! echo "int main() {}" | "$1" -fopenmp -x c++ - -o /dev/null 2>/dev/null; then
    reason="$1 has no OpenMP"
  fi
  if [ -n "$reason" ]; then
    echo "skipped: $name: $reason"
    skipped=1
    return
  fi
  if cmake -G Ninja -S "$source" -B "$folder" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_COMPILER="$1" -DCMAKE_DISABLE_FIND_PACKAGE_Kokkos=ON \
    -DCAYSPIN_KOKKOS_SOURCE="$kokkos" -DCAYSPIN_KOKKOS_AS_UNITY=ON -DKokkos_ENABLE_SERIAL=ON \
    -DKokkos_ENABLE_OPENMP=ON "-DKokkos_ARCH_$3=ON" -DCAYSPIN_TEST_CONTRACTION="$5" \
    -DCAYSPIN_BUILD_ALL_TESTS=ON -DCAYSPIN_BUILD_APP=OFF -DCAYSPIN_BUILD_BENCH=OFF \
    -DCAYSPIN_BUILD_EXAMPLES=OFF -DCAYSPIN_INSTALL=OFF >"$folder.log" 2>&1 &&
    ninja -C "$folder" -j "$threads" test_contracted >>"$folder.log" 2>&1 &&
    OMP_NUM_THREADS=2 OMP_PROC_BIND=false OMP_WAIT_POLICY=passive \
      "$folder/bin/test_contracted" >>"$folder.log" 2>&1; then
    echo "passed: $name"
  else
    echo "failed: $name"
    grep -E "error:|Failure|FAILED" "$folder.log" | head -20
    failed=1
  fi
}

if [ ! -f "$kokkos/CMakeLists.txt" ]; then
  echo "skipped: there is no Kokkos source at $kokkos"
  exit 77
fi
mkdir -p "$build"
gcc=$(first_of g++) clang=$(first_of clang++ clang++-{22..14})
# Vectors of Haswell and Skylake have 256 and 512 bits. g++ before version 14 treats `on` as `off`.
for pair in "HSW fma" "SKX avx512dq"; do
  read -r architecture flag <<<"$pair"
  combination "$gcc" g++ "$architecture" "$flag" fast
  combination "$clang" clang++ "$architecture" "$flag" fast
  combination "$clang" clang++ "$architecture" "$flag" on
done
[ $failed = 0 ] || exit 1
[ $skipped = 0 ] || exit 77
