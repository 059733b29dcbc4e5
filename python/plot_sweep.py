#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws the file of `cayspin sweep`: the final values of its runs over one key, or as a map over
two."""

import pathlib

from cayspin_plots import command_line, style, sweep_figure
from cayspin_plots.sweep import read_sweep


def main():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.h5")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="PNG",
                        help="the picture; its ending chooses the kind (default: FILE.png)")
    parser.add_argument("-k", "--keys", nargs="+", metavar="KEY",
                        help="one or two keys of the sweep for the axes; each combination of the "
                        "others has its own row (default: the first two)")
    arguments = parser.parse_args()
    sweep = read_sweep(arguments.file)
    figure = sweep_figure.draw(sweep, sweep_figure.choose_keys(sweep, arguments.keys))
    style.save(figure, arguments.output or arguments.file.with_suffix(".png"))


if __name__ == "__main__":
    main()
