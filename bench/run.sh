#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Runs bench_throughput, bench_few_spins, bench_replicas, bench_options and bench_evaluations with
# OMP_NUM_THREADS threads (default: all cores), and bench_throughput also with one thread. Then
# prints tables of the results and draws them. Usage: PYTHON=python3 bash bench/run.sh BUILD_DIR
set -euo pipefail

build_dir=$1
results=$build_dir/bench-results
export OMP_PROC_BIND=${OMP_PROC_BIND:-spread} OMP_PLACES=${OMP_PLACES:-cores}
threads=${OMP_NUM_THREADS:-$(nproc)}

# run NAME THREADS PROGRAM OPTION...
run() {
  local name=$1 threads=$2 program=$3 seconds=$SECONDS
  shift 3
  printf 'cayspin: bench_%s, %s ' "$program" "$name"
  OMP_NUM_THREADS=$threads KOKKOS_NUM_THREADS=$threads "$build_dir/bin/bench_$program" \
    --benchmark_out="$results/$name.json" "$@" >"$results/$name.txt" 2>&1 ||
    { tail -n 5 "$results/$name.txt" >&2; exit 1; }
  printf '(%d s)\n' $((SECONDS - seconds))
}

# throughput NAME THREADS CASES OPTION...: also measures the speed of the memory.
throughput() {
  local name=$1 threads=$2 cases=$3
  shift 3
  run "$name" "$threads" throughput "--benchmark_filter=^stream|$cases" "$@"
}

rm -rf "$results"
mkdir -p "$results"
drawn='/(hand-written .*|Euler|Heun|RKMK4|.* tangent)' # measured at all sizes; the others at some
throughput smallest "$threads" "$drawn/(5|10|16|24)/"
throughput small "$threads" "/(32|64|L2)/|$drawn/48/" --benchmark_repetitions=7
throughput medium "$threads" "/(128|L2)/|$drawn/96/"
throughput large "$threads" '/(256|L2)/'
throughput larger "$threads" "$drawn/(192|292)/" --benchmark_repetitions=3
throughput one_thread 1 '/(32|64|128|L2)/' --benchmark_repetitions=3
run few_spins "$threads" few_spins --benchmark_repetitions=9
run replicas "$threads" replicas --benchmark_repetitions=3
run options "$threads" options
run evaluations "$threads" evaluations --benchmark_repetitions=9
"$PYTHON" python/plot_bench.py "$results"
