#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs bench_throughput of two builds in turns and prints the ratio of the median times.

A ratio above 1: the other build is slower than the reference. Exit status 1 when a ratio is above
--limit. Arguments after -- go to both programs, for instance -- --benchmark_filter=RKMK4.
"""

import argparse
import collections
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile


def run(program, options):
    """Seconds of every benchmark of one run, by name."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "result.json")
        subprocess.run([program, f"--benchmark_out={path}", "--benchmark_out_format=json",
                        *options], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        result = json.loads(path.read_text(encoding="utf-8"))
    scale = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    times = collections.defaultdict(list)
    for case in result["benchmarks"]:
        if case["run_type"] == "iteration" and "error_occurred" not in case:
            times[case["run_name"]].append(case["real_time"] * scale[case["time_unit"]])
    return times


def parse_arguments():
    cut = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reference", type=pathlib.Path, help="a program bench_throughput")
    parser.add_argument("other", type=pathlib.Path, help="the one that is compared with it")
    parser.add_argument("--turns", type=int, default=5, help="runs of each (default: 5)")
    parser.add_argument("--limit", type=float, default=1.03, help="ratio (default: 1.03)")
    arguments = parser.parse_args(sys.argv[1:cut])
    arguments.options = sys.argv[cut + 1:]
    return arguments


def main():
    arguments = parse_arguments()
    programs = (arguments.reference, arguments.other)
    times = [collections.defaultdict(list) for _ in programs]
    for turn in range(arguments.turns):
        order = (0, 1) if turn % 2 == 0 else (1, 0)
        for index in order:
            for name, seconds in run(programs[index], arguments.options).items():
                times[index][name] += seconds
    names = [name for name in times[0] if name in times[1]]
    alone = [name for name in {**times[0], **times[1]} if name not in names]
    if not names:
        sys.exit("no benchmark that both of them have")
    ratios = {name: statistics.median(times[1][name]) / statistics.median(times[0][name])
              for name in names}
    width = max(map(len, ratios))
    print(f"{'benchmark':{width}} {'reference':>12} {'other':>12} {'ratio':>7}")
    for name, ratio in ratios.items():
        seconds = [statistics.median(found[name]) for found in times]
        print(f"{name:{width}} {seconds[0]:10.3e} s {seconds[1]:10.3e} s {ratio:7.3f}")
    for name in alone:
        print(f"{name}: in one of them only")
    worst = max(ratios, key=ratios.get)
    print(f"{len(names)} benchmarks, {arguments.turns} turns: median ratio "
          f"{statistics.median(ratios.values()):.3f}, worst {ratios[worst]:.3f} ({worst})")
    sys.exit(0 if ratios[worst] <= arguments.limit else 1)


if __name__ == "__main__":
    main()
