# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The goals of the benchmarks, beside the measured values."""

PRECISIONS = ("f64", "f32")
METHODS = ("Euler", "Heun", "RKMK4", "Euler orthogonal", "Heun orthogonal", "RKMK4 orthogonal",
           "Heun tangent", "RKMK4 tangent", "Heun projected", "RK4 projected")
BEYOND_CACHE = (128, 256)
IN_CACHE = (32, 64)


def yardstick(method):
    """Returns the name of the hand-written loop with the same number of stages; None for Euler."""
    if "Euler" in method:
        return None
    return "hand-written Heun" if "Heun" in method else "hand-written RK4"


class Goal:
    """One line: a measured value beside its goal and floor. Larger values are better or, with
    `at_most`, smaller ones."""

    def __init__(self, text, value, goal, floor=None, at_most=False):
        self.text, self.value, self.goal, self.at_most = text, value, goal, at_most
        self.floor = goal if floor is None else floor

    def _passes(self, bound):
        return self.value <= bound if self.at_most else self.value >= bound

    def verdict(self):
        if self.value is None:
            return "not measured"
        if self._passes(self.goal):
            return "met"
        return "above the floor" if self._passes(self.floor) else "missed"

    def row(self):
        def number(value):
            return "-" if value is None else f"{value:.2f}"
        sign = "<=" if self.at_most else ">="
        return (f"{self.text:<58}{number(self.value):>8}{sign:>4}{number(self.goal):>6}"
                f"{number(self.floor):>7}   {self.verdict()}")


def ratio(above, below):
    return None if above is None or below is None else above / below


def worst(text, values, goal, floor=None, at_most=False):
    """Returns the goal for the worst value of {case: value}. Its text names the case."""
    values = {case: value for case, value in values.items() if value is not None}
    if not values:
        return Goal(text, None, goal, floor, at_most)
    case = (max if at_most else min)(values, key=values.get)
    return Goal(f"{text}: {case}", values[case], goal, floor, at_most)


def speedup(results, precision, method, size):
    return ratio(results.median(f"{precision}/{yardstick(method)}/{size}", "ns/spin"),
                 results.median(f"{precision}/{method}/{size}", "ns/spin"))


def against_hand_written(results):
    """Goals for a method's speed / the speed of the hand-written loop: for each method beyond the
    caches, and for the worst method in cache."""
    for method, goal, floor in (("Heun tangent", 2.2, 1.9), ("RKMK4 tangent", 2.4, 2),
                                ("Heun", 1.5, 1.3), ("RKMK4", 2, 1.6),
                                ("Heun orthogonal", 1.5, 1.3), ("RKMK4 orthogonal", 1.8, 1.5)):
        for precision in PRECISIONS:
            for size in BEYOND_CACHE:
                yield Goal(f"{method}, {size}^3, {precision}, x {yardstick(method)}",
                           speedup(results, precision, method, size), goal, floor)
    for size in IN_CACHE:
        for precision in PRECISIONS:
            yield worst(f"in cache, {size}^3, {precision}, x hand-written",
                        {method: speedup(results, precision, method, size)
                         for method in METHODS if yardstick(method)}, 1.2, 1.05)


def against_probes(results):
    """Goals for the time of a step / the time of a probe, which is a step written out for this
    scene. Both run on one core, in the L2 cache."""
    for precision in PRECISIONS:
        for method in METHODS:
            case = f"{precision}/probe {method}/L2"
            if any(case in key for key in results.values):
                yield Goal(f"{method}, second cache, {precision}, time / probe",
                           ratio(results.median(f"{precision}/{method}/L2", "ns/spin", "one_thread"),
                                 results.median(case, "ns/spin", "one_thread")), 1.05, 1.15,
                           at_most=True)


def against_limits(results):
    for size in IN_CACHE + BEYOND_CACHE:
        found = {}
        for precision in PRECISIONS:
            for method in METHODS:
                case = f"{precision}/{method}/{size}"
                bound = results.limit(case)
                if bound:
                    found[f"{precision} {method} ({bound[1]})"] = (
                        results.median(case, "ns/spin") / bound[0])
        yield worst(f"ns / limit, {size}^3", found, 1.25, at_most=True)


