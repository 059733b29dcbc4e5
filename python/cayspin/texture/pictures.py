# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws films, planes of boxes and of crystals, and chains into matplotlib axes."""

from __future__ import annotations

import numbers
from typing import Any

import numpy as np

from . import colors as palette
from .charge import half_solid_angles
from .spins import AXES, Plane, Texture, plane_of

_COMPONENTS = ("#d55e00", "#009e73", "#0072b2")  # distinct also for colour-blind readers
_ARROWS, _INCHES_OF_ARROW = 24, 0.2


class _Picture:
    """Data of a plane to draw: colours `rgb` of the sites; numbers `field` for a colour scale."""

    def __init__(self, texture, plane, quantity, colors, before, limit):
        self.plane = plane
        self.spins = plane.vectors(texture.spins)
        self.field, self.label, self.painter = None, "", None
        self.has_arrows = before is None and quantity == "spins"
        self.is_charge = quantity == "charge"
        there, normal = self.spins.any(-1), AXES[plane.normal]
        title = [texture.title]
        if plane.of > 1:
            title.append(f"plane {normal}={plane.number} of {plane.of}")
        if before is not None:
            change = plane.vectors(before).astype(np.float64) - self.spins
            self.field = np.where(there, np.sqrt((change**2).sum(-1)), np.nan)
            self._paint("difference", "|difference of m|", 0, limit)
        elif self.is_charge:
            boundary = [texture.boundary[axis] for axis in (plane.right, plane.up)]
            self.field = half_solid_angles(self.spins.astype(np.float64), boundary) / (2 * np.pi)
            title.append(f"Q = {self.field.sum():.4f}")
            self._paint("charge", "topological charge of a cell", -1, limit)
        elif colors == "safe":
            length = np.sqrt((self.spins.astype(np.float64)**2).sum(-1))
            self.field = self.spins[..., 2] / np.where(there, length, np.nan)
            self._paint("safe", f"$m_{normal}$", -1, 1)
        else:
            self.rgb = palette.hue_colors(self.spins)
        self.title = ", ".join(filter(None, title))

    def largest(self):
        return 0.0 if self.field is None else float(np.nanmax(np.abs(self.field), initial=0))

    def _paint(self, name, label, lowest, limit):
        limit = limit or self.largest() or 1.0
        self.rgb, self.painter = palette.map_colors(self.field, name, lowest * limit, limit)
        self.label = label

    def draw_key(self, axes):
        if self.painter is None:
            palette.draw_wheel(axes, self.plane)
        else:
            palette.draw_scale(axes, self.painter, self.label)


def _length_unit(largest, si):
    """The factor from the file's unit of length to the unit of axes, and that unit's name in
    labels."""
    if not si:
        return 1.0, ""
    for size, name in ((1e-5, "nm"), (1e-2, "\u00b5m"), (np.inf, "mm")):
        if largest < size:
            return {"nm": 1e9, "\u00b5m": 1e6, "mm": 1e3}[name], f" ({name})"


def _new_axes(width, height):
    """Axes of a new figure for something of this width and height, with room for the key."""
    import matplotlib.pyplot

    scale = 5.5 / max(width, height)
    inches = max(1.5, width * scale), max(1.8, height * scale)
    whole = inches[0] + 2.6, inches[1] + 1.1
    figure = matplotlib.pyplot.figure(figsize=whole)
    place = 0.75 / whole[0], 0.6 / whole[1], inches[0] / whole[0], inches[1] / whole[1]
    return figure.add_axes(place, anchor="NW")


def _steps(axes, extents, lengths):
    """Returns how many cells share an arrow along right and up. Both numbers are odd, so that the
    arrow is on the middle cell."""
    box = axes.get_window_extent().width, axes.get_window_extent().height
    inches = min(side / length for side, length in zip(box, lengths)) / axes.figure.dpi
    count = max(1.0, min(_ARROWS, max(lengths) * inches / _INCHES_OF_ARROW))
    apart = max(lengths) / count
    return [1 + 2 * max(0, int(np.ceil((apart * extent / length - 1.5) / 2)))
            for extent, length in zip(extents, lengths)]


