#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Writes BUILD_DIR/gpu-report.md, a report on the results of `bash cmake/bootstrap.sh gpu`.

It reads gpu-tests.txt (the output of ctest), gpu-bench.txt (that of bench/run.sh) and
bench-results. The report names parts that are missing. The exit status is 1 if a part is missing or
a test failed.
"""
import argparse
import contextlib
import io
import pathlib
import re
import subprocess
import sys

import model_gpu


def output_of(*command):
    """Returns the output of a command; None if it cannot be run or fails."""
    try:
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def machine():
    asked = {
        "card": ("nvidia-smi", "--query-gpu=name,driver_version,memory.total,clocks.max.sm",
                 "--format=csv,noheader"),
        "commit": ("git", "-C", str(model_gpu.ROOT), "describe", "--always", "--dirty"),
        "nvcc": ("nvcc", "--version"),
    }
    for name, command in asked.items():
        found = output_of(*command) or "unknown"
        yield f"- {name}: {found.splitlines()[-1]}"


def tests(text):
    """Returns lines of the report about a run of ctest, and whether no test failed. `text` is the
    output of ctest."""
    summary = re.search(r"^\d+% tests passed.*$", text, re.MULTILINE)
    if not summary:
        return ["ctest printed no summary."], False
    others = re.findall(r"^\s*\d+ - (\S+) \(([^)]*)\)", text, re.MULTILINE)
    failed = [(name, why) for name, why in others if why not in ("Skipped", "Disabled")]
    skipped = [name for name, why in others if why == "Skipped"]
    lines = [summary[0], "", f"Skipped: {', '.join(skipped) or 'none'}.", ""]
    lines += [f"- **{name}**: {why}" for name, why in failed]
    return lines, not failed


def model(folder):
    with contextlib.redirect_stdout(io.StringIO()) as text:
        kernels = model_gpu.read_kernels()
        if folder.is_dir():
            model_gpu.print_measured(kernels, folder)
        for edge in (128, 256):
            model_gpu.print_steps(kernels, edge)
        model_gpu.print_replicas(kernels)
        model_gpu.print_film(model_gpu.read_all_kernels())
        model_gpu.print_kernels(kernels, 256)
    return text.getvalue()


def read(path, missing):
    if path.is_file():
        return path.read_text(encoding="utf-8", errors="replace")
    missing.append(path.name)
    return ""


def report(build):
    missing = []
    test_lines, passed = tests(read(build / "gpu-tests.txt", missing))
    bench = read(build / "gpu-bench.txt", missing)
    results = build / "bench-results"
    if not any(results.glob("*.json")):
        missing.append("bench-results")
        results = pathlib.Path("/nonexistent")
    lines = ["# A run on a GPU", "", *machine(), "", "## Tests", *test_lines, "",
             "## Beside the model", model(results), "## Benchmarks", "```", bench.rstrip(), "```"]
    if missing:
        lines[2:2] = [f"**Missing: {', '.join(missing)}.**", ""]
    return "\n".join(lines) + "\n", passed and not missing


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path, metavar="BUILD_DIR")
    build = parser.parse_args().build
    text, complete = report(build)
    path = build / "gpu-report.md"
    path.write_text(text, encoding="utf-8")
    print(f"cayspin: the report: {path}")
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())