def against_itself(results):
    for size in BEYOND_CACHE:
        yield worst(f"f32 against f64, {size}^3", {
            method: ratio(results.median(f"f64/{method}/{size}", "ns/spin"),
                          results.median(f"f32/{method}/{size}", "ns/spin"))
            for method in METHODS}, 1.9, 1.8)
    for size in IN_CACHE:
        yield worst(f"all threads against 1, {size}^3", {
            f"{precision} {method}": ratio(
                results.median(f"{precision}/{method}/{size}", "ns/spin", "one_thread"),
                results.median(f"{precision}/{method}/{size}", "ns/spin"))
            for method in METHODS for precision in PRECISIONS}, 1.9, 1.8)


def few_spins(results):
    for method, goal, floor in (("Euler", 6, 5), ("Heun", 2.5, 2.3), ("RKMK4", 1.1, 0.95)):
        for file, case in sorted(results.values):
            if case.startswith(f"few spins/{method}/"):
                yield Goal(f"100 spins, {method}, {case.split('/')[2]}, M steps/s",
                           results.median(case, "steps/s", file) / 1e6, goal, floor)
    for loop, goal in (("scalar", 1.5), ("vectorized", 1)):
        for method in ("Euler", "Heun", "RKMK4"):
            for file, case in sorted(results.values):
                if case.startswith(f"few spins/{method}/"):
                    yield Goal(f"100 spins, {method}, {case.split('/')[2]}, x {loop} loop",
                               ratio(results.median(case, "steps/s", file),
                                     results.median(f"few spins/{loop} {method}", "steps/s", file)),
                               goal)


def per_evaluation(results):
    """Goals for methods of high order and adaptive methods: their time per evaluation / that of
    RKMK4 in the same run."""
    def time(precision, method, size):
        return results.median(f"evaluations/{precision}/{method}/{size}", "ns/evaluation",
                              "evaluations")
    for method in ("rkmk5", "rkmk8", "tsit5", "dp5"):
        for precision in PRECISIONS:
            for size in ("256^2", "64^3"):
                yield Goal(f"{method}, {size}, {precision}, time an evaluation / rkmk4",
                           ratio(time(precision, method, size), time(precision, "rkmk4", size)),
                           1.25, at_most=True)


def memory(results):
    yield worst("work memory, 256^3, f64, bytes per spin", {
        method: results.median(f"f64/{method}/256", "work_bytes")
        for method in METHODS if "Euler" not in method}, 32, at_most=True)
    for method in ("RKMK4", "RKMK4 tangent"):
        yield Goal(f"work memory of passes, {method}, f64, bytes per spin",
                   results.median(f"f64/{method}/L2", "work_bytes"), 80, at_most=True)


def on_a_gpu(results):
    """Goals for an H100: ps a spin and step, and steps a second of a lattice of 4096 spins."""
    if any(context["execution_space"] in ("OpenMP", "Serial", "Threads")
           for context in results.context.values()):
        return
    for case, goal in (("f64/Euler in pairs/256", 12), ("f64/Heun in pairs/256", 30), ("f64/RKMK4 in pairs/256", 80),
                       ("f32/RKMK4 in pairs/256", 45),
                       ("replicas/f64 RKMK4/1000 of 10^3", 55)):
        time = results.median(case, "ns/spin")
        yield Goal(f"{case}, ps a spin", None if time is None else 1000 * time, goal, at_most=True)
    for case in ("f64 RKMK4/1 of 16^3", "f64 RKMK4 in pairs/1 of 64^2"):
        time = results.median(f"replicas/{case}", "ns/spin")
        yield Goal(f"{case}, M steps/s", None if time is None else 1000 / (4096 * time), 0.3)


def goals(results):
    for part in (against_hand_written, against_probes, against_limits, against_itself, few_spins,
                 per_evaluation, memory, on_a_gpu):
        yield from part(results)
