// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

/// Registers the benchmarks that main() of main.cpp runs. The program accepts all of Google
/// Benchmark's options. Repetitions are interleaved at random, and the context records the
/// conditions: commit, processor and caches, Kokkos, threads.
void register_benchmarks();
