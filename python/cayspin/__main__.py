# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""python -m cayspin, and the command `cayspin` of the package: the program of the wheel."""

import os
import sys

from cayspin.trade import program


def main():
    if sys.argv[1:2] == ["view"]:
        from cayspin.view.__main__ import main as view

        os.environ["CAYSPIN_PROGRAM"] = program()
        del sys.argv[1]
        return view()
    os.execv(program(), ["cayspin", *sys.argv[1:]])


if __name__ == "__main__":
    main()
