# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs the scripts that draw, as a user does: plots.py FOLDER_OF_SCRIPTS WRITER_OF_TRAJECTORIES."""

import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import h5py
import matplotlib.image
import numpy as np

SCRIPTS, WRITER = map(pathlib.Path, sys.argv[1:3])
sys.path.insert(0, str(SCRIPTS))

import trade_report  # noqa: E402  the folder has to be known before
from cayspin_plots import trade_costs, trade_figure  # noqa: E402
from cayspin_plots.read import read_trajectory  # noqa: E402
from cayspin_plots.table import read_table  # noqa: E402

BLUE, RED = (0x1B, 0x5F, 0xA7), (0xCF, 0x3F, 0x2B)
PIXELS_PER_INCH = 160


def write(path, sites=5, length=1.0, cell_sites=1):
    subprocess.run([WRITER, path, str(sites), str(length), str(cell_sites)], check=True)
    return path


def dimensions(png):
    content = png.read_bytes()
    assert content[:8] == b"\x89PNG\r\n\x1a\n" and content[12:16] == b"IHDR", content[:16]
    return struct.unpack(">II", content[16:24])


class ScriptTest(unittest.TestCase):
    fonts = tempfile.TemporaryDirectory()  # Matplotlib makes a list of them once

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_script(self, name, *arguments):
        return subprocess.run([sys.executable, "-B", SCRIPTS / name, *map(str, arguments)],
                              env=os.environ | {"MPLCONFIGDIR": self.fonts.name},
                              capture_output=True, text=True)

    def assert_drawn(self, png, inches, colors, result):
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout, f"{png}\n")
        self.assertEqual(dimensions(png), tuple(round(PIXELS_PER_INCH * side) for side in inches))
        self.assertTrue(15_000 < png.stat().st_size < 3_000_000, png.stat().st_size)
        for color in colors:
            self.assert_has_color(png, color)

    def assert_has_color(self, png, color):
        pixels = np.round(255 * matplotlib.image.imread(png)[..., :3]).astype(int)
        count = int(np.all(abs(pixels - color) <= 2, axis=-1).sum())
        self.assertGreater(count, 300, f"{png.name}: pixels of the color {color}")

    def assert_refused(self, png, file, part, result):
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith(f"{file}: "), result.stderr)
        self.assertIn(part, result.stderr)
        self.assertFalse(png.exists())


