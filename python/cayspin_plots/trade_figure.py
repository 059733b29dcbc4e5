# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Error over cost of the methods that `cayspin trade` tried: the cheapest ones, and baselines."""

import numpy as np

from cayspin_plots import style
from cayspin_plots.trade_costs import BASELINES, ERRORS, cheapest, cost, scene_name

LINES = 7  # largest number of curves
OF_BASELINES = 2  # of these curves, at most
# Okabe and Ito's colours, safe for colour-blind readers; and markers, for print without colour.
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
MARKS = "osD^vPX"
AXES = {"seconds": "seconds of stepping", "evaluations": "evaluations of the field"}


def chosen(trade):
    """Returns two lists of methods to draw: the best ones, and the best baselines. In the first
    list, methods that are cheapest for one of the errors come before those that are nearly as
    cheap."""
    methods = trade["methods"]
    best = {error: cheapest(methods, error)[0] for error in ERRORS}

    def merit(method):
        costs = ((best[error], cost(method, "seconds", error)) for error in ERRORS)
        return sum((b / c)**4 for b, c in costs if 0 < c < float("inf"))

    winners = {id(cheapest(methods, error)[1]) for error in ERRORS}
    ranked = sorted((m for m in methods if m["rungs"]), key=merit, reverse=True)
    baselines = [m for m in ranked if m["method"] in BASELINES][:OF_BASELINES]
    others = [m for m in ranked if m not in baselines]
    others.sort(key=lambda method: id(method) not in winners)
    return others[:LINES - len(baselines)], baselines


def axes_that_differ(trade):
    """The axes to draw. Evaluations are among them if, for a third of the errors or more, the
    method with the fewest evaluations is not the fastest one."""
    known = [error for error in ERRORS if cheapest(trade["methods"], error)[1]]
    differ = sum(cheapest(trade["methods"], error)[1] is not
                 cheapest(trade["methods"], error, "evaluations")[1] for error in known)
    return list(AXES) if 3 * differ >= len(known) > 0 else ["seconds"]


def name_ends(axis, ends):
    """Writes names beside the right end of the axes. A thin line joins each to the end of its
    curve."""
    low, high = (np.log(limit) for limit in axis.get_ylim())
    apart, heights = 0.05, []
    for x, y, name, color in sorted(ends, key=lambda end: end[1]):
        height = (np.log(y) - low) / (high - low)
        heights.append(max(height, heights[-1] + apart) if heights else max(height, 0))
        axis.annotate(name, (x, y), (1.02, heights[-1]), textcoords="axes fraction", color=color,
                      va="center", fontsize=9, annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.6})


def draw_methods(axis, trade, key, everything):
    front, baselines = chosen(trade)
    ends = []
    for method in trade["methods"]:
        points = [(rung[key], rung["error"]) for rung in method["rungs"] if rung["error"] > 0]
        if not points:
            continue
        if method in front:
            i = front.index(method)
            look = {"color": COLORS[i], "marker": MARKS[i], "markersize": 4, "linewidth": 1.6}
        elif method in baselines:
            look = {"color": style.GREY, "marker": "+x"[baselines.index(method)], "markersize": 5,
                    "linewidth": 1.4}
        elif everything:
            axis.loglog(*zip(*points), "-", color=style.GREY, linewidth=0.4, zorder=1)
            continue
        else:
            continue
        axis.loglog(*zip(*points), **look)
        ends.append((*min(points, key=lambda point: point[1]), method["method"], look["color"]))
    return ends


def draw_front(axis, trade):
    """Draws the Pareto front as steps, each piece in the colour of its method."""
    front, _ = chosen(trade)
    rungs = sorted(((rung["seconds"], rung["error"], method) for method in trade["methods"]
                    for rung in method["rungs"] if rung["front"] and rung["error"] > 0),
                   key=lambda rung: rung[0])
    for (x, y, method), (after, lower, _) in zip(rungs, rungs[1:]):
        color = COLORS[front.index(method)] if method in front else style.GREY
        axis.plot((x, after, after), (y, y, lower), color=color, linewidth=6, alpha=0.25,
                  solid_capstyle="butt", zorder=0)


def draw(trade, path, everything=False):
    keys = list(AXES) if everything else axes_that_differ(trade)
    figure, axes = style.plt.subplots(1, len(keys), figsize=(7.5 * len(keys), 5.5), squeeze=False,
                                      constrained_layout=True)
    for axis, key in zip(axes[0], keys):
        ends = draw_methods(axis, trade, key, everything)
        axis.set_xlabel(AXES[key])
        if key == "seconds":
            draw_front(axis, trade)
        if ends:
            name_ends(axis, ends)
    axes[0][0].set_ylabel("largest distance of any spin")
    shorter = "" if trade["horizon"] == trade["end"] else f" of {trade['end']:g}"
    figure.suptitle(f"{scene_name(trade)} up to t = {trade['horizon']:g}{shorter}; broad: the "
                    "front; grey: baselines", fontsize=11)
    style.save(figure, path)