def _middles(count, step):
    """The middles of the blocks of `step` cells that fit into `count` cells."""
    step = min(step, count)
    return np.arange(step // 2 + count % step // 2, count, step)[:count // step]


def _draw_arrows(axes, x, y, spins, rgb, longest):
    """Draws arrows along the in-plane parts of spins (n, 3), on a background of the colours
    `rgb`."""
    spins = spins / np.maximum(np.linalg.norm(spins, axis=-1, keepdims=True), 1e-300)
    seen = np.hypot(spins[:, 0], spins[:, 1]) > 0.2
    dark = rgb @ (0.299, 0.587, 0.114) < 0.25
    ink = np.where(dark, palette.WHITE, palette.INK)[seen]
    return axes.quiver(x[seen], y[seen], *spins[seen, :2].T, color=ink, pivot="mid", angles="xy",
                       units="xy", scale_units="xy", scale=1 / longest, width=0.09 * longest,
                       minlength=0, headwidth=3.4, headlength=4, headaxislength=3.6)


def _draw_film(axes, picture, texture):
    plane = picture.plane
    extents = picture.spins.shape[1], picture.spins.shape[0]
    factor, unit = _length_unit(max(n * d for n, d in zip(texture.spins.shape[-2:-5:-1],
                                                          texture.spacing)), texture.si)
    cell = [texture.spacing[axis] * factor for axis in (plane.right, plane.up)]
    lengths = [n * d for n, d in zip(extents, cell)]
    axes = _new_axes(*lengths) if axes is None else axes
    up, right = picture.rgb.shape[:2]
    corner = [d / 2 if picture.is_charge else 0 for d in cell]
    colored, scale = picture.rgb, {}
    if picture.painter is not None:
        colored = np.ma.masked_invalid(picture.field)
        scale = {"cmap": picture.painter.cmap, "norm": picture.painter.norm}
    axes.imshow(colored, origin="lower", extent=(corner[0], corner[0] + right * cell[0],
                                                 corner[1], corner[1] + up * cell[1]),
                interpolation="nearest" if max(extents) <= 300 else "antialiased", **scale)
    axes.set(xlim=(0, max(lengths[0], corner[0] + right * cell[0])),
             ylim=(0, max(lengths[1], corner[1] + up * cell[1])), aspect="equal")
    if picture.has_arrows:
        steps = _steps(axes, extents, lengths)
        at = [_middles(count, step) for count, step in zip(extents, steps)]
        x, y = np.meshgrid(*((number + 0.5) * d for number, d in zip(at, cell)))
        chosen = np.ix_(at[1], at[0])
        _draw_arrows(axes, x.ravel(), y.ravel(), picture.spins[chosen].reshape(-1, 3),
                     picture.rgb[chosen].reshape(-1, 3),
                     0.85 * min(step * d for step, d in zip(steps, cell)))
    return axes, unit


def _draw_crystal(axes, picture, texture):
    from matplotlib.collections import EllipseCollection

    plane = picture.plane
    flat, apart = plane.sites(texture.positions)
    factor, unit = _length_unit(np.ptp(texture.positions.reshape(-1, 3), axis=0).max(), texture.si)
    flat, apart = flat * factor, apart * factor
    lowest, highest = flat[:, :2].min(0) - 0.7 * apart, flat[:, :2].max(0) + 0.7 * apart
    axes = _new_axes(*(highest - lowest)) if axes is None else axes
    axes.set(xlim=(lowest[0], highest[0]), ylim=(lowest[1], highest[1]), aspect="equal")
    up, right = picture.spins.shape[-3:-1]
    sites = len(flat) // (up * right)
    spins, rgb = picture.spins.reshape(-1, 3), picture.rgb.reshape(-1, 3)
    there = spins.any(-1)
    upwards = np.argsort(flat[:, 2], kind="stable")
    upwards = upwards[there[upwards]]
    size = np.full(len(upwards), 0.86 * apart)
    axes.add_collection(EllipseCollection(
        size, size, np.zeros_like(size), units="xy", offsets=flat[upwards, :2],
        offset_transform=axes.transData, facecolors=rgb[upwards], edgecolors="0.6",
        linewidths=0.4 if len(upwards) < 4000 else 0), autolim=False)
    if picture.has_arrows:
        steps = _steps(axes, (right, up), highest - lowest)
        cells = np.zeros((sites, up, right), bool)
        cells[:, _middles(up, steps[1])[:, None], _middles(right, steps[0])] = True
        chosen = cells.ravel() & there
        _draw_arrows(axes, flat[chosen, 0], flat[chosen, 1], spins[chosen], rgb[chosen],
                     0.85 * apart * (min(steps) if sites == 1 else 1))
    return axes, unit


def _draw_chain(axes, picture, texture):
    """Draws a chain along its axis: components or the difference, and a strip of colours above."""
    plane = picture.plane
    along = plane.right if picture.spins.shape[-2] > 1 else plane.up
    count = picture.spins.shape[-3] * picture.spins.shape[-2]
    spacing = texture.spacing[along]
    factor, unit = _length_unit(count * spacing, texture.si)
    x = (np.arange(count) + 0.5) * spacing * factor
    if axes is None:
        axes = _new_axes(5.5, 3.6)
        axes.set_position(axes.get_position().from_bounds(*axes.get_position().bounds[:3],
                                                          3.0 / axes.figure.get_figheight()))
    if picture.has_arrows:
        there = picture.spins.reshape(count, 3).any(-1)
        for axis, color in enumerate(_COMPONENTS):
            m = picture.spins.reshape(count, 3)[:, plane.axes.index(axis)]
            axes.plot(x, np.where(there, m, np.nan), color=color, label=f"$m_{AXES[axis]}$",
                      marker="." if count < 50 else None)
        axes.legend(loc="lower right", bbox_to_anchor=(1.01, 1.11), ncol=3, frameon=False)
    else:
        axes.plot(x, picture.field.ravel(), color=_COMPONENTS[2])
        axes.set_ylabel(picture.label)
    end = count * spacing * factor
    strip = axes.inset_axes([0, 1.03, 1, 0.09])
    strip.imshow(picture.rgb.reshape(1, count, 3), extent=(0, end, 0, 1), aspect="auto",
                 interpolation="nearest" if count <= 1000 else "antialiased")
    strip.set(xlim=(0, end), xticks=[], yticks=[])
    strip.grid(False)
    strip.set_title(picture.title, loc="left")
    axes.set(xlim=(0, end), xlabel=AXES[along] + unit)
    return axes


def _is_limit(limit):
    if isinstance(limit, (np.generic, np.ndarray)) and limit.ndim == 0:
        limit = limit.item()
    return isinstance(limit, numbers.Real) and 0 <= limit < np.inf


def _picture(texture, plane, quantity, colors, before, limit):
    """Checks the arguments of draw(). Returns the picture, and "film", "crystal" or "chain"."""
    for name, word, accepted in (("quantity", quantity, ("spins", "charge")),
                                 ("colors", colors, ("hue", "safe"))):
        if not isinstance(word, str) or word not in accepted:
            shown = " ".join(repr(word).split())
            raise ValueError(f'{name} {shown}; accepted: "{accepted[0]}" or "{accepted[1]}"')
    if limit is not None and not _is_limit(limit):
        raise ValueError(f"limit {' '.join(repr(limit).split())}; accepted: a finite number >= 0")
    if before is not None and before.dtype.kind not in "buif":
        raise ValueError(f"a difference from an array of {before.dtype}; accepted: one of real "
                         "numbers")
    if before is not None and (quantity == "charge" or before.shape != texture.spins.shape):
        raise ValueError(f"a difference from spins of shape {before.shape} with quantity "
                         f'"{quantity}"; accepted: {texture.spins.shape} with "spins"')
    chosen = plane_of(texture.spins.shape, plane)
    up, right = chosen.cut(texture.spins).shape[-3:-1]
    kind = "chain" if min(up, right) == 1 < max(up, right) else "film"
    if texture.positions is not None or texture.spins.ndim == 5:
        kind = "crystal"
    if quantity == "charge" and (kind != "film" or up == 1):
        raise ValueError('quantity "charge" of a crystal, a chain or a single spin; accepted: a '
                         "film of two cells or more each way")
    return _Picture(texture, chosen, quantity, colors, before, limit), kind


def largest(texture: Texture, *, plane: str | None = None, quantity: str = "spins",
            before: np.ndarray | None = None) -> float:
    """Returns the limit that draw() would choose. Pass the largest limit of several pictures to
    draw() to give them a common scale."""
    return _picture(texture, plane, quantity, "hue", before, None)[0].largest()


def draw(texture: Texture, axes: Any = None, *, plane: str | None = None,
         quantity: str = "spins", colors: str = "hue", before: np.ndarray | None = None,
         limit: float | None = None, key: bool | None = None) -> Any:
    """Draws a `texture`, as Simulation.plot() and Trajectory.plot() make one, into matplotlib
    `axes` (None: those of a new figure), which it returns.

    `plane`: "z=0", "y=3" and so on, numbers of planes from 0 (default: the middle one across the
    axis of fewest cells). A plane that is one site wide is drawn as a chain: components along it,
    and a strip of colours.
    `colors` "hue": the angle in the plane, lighter along its normal and darker against it; "safe":
    the component along the normal, from blue to red. Except for chains, both have arrows, at most
    about 24 across.
    `quantity` "charge": the topological charge of each cell of a film, seen against the normal.
    `before`: other spins of the same shape; |difference| is drawn. `limit`: the end of the colour
    scale for "charge" and for a difference. `key`: whether the wheel or the scale is drawn to the
    right of the axes (default: only if the figure is new).

    Raises ValueError for other words, planes and shapes.
    """
    try:
        before = None if before is None else np.asarray(before)
    except ValueError:
        raise ValueError("before: rows of different lengths; accepted: spins of shape "
                         f"{texture.spins.shape}") from None
    if axes is not None and not hasattr(axes, "quiver"):
        raise ValueError(f"axes: {axes!r}; accepted: matplotlib axes, or None")
    if not isinstance(key, (bool, np.bool_, type(None))):
        raise ValueError(f"key: {key!r}; accepted: True, False or None")
    picture, kind = _picture(texture, plane, quantity, colors, before, limit)
    key = axes is None if key is None else key
    if kind == "chain":
        axes = _draw_chain(axes, picture, texture)
        key = key and picture.has_arrows
    else:
        axes, unit = (_draw_crystal if kind == "crystal" else _draw_film)(axes, picture, texture)
        axes.grid(False)
        axes.set_title(picture.title, loc="left")
        axes.set(xlabel=AXES[picture.plane.right] + unit, ylabel=AXES[picture.plane.up] + unit)
    if key:
        picture.draw_key(axes)
    return axes


OPTIONS = tuple(draw.__kwdefaults__)  #: names of the options of draw()
