# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs the drawing scripts as users do."""

import fcntl
import os
import resource
import shutil
import struct
import subprocess
import sys
import unittest

import h5py
import matplotlib.image
import numpy as np
from matplotlib.figure import Figure
from script_test import BLUE, PIXELS_PER_INCH, RED, SCRIPTS, ScriptTest, dimensions, write

from cayspin_plots import scalars
from cayspin_plots.read import read_trajectory
from cayspin_plots.table import read_table


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

    def test_runs_in_si_have_units(self):
        file = write(self.folder / "chain.h5")
        for units, labels, scale in (("reduced", ("time", "energy"), 1),
                                     ("SI", ("time (ns)", "energy (J)"), 1e9)):
            with h5py.File(file, "r+") as data:
                data.attrs["units"] = units
            trajectory = read_trajectory(file)
            axis = Figure().subplots()
            scalars.draw_energy(axis, trajectory)
            self.assertEqual((axis.get_xlabel(), axis.get_title(loc="left") or axis.get_title()), labels)
            np.testing.assert_allclose(axis.lines[0].get_xdata(), scale * trajectory.scalars.time)

    def test_chosen_panel_under_another_name(self):
        file = write(self.folder / "chain.h5")
        png = self.folder / "energy.png"
        result = self.plot(file, "--panels", "energy", "--output", png)
        self.assert_drawn(png, (5.5, 4.3), (BLUE,), result)

    def test_refusals(self):
        file, none = write(self.folder / "chain.h5"), self.folder / "none" / "chain.png"
        png = file.with_suffix(".png")
        self.assert_refused(png, file, "no site 5; there are 5", self.plot(file, "--site", 5))
        self.assert_refused(none, none, "cannot write", self.plot(file, "--output", none))
        os.truncate(file, file.stat().st_size // 2)
        self.assert_refused(png, file, "cannot read", self.plot(file))


class PlotTexture(ScriptTest):
    RED, CYAN, DARK = (255, 0, 0), (0, 255, 255), (25, 25, 25)

    def setUp(self):
        super().setUp()
        self.file, _ = self.film()

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

        def drawn(*arguments, color):
            result = self.plot(*arguments, "--output", png)
            self.assert_drawn(png, size, (color,), result)
            return matplotlib.image.imread(png)

        usual = drawn(color=self.CYAN)
        # -z; the distance of every spin from +y; a charge of 0
        lowest, largest, none = (59, 76, 192), (253, 231, 37), (247, 247, 247)
        for color, *arguments in (((128, 255, 0), "--frame", 0), (lowest, "--colors", "safe"),
                                  (largest, "--difference", 0), (none, "--charge")):
            with self.subTest(arguments):
                self.assertFalse(np.array_equal(drawn(*arguments, color=color), usual))
        for arguments in (("--plane", "z=0"), ("--frame", "last")):
            with self.subTest(arguments):
                np.testing.assert_array_equal(drawn(*arguments, color=self.CYAN), usual)

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
        self.assert_no_picture("cayspin: --fps 0: accepted: a number > 0 and < 1000", "--movie", movie, "--fps", 0)
        if not shutil.which("ffmpeg"):
            self.assert_no_picture("finds no ffmpeg", "--movie", self.folder / "film.mp4")

    def test_a_home_that_cannot_be_written(self):
        home = self.text_file()
        kept = {name: value for name, value in os.environ.items()
                if name not in ("MPLCONFIGDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME")}
        result = subprocess.run(
            [sys.executable, "-B", SCRIPTS / "plot_texture.py", self.folder / "none.h5"],
            env=kept | {"HOME": str(home)}, capture_output=True, text=True)
        self.assertEqual(result.stderr, f"{self.folder}/none.h5: there is no such file; accepted: "
                                        "a file that cayspin wrote\n")

    def test_a_full_disk(self):
        """A limit on the size of files acts like a full disk."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))

        for option, name, what in (
                ("--output", "old.png", "picture"), ("--output", "new.svg", "picture"),
                ("--movie", "old.gif", "movie"), ("--movie", "new.gif", "movie")):
            file = self.folder / name
            if file.stem == "old":
                file.write_text("before\n")
            before = set(self.folder.iterdir())
            result = self.run_script("plot_texture.py", self.file, option, file, preexec_fn=limit)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (
                2, "", f"{file}: cannot write the {what}: File too large\n"))
            self.assertEqual(set(self.folder.iterdir()), before)
            if file.stem == "old":
                self.assertEqual(file.read_text(), "before\n")

    def test_an_encoder_that_fails(self):
        movie, ffmpeg = self.folder / "film.mp4", self.folder / "bin" / "ffmpeg"
        ffmpeg.parent.mkdir()
        for end, reason in (("echo 'disk: full' >&2; echo more >&2; exit 5", "disk: full"),
                            ("exit 5", "ffmpeg ended with status 5")):
            ffmpeg.write_text(f"#!/bin/sh\nfor last; do :; done; echo >\"$last\"; {end}\n")
            ffmpeg.chmod(0o755)
            before = set(self.folder.iterdir())
            result = self.run_script("plot_texture.py", self.file, "--movie", movie,
                                     path=f"{ffmpeg.parent}:{os.environ['PATH']}")
            self.assertEqual((result.returncode, result.stdout, result.stderr), (
                2, "", f"{movie}: cannot write the movie: {reason}\n"))
            self.assertEqual(set(self.folder.iterdir()), before)

    def test_a_picture_that_is_replaced(self):
        """A link stays a link, and the picture keeps its permissions."""
        picture, link = self.folder / "film.png", self.folder / "link.png"
        picture.write_text("before\n")
        picture.chmod(0o640)
        link.symlink_to(picture)
        self.assert_drawn(link, (8.1, 0.8 * 5.5 + 1.1), (self.RED,), self.plot("-o", link))
        self.assertTrue(link.is_symlink())
        self.assertEqual(picture.stat().st_mode & 0o777, 0o640)
        result = self.plot("-o", self.folder / "no_ending")
        self.assertEqual(result.stdout, f"{self.folder}/no_ending.png\n", result.stderr)
        self.assertEqual(dimensions(self.folder / "no_ending.png"), dimensions(picture))

    def test_wrong_options(self):
        number = "accepted: last or a whole number; from the end: -1"
        for part, *arguments in (
                (f"--frame abc: {number}", "--frame", "abc"),
                (f"--difference 1.5: {number}", "--difference", 1.5),
                ("--replica x: accepted: a whole number", "--replica", "x"),
                ("--fps x: accepted: a number", "--fps", "x"),
                ("--fps without --movie; accepted: both, or no --fps", "--fps", 5),
                ("--colors x: accepted: hue, safe", "--colors", "x"),
                ("--charge not allowed with argument --difference (see cayspin plot --help)",
                 "--difference", 0, "--charge"),
                ("-o/--output expected one argument (see cayspin plot --help)", "--output"),
                ("unrecognized arguments: --a b (see cayspin plot --help)", "--a\nb")):
            result = self.plot(*arguments)
            self.assertEqual((result.returncode, result.stdout, result.stderr),
                             (2, "", f"cayspin: {part}\n"))

    def test_wrong_options_of_other_scripts(self):
        for script in SCRIPTS.glob("*.py"):
            self.assertNotIn("ArgumentParser(", script.read_text(), script)
        result = self.run_script("plot_sweep.py", self.file, "--none")
        self.assertEqual((result.returncode, result.stderr), (
            2, "plot_sweep.py: unrecognized arguments: --none (see plot_sweep.py --help)\n"))

    def test_refusals(self):
        self.assert_no_picture("frame 20; accepted: -20 to 19", "--frame", 20)
        self.assert_no_picture("frame -21", "--difference", -21)
        self.assert_no_picture("plane 'z=1'; accepted: z=0 to z=0", "--plane", "z=1")
        self.assert_no_picture("plane 'top'", "--plane", "top")
        self.assert_no_picture("cannot write", "--output", self.folder / "none" / "film.png")
        self.assert_no_picture("there is no such file", file=self.folder / "none.h5")
        self.assert_no_picture("it is a folder; accepted: a file", file=self.folder)
        self.assert_no_picture("cannot be opened", file=self.text_file())
        with open(write(self.folder / "locked.h5"), "rb") as locked:
            fcntl.flock(locked, fcntl.LOCK_EX)  # as HDF5 does while it writes
            self.assert_no_picture("another program is writing it; accepted: ", file=locked.name)
        (self.folder / "text.h5.journal").touch()
        self.assert_no_picture("; accepted: `cayspin info ", file=self.text_file())
        other = self.folder / "other.h5"
        h5py.File(other, "w").close()
        self.assert_no_picture("not a trajectory: it has no spins", file=other)
        chain = write(self.folder / "chain.h5")
        self.assert_no_picture("a crystal, a chain or a single spin", "--charge", file=chain)
        crystal = write(self.folder / "crystal.h5", cell_sites=2)
        self.assert_no_picture("have no positions", file=crystal)
        with h5py.File(chain, "r+") as data:
            data["spins"][4, 0, 0, 2, 1] += 1
        for arguments in (("--frame", 4), ("--difference", 4)):
            self.assert_no_picture("frame 4 is damaged", *arguments, file=chain)


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
        text = self.text_file()
        for arguments in ((text, self.classical), (self.geometric, text),
                          (self.geometric, self.classical, "--reference", text)):
            with self.subTest(arguments):
                self.assert_refused(self.png, text, "cannot read", self.plot(*arguments))


class PlotPaper(ScriptTest):
    """Draws tables like those of `cayspin reproduce figures`, with a few rows each."""

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


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
