# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads the results of bench/run.sh: medians over repetitions, and the limits of a step."""

import json
import statistics


class Results:
    """The cases in the JSON files of a folder. Files have names such as small.json and
    one_thread.json."""

    def __init__(self, folder):
        self.context = {}
        self.values = {}  # (file, case): {counter: [..]}
        paths = sorted(folder.glob("*.json"))
        if not paths:
            raise SystemExit(f"{folder}: no result of a benchmark")
        for path in paths:
            try:
                content = json.loads(path.read_text(encoding="utf-8"))
                self._add(path.stem, content)
            except (OSError, ValueError, KeyError) as error:
                raise SystemExit(f"{path}: cannot read the result: {error}") from None

    def _add(self, file, content):
        self.context[file] = content["context"]
        for run in sorted(content["benchmarks"], key=lambda run: run["family_index"]):
            if run["run_type"] != "iteration":
                continue
            case = run["run_name"].removesuffix("/real_time")
            counters = self.values.setdefault((file, case), {})
            for name, value in run.items():
                if isinstance(value, float):
                    counters.setdefault(name, []).append(value)

    def files(self, case):
        return [file for file, name in self.values if name == case and file != "one_thread"]

    def median(self, case, counter, file=None):
        """The median of a counter; None if the case was not measured."""
        file = file or next(iter(self.files(case)), None)
        found = self.values.get((file, case), {}).get(counter)
        return statistics.median(found) if found else None

    def threads(self, file):
        return int(self.context[file]["threads"])

    def copy_rate(self, file, kind="stream copy, non-temporal"):
        """Returns the bytes per second that a copy reads and writes."""
        return 1e9 * self.median(kind, "GB/s", file)

    def limit(self, case):
        """Returns (limit, what sets it): the larger of two lower limits of the time of a step, in
        ns per spin. "memory" is the time to move the values to and from memory; "arithmetic" is the
        time measured with all fields in the L2 cache, divided by the number of threads. Returns
        None if one of them was not measured."""
        precision, method, _ = case.split("/")
        file = next(iter(self.files(case)), None)
        words = self.median(case, "words", file)
        inside = self.median(f"{precision}/{method}/L2", "ns/spin", file)
        if not words or inside is None:
            return None
        size = 4 if precision == "f32" else 8
        memory = 1e9 * words * size / self.copy_rate(file)
        return max((memory, "memory"), (inside / self.threads(file), "arithmetic"))
