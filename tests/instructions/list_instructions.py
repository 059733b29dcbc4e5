#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Prints what the main kernels execute, by kind of instruction, for each step and pack of spins
(four in double, eight in single precision): in the loop over the packs of a row, and outside it
(ends of rows, rows, tasks). Counted by callgrind, not guessed from the code. The program is
test_instructions."""

import argparse
import collections
import re
import subprocess
import sys

from callgrind import SITES, dumps_of

LANES = {"f64": 4, "f32": 8}

# An instruction's kind is the first one whose pattern matches.
KINDS = [
    ("prefetch", r"prefetch"),
    ("div, sqrt", r"v(div|sqrt|rcp|rsqrt)"),
    ("fma", r"vf(n?m)(add|sub)"),
    ("mul", r"vmul[ps][ds]"),
    ("add, sub", r"v(add|sub)[ps][ds]"),
    ("logic, max", r"v(and|andn|or|xor|max|min)[ps][ds]"),
    ("blend, shuffle", r"v(blend|perm|unpck|shuf|insert|extract|broadcast|movddup|cvt)"),
    ("compare", r"v(cmp|ucomi|comi)"),
    ("load", r"vmov\w+\s+[^,]*\([^)]*\),%[xy]mm|mov\w*\s+[^,]*\([^)]*\),%r"),
    ("store", r"vmov\w+\s+%[xy]mm\d+,.*\(|mov\w*\s+%?\$?\w+,.*\("),
    ("vector move", r"vmov"),
    ("branch", r"j|call|ret"),
    ("integer", r""),
]
ARITHMETIC = ("div, sqrt", "fma", "mul", "add, sub", "logic, max", "compare", "blend, shuffle")


def kind_of(text):
    return next(name for name, pattern in KINDS if re.match(pattern, text))


def has_memory_operand(text):
    return "(" in text and not text.startswith(("lea", "prefetch", "j", "call"))


def counts_of_dump(text):
    """Returns the number of executions of each instruction, by its address in memory, and the
    lowest address of each function."""
    executed, entries = collections.Counter(), {}
    names, address, function, after_call = {}, 0, None, False
    for line in text.splitlines():
        if match := re.match(r"fn=\((\d+)\)(?: (.*))?", line):
            names.setdefault(match[1], match[2])
            function = names[match[1]]
        elif line.startswith("calls="):
            after_call = True
        elif match := re.match(r"(0x[0-9a-f]+|[+-]\d+|\*) \S+(?: (\d+))?$", line):
            step = match[1]
            if step.startswith("0x"):
                address = int(step, 16)
            elif step != "*":
                address += int(step)
            if not after_call:
                executed[address] += int(match[2] or 0)
                entries[function] = min(address, entries.get(function, address))
            after_call = False
    return executed, entries


def disassembly(program):
    """Returns, for the file, the instructions by address and the addresses of the functions."""
    listing = subprocess.run(["objdump", "-d", "--no-show-raw-insn", "-C", program], check=True,
                             text=True, stdout=subprocess.PIPE).stdout
    texts, functions = {}, {}
    for line in listing.splitlines():
        if match := re.match(r"([0-9a-f]+) <(.*)>:$", line):
            functions[match[2]] = int(match[1], 16)
        elif match := re.match(r"\s*([0-9a-f]+):\t(\S.*)", line):
            texts[int(match[1], 16)] = re.sub(r"\s+", " ", match[2].split("#")[0]).strip()
    return texts, functions


def load_offset(counted, functions):
    """Returns the address in memory minus that in the file, on which most functions agree."""
    offsets = collections.Counter(entries[name] - functions[name] for _, entries in counted
                                  for name in entries if name in functions)
    if not offsets:
        sys.exit("no function of the program is in callgrind's output")
    return offsets.most_common(1)[0][0]


def table(name, executed, texts, offset):
    packs = SITES // LANES[name[:3]]
    inside, outside = collections.Counter(), collections.Counter()
    references = 0
    unknown = sum(count for address, count in executed.items() if address - offset not in texts)
    # A sample's five exact sums are zeroed by memset, which counts as one instruction per byte.
    most = 0.06 if name.endswith("sample") else 0.02
    if unknown > most * sum(executed.values()):
        sys.exit(f"{name}: {unknown} of {sum(executed.values())} instructions are not the program's")
    for address, count in executed.items():
        text = texts.get(address - offset, "")
        # Instructions that at least half of the packs execute are the loop's; a few packs take
        # another path.
        of_loop = count if count >= packs / 2 else 0
        inside[kind_of(text)] += of_loop
        outside[kind_of(text)] += count - of_loop
        references += of_loop if has_memory_operand(text) else 0
    print(f"{name}: {sum(inside.values()) / packs:.0f} instructions of the loop for a pack of "
          f"{LANES[name[:3]]} spins, {sum(outside.values()) / packs:.0f} outside; "
          f"{references / packs:.0f} references to memory")
    print(f"  {'kind':16} {'loop':>7} {'outside':>8}")
    for kind, _ in KINDS:
        if inside[kind] or outside[kind]:
            print(f"  {kind:16} {inside[kind] / packs:7.1f} {outside[kind] / packs:8.1f}")
    of_method = sum(inside[kind] for kind in ARITHMETIC)
    print(f"  {'vector arithmetic':16} {of_method / packs:6.1f}\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="test_instructions")
    parser.add_argument("names", nargs="*", help="of kernels, for instance f64_Rkmk4 (default: all)")
    arguments = parser.parse_args()
    texts, functions = disassembly(arguments.program)
    found = dumps_of(arguments.program, "--dump-instr=yes")
    if missing := [name for name in arguments.names if name not in found]:
        sys.exit(f"no kernel {missing[0]}; there are {', '.join(sorted(found))}")
    counted = {name: counts_of_dump(text) for name, text in found.items()}
    offset = load_offset(counted.values(), functions)
    for name in arguments.names or counted:
        table(name, counted[name][0], texts, offset)


if __name__ == "__main__":
    main()
