#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws a trajectory file: components along x, energy, norm defect, a spin's path."""

import pathlib

from cayspin_plots import command_line, components, hodograph, scalars, style
from cayspin_plots.read import read_trajectory

PANELS = ("components", "magnetization", "energy", "norm", "hodograph")
OVER_TIME = {"energy": scalars.draw_energy, "norm": scalars.draw_norm_defect,
             "magnetization": scalars.draw_magnetization}


def parse_arguments():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.h5")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="PNG",
                        help="the picture; its ending chooses the kind (default: FILE.png)")
    parser.add_argument("-p", "--panels", nargs="+", metavar="PANEL",
                        type=command_line.one_of(*PANELS),
                        help="what to draw, of: " + ", ".join(PANELS) + " (default: all)")
    parser.add_argument("-s", "--site", type=command_line.whole,
                        help="the spin of the hodograph, counted from 0 (default: in the middle)")
    return parser.parse_args()


def draw(trajectory, panels, site):
    rows_of_components = 3 if "components" in panels else 0
    narrow = [panel for panel in panels if panel != "components"]
    heights = [1.9] * rows_of_components + [4.0] * ((len(narrow) + 1) // 2)
    columns = 2 if rows_of_components or len(narrow) > 1 else 1
    figure = style.plt.figure(figsize=(5.5 * columns, sum(heights) + 0.3), constrained_layout=True)
    grid = figure.add_gridspec(len(heights), columns, height_ratios=heights)
    if rows_of_components:
        axes = [figure.add_subplot(grid[row, :]) for row in range(3)]
        components.draw_components(axes, trajectory)
    for place, panel in enumerate(narrow):
        axis = figure.add_subplot(grid[rows_of_components + place // 2, place % 2])
        if panel in OVER_TIME:
            OVER_TIME[panel](axis, trajectory)
        else:
            axis.set_title(f"path of spin {site}", loc="center")
            hodograph.draw_hodograph(axis, trajectory.site(site), style.BLUE)
    return figure


def main():
    arguments = parse_arguments()
    trajectory = read_trajectory(arguments.file)
    panels = arguments.panels or list(PANELS)
    if arguments.panels is None and trajectory.spins.shape[3] == 1:
        panels.remove("components")
    site = trajectory.sites() // 2 if arguments.site is None else arguments.site
    figure = draw(trajectory, panels, site)
    note = "" if trajectory.complete else ", not complete"
    figure.suptitle(f"{arguments.file.name}  ({trajectory.precision}{note})", x=0.01, ha="left")
    style.save(figure, arguments.output or arguments.file.with_suffix(".png"))


if __name__ == "__main__":
    main()
