# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""cayspin.path finds what `cayspin path` finds, from arrays and from files."""

import os
import pathlib
import signal
import threading
import unittest

import cayspin
import numpy as np
from package_test import PackageTest

EASY, HARD = 1.3, 0.7
TABLES = {
    "system": {"kind": "llg", "damping": 0.2},
    "lattice": {"shape": [3]},
    "field": {"exchange": 20.0, "anisotropy": [{"constant": EASY, "axis": [0, 0, 1]},
                                               {"constant": -HARD, "axis": [0, 1, 0]}],
              "applied": [0.4, 0, 0]},
    "initial": {"uniform": [0, 0, 1]},
}
UP = np.tile([0.0, 0.0, 1.0], (1, 1, 3, 1))


def scene(**tables):
    return cayspin.Scene(**{**TABLES, **tables})


class Paths(PackageTest):
    def test_a_macrospin(self):
        path = cayspin.path(scene(), UP, -UP, images=12, torque=1e-9)
        self.assertTrue(path.converged)
        self.assertEqual(path.end, "converged")
        barrier = 3 * 0.5 * EASY * (1 - 0.4 / EASY)**2
        self.assertAlmostEqual(path.barrier_forward, barrier, delta=1e-12)
        self.assertAlmostEqual(path.barrier_backward, barrier, delta=1e-12)
        self.assertAlmostEqual(path.saddle_energy, -3 * 0.4, delta=1e-12)
        self.assertAlmostEqual(path.saddle_curvature, 0.4 - EASY, delta=1e-6)
        self.assertEqual(path.spins.shape, (12, 1, 1, 3, 3))
        self.assertEqual(path.saddle.shape, (1, 1, 3, 3))
        np.testing.assert_allclose(path.saddle, [[[[1, 0, 0]] * 3]], atol=1e-6)
        self.assertEqual((path.energy.shape, path.distance.shape), ((12,), (12,)))
        self.assertEqual(path.distance[0], 0)
        self.assertTrue((np.diff(path.distance) > 0).all())
        self.assertEqual(len(path.saddles), 1)
        image = path.saddles["image"][0]
        np.testing.assert_array_equal(path.spins[image], path.saddle)
        self.assertEqual(path.energy[image], path.saddle_energy)
        self.assertIsNone(path.prefactor_forward)
        self.assertIsNone(path.langer_forward)
        self.assertIsNone(path.zero_modes)
        arcs = 2 * np.arcsin(np.linalg.norm(np.diff(path.spins, axis=0), axis=-1) / 2)
        np.testing.assert_allclose(np.diff(path.distance), np.sqrt((arcs**2).sum((1, 2, 3))),
                                   rtol=1e-9)

    def test_rates(self):
        field = {**TABLES["field"], "applied": [0, 0, 0]}
        path = cayspin.path(scene(lattice={"shape": [1]}, field=field), UP[..., :1, :],
                            -UP[..., :1, :], torque=1e-10, rates=True)
        self.assertEqual(path.zero_modes, (0, 0, 0))
        exact = np.sqrt(EASY * (EASY + HARD)) / (2 * np.pi)
        self.assertAlmostEqual(path.prefactor_forward, exact, delta=1e-9)
        self.assertAlmostEqual(path.prefactor_backward, exact, delta=1e-9)
        damping = 0.2
        growth = 0.5 * (damping * (EASY - HARD) +
                        np.sqrt(damping**2 * (EASY + HARD)**2 + 4 * EASY * HARD))
        self.assertAlmostEqual(path.langer_forward / exact, growth / np.sqrt(EASY * HARD),
                               delta=1e-9)

    # Spirit's own test of its solvers, in meV.
    def test_the_collapse_of_a_skyrmion(self):
        skyrmion = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1},
            lattice={"shape": [16, 16], "boundary": "periodic"},
            field={"exchange": 10, "dmi": {"bulk": 6}, "applied": [0, 0, 2.894190905]},
            initial={"state": "bloch_skyrmion", "radius": 5})
        up = np.zeros((1, 16, 16, 3))
        up[..., 2] = 1
        path = cayspin.path(skyrmion, cayspin.Simulation(skyrmion).spins, up)
        self.assertAlmostEqual(path.barrier_forward, 38.16697354, delta=1e-7)
        self.assertAlmostEqual(path.barrier_backward, 49.38834616, delta=1e-7)
        self.assertAlmostEqual(path.saddle_curvature, -11.821835, delta=1e-5)
        self.assertAlmostEqual(path.saddle[..., 2].mean(), 0.966573, delta=1e-6)

    def test_the_path_of_the_program(self):
        for precision in ("double", "single"):
            ends = [pathlib.Path(self.run_program(scene(initial={"uniform": [0, 0, z]}),
                                                  command="relax").filename) for z in (1, -1)]
            path = cayspin.path(scene(), str(ends[0]), ends[1], precision=precision)
            file = self.run_program(scene(), "--from", ends[0], "--to", ends[1], "--precision",
                                    precision, command="path")
            self.assertEqual(path.spins.dtype, file["spins"].dtype)
            np.testing.assert_array_equal(path.spins, file["spins"])
            np.testing.assert_array_equal(path.saddle, file["saddle"])
            np.testing.assert_array_equal(path.energy, file["energy"])
            np.testing.assert_array_equal(path.distance, file["distance"])
            for name in ("saddle_energy", "barrier_forward", "barrier_backward", "evaluations",
                         "saddle_curvature"):
                self.assertEqual(getattr(path, name), file.attrs[name], name)

    def test_a_crystal(self):
        crystal = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1},
            lattice={"shape": [2, 2], "crystal": "honeycomb"},
            field={"anisotropy": {"constant": EASY, "axis": [0, 0, 1], "site": 0},
                   "couplings": {"shells": [20.0]}},
            initial={"uniform": [0, 0, 1]})
        up = cayspin.Simulation(crystal).spins
        path = cayspin.path(crystal, up, -up)
        self.assertEqual(path.spins.shape[1:], up.shape)
        np.testing.assert_allclose(path.spins[0], up, atol=1e-6)
        self.assertLess(path.barrier_forward, 4 * 0.5 * EASY)
        self.assertGreater(path.barrier_forward, 4 * 0.45 * EASY)

    def test_early_ends(self):
        short = cayspin.path(scene(), UP, -UP, evaluations=70)
        self.assertFalse(short.converged)
        self.assertEqual(short.end, "evaluation limit")
        self.assertIsNone(short.saddle)
        self.assertIsNone(short.barrier_forward)
        with self.assertRaisesRegex(cayspin.NumbersFailed,
                                    "path: both ends relaxed to the same state, after"):
            cayspin.path(scene(), UP, UP)
        with self.assertRaisesRegex(cayspin.NumbersFailed, "path: an end could not be relaxed"):
            cayspin.path(scene(), UP, -UP, evaluations=1)
        still = scene(system={"kind": "llg", "damping": 0, "precession": False})
        self.assertTrue(cayspin.path(still, UP, -UP).converged)
        with self.assertRaisesRegex(cayspin.NumbersFailed, "rates: a spin .* does not move"):
            cayspin.path(still, UP, -UP, rates=True)

    def test_refusals(self):
        error, call = cayspin.CayspinError, cayspin.path
        none = self.folder / "none.h5"
        wrong = scene(thermal={"temperature": 1.0, "seed": 1},
                      integrator={"method": "heun", "dt": 0.1, "steps": 1})
        self.assert_refused(error, "path: a dict; accepted: a Scene", call, TABLES, UP, -UP)
        self.assert_refused(error, "path: images 2; accepted: a whole number from 3 to 1000", call,
                            scene(), UP, -UP, images=2)
        self.assert_refused(error, "path: images: 3.5; accepted: a whole number", call, scene(), UP,
                            -UP, images=3.5)
        self.assert_refused(error, "path: torque 0; accepted: a number of at least", call, scene(),
                            UP, -UP, torque=0)
        self.assert_refused(error, "path: evaluations 0; accepted: a whole number >= 1", call,
                            scene(), UP, -UP, evaluations=0)
        self.assert_refused(error, "path: rates: 2; accepted: True or False", call, scene(), UP,
                            -UP, rates=2)
        self.assert_refused(error, "path: start: an array of shape (1, 1, 2, 3); accepted: "
                            "(1, 1, 3, 3), or the name of a file", call, scene(), UP[:, :, :2], -UP)
        self.assert_refused(error, "path: end: the spin of site (0, 0, 0) is (0, 0, 0)", call, scene(), UP, 0 * UP)
        self.assert_refused(error, "path: end: an array of", call, scene(), UP, {})
        self.assert_refused(error, f"path: start: {none}: cannot open", call, scene(), none, UP)
        self.assert_refused(cayspin.SceneError, "thermal.temperature", call, wrong, UP, -UP)
        self.assert_refused(error, "precision", call, scene(), UP, -UP, precision="half")

    def test_an_interrupt(self):
        large = scene(lattice={"shape": [64, 64]})
        up = np.tile([0.0, 0.0, 1.0], (1, 64, 64, 1))
        threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                cayspin.path(large, up, -up, images=64)


if __name__ == "__main__":
    unittest.main()
