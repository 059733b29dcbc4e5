// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

/// A program links main.cpp, whose main() runs what this registers. It takes all of Google
/// Benchmark's options. Repetitions are interleaved at random, and what was measured where goes
/// into the context: commit, processor and caches, Kokkos, threads.
void register_benchmarks();
