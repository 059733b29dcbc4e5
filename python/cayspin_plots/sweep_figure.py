# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The final values of a sweep's runs: curves over one key, maps over two."""

import itertools
import pathlib

import numpy as np

from . import scalars, style

MOST_ROWS = 12
MOST_TICKS = 12
MARKS = {"failed": ("x", style.RED), "not run": ("|", style.GREY)}  # of runs without a result


def choose_keys(sweep, names):
    """Indices of the keys for the axes: the named ones, or the first two that vary; the first key
    if none does."""
    if names is None:
        varying = [i for i, values in enumerate(sweep.values) if len(values) > 1]
        return (varying or [0])[:2]
    if len(names) > 2 or len(set(names)) < len(names):
        raise SystemExit(f"{sweep.path}: --keys takes one or two keys")
    for name in names:
        if name not in sweep.keys:
            raise SystemExit(f"{sweep.path}: it has no key {name}; accepted: "
                             + ", ".join(sweep.keys))
    return [sweep.keys.index(name) for name in names]


def draw(sweep, axes_keys):
    others = [i for i in range(len(sweep.keys)) if i not in axes_keys]
    rows = list(itertools.product(*(range(len(sweep.values[i])) for i in others)))
    if len(rows) > MOST_ROWS:
        raise SystemExit(f"{sweep.path}: {len(rows)} rows of panels are too many; "
                         f"accepted: --keys that leave {MOST_ROWS}")
    figure, axes = style.plt.subplots(len(rows), 2, figsize=(11, 0.5 + 4.2 * len(rows)),
                                      squeeze=False, constrained_layout=True)
    for row, fixed in zip(axes, rows):
        where = ", ".join(f"{sweep.keys[i]} = {sweep.values[i][v]}" for i, v in zip(others, fixed)
                          if len(sweep.values[i]) > 1)
        # Moves the plotted keys to the first dimensions of the arrays.
        order = axes_keys + others
        energy = sweep.energy.transpose(order)[(Ellipsis, *fixed)]
        m = sweep.magnetization.transpose(*order, len(order))[(Ellipsis, *fixed, slice(None))]
        if len(axes_keys) == 1:
            missing = {text: runs.transpose(order)[(Ellipsis, *fixed)]
                       for text, runs in _missing(sweep).items()}
            _draw_curves(row, sweep, axes_keys[0], energy, m, missing, where)
        else:
            _draw_maps(row, sweep, axes_keys, energy, m, where)
    runs = "1 run" if sweep.done.size == 1 else f"{sweep.done.size} runs"
    counts = [f"{int(of.sum())} {text}" for text, of in _missing(sweep).items() if of.any()]
    title = ", ".join([f"{pathlib.Path(sweep.path).name}: {runs}", *counts])
    figure.suptitle(title, x=0.01, ha="left")
    return figure


def _missing(sweep):
    """Returns the runs without a result, by why they have none."""
    return {"failed": sweep.failed, "not run": ~(sweep.done | sweep.failed)}


def _is_logarithmic(positions):
    return positions[0] > 0 and positions[-1] >= 30 * positions[0]


def _title(text, where):
    return f"{where}\n{text}" if where else text


def _numbers(sweep, key):
    """Returns the values of a key as positions on an axis; None unless there are at least two and
    all of them are finite numbers."""
    numbers = sweep.numbers[key]
    return numbers if numbers and len(numbers) > 1 and np.all(np.isfinite(numbers)) else None


def _coordinates(sweep, key):
    """Positions of the values along an axis, sorted, and the order that sorts the values."""
    numbers = _numbers(sweep, key)
    if numbers is None:
        places = np.arange(len(sweep.values[key]))
        return places, places
    order = np.argsort(numbers)
    return np.array(numbers)[order], order


def _label(axis, sweep, key, positions, order):
    """Labels an axis. Values that are not numbers are written at equal distances."""
    axis.set_label_text(sweep.keys[key])
    if _numbers(sweep, key) is None:
        ticks = np.unique(np.linspace(0, len(order) - 1, MOST_TICKS).round().astype(int))
        axis.set_ticks(positions[ticks], [sweep.values[key][order[tick]] for tick in ticks])
    elif _is_logarithmic(positions):
        axis.axes.set(**{f"{axis.axis_name}scale": "log"})


def _draw_curves(axes, sweep, key, energy, m, missing, where):
    positions, order = _coordinates(sweep, key)
    scalars.draw_means(axes[0], positions, m[order], "o-", markersize=4)
    axes[0].set_title(_title("magnetization at the end", where))
    axes[1].plot(positions, energy[order], "o-", markersize=4, color=style.BLUE)
    axes[1].set_title(_title("energy at the end", where))
    for axis in axes:
        _label(axis.xaxis, sweep, key, positions, order)
        axis.set_xlim(_edges(positions)[[0, -1]])
        for text, (mark, color) in MARKS.items():
            places = positions[missing[text][order]]
            if places.size:
                axis.plot(places, np.full(places.size, 0.02), mark, color=color, clip_on=False,
                          transform=axis.get_xaxis_transform(), label=text)
    axes[0].legend(loc="best")


def _draw_maps(axes, sweep, keys, energy, m, where):
    (x, x_order), (y, y_order) = (_coordinates(sweep, key) for key in keys)
    panels = (("$\\langle m_z \\rangle$ at the end", m[..., 2], "RdBu_r", (-1, 1)),
              ("energy at the end", energy, "viridis", (None, None)))
    for axis, (text, values, colors, (least, most)) in zip(axes, panels):
        values = values[np.ix_(x_order, y_order)].T
        axis.set_facecolor("#d9dcdf")  # where a run has no result
        image = axis.pcolormesh(_edges(x), _edges(y), np.ma.masked_invalid(values), cmap=colors,
                                vmin=least, vmax=most, rasterized=True)
        axis.grid(False)
        axis.set_title(_title(text, where))
        axis.figure.colorbar(image, ax=axis, pad=0.02)
        _label(axis.xaxis, sweep, keys[0], x, x_order)
        _label(axis.yaxis, sweep, keys[1], y, y_order)


def _edges(positions):
    """Returns the edges of cells around positions, which need not be equally spaced."""
    positions = np.asarray(positions, dtype=float)
    if len(positions) == 1:
        return positions[0] + np.array([-0.5, 0.5])
    logarithmic = _is_logarithmic(positions)
    places = np.log(positions) if logarithmic else positions
    middles = (places[1:] + places[:-1]) / 2
    edges = np.concatenate(([2 * places[0] - middles[0]], middles,
                            [2 * places[-1] - middles[-1]]))
    return np.exp(edges) if logarithmic else edges
