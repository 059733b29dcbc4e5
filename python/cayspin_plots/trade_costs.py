# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Cost of reaching an error, from `cayspin trade --json`."""

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
    """Returns the cost at which a method reaches one of the ERRORS: its `key`, "seconds" or
    "evaluations". Infinite if the method does not reach the error."""
    amount = {one["error"]: one[key] for one in method["costs"]}[error]
    return math.inf if amount is None else amount


def cheapest(methods, error, key="seconds"):
    """Returns (cost, method) of the method that reaches the error at the lowest cost, or (infinity,
    None) if none reaches it."""
    return min([(math.inf, None), *((cost(method, key, error), method) for method in methods)],
               key=lambda found: found[0])


def gain(trade, error):
    """Returns the time of the fastest baseline / the time of the fastest method that is neither a
    baseline nor WITHOUT_GEOMETRY, and the name of that method. All are in double precision. Returns
    None if no such method reaches the error. The ratio is infinite if no baseline reaches it."""
    double = [method for method in trade["methods"] if is_double(method)]
    here, winner = cheapest([method for method in double
                             if method["method"] not in (*BASELINES, WITHOUT_GEOMETRY)], error)
    baseline, _ = cheapest([m for m in double if m["method"] in BASELINES], error)
    return None if math.isinf(here) else (baseline / here, winner["method"])
