#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compares how many instructions the main kernels execute per site and step with the expected
numbers, to 2 %. The program is test_instructions."""

import argparse
import pathlib
import re
import sys

import callgrind

MARGIN = 0.02


def wrong_counts(found, expected):
    for name in found.keys() - expected.keys():
        yield f"{name}: not expected"
    for name, before in expected.items():
        if name not in found:
            yield f"{name}: not counted"
            continue
        print(f"{name}: {found[name]:.2f}, expected {before:.2f}")
        if abs(found[name] - before) > MARGIN * before:
            yield f"{name}: {found[name]:.2f} instructions per site and step, expected {before:.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="test_instructions")
    parser.add_argument("expected", type=pathlib.Path)
    parser.add_argument("--record", action="store_true", help="write what is found")
    arguments = parser.parse_args()
    found = {name: int(re.search(r"^totals: (\d+)", text, re.MULTILINE)[1]) / callgrind.SITES
             for name, text in callgrind.dumps_of(arguments.program).items()}
    if arguments.record:
        text = "".join(f"{name} {count:.2f}\n" for name, count in found.items())
        arguments.expected.write_text(text)
        print(f"written to {arguments.expected}:\n{text}")
        return
    lines = arguments.expected.read_text().splitlines()
    expected = {name: float(count) for name, count in map(str.split, lines)}
    if wrong := list(wrong_counts(found, expected)):
        sys.exit("\n  ".join([f"more than {MARGIN:.0%} away:", *wrong,
                              "Where that is meant, build the target record_instructions."]))


if __name__ == "__main__":
    main()
