# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Files of ensembles, as the package reads and draws them."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import cayspin
import matplotlib
import numpy as np

matplotlib.use("Agg")
PROGRAM = os.environ["CAYSPIN_PROGRAM"]
FIELDS = [0.1, 0.3, -0.2]


def scene(**tables):
    return cayspin.Scene(**{
        "system": {"kind": "llg", "damping": 0.2},
        "lattice": {"shape": [6, 4]},
        "field": {"exchange": 1.0, "applied": [0, 0, 0.5]},
        "initial": {"random": {"seed": 4}},
        "integrator": {"method": "heun", "dt": 0.02, "steps": 30},
        "output": {"every": 10, "scalars_every": 5},
        **tables})


class Ensembles(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_program(self, command, made):
        (self.folder / "scene.toml").write_text(made.text)
        file = self.folder / f"{command}.h5"
        subprocess.run([PROGRAM, command, "scene.toml", "--quiet", "-o", file], cwd=self.folder,
                       check=True)
        return file

    def test_files_have_every_replica(self):
        file = self.run_program("run", scene(ensemble={
            "replicas": 3, "vary": {"field.applied.0": np.array(FIELDS)}}))
        with cayspin.open(file) as ensemble:
            self.assertIsInstance(ensemble, cayspin.Ensemble)
            self.assertEqual(ensemble.replicas, 3)
            self.assertEqual(len(ensemble), 4)
            self.assertTrue(ensemble.complete)
            self.assertIn("[ensemble", ensemble.scene)
            self.assertEqual(ensemble.spins.shape, (4, 3, 1, 4, 6, 3))
            self.assertEqual(ensemble.scalars["energy"].shape, (7, 3))
            np.testing.assert_array_equal(ensemble.vary["field.applied.0"], FIELDS)
            np.testing.assert_allclose(ensemble.spins[-1].mean(axis=(1, 2, 3)),
                                       ensemble.magnetization[-1], atol=1e-14)
            for replica, field in enumerate(FIELDS):
                alone = cayspin.Simulation(scene(
                    field={"exchange": 1.0, "applied": [field, 0, 0.5]},
                    initial={"random": {"seed": 4 + replica}}))
                alone.run()
                np.testing.assert_array_equal(ensemble.spins[-1, replica], alone.spins)
                self.assertEqual(ensemble.energy[-1, replica], alone.energy())
            with self.assertRaisesRegex(AttributeError, "accepted: a file of cayspin relax"):
                ensemble.torque

    def test_a_replica_is_drawn_as_a_trajectory(self):
        file = self.run_program("run", scene(ensemble={"replicas": 2}))
        with cayspin.open(file) as ensemble:
            pictures = []
            for replica in (0, 1, -1):
                figure = ensemble.plot(replica).figure
                figure.canvas.draw()
                pictures.append(np.asarray(figure.canvas.buffer_rgba()).copy())
            self.assertTrue((pictures[1] == pictures[2]).all())
            self.assertFalse((pictures[0] == pictures[1]).all())
            for wrong, says in ((2, "replica 2; accepted: -2 to 1"), (0.5, "whole number")):
                with self.assertRaisesRegex(cayspin.CayspinError, says):
                    ensemble.plot(wrong)
            with self.assertRaisesRegex(cayspin.CayspinError, "frame 9; accepted"):
                ensemble.plot(0, 9)

    def test_searches_have_their_ends(self):
        file = self.run_program("relax", scene(ensemble={
            "replicas": 2, "vary": {"field.applied.2": {"from": 0.5, "to": 1.0}}}))
        with cayspin.open(file) as ensemble:
            np.testing.assert_array_equal(ensemble.converged, [1, 1])
            self.assertLess(np.max(ensemble.torque), 1e-6)
            np.testing.assert_allclose(ensemble.energy[0], [-24 * 0.5, -24 * 1.0], atol=1e-9)

    def test_a_simulation_takes_none(self):
        with self.assertRaisesRegex(cayspin.SceneError, "a Simulation takes no ensemble"):
            cayspin.Simulation(scene(ensemble={"replicas": 2}))


if __name__ == "__main__":
    unittest.main()
