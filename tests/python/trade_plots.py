# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs the scripts that draw `cayspin trade --json` and write tables, as users do."""

import json
import math
import sys
import unittest

from script_test import ScriptTest

import trade_report  # in the folder of scripts
from cayspin_plots import trade_costs, trade_figure


class PlotTrade(ScriptTest):
    """Draws `cayspin trade --json` of five methods, of which the third is never near the front."""

    FIRST, SECOND, GREY = (0x00, 0x72, 0xB2), (0xD5, 0x5E, 0x00), (0x8B, 0x91, 0x99)
    PANEL = (7.5, 5.5)

    def setUp(self):
        super().setUp()
        self.file = self.folder / "trade.json"
        self.trade = {"scene": "scenes/film.toml", "horizon": 2.0, "end": 8.0,
                      "why_shorter": "chaos", "uncertainty": 1e-11,
                      "methods": [self.method("rkmk4", False, 1.0, True),
                                  self.method("rkmk4 tangent", False, 2.0, False),
                                  self.method("euler", False, 1e4, False),
                                  self.method("rkmk4, single", False, 0.5, False),
                                  self.method("projected_rk4", True, 3.0, False)]}

    @staticmethod
    def method(name, baseline, cost, front, evaluations=None):
        per_step = evaluations or cost

        def costs(error):
            dt = 0.95 * (error / 0.1)**0.25  # off the power law through the runs
            known = dt > 0.04
            return {"error": error, "seconds": 1e-3 * cost / dt if known else None,
                    "evaluations": 40 * per_step / dt if known else None}

        return {"method": name, "baseline": baseline,
                "rungs": [{"error": 0.1 * dt**4, "dt": dt, "seconds": 1e-3 * cost / dt,
                           "evaluations": round(40 * per_step / dt), "front": front}
                          for dt in (0.4, 0.2, 0.1, 0.05)],
                "costs": [costs(error) for error in trade_costs.ERRORS]}

    def plot(self, *arguments):
        self.file.write_text(json.dumps(self.trade))
        return self.run_script("plot_trade.py", self.file, *arguments)

    def test_methods_and_front(self):
        png = self.file.with_suffix(".png")
        colors = (self.FIRST, self.SECOND, self.GREY)
        self.assert_drawn(png, self.PANEL, colors, self.plot())
        with_front = png.read_bytes()
        for rung in self.trade["methods"][0]["rungs"]:
            rung["front"] = False
        self.assert_drawn(png, self.PANEL, colors, self.plot())
        self.assertNotEqual(png.read_bytes(), with_front)

    def test_evaluations_where_another_method_needs_fewest_or_all_are_asked_for(self):
        png = self.file.with_suffix(".png")
        two = (2 * self.PANEL[0], self.PANEL[1])
        self.assert_drawn(png, two, (), self.plot("--all"))
        self.trade["methods"][1] = self.method("rkmk4 tangent", False, 2.0, False, 0.1)
        self.assert_drawn(png, two, (), self.plot())

    def test_a_method_without_runs_under_another_name(self):
        self.trade["methods"][1]["rungs"] = []
        png = self.folder / "other.png"
        self.assert_drawn(png, self.PANEL, (self.FIRST,), self.plot("--output", png))

    def test_at_most_seven_lines_and_the_front_among_them(self):
        self.trade["methods"] += [self.method(f"other {i}", False, 5.0 + i, False)
                                  for i in range(9)]
        others, baselines = trade_figure.chosen(self.trade)
        self.assertEqual([method["method"] for method in baselines], ["projected_rk4"])
        self.assertEqual(len(others), 6)
        self.assertEqual([method["method"] for method in others[:3]],
                         ["rkmk4, single", "rkmk4", "rkmk4 tangent"])

    def test_costs_and_gains(self):
        fast, euler = self.trade["methods"][0], self.trade["methods"][2]
        self.assertAlmostEqual(trade_costs.cost(fast, "seconds", 1e-4), 1e-3 / 0.95 / 1e-3**0.25)
        self.assertAlmostEqual(trade_costs.cost(fast, "evaluations", 1e-2), 40 / 0.95 / 0.1**0.25)
        self.assertEqual(trade_costs.cost(euler, "seconds", 1e-8), float("inf"))
        ratio, winner = trade_costs.gain(self.trade, 1e-4)
        self.assertEqual(winner, "rkmk4")  # only double precision
        self.assertAlmostEqual(ratio, 3)
        self.assertIsNone(trade_costs.gain(self.trade, 1e-8))

    def test_an_error_that_no_method_reaches(self):
        self.assertEqual(trade_costs.cheapest(self.trade["methods"], 1e-8), (math.inf, None))
        # Makes a method that is not the fastest need the fewest evaluations for one of the three
        # errors that are reached.
        self.trade["methods"][1]["costs"][2]["evaluations"] = 1
        self.assertEqual(trade_figure.axes_that_differ(self.trade), ["seconds", "evaluations"])

    def test_overview_of_several_scenes(self):
        other, png = self.folder / "other.json", self.folder / "overview.png"
        other.write_text(json.dumps(self.trade))
        self.assert_drawn(png, (9, 1.2 + 2 * 0.42), (), self.plot(other, "--output", png))

    def test_the_tables_of_the_page(self):
        page = ("| scene | 1e-2 |\n|---|---|\n| Film, 16 x 16 | 9 (9) |\n| Slab | 7 (7) |\n"
                "\n| scene | best here |\n|---|---|\n| Film, 16 x 16 | 5 |\n"
                "### Film, 16 x 16\n| us (evaluations) | 1e-2 |\n|---|---|\n| rkmk4 | 1 (1) |\n"
                "### Slab\n| us (evaluations) | 1e-2 |\n|---|---|\n| rkmk4 | 1 (1) |\n")
        title = "Film, 16 x 16"
        row = trade_report.ratio_row(title, trade_report.ratios(self.trade))
        self.assertTrue(row.startswith("| Film, 16 x 16 | 3.00 (-) | 3.00 (-) | 3.00 (-) | - (-)"))
        self.assertTrue(row.endswith("| 2.00 | 2.00 | 2.00 |"), row)
        found = trade_report.with_tables(page, {title: self.trade | {"name": title}}, {title: row})
        self.assertTrue(found.startswith(
            "| scene | 1e-2 | 1e-4 | 1e-6 | 1e-8 | single: 1e-2 | 1e-4 | 1e-6 | spread |\n"
            f"{'|---' * 9}|\n{row}\n| Slab | 7 (7) |\n"), found)
        self.assertIn("| rkmk4 | 1870 (75) | 5920 (237) | 18700 (749) | - |\n", found)
        self.assertIn("| scene | best here |\n|---|---|\n| Film, 16 x 16 | 5 |\n", found)
        self.assertEqual(len(found.splitlines()), 4 + 4 + 3 + 5 + 4, found)  # five methods are drawn
        self.assertTrue(found.endswith("| rkmk4 | 1 (1) |\n"))
        gains = (f"{trade_report.row_of(trade_report.GAINS)}\n|---|---|---|---|---|\n"
                 "| Film, 16 x 16 | 9 | 9 | 9 | 9 |\n| Slab | 7 | 7 | 7 | 7 |\n")
        self.assertEqual(trade_report.with_tables(gains, {}, {title: row}), gains.replace(
            "| 9 | 9 | 9 | 9 |", "| 3.00 | 3.00 | 3.00 | - |"))

    def test_pages_have_the_tables(self):
        title, row = "Bloch wall", "| Bloch wall | 1 (2) | 3 (4) | 5 (6) | 7 (8) | 9 | 10 | 11 | 12 |"
        report, appendix = (trade_report.with_tables(page.read_text(), {}, {title: row})
                            for page in trade_report.PAGES)
        self.assertIn("\n| Bloch wall | 1 | 3 | 5 | 7 |\n", report)
        self.assertIn(f"\n{row}\n", appendix)
        costs = trade_report.with_tables(trade_report.PAGES[1].read_text(), {
            "Film, 16 x 16": self.trade | {"name": "Film, 16 x 16"}}, {})
        self.assertIn("\n| rkmk4 | 1870 (75) | 5920 (237) | 18700 (749) | - |\n", costs)

    def test_what_is_no_trade(self):
        png = self.folder / "trade.png"
        for content in ("method steps error", "[]", '{"scene": "a.toml"}',
                        '{"scene": "a.toml", "horizon": 1, "end": 1, "methods": [{}]}'):
            with self.subTest(content):
                self.file.write_text(content)
                self.assert_refused(png, self.file, "cannot be read as the JSON of cayspin trade",
                                    self.run_script("plot_trade.py", self.file))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
