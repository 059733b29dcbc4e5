#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles the device code of a source and prints the registers that its kernels take; fails when
a kernel of cayspin spills any, or keeps arrays in a stack frame, both of which is memory."""

import argparse
import pathlib
import re
import shlex
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from device_kernels import compile_entry, short_names  # noqa: E402

ENTRY = re.compile(
    r"Compiling entry function '(\S+)'.*?(\d+) bytes stack frame, (\d+) bytes spill stores, "
    r"(\d+) bytes spill loads.*?Used (\d+) registers", re.DOTALL)


def device_command(words, output):
    """nvcc's own command for the cubin, from the one that compiles the object."""
    words.remove("-c")
    at = words.index("-o")
    del words[at:at + 2]
    asked = subprocess.run([words[0], "--show", *words[1:]], check=True, text=True,
                           stdout=subprocess.PIPE)
    return [*shlex.split(asked.stdout), "-Xptxas=-v", "-cubin", "-o", output]


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
    found = [match.groups() for match in ENTRY.finditer(done.stdout) if "cayspin" in match[1]]
    if done.returncode != 0 or not found:
        sys.exit(f"{done.stdout}\nno kernels: {shlex.join(command)} ended with {done.returncode}")

    spilled = 0
    print("registers  stack  spilled  (bytes)")
    for name, row in sorted(zip(short_names(row[0] for row in found), found)):
        _, stack, stores, loads, registers = row
        spilled += (stack, stores, loads) != ("0", "0", "0")
        print(f"{registers:>9}  {stack:>5}  {int(stores) + int(loads):>7}  {name}")
    print(f"{len(found)} kernels, {spilled} with spills or a stack frame")
    return spilled > 0


if __name__ == "__main__":
    sys.exit(main())
