# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shared code of the tests of device compilers."""

import argparse
import collections
import json
import pathlib
import re
import shlex
import subprocess
import sys

Kernel = collections.namedtuple("Kernel", "symbol stack spill_stores spill_loads registers")
ENTRY = re.compile(
    r"Compiling entry function '(\S+)'.*?(\d+) bytes stack frame, (\d+) bytes spill stores, "
    r"(\d+) bytes spill loads.*?Used (\d+) registers", re.DOTALL)


def parser_of(description):
    """Returns the parser of a script that recompiles a source into another file."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("commands", type=pathlib.Path, metavar="compile_commands.json")
    parser.add_argument("source")
    parser.add_argument("output")
    return parser


def compile_entry(arguments):
    """Returns the directory and the words of the command that compiles the source."""
    entry = next(entry for entry in json.loads(arguments.commands.read_text())
                 if entry["file"] == arguments.source)
    return entry["directory"], shlex.split(entry["command"])


def output_of(command, directory):
    """Returns the output of a command. If the command fails, ends the script."""
    done = subprocess.run(command, cwd=directory, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}\n{shlex.join(command)} ended with {done.returncode}")
    return done.stdout


def device_command(words, output):
    """Returns nvcc's command for the cubin, made from nvcc_wrapper's command for the object."""
    words = list(words)
    words.remove("-c")
    at = words.index("-o")
    del words[at:at + 2]
    asked = subprocess.run([words[0], "--show", *words[1:]], check=True, text=True,
                           stdout=subprocess.PIPE)
    return [*shlex.split(asked.stdout), "-Xptxas=-v", "-cubin", "-o", output]


def kernels_of_log(text):
    """Yields the statistics of ptxas for cayspin's kernels."""
    for symbol, *numbers in ENTRY.findall(text):
        if "cayspin" in symbol:
            yield Kernel(symbol, *map(int, numbers))


def short_names(symbols):
    """Yields the names and precisions of kernels, without Kokkos' wrapping."""
    names = subprocess.run(["c++filt"], input="\n".join(symbols), check=True, text=True,
                           stdout=subprocess.PIPE).stdout.splitlines()
    for name in names:
        inner = re.search(r"ParallelFor<(.*?), Kokkos::(Range|Team)Policy", name)
        yield re.sub(r"(cayspin|detail|stepper|tableau)::", "", inner[1] if inner else name)
