#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws the figures of Lewis and Nigam 2002 from what `cayspin reproduce figures` wrote."""

import pathlib

import numpy as np
from cayspin_plots import command_line, hodograph, style
from cayspin_plots.table import groups, read_table

SLABS = {
    "weak_overdamped": "fig:1  overdamped slab, applied (0.05, 0.05, 0)",
    "strong_overdamped": "fig:2  overdamped slab, applied (5, 0, 0)",
    "full": "fig:4  slab with precession, applied (5, 0, 0), damping 0.05",
}
# Runs of a slab that the paper draws.
DRAWN = {
    "Euler, dt = 0.0001": style.INK,
    "geometric Euler, optimal sigma, dt = 0.01": style.BLUE,
    "geometric Euler, sigma = 10, dt = 0.01": style.RED,
}
COLORS = (style.BLUE, style.RED, style.COMPONENTS[1], "#a26bc0", "#d99a2b", style.GREY)


def points(part):
    return np.transpose([part["x"], part["y"], part["z"]])


def draw_trajectories(folder):
    table = read_table(folder / "trajectories.csv", ("body", "update", "path"),
                       ("time", "x", "y", "z"))
    figure = style.plt.figure(figsize=(11, 7.6), constrained_layout=True)
    panels = list(groups(table, "body", "update"))
    for place, ((body, update), panel) in enumerate(panels):
        axis = figure.add_subplot(2, (len(panels) + 1) // 2, place + 1)
        axis.set_title(f"{update}, {body}", loc="center")
        hodograph.draw_sphere(axis, 1.27)
        for number, (_, path) in enumerate(groups(panel, "path")):
            hodograph.draw_path(axis, points(path), COLORS[number % len(COLORS)],
                                linewidth=0.8, fade=False)
    figure.suptitle("traj_plots  free rigid bodies over [0, 200], geometric Euler, dt = 0.1")
    style.save(figure, folder / "trajectories.png")


def draw_slab(folder, name, title):
    table = read_table(folder / f"slab_{name}.csv", ("run",), ("time", "x", "y", "z", "log_norm"))
    sigma = read_table(folder / f"sigma_{name}.csv", (), ("time", "sigma"))
    figure = style.plt.figure(figsize=(11, 5.4), constrained_layout=True)
    left, right = figure.subplots(1, 2)
    runs = dict(groups(table, "run"))
    paths = {run: points(runs[run]) for run in DRAWN if run in runs}
    hodograph.draw_sphere(left, max(map(hodograph.reach_of, paths.values())))
    for run, path in paths.items():
        hodograph.draw_path(left, path, DRAWN[run], fade=False)
        hodograph.draw_ends(left, path, DRAWN[run])
        left.plot([], [], color=DRAWN[run], label=run)
    left.legend(loc="upper center", bbox_to_anchor=(0.5, 0.04), fontsize=9)
    left.set_title("spin 37", loc="center")
    right.plot(sigma["time"], sigma["sigma"], color=style.BLUE)
    right.set_title("its optimal sigma")
    right.set_xlabel("time")
    figure.suptitle(title)
    style.save(figure, folder / f"slab_{name}.png")


def draw_slab_norm(folder):
    table = read_table(folder / "slab_full.csv", ("run",), ("time", "x", "y", "z", "log_norm"))
    figure, axis = style.plt.subplots(figsize=(8, 4.4), constrained_layout=True)
    for run, part in groups(table, "run"):
        if run in DRAWN:
            axis.plot(part["time"], np.exp(part["log_norm"]), color=DRAWN[run], label=run)
    axis.set_title("fig:5  |m| of the spin farthest from the sphere, slab of fig:4")
    axis.set_xlabel("time")
    axis.ticklabel_format(useOffset=False)
    axis.legend()
    style.save(figure, folder / "slab_norm.png")


def draw_orders(folder):
    table = read_table(folder / "orders.csv", ("sweep", "method"),
                       ("sigma", "fitted_order", "finest_order", "error"))
    sweeps = list(groups(table, "sweep"))
    figure, axes = style.plt.subplots(2, len(sweeps), figsize=(11, 7.6), squeeze=False,
                                      constrained_layout=True)
    for (above, below), (sweep, panel) in zip(axes.T, sweeps):
        for number, (method, part) in enumerate(groups(panel, "method")):
            color = COLORS[number % len(COLORS)]
            above.plot(part["sigma"], part["fitted_order"], "o-", color=color, markersize=4,
                       label=method)
            above.plot(part["sigma"], part["finest_order"], ":", color=color)
            below.semilogy(part["sigma"], part["error"], "o-", color=color, markersize=4)
        above.set_title(f"order, {sweep}")
        below.set_title("error at dt = 0.02")
        below.set_xlabel("sigma")
    axes[0, 0].legend(fontsize=9)
    figure.suptitle("fig:7, fig:10  order over sigma, damping 10: fitted, and of the finest pair of "
                    "dt (dotted)")
    style.save(figure, folder / "orders.png")


def draw_convergence(folder):
    table = read_table(folder / "convergence.csv", ("case", "method"), ("dt", "error", "error_x"))
    cases = list(groups(table, "case"))
    figure, axes = style.plt.subplots(1, len(cases), figsize=(13, 4.8), squeeze=False,
                                      constrained_layout=True)
    for axis, (case, panel) in zip(axes[0], cases):
        for number, (method, part) in enumerate(groups(panel, "method")):
            axis.loglog(part["dt"], part["error"], "o-", color=COLORS[number], label=method)
            axis.loglog(part["dt"], part["error_x"], "o:", color=COLORS[number],
                        label=f"{method}, $m_x$ of spin 37")
        axis.set_title(case, fontsize=10)
        axis.set_xlabel("dt")
    axes[0, 0].legend(fontsize=9)
    figure.suptitle("fig:7b  error of RKMK4 over dt, sigma = 0")
    style.save(figure, folder / "convergence.png")


def draw_norm(folder):
    table = read_table(folder / "norm.csv", ("method", "damping"), ("time", "log_norm"))
    figure, axis = style.plt.subplots(figsize=(8, 4.8), constrained_layout=True)
    for number, (damping, panel) in enumerate(groups(table, "damping")):
        for method, part in groups(panel, "method"):
            size = np.maximum(np.abs(part["log_norm"]), 1e-17)
            axis.semilogy(part["time"], size, "-" if method == "RK4" else ":",
                          color=COLORS[number], label=f"{method}, damping {damping}")
    axis.set_title("fig:9  |ln|m||, classical RK4 and RKMK4, dt = 0.01")
    axis.set_xlabel("time")
    axis.legend(fontsize=9, ncol=2)
    style.save(figure, folder / "norm.png")


def main():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, metavar="DIR",
                        help="the --output of `cayspin reproduce figures`")
    folder = parser.parse_args().folder
    draw_trajectories(folder)
    for name, title in SLABS.items():
        draw_slab(folder, name, title)
    draw_slab_norm(folder)
    draw_orders(folder)
    draw_convergence(folder)
    draw_norm(folder)


if __name__ == "__main__":
    main()
