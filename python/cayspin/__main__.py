# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Starts the program cayspin: for python -m cayspin, and for the command `cayspin` of the wheel."""

import os
import sys

from cayspin.trade import program


def main():
    os.environ.setdefault("CAYSPIN_PYTHON", sys.executable)  # for `plot` and `view`
    name = program()
    try:
        os.execv(name, ["cayspin", *sys.argv[1:]])
    except OSError as error:
        print(f"cayspin: the program {name} does not run: {error.strerror}; accepted: one on the "
              "PATH, or its file in CAYSPIN_PROGRAM", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
