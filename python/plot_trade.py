#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws what `cayspin trade SCENE --json` measured: for one scene, error over cost; for several,
which method to use."""

import json
import pathlib
import sys

from cayspin_plots import command_line, trade_costs, trade_figure, trade_overview


def read(path):
    try:
        trade = json.loads(path.read_text())
        trade_costs.require_keys(trade)
        return trade
    except (OSError, ValueError, KeyError, TypeError) as error:
        sys.exit(f"{path}: cannot be read as the JSON of cayspin trade: {error}")


def main():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("files", type=pathlib.Path, nargs="+", metavar="FILE.json")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="PICTURE.png",
                        help="default: the first file's name with .png")
    parser.add_argument("--all", action="store_true",
                        help="of one scene: all methods, and evaluations beside seconds")
    arguments = parser.parse_args()
    output = arguments.output or arguments.files[0].with_suffix(".png")
    trades = [read(path) for path in arguments.files]
    if len(trades) == 1:
        trade_figure.draw(trades[0], output, arguments.all)
    else:
        trade_overview.draw(trades, output)


if __name__ == "__main__":
    main()
