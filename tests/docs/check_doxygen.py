#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs Doxygen; fails on a warning, or on a public class or free function without a docstring.

Usage: check_doxygen.py DOXYGEN ROOT OUTPUT_DIR
"""
import re
import subprocess
import sys

UNDOCUMENTED = re.compile(r"is not documented\.$")
REQUIRED = re.compile(r"Compound cayspin[^ <]* is not documented|\(function\) of namespace cayspin")


def warnings(doxygen, root, settings):
    """Returns the output of Doxygen with docs/Doxyfile and these settings."""
    with open(f"{root}/docs/Doxyfile", encoding="utf-8") as file:
        text = file.read() + "\n" + "\n".join(settings) + "\n"
    run = subprocess.run([doxygen, "-"], input=text, cwd=root, text=True, capture_output=True,
                         check=False)
    lines = [line for line in (run.stdout + run.stderr).splitlines() if line.strip()]
    if run.returncode != 0 and not lines:
        lines.append(f"{doxygen} ended with status {run.returncode}")
    return lines


def main(arguments):
    if len(arguments) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    doxygen, root, output = arguments
    found = warnings(doxygen, root, [f"OUTPUT_DIRECTORY = {output}", "GENERATE_HTML = NO",
                                     "GENERATE_XML = YES", "WARN_IF_UNDOCUMENTED = YES"])
    faults = [line for line in found if not UNDOCUMENTED.search(line) or REQUIRED.search(line)]
    print("\n".join(faults + [f"{len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
