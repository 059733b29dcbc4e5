#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Prints the tables of a run of the benchmarks beside their goals, and draws it."""

import pathlib

from cayspin_plots import bench_figures, bench_goals, bench_options, command_line
from cayspin_plots.bench import Results

STREAM = ("stream copy", "stream copy, non-temporal")


def print_context(results):
    context = next(iter(results.context.values()))
    caches = ", ".join(f"L{cache['level']} {cache['size'] >> 10} KiB" for cache in
                       context["caches"] if cache["type"] != "Instruction")
    threads = sorted({results.threads(file) for file in results.context})
    print(f"{context.get('processor', context['host_name'])}, {caches}; threads {threads}; Kokkos "
          f"{context['kokkos_version']}, {context['execution_space']}; commit "
          f"{context['git_commit'][:12]}{' and changes' if context['git_dirty'] == 'yes' else ''}; "
          f"load before the first run {context['load_avg'][0]:.1f}")


def print_stream(results):
    print(f"\n{'GB/s, read and written, median (lowest .. highest)':<58}ordinary stores     "
          "non-temporal stores")
    for file in results.context:
        rates = [results.values.get((file, case), {}).get("GB/s") for case in STREAM]
        if all(rates):
            threads = results.threads(file)
            print(f"  {file}, {threads} thread{'s' * (threads != 1)}".ljust(56), *(
                f"{results.median(case, 'GB/s', file):7.1f} ({min(rate):.1f} .. {max(rate):.1f})"
                for case, rate in zip(STREAM, rates)))


def print_goals(results):
    print(f"\n{'medians of interleaved repetitions':<58}{'measured':>8}{'goal':>10}{'floor':>7}")
    for goal in bench_goals.goals(results):
        print(goal.row())


def print_options(results):
    if "options" in results.context:
        print("\nWhat options cost: 100 spins, 32^3 and 128^3, double; at 128^3 beside their limit")
        for row in bench_options.rows(results):
            print(row)


def main():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, metavar="DIR",
                        help="where bench/run.sh left its results")
    folder = parser.parse_args().folder
    results = Results(folder)
    print_context(results)
    print_stream(results)
    print_goals(results)
    print_options(results)
    bench_figures.draw_sizes(results, folder / "bench_sizes.png")
    bench_figures.draw_threads(results, folder / "bench_threads.png")


if __name__ == "__main__":
    main()
