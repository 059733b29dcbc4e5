#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compiles the device code of a source and prints the registers that its kernels take; fails if
a kernel of cayspin spills registers or keeps arrays in a stack frame, both of which use memory."""

import sys

from device_kernels import (
    compile_entry, device_command, kernels_of_log, output_of, parser_of, short_names)


def main():
    arguments = parser_of(__doc__).parse_args()
    directory, words = compile_entry(arguments)
    log = output_of(device_command(words, arguments.output), directory)
    found = list(kernels_of_log(log))
    if not found:
        sys.exit(f"{log}\nno kernels")

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
