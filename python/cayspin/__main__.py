# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""python -m cayspin, and the command `cayspin` of the package: the program of the wheel."""

import os
import sys

from cayspin.trade import program


def main():
    os.environ.setdefault("CAYSPIN_PYTHON", sys.executable)  # for `plot` and `view`
    os.execv(program(), ["cayspin", *sys.argv[1:]])


if __name__ == "__main__":
    main()
