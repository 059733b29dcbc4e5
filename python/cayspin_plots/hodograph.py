# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The path of a spin on the unit sphere, seen from far away."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, to_rgba_array
from matplotlib.patches import Circle

from .style import GREY, INK


A, E = np.radians([55, 22])  # azimuth and elevation of the viewer
RIGHT_UP_TOWARD = np.array([[-np.sin(A), np.cos(A), 0],
                            [-np.sin(E) * np.cos(A), -np.sin(E) * np.sin(A), np.cos(E)],
                            [np.cos(E) * np.cos(A), np.cos(E) * np.sin(A), np.sin(E)]])


def project(points):
    """(n, 3) -> positions on the page (n, 2) and whether the unit sphere hides them (n,)."""
    seen = np.asarray(points, float) @ RIGHT_UP_TOWARD.T
    hidden = (seen[:, 2] < 0) & (np.hypot(seen[:, 0], seen[:, 1]) < 1)
    return seen[:, :2], hidden


def draw_sphere(axis, reach=1.0):
    """Draws a shaded unit sphere with circles of latitude and longitude. The page shows
    |x| <= reach."""
    ticks = np.linspace(-1, 1, 400)
    x, y = np.meshgrid(ticks, ticks)
    depth = np.sqrt(np.clip(1 - x**2 - y**2, 0, 1))
    light = np.clip(0.5 + 0.5 * (0.75 * depth - 0.3 * x + 0.45 * y), 0, 1)
    disk = Circle((0, 0), 1, facecolor="none", edgecolor="#b9bfc6", linewidth=1)
    axis.add_patch(disk)
    shade = LinearSegmentedColormap.from_list("sphere", ["#ccd3da", "#fbfcfd"])
    axis.imshow(light, extent=(-1, 1, -1, 1), origin="lower", cmap=shade, vmin=0.2, vmax=1,
                clip_path=disk, zorder=0)
    angle = np.linspace(0, 2 * np.pi, 241)
    for latitude in np.radians(np.arange(-60, 61, 30)):
        circle = [np.cos(latitude) * np.cos(angle), np.cos(latitude) * np.sin(angle),
                  np.full_like(angle, np.sin(latitude))]
        _draw_grid_line(axis, np.transpose(circle))
    for longitude in np.radians(np.arange(0, 180, 30)):
        circle = [np.sin(angle) * np.cos(longitude), np.sin(angle) * np.sin(longitude),
                  np.cos(angle)]
        _draw_grid_line(axis, np.transpose(circle))
    for name, direction in zip("xyz", np.eye(3)):
        _draw_axis(axis, name, direction)
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")
    axis.set_axis_off()


def _draw_grid_line(axis, points):
    page, hidden = project(points)
    page[hidden] = np.nan
    axis.plot(*page.T, color="white", linewidth=0.9, zorder=1)


def _draw_axis(axis, name, direction):
    (tip, end), _ = project([direction, 1.22 * direction])
    axis.annotate("", end, tip, zorder=4,
                  arrowprops={"arrowstyle": "-|>", "color": GREY, "linewidth": 1, "shrinkA": 0})
    label = end + 0.06 * end / max(np.hypot(*end), 1e-9)
    axis.text(*label, f"${name}$", color=GREY, ha="center", va="center", zorder=4)


def draw_path(axis, path, color, linewidth=1.4, fade=True):
    """Draws a path (n, 3), paler towards its beginning and where the sphere hides it."""
    if len(path) < 2:
        return
    page, hidden = project(path)
    segments = np.stack([page[:-1], page[1:]], axis=1)
    colors = np.repeat(to_rgba_array(color), len(segments), axis=0)
    length = np.cumsum(np.hypot(*(segments[:, 1] - segments[:, 0]).T))
    age = 0.45 + 0.55 * length / max(length[-1], 1e-9) if fade else np.ones(len(segments))
    behind = hidden[:-1] & hidden[1:]
    colors[:, :3] = 1 - (1 - colors[:, :3]) * age[:, None]
    colors[:, 3] = np.where(behind, 0.22, 1)
    for part, capstyle, zorder in ((behind, "butt", 2), (~behind, "round", 3)):
        lines = LineCollection(segments[part], colors=colors[part], linewidths=linewidth,
                               capstyle=capstyle, zorder=zorder)
        axis.add_collection(lines)


def draw_ends(axis, path, color):
    """Draws an open circle at the start of the path, and a filled circle at its end."""
    page, _ = project(path[[0, -1]])
    axis.plot(*page[0], "o", markersize=6, markerfacecolor="white", markeredgecolor=INK, zorder=5)
    axis.plot(*page[1], "o", markersize=7, color=color, markeredgecolor="white", zorder=5)


def reach_of(path):
    """Half the width of the page that shows the sphere, its axes and a path."""
    return max(1.27, 1.05 * float(np.abs(project(path)[0]).max()))


def draw_hodograph(axis, path, color, reference=None, reach=None):
    """Draws the sphere with a path on it (or beside it, if the spins leave the sphere), and a
    reference path under that path."""
    draw_sphere(axis, reach or reach_of(path))
    if reference is not None:
        draw_path(axis, reference, INK, linewidth=0.8, fade=False)
    draw_path(axis, path, color)
    draw_ends(axis, path, color)
