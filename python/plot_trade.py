#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws what `cayspin trade SCENE --json` measured: error over time, and over evaluations."""

import argparse
import json
import pathlib
import sys

from cayspin_plots import trade_figure


def read(path):
    try:
        trade = json.loads(path.read_text())
        trade_figure.require_keys(trade)
        return trade
    except (OSError, ValueError, KeyError, TypeError) as error:
        sys.exit(f"{path}: cannot be read as the JSON of cayspin trade: {error}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.json")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="PICTURE.png",
                        help="default: the file's name with .png")
    arguments = parser.parse_args()
    output = arguments.output or arguments.file.with_suffix(".png")
    trade_figure.draw(read(arguments.file), output)


if __name__ == "__main__":
    main()