class PlotTrajectory(ScriptTest):
    def plot(self, *arguments):
        return self.run_script("plot_trajectory.py", *arguments)

    def test_everything(self):
        file = write(self.folder / "chain.h5")
        self.assert_drawn(file.with_suffix(".png"), (11, 14), (BLUE, RED), self.plot(file))

    def test_crystal(self):
        file = write(self.folder / "crystal.h5", cell_sites=2)
        self.assert_drawn(file.with_suffix(".png"), (11, 14), (BLUE, RED), self.plot(file))
        trajectory = read_trajectory(file)
        self.assertEqual(trajectory.spins.shape, (20, 2, 1, 5, 3))
        with h5py.File(file, "r+") as data:
            means = data["sublattice_magnetization"]
            self.assertEqual(means.shape, (20, 2, 3))
            np.testing.assert_allclose(means, trajectory.spins.mean(axis=(2, 3)), rtol=1e-14)
            means[3, 1, 0] += 1
        with self.assertRaisesRegex(SystemExit, "frame 3 is damaged"):
            read_trajectory(file)

    def test_single_spin_has_no_components_along_x(self):
        file = write(self.folder / "spin.h5", sites=1)
        self.assert_drawn(file.with_suffix(".png"), (11, 8.3), (BLUE, RED), self.plot(file))

    def test_chosen_panel_under_another_name(self):
        file = write(self.folder / "chain.h5")
        png = self.folder / "energy.png"
        result = self.plot(file, "--panels", "energy", "--output", png)
        self.assert_drawn(png, (11, 4.3), (BLUE,), result)

    def test_truncated_file(self):
        file = write(self.folder / "chain.h5")
        os.truncate(file, file.stat().st_size // 2)
        self.assert_refused(file.with_suffix(".png"), file, "cannot read", self.plot(file))

    def test_site_that_is_not_there(self):
        file = write(self.folder / "chain.h5")
        result = self.plot(file, "--site", 5)
        self.assert_refused(file.with_suffix(".png"), file, "no site 5; there are 5", result)

    def test_folder_that_is_not_there(self):
        file = write(self.folder / "chain.h5")
        png = self.folder / "none" / "chain.png"
        self.assert_refused(png, png, "cannot write", self.plot(file, "--output", png))


class PlotTexture(ScriptTest):
    """A film with +x at the lower left, -x at the lower right, -z above and one site empty."""

    RED, CYAN, DARK = (255, 0, 0), (0, 255, 255), (25, 25, 25)

    def setUp(self):
        super().setUp()
        self.file = write(self.folder / "film.h5")
        film = np.zeros((20, 1, 8, 10, 3))
        film[..., :4, :5, 0], film[..., :4, 5:, 0], film[..., 4:, :, 2] = 1, -1, -1
        film[0] = [0, 1, 0]
        film[:, 0, 7, 9] = 0
        with h5py.File(self.file, "r+") as data:
            del data["spins"], data["checksum"]
            data["spins"] = film

    def plot(self, *arguments, file=None):
        return self.run_script("plot_texture.py", file or self.file, *arguments)

    def assert_no_picture(self, part, *arguments, file=None):
        result = self.plot(*arguments, file=file)
        self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(part, result.stderr)

    def test_a_film(self):
        png = self.folder / "film_texture.png"
        size = 8.1, 0.8 * 5.5 + 1.1
        self.assert_drawn(png, size, (self.RED, self.CYAN, self.DARK), self.plot())
        pixels = np.round(255 * matplotlib.image.imread(png)[..., :3]).astype(int)

        def at(x, y):
            column = 160 * (0.75 + 5.5 * x / 10)
            return tuple(pixels[round(160 * (size[1] - 0.6 - 4.4 * y / 8)), round(column)])

        self.assertEqual(at(0.05, 0.2), self.RED)
        self.assertEqual(at(9.95, 0.2), self.CYAN)
        self.assertEqual(at(0.1, 7.8), self.DARK)
        self.assertEqual(at(9.5, 7.5), (255, 255, 255))

    def test_other_frames_and_quantities(self):
        png = self.folder / "other.png"
        size = 8.1, 0.8 * 5.5 + 1.1
        for arguments in (("--frame", 0), ("--colors", "safe"), ("--difference", 0), ("--charge",),
                          ("--plane", "z=0")):
            with self.subTest(arguments):
                self.assert_drawn(png, size, (), self.plot(*arguments, "--output", png))
        self.plot("--frame", 0, "--output", png)
        self.assert_has_color(png, (128, 255, 0))

    def test_chain_and_vector_graphics(self):
        chain, svg = write(self.folder / "chain.h5"), self.folder / "chain.svg"
        self.assert_drawn(self.folder / "chain_texture.png", (8.1, 4.7), (), self.plot(file=chain))
        result = self.plot("--output", svg, file=chain)
        self.assertEqual((result.returncode, result.stdout), (0, f"{svg}\n"))
        self.assertIn("<svg", svg.read_text())

    def test_movie(self):
        movie = self.folder / "film.gif"
        for arguments in ((), ("--difference", 0)):
            result = self.plot("--movie", movie, *arguments)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual(result.stdout, f"{movie}\n")
            content = movie.read_bytes()
            self.assertEqual(content[:6], b"GIF89a")
            self.assertEqual(struct.unpack("<HH", content[6:10]), (810, 550))
        self.assertFalse((self.folder / "film_texture.png").exists())
        self.assert_no_picture("a movie that ends in .mp4 or .gif", "--movie", "film.avi")
        self.assert_no_picture("--fps 0", "--movie", movie, "--fps", 0)
        if not shutil.which("ffmpeg"):
            self.assert_no_picture("finds no ffmpeg", "--movie", self.folder / "film.mp4")

    def test_refusals(self):
        self.assert_no_picture("frame 20; accepted: -20 to 19", "--frame", 20)
        self.assert_no_picture("frame -21", "--difference", -21)
        self.assert_no_picture("plane 'z=1'; accepted: z=0 to z=0", "--plane", "z=1")
        self.assert_no_picture("plane 'top'", "--plane", "top")
        self.assert_no_picture("cannot write", "--output", self.folder / "none" / "film.png")
        self.assert_no_picture("there is no such file", file=self.folder / "none.h5")
        text, other = self.folder / "text.h5", self.folder / "other.h5"
        text.write_text("not a trajectory\n")
        self.assert_no_picture("cannot be opened", file=text)
        h5py.File(other, "w").close()
        self.assert_no_picture("no trajectory, it has no spins", file=other)
        chain = write(self.folder / "chain.h5")
        self.assert_no_picture("a crystal or a chain", "--charge", file=chain)
        crystal = write(self.folder / "crystal.h5", cell_sites=2)
        self.assert_no_picture("have no positions", file=crystal)
        with h5py.File(chain, "r+") as data:
            data["spins"][4, 0, 0, 2, 1] += 1
        self.assert_no_picture("frame 4 is damaged", "--frame", 4, file=chain)


class PlotDemo(ScriptTest):
    def setUp(self):
        super().setUp()
        self.geometric = write(self.folder / "geometric.h5")
        self.classical = write(self.folder / "classical.h5", length=1.25)
        self.png = self.folder / "demo.png"

    def plot(self, *arguments):
        return self.run_script("plot_demo.py", *arguments, "--site", 3, "--output", self.png)

    def test_two_runs(self):
        result = self.plot(self.geometric, self.classical)
        self.assert_drawn(self.png, (11, 8), (BLUE, RED), result)

    def test_reference_adds_to_the_picture(self):
        self.plot(self.geometric, self.classical)
        without = self.png.read_bytes()
        result = self.plot(self.geometric, self.classical, "--reference", self.geometric)
        self.assert_drawn(self.png, (11, 8), (BLUE, RED), result)
        self.assertNotEqual(self.png.read_bytes(), without)

    def test_corrupt_file_in_each_place(self):
        text = self.folder / "text.h5"
        text.write_text("not a trajectory\n")
        for arguments in ((text, self.classical), (self.geometric, text),
                          (self.geometric, self.classical, "--reference", text)):
            with self.subTest(arguments):
                self.assert_refused(self.png, text, "cannot read", self.plot(*arguments))


class PlotTrade(ScriptTest):
    """What `cayspin trade --json` prints of five methods, the third never near the front."""

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
            dt = 0.95 * (error / 0.1)**0.25  # no power law between the runs would have that
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
        self.assertEqual(winner, "rkmk4")  # double precision alone
        self.assertAlmostEqual(ratio, 3)
        self.assertIsNone(trade_costs.gain(self.trade, 1e-8))

    def test_overview_of_several_scenes(self):
        other, png = self.folder / "other.json", self.folder / "overview.png"
        other.write_text(json.dumps(self.trade))
        self.assert_drawn(png, (9, 1.2 + 2 * 0.42), (), self.plot(other, "--output", png))

    def test_the_tables_of_the_page(self):
        page = ("| scene | 1e-2 |\n|---|---|\n| Film, 16 x 16 | 9 (9) |\n| Slab | 7 (7) |\n"
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
        self.assertEqual(len(found.splitlines()), 4 + 3 + 5 + 4, found)  # five methods are drawn
        self.assertTrue(found.endswith("| rkmk4 | 1 (1) |\n"))

    def test_what_is_no_trade(self):
        png = self.folder / "trade.png"
        for content in ("method steps error", "[]", '{"scene": "a.toml"}',
                        '{"scene": "a.toml", "horizon": 1, "end": 1, "methods": [{}]}'):
            with self.subTest(content):
                self.file.write_text(content)
                self.assert_refused(png, self.file, "cannot be read as the JSON of cayspin trade",
                                    self.run_script("plot_trade.py", self.file))


class PlotPaper(ScriptTest):
    """Tables as `cayspin reproduce figures` writes them, of a few rows each."""

    def setUp(self):
        super().setUp()
        path = [(t, np.cos(t), np.sin(t), 0) for t in np.linspace(0, 6, 40)]
        self.write("trajectories", "body,update,path,time,x,y,z",
                   [(body, update, 0, *point) for body in ("triaxial", "axisymmetric")
                    for update in ("a", "b", "c") for point in path])
        runs = ("Euler, dt = 0.0001", "geometric Euler, optimal sigma, dt = 0.01",
                "geometric Euler, sigma = 10, dt = 0.01", "not drawn")
        for slab in ("weak_overdamped", "strong_overdamped", "full"):
            self.write(f"slab_{slab}", "run,time,x,y,z,log_norm",
                       [(f'"{run}"', t, x, (1 - number / 5) * y, z, 1e-3 * number)
                        for number, run in enumerate(runs) for t, x, y, z in path])
            self.write(f"sigma_{slab}", "time,sigma", [(t, t * t) for t in range(9)])
        self.write("orders", "sweep,method,sigma,fitted_order,finest_order,error",
                   [(sweep, method, sigma, order, order + 0.1, 10.0**-order) for sweep in "ab"
                    for order, method in enumerate("cde") for sigma in (-1, 0, 1)])
        self.write("convergence", "case,method,dt,error,error_x",
                   [(case, method, dt, dt**4, dt**5) for case in "abc" for method in "de"
                    for dt in (0.1, 0.05)])
        self.write("norm", "method,damping,time,log_norm",
                   [(method, 1, t, 1e-9 * t) for method in ("RK4", "RKMK4") for t in range(9)])

    def write(self, name, columns, rows):
        lines = [columns] + [",".join(map(str, row)) for row in rows]
        (self.folder / f"{name}.csv").write_text("\n".join(lines) + "\n")

    def test_every_figure(self):
        result = self.run_script("plot_paper.py", self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        drawn = {"trajectories": (11, 7.6), "slab_weak_overdamped": (11, 5.4),
                 "slab_strong_overdamped": (11, 5.4), "slab_full": (11, 5.4),
                 "slab_norm": (8, 4.4), "orders": (11, 7.6), "convergence": (13, 4.8),
                 "norm": (8, 4.8)}
        files = [self.folder / f"{name}.png" for name in drawn]
        self.assertEqual(result.stdout, "".join(f"{file}\n" for file in files))
        for file, inches in zip(files, drawn.values()):
            self.assertEqual(dimensions(file), tuple(round(PIXELS_PER_INCH * s) for s in inches))
            self.assert_has_color(file, BLUE)
        self.assert_has_color(self.folder / "slab_full.png", RED)

    def test_wrong_tables(self):
        file = self.folder / "trajectories.csv"
        columns = "body,update,path,time,x,y,z\n"
        for content in ("", columns, "body,update\na,b\n", columns + "a,b,0,1,0,0,text\n"):
            with self.subTest(content), self.assertRaises(SystemExit) as caught:
                file.write_text(content)
                read_table(file, ("body", "update", "path"), ("time", "x", "y", "z"))
            self.assertNotIn("\n", caught.exception.code)
            self.assertTrue(caught.exception.code.startswith(f"{file}: "), caught.exception.code)
        self.assert_refused(file.with_suffix(".png"), file, "cannot read the table",
                            self.run_script("plot_paper.py", self.folder))


class CorruptFile(ScriptTest):
    def setUp(self):
        super().setUp()
        self.file = write(self.folder / "a.h5")

    def assert_file_refused(self, part="cannot read the trajectory: "):
        """In this process: starting Matplotlib for each of many files takes its time."""
        with self.assertRaises(SystemExit) as caught:
            read_trajectory(self.file)
        self.assertNotIn("\n", caught.exception.code)
        self.assertTrue(caught.exception.code.startswith(f"{self.file}: {part}"),
                        caught.exception.code)

    def change(self, change):
        with h5py.File(self.file, "r+") as file:
            change(file)

    def test_no_file(self):
        self.file.unlink()
        self.assert_file_refused("there is no such file")

    def test_truncated(self):
        size = self.file.stat().st_size
        for kept in (size - 1, size // 2, 600, 4, 0):
            with self.subTest(kept=kept):
                os.truncate(self.file, kept)
                self.assert_file_refused()

    def test_checksum(self):
        with h5py.File(self.file) as file:
            known = file["spins"][3].tobytes()
        content = bytearray(self.file.read_bytes())
        content[content.index(known)] ^= 1
        self.file.write_bytes(content)
        self.assert_file_refused()

    def test_something_missing(self):
        for name in ("spins", "time", "scalars/energy", "scalars"):
            with self.subTest(name):
                write(self.file)
                self.change(lambda file: file.pop(name))
                self.assert_file_refused()
        for name in ("precision", "complete"):
            with self.subTest(name):
                write(self.file)
                self.change(lambda file: file.attrs.pop(name))
                self.assert_file_refused()

    def test_no_frame(self):
        self.change(lambda file: file["time"].resize(0, axis=0))
        self.assert_file_refused("it holds no frame")

    def test_wrong_extents(self):
        for name, values in (("spins", np.zeros((20, 15))), ("spins", np.float64(1)),
                             ("spins", np.zeros((20, 1, 1, 5, 2))), ("spins", np.bytes_("text")),
                             ("magnetization", np.zeros(20)), ("time", np.zeros((20, 2))),
                             ("scalars", np.zeros(20))):
            with self.subTest(name, shape=values.shape):
                write(self.file)

                def replace(file):
                    del file[name]
                    file[name] = values

                self.change(replace)
                self.assert_file_refused()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
