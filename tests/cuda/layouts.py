#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles layouts.cpp and fails where a struct that kernels take has another size for the device
than for the host: then kernels find nothing in its place. nvcc 12.9 and 13 do so to structs with
[[no_unique_address]] members."""

import argparse
import pathlib
import re
import shlex
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from device_kernels import compile_entry, device_command  # noqa: E402


def output_of(command, directory):
    done = subprocess.run(command, cwd=directory, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}\n{shlex.join(command)} ended with {done.returncode}")
    return done.stdout


def sizes_on_host(words, directory, output):
    """By the mangled name of the struct: the size, and a symbol that has the name."""
    words = list(words)
    words[words.index("-o") + 1] = output
    output_of(words, directory)
    found = re.findall(r"(\S+8has_sizeI(\S+)Lm(\d+)EEEvv)$", output_of(["nm", output], directory),
                       re.MULTILINE)
    return {name: (int(size), symbol) for symbol, name, size in found}


def sizes_on_device(words, directory, output):
    command = device_command(words, output)
    command[command.index("-cubin")] = "-ptx"
    output_of(command, directory)
    found = re.findall(r"\.entry \S+?5takesI(\S+)EEvT_\(\s*\.param \S+ \d+ \.b8 \S+\[(\d+)\]",
                       pathlib.Path(directory, output).read_text(encoding="utf-8"))
    return {name: int(size) for name, size in found}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commands", type=pathlib.Path, metavar="compile_commands.json")
    parser.add_argument("source")
    parser.add_argument("output", metavar="FILE", help="without its ending")
    arguments = parser.parse_args()
    directory, words = compile_entry(arguments.commands, arguments.source)
    host = sizes_on_host(words, directory, f"{arguments.output}.o")
    device = sizes_on_device(words, directory, f"{arguments.output}.ptx")
    if not host or host.keys() != device.keys():
        sys.exit(f"{len(host)} structs on the host, {len(device)} on the device")
    differ = 0
    for name, (size, symbol) in host.items():
        if size != device[name]:
            differ += 1
            readable = subprocess.run(["c++filt", symbol], check=True, text=True,
                                      stdout=subprocess.PIPE).stdout.strip()
            print(f"{size} bytes on the host, {device[name]} on the device: {readable}")
    print(f"{len(host)} structs, {differ} with two sizes")
    return differ > 0


if __name__ == "__main__":
    sys.exit(main())
