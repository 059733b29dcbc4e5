#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles the device code of a source with hipcc and prints the registers that its kernels take;
fails when a kernel spills vector registers to memory that is not known to. Scalar registers spill
into lanes of vector registers."""

import argparse
import pathlib
import re
import shlex
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from device_kernels import compile_entry, short_names  # noqa: E402

REMARK = re.compile(r"remark:\s+(Function Name|VGPRs|AGPRs|ScratchSize|SGPRs Spill|VGPRs Spill)"
                    r"(?: \[[^\]]*\])?: (\S+)")


def kernels(output):
    """What the compiler says of each kernel, a dictionary for each."""
    found = []
    for name, value in REMARK.findall(output):
        if name == "Function Name":
            found.append({"symbol": value})
        elif found:
            found[-1][name] = int(value)
    return [kernel for kernel in found if "cayspin" in kernel["symbol"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commands", type=pathlib.Path, metavar="compile_commands.json")
    parser.add_argument("source")
    parser.add_argument("output", metavar="OBJECT")
    parser.add_argument("--may-spill", metavar="PATTERN", default="(?!)")
    arguments = parser.parse_args()
    directory, words = compile_entry(arguments.commands, arguments.source)
    words[words.index("-o") + 1] = arguments.output
    command = [*words, "--cuda-device-only", "-Rpass-analysis=kernel-resource-usage"]
    done = subprocess.run(command, cwd=directory, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    found = kernels(done.stdout)
    if done.returncode != 0 or not found:
        sys.exit(f"{done.stdout}\nno kernels: {shlex.join(command)} ended with {done.returncode}")

    spilled, refused = 0, 0
    print("VGPRs  AGPRs  scratch (bytes)  spilled VGPRs  spilled SGPRs")
    for name, row in sorted(zip(short_names(row["symbol"] for row in found), found),
                            key=lambda pair: pair[0]):
        spilled += row["VGPRs Spill"] > 0
        refused += row["VGPRs Spill"] > 0 and not re.search(arguments.may_spill, name)
        print(f"{row['VGPRs']:>5}  {row['AGPRs']:>5}  {row['ScratchSize']:>15}  "
              f"{row['VGPRs Spill']:>13}  {row['SGPRs Spill']:>13}  {name}")
    print(f"{len(found)} kernels, {spilled} spill vector registers, {refused} that should not")
    return refused > 0


if __name__ == "__main__":
    sys.exit(main())
