// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

/// Runs the registered benchmarks. Their repetitions are interleaved at random, and what was
/// measured where goes into the context: commit, processor and caches, Kokkos, threads. Takes all
/// of Google Benchmark's options; returns the exit status.
int run_benchmarks(int argc, char** argv);
