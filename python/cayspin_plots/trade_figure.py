# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Error over cost of every method that `cayspin trade` tried."""

import pathlib

from cayspin_plots import style

SHOWN = 9  # methods with a colour and a name; the others are drawn thin
COLORS = (style.BLUE, style.RED, style.COMPONENTS[1], "#7a4fa3", "#c98a1b", "#2aa0b0", "#b0457f",
          "#6b7d2a", "#4a4f57")
AXES = (("seconds", "seconds of stepping"), ("evaluations", "evaluations of the field"))


def require_keys(trade):
    """Raises KeyError or TypeError where something is missing that is drawn."""
    for name in ("scene", "horizon", "end"):
        trade[name]
    for method in trade["methods"]:
        for name in ("method", "baseline"):
            method[name]
        for rung in method["rungs"]:
            for name in ("error", "seconds", "evaluations", "front"):
                rung[name]


def cost(method, key, error):
    """The least cost of a run of at most this error; none where there is no such run."""
    return min((rung[key] for rung in method["rungs"] if rung["error"] <= error), default=None)


def best_first(trade):
    """Methods by how many of some errors they are the cheapest ones to, nearly."""
    errors = [10.0**-power for power in range(1, 10)]
    best = {error: min((c for method in trade["methods"]
                        if (c := cost(method, "seconds", error)) is not None), default=None)
            for error in errors}

    def merit(method):
        costs = ((cost(method, "seconds", error), best[error]) for error in errors)
        return sum((b / c)**2 for c, b in costs if c and b)

    return sorted(trade["methods"], key=merit, reverse=True)


def draw(trade, path):
    figure, axes = style.plt.subplots(1, 2, figsize=(13, 6), sharey=True, constrained_layout=True)
    methods = best_first(trade)
    baselines = [method for method in methods if method["baseline"]]
    named = [method for method in methods if not method["baseline"]][:SHOWN - 1]
    for axis, (key, label) in zip(axes, AXES):
        for method in methods:
            points = [(rung[key], rung["error"]) for rung in method["rungs"] if rung["error"] > 0]
            if not points:
                continue
            if method in named:
                axis.loglog(*zip(*points), "o-", color=COLORS[named.index(method)], markersize=3,
                            linewidth=1.5, label=method["method"])
            elif method in baselines:
                marker = "sv^D*P"[baselines.index(method) % 6]
                axis.loglog(*zip(*points), f"{marker}:", color=style.INK, markersize=3,
                            linewidth=1.1, label=method["method"])
            else:
                axis.loglog(*zip(*points), "-", color=style.GREY, linewidth=0.5, zorder=1)
        axis.set_xlabel(label)
    front = sorted((rung["seconds"], rung["error"]) for method in methods
                   for rung in method["rungs"] if rung["front"] and rung["error"] > 0)
    if front:
        axes[0].step(*zip(*front), where="post", color=style.GREY, linewidth=5, alpha=0.35,
                     zorder=0, label="Pareto front")
    axes[0].set_ylabel("largest distance of any spin")
    axes[0].legend(fontsize=8)
    shorter = "" if trade["horizon"] == trade["end"] else f" of {trade['end']:g}"
    figure.suptitle(f"{pathlib.Path(trade['scene']).name} up to t = {trade['horizon']:g}{shorter}; "
                    "dotted: baselines; thin: what is never near the front")
    style.save(figure, path)
