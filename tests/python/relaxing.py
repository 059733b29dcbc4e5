# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Simulation.relax finds the states that `cayspin relax` finds, and says how the search ended."""

import os
import signal
import threading
import unittest

import cayspin
import numpy as np
from package_test import PackageTest

TABLES = {
    "system": {"kind": "llg", "damping": 0.1},
    "lattice": {"shape": [12, 10]},
    "field": {"exchange": 40.0, "anisotropy": {"constant": 0.1, "axis": [1, 0, 0]},
              "slab_demag": {"normal": [0, 0, 1]}},
    "initial": {"random": {"seed": 3}},
}


def scene(**tables):
    return cayspin.Scene(**{**TABLES, **tables})


class Relaxing(PackageTest):
    def test_the_curvature_is_an_energy_in_si(self):
        edge, easy = 3e-9, 1e5
        sim = cayspin.Simulation(cayspin.Scene(
            units="SI", system={"kind": "llg"}, lattice={"shape": [1], "spacing": [edge] * 3},
            material={"Ms": 8e5, "Ku": easy, "axis": [0, 0, 1], "alpha": 0.1,
                      "damping_form": "gilbert"},
            initial={"uniform": [0.1, 0.2, 0.9]}))
        curvature = sim.relax(torque=1e-9).curvature
        self.assertAlmostEqual(curvature / (2 * easy * edge**3), 1, 6)

    def test_saddles(self):
        sim = cayspin.Simulation(scene(initial={"uniform": [0, 1, 0]}))
        self.assertEqual(sim.relax(keep_saddles=True).saddles, 0)
        self.assertAlmostEqual(sim.energy(), 0, delta=1e-6)
        self.assertEqual(sim.relax().saddles, 1)
        self.assertAlmostEqual(sim.energy(), -0.05 * 120, delta=1e-6)

    def test_the_state_of_the_program(self):
        for precision in ("double", "single"):
            of = scene()
            sim = cayspin.Simulation(of, precision)
            found = sim.relax()
            self.assertTrue(found.converged)
            self.assertEqual(found.end, "converged")
            self.assertLess(found.torque, 1e-6)
            self.assertAlmostEqual(found.energy, -0.05 * 120, delta=1e-6)
            self.assertAlmostEqual(found.energy, sim.energy(), delta=1e-6)
            self.assertLess(found.evaluations, 105)
            self.assertGreater(found.evaluations, found.iterations)
            self.assertEqual(sim.evaluations, found.evaluations)
            self.assertEqual((sim.steps, sim.time), (0, 0.0))
            self.assertAlmostEqual(abs(sim.magnetization()[0]), 1, delta=1e-6)
            torque = np.linalg.norm(np.cross(sim.spins, sim.field()), axis=-1).max()
            self.assertLess(torque, 1.1e-6 if precision == "double" else 1e-4)
            file = self.run_program(of, "--precision", precision, command="relax")
            np.testing.assert_array_equal(sim.spins, file["spins"][-1])
            self.assertEqual(file.attrs["evaluations"], found.evaluations)
            self.assertEqual(file.attrs["torque"], found.torque)

    # Kittel's frequency of the film, with curvatures K in the plane and K + 1 across it.
    def test_the_modes_of_the_program(self):
        sim = cayspin.Simulation(scene(initial={"uniform": [1, 0, 0]}))
        modes = sim.modes(3)
        self.assertTrue(modes.converged)
        self.assertEqual(modes.shape.shape, (3, 1, 10, 12, 3))
        half = 0.1 * (0.1 + 1.1) / 2
        kittel = np.sqrt((1 + 0.1**2) * 0.1 * 1.1 - half**2)
        self.assertAlmostEqual(modes.frequency[0], kittel, delta=1e-10)
        self.assertAlmostEqual(modes.decay[0], half, delta=1e-10)
        longest = np.sqrt((np.abs(modes.shape)**2).sum(-1)).max(axis=(1, 2, 3))
        np.testing.assert_allclose(longest, 1, rtol=1e-12)
        file = self.run_program(scene(initial={"uniform": [1, 0, 0]}), "--count", "3", "--at-rest",
                                command="modes")
        np.testing.assert_array_equal(modes.frequency, file["frequency"])
        np.testing.assert_array_equal(modes.shape.real, file["mode"][..., 0])
        for count in (0, -1, 1000):
            self.assert_refused(cayspin.CayspinError, "modes; accepted: 1 to 128",
                                lambda count=count: sim.modes(count))
        self.assert_refused(cayspin.CayspinError, "tolerance", lambda: sim.modes(tolerance=2.0))
        for limit in (0, -1):
            self.assert_refused(cayspin.CayspinError, "evaluations; accepted: a whole number >= 1",
                                lambda limit=limit: sim.modes(evaluations=limit))

    # With the polarization along the spins, the torque adds a = damping_like to the decay and
    # -damping * a to both stiffnesses.
    def test_a_torque_makes_modes_grow(self):
        torque = {"slonczewski": {"damping_like": -0.2, "polarization": [1, 0, 0]}}
        film = {"torque": torque, "lattice": {"shape": [4, 3]}}
        modes = cayspin.Simulation(scene(**film, initial={"uniform": [1, 0, 0]})).modes(1)
        frequency = np.sqrt((0.1 + 0.02) * (1.1 + 0.02) - (0.1 * (1.1 - 0.1) / 2)**2)
        self.assertAlmostEqual(modes.frequency[0], frequency, delta=1e-10)
        self.assertAlmostEqual(modes.decay[0], 0.06 - 0.2, delta=1e-10)
        moving = cayspin.Simulation(scene(**film, initial={"uniform": [0, 0.6, 0.8]}))
        self.assert_refused(cayspin.NumbersFailed, "not at rest", lambda: moving.modes(1))
        self.assert_refused(cayspin.SceneError, "torque", moving.relax)

    # In a field along its easy axis, a uniform film switches at |h| = K.
    def test_hysteresis(self):
        fields = [[0.03 * i, 0, 0.0003] for i in range(10, -11, -1)]
        start = {"uniform": [1, 0.02, 0]}
        sim = cayspin.Simulation(scene(initial=start))
        loop = []
        for h in fields:
            self.assertTrue(sim.relax(applied=h).converged)
            loop.append(sim.magnetization())
        for h, m in zip(fields, loop):
            self.assertAlmostEqual(m[0], 1 if h[0] > -0.1 else -1, delta=1e-5)
        file = self.run_program(scene(initial=start), "--set", f"field.applied={fields}",
                                command="relax")
        np.testing.assert_array_equal(loop, file["magnetization"])

    def test_after_steps_and_before(self):
        of = scene(integrator={"method": "ab2", "dt": 0.001})
        sim = cayspin.Simulation(of)
        sim.step(5)
        held = sim.spins
        before = held.copy()
        found = sim.relax(torque=1e-3, evaluations=50)
        self.assertEqual(sim.steps, 5)
        self.assertEqual(found.end, "converged")
        np.testing.assert_array_equal(held, before)
        again = cayspin.Simulation(of)
        again.spins = sim.spins
        for each in (sim, again):
            each.step(3)
        np.testing.assert_allclose(sim.spins, again.spins, atol=1e-15)

    def test_how_it_ends(self):
        sim = cayspin.Simulation(scene())
        self.assertEqual(sim.relax(evaluations=12).end, "evaluation limit")
        stagnated = sim.relax(torque=1e-30, applied=[0.03, 0.05, 0.02])
        self.assertEqual(stagnated.end, "stagnated")
        self.assertFalse(stagnated.converged)

    def test_own_fields(self):
        def demagnetization(spins, t):
            return np.array([0, 0, -1]) * spins

        tables = {"exchange": 40.0, "anisotropy": {"constant": 0.1, "axis": [1, 0, 0]}}
        own = cayspin.Simulation(scene(field={**tables, "nonlocal": demagnetization,
                                              "applied": lambda t: (0.2, 0.1 - t, 0)}))
        same = cayspin.Simulation(scene(field={**TABLES["field"], "applied": [0.2, 0.1, 0]}))
        for sim in (own, same):
            self.assertTrue(sim.relax().converged)
        np.testing.assert_allclose(own.spins, same.spins, atol=1e-5)
        self.assertTrue(own.relax(applied=(0, 1, 0)).converged)
        self.assertGreater(own.magnetization()[1], 0.99)

        def fails(spins, t):
            raise ZeroDivisionError("own")

        self.assert_refused(ZeroDivisionError, "own",
                            cayspin.Simulation(scene(field={"nonlocal": fails})).relax)

    def test_in_si(self):
        material = {"Ms": 8e5, "A": 1.3e-11, "alpha": 0.02, "damping_form": "gilbert"}
        of = cayspin.Scene(units="SI", material=material, system={"kind": "llg"},
                           lattice={"shape": [8, 6], "spacing": 5e-9},
                           field={"applied": [0.0, 1e-4, 0.502654824574367],
                                  "slab_demag": {"normal": [0, 0, 1]}},
                           initial={"uniform": [1, 0.1, 0.2]})
        sim = cayspin.Simulation(of)
        found = sim.relax(torque=1e-9)
        self.assertLess(found.torque, 1e-9)
        self.assertAlmostEqual(sim.magnetization()[2], 0.5, delta=2e-4)
        self.assertEqual(found.energy, sim.energy())
        sim.relax(torque=1e-9, applied=[0, 1e-4, 0.25 * 4e-7 * np.pi * 8e5])
        self.assertAlmostEqual(sim.magnetization()[2], 0.25, delta=2e-4)

    def test_interrupted(self):
        sim = cayspin.Simulation(scene(lattice={"shape": [300, 300]}))
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                sim.relax(torque=1e-30)
                sim.spins = np.random.default_rng(1).normal(size=(1, 300, 300, 3))
        timer.join()
        self.assertLess(sim.norm_defect(), 1e-15)

    def test_refused(self):
        sim = cayspin.Simulation(scene())
        before = sim.spins.copy()
        for keys, says in (({"torque": 0}, "torque 0"), ({"torque": "x"}, "relax: torque"),
                           ({"torque": 1e-151}, "accepted: a number of at least 1e-150"),
                           ({"torque": float("nan")}, "torque nan"),
                           ({"evaluations": 0}, "0 evaluations"),
                           ({"evaluations": 1.5}, "relax: evaluations"),
                           ({"applied": [1, 2]}, "relax: applied of shape"),
                           ({"applied": "x"}, "relax: applied"),
                           ({"applied": [1, 2, float("inf")]}, "applied: not finite")):
            self.assert_refused(cayspin.CayspinError, says, sim.relax, **keys)
        for call in (sim.step, sim.run):
            self.assert_refused(cayspin.CayspinError, "no integrator; accepted: relax", call)
        np.testing.assert_array_equal(sim.spins, before)
        of = sim.scene
        self.assertEqual((of.method, of.dt, of.steps), (None, None, 0))
        self.assertIn("to relax", repr(of))
        self.assert_refused(cayspin.SceneError, "Simulation.relax(applied=", scene,
                            field={"applied": [[1, 0, 0], [0, 1, 0]]})
        steps = {"method": "rkmk4", "dt": 0.1}
        warm = scene(integrator=steps, thermal={"temperature": 1, "seed": 1})
        body = cayspin.Scene(system={"kind": "rigid_body", "inertia": [1, 2, 3]},
                             lattice={"shape": [1]}, initial={"uniform": [1, 0, 0]},
                             integrator=steps)
        for of, says in ((warm, "no temperature"), (body, "no equilibrium")):
            self.assert_refused(cayspin.SceneError, says, cayspin.Simulation(of).relax)
        endless = cayspin.Simulation(scene(field={"nonlocal": lambda s, t: s * np.nan}))
        self.assert_refused(cayspin.NumbersFailed, "not finite", endless.relax)


if __name__ == "__main__":
    unittest.main()
