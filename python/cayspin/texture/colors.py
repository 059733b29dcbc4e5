# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Directions as colours, and the keys beside a picture."""

from __future__ import annotations

from typing import Any

import numpy as np

from .spins import AXES, Plane

INK, WHITE = "#22262b", "white"
MAPS = {"safe": "coolwarm", "charge": "PuOr_r", "difference": "viridis"}


def hue_colors(spins: np.ndarray) -> np.ndarray:
    """Red, green and blue (..., 3) of spins (..., 3) with components along right, up and the
    normal: the hue is the angle in the plane, red to the right and yellow-green up. Spins along the
    normal are light grey, against it dark grey. White where there is no spin."""
    spins = np.asarray(spins, np.float32)
    right, up, normal = (spins[..., axis] for axis in range(3))
    length = np.sqrt(right * right + up * up + normal * normal)
    there = length > 0
    normal = normal / np.where(there, length, 1)
    turn = np.arctan2(up, right) * np.float32(3 / np.pi)  # in sixths
    saturation = 1 - np.abs(normal)
    base = 0.5 + 0.4 * normal - 0.5 * saturation
    colors = np.empty(spins.shape, np.float32)
    for channel, peak in enumerate((0, 2, 4)):
        away = np.abs((turn - peak + 3) % 6 - 3)
        colors[..., channel] = base + saturation * np.clip(2 - away, 0, 1)
    colors[~there] = 1
    return np.clip(colors, 0, 1)


def map_colors(values: np.ndarray, name: str, lowest: float, highest: float) -> Any:
    """Returns the colours of values, white for NaN, and the ScalarMappable that draws the scale.
    The colour map MAPS[name] extends from `lowest` to `highest`."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    colors = matplotlib.colormaps[MAPS[name]].with_extremes(bad=WHITE)
    painter = ScalarMappable(Normalize(lowest, highest), colors)
    return colors(painter.norm(np.ma.masked_invalid(values)))[..., :3], painter


def wheel_colors(pixels: int) -> np.ndarray:
    """Returns the key of hue_colors, an image (pixels, pixels, 4). Its middle has the colour of a
    spin along the normal, the points half way out those of spins in the plane, and the rim that of
    a spin against the normal. It is transparent beyond the rim."""
    across = (np.arange(pixels) + 0.5) / pixels * 2 - 1
    right, up = np.meshgrid(across, across)
    radius = np.hypot(right, up)
    angle = np.pi * np.minimum(radius, 1)
    part = np.sin(angle) / np.maximum(radius, 1e-9)
    colors = hue_colors(np.stack((right * part, up * part, np.cos(angle)), -1))
    edge = np.clip((1 - radius) * pixels / 2, 0, 1)
    return np.concatenate((colors, edge[..., None]), -1)


def _beside(axes, width, height, below=0.0):
    """New axes to the right of `axes`. `width` and `height` are in inches or, as text, in percent
    of those of `axes`; the new axes begin `below` inches below the top of `axes`."""
    from matplotlib.transforms import ScaledTranslation
    from mpl_toolkits.axes_grid1.inset_locator import inset_axes

    away = ScaledTranslation(0.42, -below, axes.figure.dpi_scale_trans)
    return inset_axes(axes, width, height, loc="upper left", bbox_to_anchor=(1, 0, 1, 1),
                      bbox_transform=axes.transAxes + away, borderpad=0)


def draw_wheel(axes: Any, plane: Plane) -> Any:
    """Draws the wheel of the colours to the right of `axes`, with the names of its directions."""
    key = _beside(axes, 1.1, 1.1, 0.12)
    key.imshow(wheel_colors(256), origin="lower", extent=(-1, 1, -1, 1))
    key.set_axis_off()
    right, up, normal = (AXES[axis] for axis in plane.axes)
    for x, y, text in ((1.08, 0, f"+{right}"), (-1.08, 0, f"\u2212{right}"), (0, 1.08, f"+{up}"),
                       (0, -1.08, f"\u2212{up}")):
        sides = {1: "left", -1: "right", 0: "center"}, {1: "bottom", -1: "top", 0: "center"}
        key.text(x, y, text, ha=sides[0][round(x)], va=sides[1][round(y)], fontsize="small")
    key.text(0, -1.65, f"middle: +{normal}, rim: \u2212{normal}", ha="center", va="top",
             fontsize="small")
    return key


def draw_scale(axes: Any, painter: Any, label: str) -> Any:
    """Draws the scale of a colour map to the right of `axes`."""
    key = _beside(axes, 0.15, "100%")
    axes.figure.colorbar(painter, cax=key, label=label)
    key.grid(False)
    return key
