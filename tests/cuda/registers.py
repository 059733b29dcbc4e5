#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles the device code of a source and prints the registers that its kernels take; fails when
a kernel of cayspin spills any, or keeps arrays in a stack frame, both of which is memory."""

import argparse
import pathlib
import shlex
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from device_kernels import (  # noqa: E402
    compile_entry, device_command, kernels_of_log, short_names)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commands", type=pathlib.Path, metavar="compile_commands.json")
    parser.add_argument("source")
    parser.add_argument("output", metavar="CUBIN")
    arguments = parser.parse_args()
    directory, words = compile_entry(arguments.commands, arguments.source)
    command = device_command(words, arguments.output)
    done = subprocess.run(command, cwd=directory, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    found = list(kernels_of_log(done.stdout))
    if done.returncode != 0 or not found:
        sys.exit(f"{done.stdout}\nno kernels: {shlex.join(command)} ended with {done.returncode}")

    spilled = 0
    print("registers  stack  spilled  (bytes)")
    for name, row in sorted(zip(short_names(row.symbol for row in found), found)):
        bytes_spilled = row.spill_stores + row.spill_loads
        spilled += row.stack + bytes_spilled > 0
        print(f"{row.registers:>9}  {row.stack:>5}  {bytes_spilled:>7}  {name}")
    print(f"{len(found)} kernels, {spilled} with spills or a stack frame")
    return spilled > 0


if __name__ == "__main__":
    sys.exit(main())
