#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""One picture of what geometric integration is for: two runs of one scene, side by side."""

import pathlib

from cayspin_plots import command_line, hodograph, scalars, style
from cayspin_plots.read import read_trajectory


def parse_arguments():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("geometric", type=pathlib.Path, metavar="GEOMETRIC.h5")
    parser.add_argument("classical", type=pathlib.Path, metavar="CLASSICAL.h5")
    parser.add_argument("-r", "--reference", type=pathlib.Path, metavar="REFERENCE.h5",
                        help="a more accurate run, drawn thin beneath both")
    parser.add_argument("-s", "--site", type=command_line.whole, default=37,
                        help="the spin to follow (default: 37)")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="PNG")
    return parser.parse_args()


def draw_paths(axes, geometric, classical, reference, site):
    under = None if reference is None else reference.site(site)
    reach = max(hodograph.reach_of(run.site(site)) for run in (geometric, classical))
    for axis, run, color, title in zip(
        axes,
        (geometric, classical),
        (style.BLUE, style.RED),
        ("Geometric Euler: each step is a rotation", "Classical Euler: the spin leaves the sphere"),
    ):
        axis.set_title(title, color=color, weight="bold", loc="center")
        hodograph.draw_hodograph(axis, run.site(site), color, under, reach)


def draw_norms(axis, geometric, classical):
    for run, color, name in ((classical, style.RED, "classical Euler"),
                             (geometric, style.BLUE, "geometric Euler")):
        scalars.draw_norm_defect(axis, run, color=color, linewidth=1.8)
        worst = float(run.scalars.norm_defect.max())
        end = run.in_time_unit(run.scalars.time[-1])
        axis.annotate(f"{name}: at most {worst:.2g}", (end, worst), (0, 8), textcoords="offset points",
                      ha="right", color=color, weight="bold")
    axis.set_title(r"How far the spins are from the sphere:  max $|\,|m| - 1\,|$ over the slab")
    axis.set_ylim(scalars.SMALLEST, 100)
    axis.set_yticks([1e-16, 1e-12, 1e-8, 1e-4, 1])
    axis.margins(x=0.01)


def main():
    arguments = parse_arguments()
    geometric, classical = map(read_trajectory, (arguments.geometric, arguments.classical))
    reference = arguments.reference and read_trajectory(arguments.reference)
    figure = style.plt.figure(figsize=(11, 8), constrained_layout=True)
    grid = figure.add_gridspec(2, 2, height_ratios=(5.4, 2.6))
    spheres = [figure.add_subplot(grid[0, column]) for column in range(2)]
    draw_paths(spheres, geometric, classical, reference, arguments.site)
    draw_norms(figure.add_subplot(grid[1, :]), geometric, classical)
    title = f"Spin {arguments.site} of a switching slab: the same equation, the same step"
    if reference is not None:
        title += " (black: an accurate run)"
    figure.suptitle(title)
    style.save(figure, arguments.output)


if __name__ == "__main__":
    main()
