# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Pictures and movies of files of paths and modes, drawn by the script that users run."""

import sys
import unittest

import h5py
import numpy as np
from script_test import BLUE, RED, ScriptTest

SCENE = 'units = "SI"\n[lattice]\nshape = [10, 8]\nspacing = [1e-9, 1e-9, 1e-9]\n'


class PlotFound(ScriptTest):
    def plot(self, file, *arguments):
        return self.run_script("plot_texture.py", file, *arguments)

    def assert_no_picture(self, part, file, *arguments):
        result = self.plot(file, *arguments)
        self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(part, result.stderr)

    def assert_movie(self, file, frames, *arguments):
        movie = self.folder / "found.gif"
        result = self.plot(file, "--movie", movie, *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout, f"{movie}\n")
        content = movie.read_bytes()
        self.assertEqual(content[:6], b"GIF89a")
        self.assertEqual(content.count(b"\x21\xf9\x04"), frames)  # one before each frame


class PlotPath(PlotFound):
    def setUp(self):
        super().setUp()
        self.file = self.path("path.h5", (1, 8, 10))

    def path(self, name, shape, images=7):
        angle = np.linspace(0, np.pi, images).reshape(-1, *[1] * len(shape))
        spins = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], -1)
        file = self.folder / name
        with h5py.File(file, "w") as data:
            data.attrs.update({"path_format": 1, "scene": SCENE, "units": "SI",
                               "barrier_forward": 3e-21, "barrier_backward": 2e-21})
            data["spins"] = np.broadcast_to(spins, (images, *shape, 3))
            data["distance"] = np.linspace(0, 10, images)
            data["energy"] = 1e-21 * (3 * np.sin(angle.ravel())**2 + angle.ravel() / np.pi)
            data["saddles/image"] = [3]
        return file

    def test_energy_and_images(self):
        png = self.folder / "path_path.png"
        self.assert_drawn(png, (9, 6.4), (BLUE, RED, (255, 0, 0)), self.plot(self.file))
        self.plot(self.file, "--colors", "safe", "--output", self.folder / "safe.svg")
        self.assertIn("barriers 3e-21 J forward", (self.folder / "safe.svg").read_text())

    def test_energy_only(self):
        for name, shape in (("spin.h5", (1, 1, 1)), ("crystal.h5", (2, 1, 8, 10))):
            png = self.folder / name.replace(".h5", "_path.png")
            result = self.plot(self.path(name, shape))
            self.assert_drawn(png, (9, 4.2), (BLUE,), result)

    # Drawn as squares, the cells of this triangular lattice would be sheared.
    def test_a_skew_cell(self):
        file = self.path("skew.h5", (1, 8, 10))
        with h5py.File(file, "r+") as data:
            data.attrs["scene"] = SCENE + "cell = [[1, 0, 0], [0.5, 0.8660254, 0], [0, 0, 1]]\n"
        png = self.folder / "skew_path.png"
        self.assert_drawn(png, (9, 4.2), (BLUE,), self.plot(file))
        self.assert_no_picture("its sites are not on a rectangular grid", file, "--frame", "0")

    def test_an_image(self):
        for arguments in (("--frame", 3), ("--frame", -1), ("--difference", 0)):
            png = self.folder / "image.png"
            size = 8.1, 0.8 * 5.5 + 1.1
            self.assert_drawn(png, size, (), self.plot(self.file, *arguments, "--output", png))
        self.plot(self.file, "--frame", 3, "--output", png)
        self.assert_has_color(png, (255, 0, 0))

    def test_movie(self):
        self.assert_movie(self.file, 7, "--difference", 0)

    def test_refusals(self):
        self.assert_no_picture("frame 7; accepted: -7 to 6, the images of the path", self.file,
                               "--frame", 7)
        self.assert_no_picture("frame -8", self.file, "--difference", -8)
        self.assert_no_picture("plane 'z=1'; accepted", self.file, "--frame", 0, "--plane", "z=1")
        self.assert_no_picture("have no positions", self.path("crystal.h5", (2, 1, 8, 10)),
                               "--frame", 0)


class PlotModes(PlotFound):
    def setUp(self):
        super().setUp()
        self.file = self.modes("modes.h5")

    def modes(self, name, waves=False):
        file = self.folder / name
        with h5py.File(file, "w") as data:
            data.attrs.update({"cayspin_modes_format": 1, "scene": SCENE, "units": "SI"})
            data["spins"] = np.broadcast_to([1.0, 0, 0], (1, 8, 10, 3))
            if waves:
                data["wave_vector"] = [[0, 0, 0], [0.5, 0, 0]]
                data["frequency"] = data["decay"] = [[1e9], [2e9]]
                return file
            data["frequency"] = data["decay"] = [1e9, 2e9]
            shapes = np.zeros((2, 1, 8, 10, 3, 2))
            shapes[0, ..., 1, 0] = shapes[0, ..., 2, 1] = 1
            shapes[1, ..., :5, 1, 0] = shapes[1, ..., 5:, 2, 0] = 1
            data["mode"] = shapes
        return file

    def test_spectrum_and_shapes(self):
        png = self.folder / "modes_modes.png"
        self.assert_drawn(png, (0.5 + 2 * 3.6, 6.6), (BLUE,), self.plot(self.file))

    def test_modes_of_equal_frequency_have_one_label(self):
        from cayspin_plots import modes

        places = np.array([[1.0, 3.0], [1.001, 3.0], [5.0, 3.0], [1.0, 2.0], [1.0, 3.001]])
        self.assertEqual(modes.together(places, np.array([10.0, 2.0])), [[0, 1, 4], [2], [3]])

    def test_bands_of_negative_frequency_fill_the_picture(self):
        from cayspin_plots import modes

        waves = self.modes("waves.h5", waves=True)
        with h5py.File(waves, "r+") as data:
            data["frequency"][:] = [[-1e9], [2e9]]  # -1 GHz and 2 GHz
            axis, = modes.draw(data).axes
        self.assertTrue(-1.5 < axis.get_ylim()[0] <= -1, axis.get_ylim())

    def test_a_mode_that_moves(self):
        self.assert_movie(self.file, 40, "--frame", 1)
        from cayspin_plots import modes

        import texture

        with h5py.File(self.file) as data:
            for frame, turn in ((0, [0, 1, 0]), (10, [0, 0, -1]), (20, [0, -1, 0])):
                shown = modes.moving(data, 0, frame, texture)
                expected = np.cos(0.5) * np.array([1, 0, 0]) + np.sin(0.5) * np.array(turn)
                np.testing.assert_allclose(shown.spins, np.broadcast_to(expected, (1, 8, 10, 3)),
                                           atol=1e-12)

    def test_refusals(self):
        movie = self.folder / "mode.gif"
        self.assert_no_picture("frame 2; accepted: -2 to 1, the modes", self.file, "--movie", movie,
                               "--frame", 2)
        self.assert_no_picture("--difference of a mode; accepted: a file of frames", self.file,
                               "--movie", movie, "--difference", 0)
        for option in (("--frame", 0), ("--plane", "z=0"), ("--difference", 0), ("--charge",)):
            self.assert_no_picture(f"{option[0]} of a picture of modes; accepted: no {option[0]}",
                                   self.file, *option)
        waves = self.modes("waves.h5", waves=True)
        self.assertEqual(self.plot(waves).returncode, 0)
        self.assert_no_picture("waves have no shapes; accepted: a file of modes", waves, "--movie",
                               movie)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
