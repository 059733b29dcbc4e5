#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles layouts.cpp and fails if a struct that kernels take has another size on the device than
on the host: kernels would look for its members in wrong places. nvcc 12.9 and 13 give structs with
[[no_unique_address]] members such different sizes."""

import pathlib
import re
import subprocess
import sys

from device_kernels import compile_entry, device_command, output_of, parser_of


def sizes_on_host(words, directory, output):
    """Returns {mangled name of a struct: (its size, a symbol that contains the name)}."""
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
    arguments = parser_of(__doc__).parse_args()  # output: a path without its ending
    directory, words = compile_entry(arguments)
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
