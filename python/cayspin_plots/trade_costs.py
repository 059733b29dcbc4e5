# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Cost of an error, from `cayspin trade --json`."""

import math
import pathlib

# The alternatives without cayspin: classical methods with renormalisation.
BASELINES = ("projected_heun", "projected_rk4", "projected_rk5", "projected_dp5")
WITHOUT_GEOMETRY = "projected_rk8"
ERRORS = (1e-2, 1e-4, 1e-6, 1e-8)


def require_keys(trade):
    """Raises KeyError or TypeError if something that is drawn is missing."""
    for name in ("scene", "horizon", "end"):
        trade[name]
    for method in trade["methods"]:
        for name in ("method", "baseline"):
            method[name]
        for rung in method["rungs"]:
            for name in ("error", "seconds", "evaluations", "front"):
                rung[name]
        for error in ERRORS:
            cost(method, "seconds", error), cost(method, "evaluations", error)


def scene_name(trade):
    return trade.get("name") or pathlib.Path(trade["scene"]).stem


def is_double(method):
    return ", single" not in method["method"]


def cost(method, key, error):
    """Returns the cost of one of the ERRORS; infinite if the method does not reach it."""
    amount = {one["error"]: one[key] for one in method["costs"]}[error]
    return math.inf if amount is None else amount


def cheapest(methods, error, key="seconds"):
    """(cost, method), or (infinity, None)."""
    return min([(math.inf, None), *((cost(method, key, error), method) for method in methods)],
               key=lambda found: found[0])


def gain(trade, error):
    """Time of the best baseline over that of the best method that is neither a baseline nor
    WITHOUT_GEOMETRY, in double precision, and that method. None if no such method reaches the
    error; infinite if no baseline does."""
    double = [method for method in trade["methods"] if is_double(method)]
    here, winner = cheapest([method for method in double
                             if method["method"] not in (*BASELINES, WITHOUT_GEOMETRY)], error)
    baseline, _ = cheapest([m for m in double if m["method"] in BASELINES], error)
    return None if math.isinf(here) else (baseline / here, winner["method"])
