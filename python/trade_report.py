#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Measures the scenes of docs/reports/trade.md on this machine, one after the other. Writes the
tables of times and ratios of that page and of its appendix, and the pictures. Takes a quarter of an
hour, plus five minutes for each further repetition, which leaves out the large scenes."""

import json
import math
import os
import pathlib
import re
import statistics
import subprocess

from cayspin_plots import command_line, trade_costs, trade_figure
from cayspin_plots.trade_costs import ERRORS, cheapest, cost

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = (ROOT / "docs/reports/trade.md", ROOT / "docs/reports/appendix.md")
# Title in the page, name of the picture, arguments.
SCENES = (
    ("One switching spin", "switching_spin", ()),
    ("Film, 16 x 16", "film", ()),
    ("Film, damping 0.02", "film_low_damping", ()),
    ("Slab", "slab_switching", ()),
    ("Heisenberg, 8^3", "heisenberg", ()),
    ("Film, 256 x 256", "film_256",
     ("--set", "lattice.shape=[256,256]", "--set", "integrator.end=5", "--seconds", "4")),
    ("Heisenberg, 64^3", "heisenberg_64",
     ("--set", "lattice.shape=[64,64,64]", "--set", "integrator.end=0.5", "--seconds", "1")),
    ("One spin in a field", "macrospin", ()),
    ("Rotating field", "macrospin_rotating_field", ()),
    ("Rigid bodies", "rigid_body_ensemble", ()),
    ("Bloch wall", "bloch_wall", ()),
    ("Spin wave", "spin_wave", ()),
    ("Slab, weak field", "slab_weak_field", ()),
    ("Slab, damping 1", "slab_switching_overdamped", ()),
    ("Slab, weak field, damping 1", "slab_weak_field_overdamped", ()),
)
ONCE = ("film_256", "heisenberg_64")  # take many minutes

GAINS = ("scene", "1e-2", "1e-4", "1e-6", "1e-8")
COLUMNS = (*GAINS, "single: 1e-2", "1e-4", "1e-6", "spread")


def printed(program, name, arguments):
    scene = ROOT / f"scenes/{re.sub('_(256|64)$', '', name)}.toml"
    command = [program, "trade", scene, "--json", "--threads", "1", *arguments]
    done = subprocess.run(command, capture_output=True, text=True,
                          env=os.environ | {"OMP_NUM_THREADS": "1"})
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def measure(program, title, name, arguments, path):
    if not path.exists():
        path.write_text(printed(program, name, arguments))
    return json.loads(path.read_text()) | {"name": title}


def best(trade, error, keep):
    return cheapest([method for method in trade["methods"] if keep(method)], error)[0]


def ratios(trade):
    """Returns the ratios of the first table: for each error, the gain and the time of
    projected_rk8 / that of the fastest cayspin method, in double precision; then, for three errors,
    the time in double / that in single precision."""
    found = []
    for error in ERRORS:
        gain = trade_costs.gain(trade, error)
        here = best(trade, error, lambda m: trade_costs.is_double(m) and m["method"] not in
                    (*trade_costs.BASELINES, trade_costs.WITHOUT_GEOMETRY))
        without = best(trade, error, lambda m: m["method"] == trade_costs.WITHOUT_GEOMETRY)
        found += [gain[0] if gain else math.inf, without / here]
    for error in ERRORS[:3]:
        found.append(best(trade, error, trade_costs.is_double) /
                     best(trade, error, lambda m: not trade_costs.is_double(m)))
    return found


def text(ratio):
    return f"{ratio:.2f}" if math.isfinite(ratio) and ratio > 0 else "-"


def ratio_row(title, found):
    gains = [f"{text(found[2 * i])} ({text(found[2 * i + 1])})" for i in range(len(ERRORS))]
    return row_of((title, *gains, *map(text, found[8:])))


def gains_of(row):
    """Returns the row of a table of gains, made from a row with all ratios."""
    return row_of([cell.split(" (")[0] for cell in row.strip("| ").split(" | ")[:len(GAINS)]])


def three_digits(number):
    return f"{number:#.3g}".rstrip(".") if number < 1000 else f"{float(f'{number:.3g}'):.0f}"


def row_of(cells):
    return f"| {' | '.join(cells)} |"


def cost_row(method, unit):
    cells = []
    for error in ERRORS:
        seconds = cost(method, "seconds", error)
        cells.append("-" if math.isinf(seconds) else
                     f"{three_digits(seconds / unit)} ({cost(method, 'evaluations', error):.0f})")
    return row_of((method["method"], *cells))


def with_tables(page, trades, rows):
    """Returns the page with new rows in its tables of ratios or gains. The tables of scenes list
    the methods that their pictures show."""
    trade, lines, replaced, in_ratios, only_gains = None, [], False, False, False
    for line in page.splitlines():
        heading, first = re.match("### (.*)", line), re.match(r"\| ?([^|]*?) ?\|", line)
        if lines and lines[-1] == row_of(COLUMNS):
            line = "|---" * len(COLUMNS) + "|"
        replaced, in_ratios = replaced and bool(first), in_ratios and bool(first)
        if line.startswith("#"):
            trade = trades.get(heading and heading[1])
        if line.startswith(row_of(COLUMNS[:2])):
            in_ratios, only_gains = True, line == row_of(GAINS)
            line = row_of(GAINS if only_gains else COLUMNS)
        elif in_ratios and first[1] in rows:
            row = rows[first[1]]
            line = gains_of(row) if only_gains else row
        if replaced:
            continue
        lines.append(line)
        if first and trade and (header := re.match(r"(us|ms) \(evaluations\)", first[1])):
            unit = {"us": 1e-6, "ms": 1e-3}[header[1]]
            lines.append("|---" * (1 + len(ERRORS)) + "|")
            lines += [cost_row(method, unit) for group in trade_figure.chosen(trade)
                      for method in group]
            replaced = True
    return "\n".join(lines) + "\n"


def main():
    parser = command_line.Parser(description=__doc__)
    parser.add_argument("--program", default=ROOT / "build/release/bin/cayspin", type=pathlib.Path)
    parser.add_argument("--folder", default=ROOT / "build/trade", type=pathlib.Path,
                        help="for the output of trade; existing results are not measured again")
    parser.add_argument("--repetitions", default=1, type=command_line.whole,
                        help="ratios are medians; the spread is that of the median ratio")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    trades, rows = {}, {}
    for title, name, options in SCENES:
        found = []
        for repetition in range(1 if name in ONCE else arguments.repetitions):
            path = arguments.folder / f"{name}_{repetition}.json"
            trades[title] = measure(arguments.program, title, name, options, path)
            found.append(ratios(trades[title]))
        medians = [statistics.median(column) for column in zip(*found)]
        spreads = [max(column) / min(column) for column in zip(*found)
                   if all(math.isfinite(number) and number > 0 for number in column)]
        spread = f"{statistics.median(spreads):.2f}" if len(found) > 1 else "-"
        rows[title] = f"{ratio_row(title, medians)} {spread} |"
        print(rows[title], flush=True)
        trade_figure.draw(trades[title], ROOT / f"docs/images/trade_{name}.png")
    for page in PAGES:
        page.write_text(with_tables(page.read_text(), trades, rows))


if __name__ == "__main__":
    main()
