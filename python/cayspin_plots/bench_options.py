# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Cost of options, and how much of that cost memory traffic and arithmetic explain."""

SIZES = ("100", "32", "128")
PLAIN = ("Euler", "Heun of bodies", "RKMK4 of bodies")
ON_HOST = "demag on the host"
ALLOWED = 1.15


def beside(method):
    """Returns the plain form of a method with options; Euler for a method that is plain itself."""
    base = method.split(",")[0]
    return base if base != method else "Euler"


def predicted(results, method, size):
    """Returns the time of a step, in ns per spin, that memory traffic and arithmetic explain, or
    None if it was not measured. This is Results.limit(), except for methods with code on the host.
    Such code runs after the kernels, on one thread, so its time is added to the limit of the plain
    method."""
    def in_cache(name):
        return results.median(f"options/{name}/L2", "ns/spin")
    bound = results.limit(f"options/{method}/{size}")
    if bound is None or ON_HOST not in method:
        return bound and bound[0]
    plain = beside(method)
    return results.limit(f"options/{plain}/{size}")[0] + in_cache(method) - in_cache(plain)


def row(results, method):
    def time(name, size):
        return results.median(f"options/{name}/{size}", "ns/spin")
    base = beside(method)
    text = f"{method:<44}{base if method not in PLAIN else '(ns per spin and step)':<24}"
    for size in SIZES:
        mine, plain = time(method, size), time(base, size)
        if method in PLAIN:
            plain = 1
        text += f"{mine / plain:8.2f}" if mine and plain else f"{'-':>8}"
    explained = predicted(results, method, SIZES[-1])
    if explained is None:
        return text
    ratio = time(method, SIZES[-1]) / explained
    return text + f"{explained:10.2f}{ratio:8.2f}{'   more than explained' if ratio > ALLOWED else ''}"


def rows(results):
    yield (f"{'option':<44}{'cost beside':<24}" + "".join(f"{size:>8}" for size in SIZES)
           + "  limit ns   ratio")
    methods = dict.fromkeys(case.split("/")[1] for _, case in results.values
                            if case.startswith("options/"))
    for method in methods:
        yield row(results, method)
