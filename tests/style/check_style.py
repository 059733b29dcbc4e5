#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks the tracked files with clang-format, cmake-format and typos, or formats them with --fix.

The tools are those of requirements.txt, installed by
    python3 -m pip install --target .deps/style -r tests/style/requirements.txt
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SOURCES = re.compile(r".*\.(hpp|cpp)")
BUILD_FILES = re.compile(r"(.*/)?CMakeLists\.txt|.*\.cmake")


def tracked_files(pattern):
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True,
                           text=True).stdout.split("\0")
    return [name for name in names if pattern.fullmatch(name) and (ROOT / name).is_file()]


def commands(tools, fix):
    """Yields the command line of each tool, with the files that it checks or formats."""
    clang_format, cmake_format, typos = (
        str(tools / "bin" / name) for name in ("clang-format", "cmake-format", "typos"))
    yield [clang_format, *(["-i"] if fix else ["--dry-run", "--Werror"]), *tracked_files(SOURCES)]
    yield [cmake_format, "-i" if fix else "--check", *tracked_files(BUILD_FILES)]
    yield [typos, "--force-exclude", "--format", "brief", *tracked_files(re.compile(".+"))]


def differing_pins():
    """Returns the pins of requirements.txt that .pre-commit-config.yaml does not have."""
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    pins = (HERE / "requirements.txt").read_text(encoding="utf-8").split()
    return [pin for pin in pins if pin not in hooks]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fix", action="store_true", help="format files; typos are only listed")
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / ".deps/style",
                        metavar="FOLDER", help="where pip put the tools (default: .deps/style)")
    arguments = parser.parse_args()
    environment = {**os.environ, "PYTHONPATH": str(arguments.tools)}
    running = [subprocess.Popen(command, cwd=ROOT, env=environment, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
               for command in commands(arguments.tools.resolve(), arguments.fix)]
    failed = False
    for process in running:
        output, _ = process.communicate()
        print(output, end="")
        failed |= process.returncode != 0
    for pin in differing_pins():
        print(f".pre-commit-config.yaml does not pin {pin}, as tests/style/requirements.txt does")
        failed = True
    if failed and not arguments.fix:
        print("format with: python3 tests/style/check_style.py --fix")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
