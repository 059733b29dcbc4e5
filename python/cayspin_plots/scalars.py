# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Curves over time: energy, norm defect, magnetization."""

import numpy as np

from .style import BLUE, COMPONENTS

# Smaller defects are drawn with this value, because a logarithmic axis cannot show 0.
SMALLEST = 1e-17


def draw_energy(axis, trajectory):
    axis.plot(trajectory.in_time_unit(trajectory.scalars.time), trajectory.scalars.energy,
              color=BLUE)
    axis.set_title("energy (J)" if trajectory.si else "energy")
    axis.set_xlabel(trajectory.time_label())


def draw_norm_defect(axis, trajectory, **line):
    """Draws max | |m| - 1 | over the sites, on a logarithmic axis."""
    line.setdefault("color", BLUE)
    defect = np.maximum(trajectory.scalars.norm_defect, SMALLEST)
    axis.set_ylim(SMALLEST, max(1e-12, 30 * float(defect.max())))
    axis.semilogy(trajectory.in_time_unit(trajectory.scalars.time), defect, **line)
    axis.set_title(r"norm defect,  max $|\,|m| - 1\,|$")
    axis.set_xlabel(trajectory.time_label())


def draw_means(axis, x, m, *line, **look):
    """Draws the three components of means (n, 3)."""
    for component, name in enumerate("xyz"):
        axis.plot(x, m[:, component], *line, color=COMPONENTS[component],
                  label=f"$\\langle m_{name} \\rangle$", **look)
    axis.set_ylim(-1.08, 1.08)


def draw_magnetization(axis, trajectory):
    draw_means(axis, trajectory.in_time_unit(trajectory.scalars.time),
               trajectory.scalars.magnetization)
    axis.legend(ncol=3, loc="lower right", bbox_to_anchor=(1, 0.98), borderaxespad=0)
    axis.set_title("magnetization")
    axis.set_xlabel(trajectory.time_label())
