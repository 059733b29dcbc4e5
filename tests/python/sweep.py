# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A sweep, read and drawn as a user does: sweep.py FOLDER_OF_SCRIPTS PROGRAM."""

import subprocess
import sys
import unittest

import h5py
import matplotlib.image
import numpy as np
from script_test import BLUE, ScriptTest

from cayspin_plots import sweep_figure
from cayspin_plots.sweep import read_sweep

PROGRAM = sys.argv[2]

# A damped spin that starts at the equator has m_z = tanh(damping * t).
SCENE = """
[system]
kind = "llg"
damping = 0.5
[lattice]
shape = [1]
[field]
applied = [0, 0, 1]
[initial]
uniform = [1, 0, 0]
[integrator]
method = "rkmk4"
dt = 0.01
end = 1.0
"""
DAMPING = [0.8, 0.1, 0.4]


class Sweep(ScriptTest):
    def setUp(self):
        super().setUp()
        (self.folder / "scene.toml").write_text(SCENE)

    def sweep(self, name, *over, status=0):
        file = self.folder / name
        arguments = [argument for one in over for argument in ("--over", one)]
        result = subprocess.run([PROGRAM, "sweep", "scene.toml", "--output", file, "--quiet",
                                 *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stdout), (status, ""), result.stderr)
        return file

    def plot(self, file, *options, rows=1):
        """Returns the pixels of the picture of a sweep."""
        png = file.with_suffix(".png")
        result = self.run_script("plot_sweep.py", file, *options)
        self.assert_drawn(png, (11, 0.5 + 4.2 * rows), (), result)
        return np.round(255 * matplotlib.image.imread(png)[..., :3]).astype(int)

    def assert_no_picture(self, part, file, *options):
        self.assert_refused(self.folder / "none.png", file, part,
                            self.run_script("plot_sweep.py", file, *options))

    def test_the_numbers_are_those_of_the_closed_form(self):
        file = self.sweep("one.h5", "system.damping=" + ",".join(map(str, DAMPING)))
        sweep = read_sweep(file)
        self.assertEqual((sweep.keys, sweep.numbers), (["system.damping"], [DAMPING]))
        np.testing.assert_allclose(sweep.magnetization[:, 2], np.tanh(DAMPING), rtol=1e-9)
        np.testing.assert_allclose(sweep.energy, -np.tanh(DAMPING), rtol=1e-9)
        self.assertTrue(sweep.complete and sweep.done.all())
        with h5py.File(file) as data:
            self.assertEqual(data["runs/0001/spins"].shape, (2, 1, 1, 1, 3))
            self.assertEqual(data["runs/0001"].attrs["complete"], 1)
        pixels = self.plot(file)
        blue = np.all(abs(pixels - BLUE) <= 2, axis=-1)
        self.assertGreater(blue[:, :880].sum(), 300)
        self.assertGreater(blue[:, 880:].sum(), 300)

    def test_two_keys_are_a_map_and_failures_stay_empty(self):
        file = self.sweep("two.h5", "integrator.method='rkmk4','classical_euler'",
                          "field.applied=[0,0,1],[0,0,1e30],[0,0,2]", "lattice.shape=[1],[2]",
                          status=3)
        sweep = read_sweep(file)
        self.assertEqual(sweep.done.shape, (2, 3, 2))
        self.assertFalse(sweep.done[1, 1].any())
        self.assertTrue(np.isnan(sweep.energy[1, 1]).all())
        self.assertTrue(sweep.done[0, [0, 2]].all())
        np.testing.assert_allclose(sweep.magnetization[0, 2, :, 2], np.tanh(1.0), rtol=1e-8)
        pixels = self.plot(file, rows=2)
        self.assertGreater(np.all(pixels == (0xD9, 0xDC, 0xDF), axis=-1).sum(), 10000)
        self.plot(file, "--keys", "field.applied", rows=4)
        self.assertEqual(sweep_figure.choose_keys(sweep, ["lattice.shape"]), [2])
        self.assert_no_picture("it has no key field", file, "--keys", "field")

    def test_values_that_are_one_number_or_none(self):
        file = self.sweep("same.h5", "system.damping=0.1,0.10,0.8")
        sweep = read_sweep(file)
        self.assertEqual(sweep.numbers, [[0.1, 0.1, 0.8]])
        line = sweep_figure.draw(sweep, [0]).axes[0].lines[2]
        np.testing.assert_array_equal(line.get_xdata(), [0.1, 0.1, 0.8])
        np.testing.assert_allclose(line.get_ydata(), np.tanh([0.1, 0.1, 0.8]), rtol=1e-9)
        sweep.numbers, sweep.done = [[0.1, np.inf, 0.8]], np.array([True, False, True])
        sweep.energy[1], sweep.failed[1] = np.nan, True
        axes = sweep_figure.draw(sweep, [0]).axes[0]
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()],
                         ["0.1", "0.10", "0.8"])
        self.assertEqual(axes.get_legend().get_texts()[-1].get_text(), "failed")

    def test_runs_still_to_do_are_not_failures(self):
        file = self.sweep("part.h5", "system.damping=0.1,0.2,0.4,0.8")
        with h5py.File(file, "r+") as data:
            data["status"][1:] = [3, -1, -1]
        sweep = read_sweep(file)
        self.assertEqual(sweep.done.tolist(), [True, False, False, False])
        self.assertEqual(sweep.failed.tolist(), [False, True, False, False])
        self.assertTrue(np.isnan(sweep.energy[1:]).all())
        figure = sweep_figure.draw(sweep, [0])
        self.assertEqual(figure.texts[0].get_text(), "part.h5: 4 runs, 1 failed, 2 not run")
        lines = {line.get_label(): line.get_xdata().tolist() for line in figure.axes[0].lines}
        self.assertEqual((lines["failed"], lines["not run"]), ([0.2], [0.4, 0.8]))

    def test_other_files_are_refused(self):
        self.assert_no_picture("there is no such file", self.folder / "none.h5")
        with h5py.File(self.folder / "other.h5", "w"):
            pass
        self.assert_no_picture("it has no sweep", self.folder / "other.h5")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
