#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compares two ranks of one thread with one rank of two threads, and with two independent ranks.

Usage: compare_ranks.py BUILD_DIR [--repetitions N]

Columns of the table, for a lattice of the given number of sites:
- strong: (time of one rank with two threads) / (time of two ranks), both on this lattice,
- weak: (time of two independent ranks that have this lattice each) / (time of two ranks that share
  a lattice of twice its length),
- in step: like weak, but the independent ranks wait for each other after each step,
- exchange: percentage of the time that two ranks spend exchanging ghosts, on this lattice and on
  the one of twice its length.
The kinds of run take turns, and the fastest run of each kind counts.
"""
import argparse
import os
import pathlib
import re
import subprocess

SIZES = [(128, 128, 128), (256, 256, 256)]
LINE = re.compile(r"(.*): ([\d.]+) ns, exchange ([\d.]+), exchanges \d+, stages (\d+)")


def measure(program, ranks, threads, size, *more):
    """Returns {method: (ns per spin and step, fraction of the time spent in exchanges, stages)}."""
    environment = dict(os.environ, OMP_NUM_THREADS=str(threads), OMP_WAIT_POLICY="passive",
                       OMP_PROC_BIND="false")
    text = subprocess.run(["mpiexec", "-n", str(ranks), program, *map(str, size), *more],
                          check=True, capture_output=True, text=True, env=environment).stdout
    return {name: (float(ns), float(part), int(stages))
            for name, ns, part, stages in LINE.findall(text)}


def better(one, other):
    return {name: min(one.get(name, other[name]), other[name]) for name in other}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--repetitions", type=int, default=5)
    arguments = parser.parse_args()
    program = arguments.build / "bin" / "bench_ranks"
    print("| sites | method | strong | weak | in step | exchange |\n|---|---|---|---|---|---|")
    for nx, ny, nz in SIZES:
        threads, ranks, longer, apart, in_step = {}, {}, {}, {}, {}
        for _ in range(arguments.repetitions):
            threads = better(threads, measure(program, 1, 2, (nx, ny, nz)))
            ranks = better(ranks, measure(program, 2, 1, (nx, ny, nz)))
            longer = better(longer, measure(program, 2, 1, (nx, ny, 2 * nz)))
            apart = better(apart, measure(program, 2, 1, (nx, ny, nz), "apart"))
            in_step = better(in_step, measure(program, 2, 1, (nx, ny, nz), "in_step"))
        for name, (ns, exchange, _) in ranks.items():
            weak, exchange_weak, _ = longer[name]
            print(f"| {nx} x {ny} x {nz} | {name} | {threads[name][0] / ns:.2f} | "
                  f"{apart[name][0] / weak:.2f} | {in_step[name][0] / weak:.2f} | "
                  f"{100 * exchange:.1f} %, {100 * exchange_weak:.1f} % |", flush=True)


if __name__ == "__main__":
    main()
