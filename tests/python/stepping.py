# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A Simulation gives bitwise the same results as `cayspin run`, ends with a complete step after
Ctrl-C, and runs while other Python threads do."""

import os
import signal
import threading
import unittest
import warnings

import cayspin
import h5py
import numpy as np
from package_test import PackageTest, scene, stepped

METHODS = {
    "rkmk4": {},
    "ab2": {"method": "ab2"},
    "tsit5": {"method": "tsit5", "tolerance": 1e-5},
    "compensated": {"compensated": True},
    "lagged": {"method": "euler", "isotropy": "finite_difference_backward"},
}
SCENES = {name: {"integrator": keys} for name, keys in METHODS.items()} | {
    "temperature": {"thermal": {"temperature": 0.4, "seed": 5}},
    "energy control": {"system": {"damping": 0}, "integrator": {"energy_control": True}},
}


class Warnings(PackageTest):
    def test_a_dt_that_is_too_large(self):
        sim = cayspin.Simulation(scene(integrator={"dt": 1e3}))
        with self.assertWarnsRegex(UserWarning, "integrator.dt: 1000 is above the stable "):
            sim.step(2)
        refused = cayspin.Simulation(scene(integrator={"dt": 1e3, "refuse_unstable": True}))
        for _ in range(2):
            self.assert_refused(cayspin.SceneError, "is above the stable", refused.step)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            cayspin.Simulation(scene()).step()


class Bits(PackageTest):
    def test_pieces_are_one_run_and_the_program(self):
        for name, tables in SCENES.items():
            for precision in ("double", "single"):
                with self.subTest(name, precision=precision):
                    of = scene(**tables)
                    whole, pieces = (cayspin.Simulation(of, precision) for _ in range(2))
                    whole.step(40)
                    for steps in (1, 2, 7, *[1] * 30):
                        pieces.step(steps)
                        pieces.energy()
                    ran = self.run_program(of, "--precision", precision)["spins"][-1]
                    self.assertEqual(ran.dtype, {"double": "f8", "single": "f4"}[precision])
                    np.testing.assert_array_equal(whole.spins, ran)
                    np.testing.assert_array_equal(pieces.spins, ran)
                    self.assertEqual(pieces.evaluations, whole.evaluations)

    def test_saved_and_restarted(self):
        for name, tables in SCENES.items():
            with self.subTest(name):
                of = scene(**tables)
                whole = cayspin.Simulation(of)
                whole.step(17)
                file = self.folder / "run.checkpoint.h5"
                whole.save(file)
                again = cayspin.Simulation(of, restart=file)
                self.assertEqual((again.steps, again.time), (whole.steps, whole.time))
                for sim in (whole, again):
                    sim.step(23)
                np.testing.assert_array_equal(again.spins, whole.spins)
        self.assert_refused(cayspin.CayspinError, "missing.h5", cayspin.Simulation, of,
                            restart="missing.h5")

    def test_restart_of_another_scene(self):
        of = scene(field={"applied": [0.1, 0, 0]})
        run = cayspin.Simulation(of)
        run.step(5)
        file = self.folder / "other.checkpoint.h5"
        run.save(file)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            cayspin.Simulation(of, restart=file)
        with self.assertWarnsRegex(UserWarning, "these keys differ from its scene: field.applied$"):
            cayspin.Simulation(scene(field={"applied": [0.2, 0, 0]}), restart=file)
        for lattice, key in (({"spacing": 3.0}, "spacing"), ({"frozen": "i==0"}, "frozen"),
                             ({"occupied": "i>0"}, "occupied")):
            self.assert_refused(cayspin.CayspinError, f"lattice.{key} differs",
                                cayspin.Simulation, scene(lattice=lattice), restart=file)

    def test_noise_is_that_of_the_seed(self):
        for precision in ("double", "single"):
            one, other = (stepped(scene(thermal={"temperature": 0.4, "seed": seed}), 40, precision)
                          for seed in (5, 6))
            self.assertGreater(np.abs(other - one).max(), 0.1)

    def test_run_leaves_a_checkpoint(self):
        of = scene(integrator={"method": "ab2"}, output={"checkpoint_every": "7 steps"})
        first = cayspin.Simulation(of)
        first.observe(23, lambda sim: True)
        first.run(output=self.folder / "first.h5")
        second = cayspin.Simulation(of, restart=self.folder / "first.h5")
        self.assertEqual(second.steps, 23)
        second.step(17)
        np.testing.assert_array_equal(second.spins, stepped(of, 40))

    def test_many_small_steps(self):
        of = scene(lattice={"shape": [5], "spacing": 1, "boundary": "open"},
                   field={"slab_demag": None}, integrator={"steps": 3000, "dt": 0.01})
        pieces, whole = cayspin.Simulation(of), cayspin.Simulation(of)
        for _ in range(3):
            pieces.step(1000)
        whole.run()
        self.assertEqual((whole.steps, whole.time), (3000, 30))
        np.testing.assert_array_equal(pieces.spins, whole.spins)


class Time(PackageTest):
    def test_until(self):
        sim = cayspin.Simulation(scene())
        sim.run(until=0.5)
        self.assertEqual((sim.steps, sim.time), (10, 0.5))
        self.assert_refused(cayspin.CayspinError, "whole number of steps", sim.run, until=0.52)
        self.assert_refused(cayspin.CayspinError, "has passed, the time is", sim.run, until=0.25)

    def test_scene_without_end(self):
        for keys in ({}, {"method": "tsit5", "tolerance": 1e-5}):
            endless = cayspin.Simulation(scene(integrator={"steps": None, **keys}))
            self.assert_refused(cayspin.CayspinError, "no end", endless.run)
            endless.step(50)
            self.assertEqual(endless.steps, 50)

    def test_adaptive_method_ends_where_its_scene_ends(self):
        sim = cayspin.Simulation(scene(integrator=METHODS["tsit5"]))
        self.assert_refused(cayspin.CayspinError, "lies beyond step 40", sim.step, 41)
        sim.observe(10, lambda sim: None)
        file = self.folder / "beyond.h5"
        for call in (lambda: sim.step(41), lambda: sim.run(until=41 * sim.scene.dt, output=file)):
            self.assert_refused(cayspin.CayspinError, "lies beyond step 40", call)
        self.assertEqual(sim.steps, 0)
        self.assertFalse(file.exists())
        sim.step(40)

    def test_failing_numbers(self):
        unstable = scene(system={"damping": 1.0},
                         integrator={"method": "classical_euler", "dt": 50.0, "steps": 4000})
        sim = cayspin.Simulation(unstable)
        self.assert_refused(cayspin.NumbersFailed, "not finite any more", sim.step, 4000)
        self.assertGreater(sim.steps, 0)
        self.assertLess(sim.steps, 4000)

    def test_failing_numbers_in_the_last_frame(self):
        sim = cayspin.Simulation(scene(
            lattice={"shape": [4100, 1, 1]}, field={"slab_demag": None}, system={"damping": 1.0},
            integrator={"method": "classical_rk4", "dt": 1e4, "steps": 5}))
        file = self.folder / "failing.h5"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assert_refused(cayspin.NumbersFailed, "not finite any more", sim.run, output=file)
        with h5py.File(file) as written:
            self.assertEqual(written.attrs["complete"], 0)
            self.assertTrue(np.isfinite(written["spins"][:]).all())


class OtherThreads(PackageTest):
    def setUp(self):
        super().setUp()
        self.large = scene(lattice={"shape": [32, 32, 32]}, integrator={"steps": None})

    def test_another_thread_runs_while_stepping(self):
        sim, count, done = cayspin.Simulation(self.large), [0], threading.Event()

        def counting():
            while not done.is_set():
                count[0] += 1

        thread = threading.Thread(target=counting)
        thread.start()
        before = count[0]
        sim.step(20)
        counted = count[0] - before
        done.set()
        thread.join()
        self.assertGreater(counted, 1000)

    def test_counts_are_read_while_stepping(self):
        sim, whole = cayspin.Simulation(scene()), cayspin.Simulation(scene())
        whole.step(40)
        thread = threading.Thread(target=lambda: [sim.step() for _ in range(40)])
        thread.start()
        counts = [(0, 0.0, 0)]
        while thread.is_alive():
            counts.append((sim.steps, sim.time, sim.evaluations))
        thread.join()
        counts.append((sim.steps, sim.time, sim.evaluations))
        for before, after in zip(counts, counts[1:]):
            self.assertTrue(all(a <= b for a, b in zip(before, after)), (before, after))
        self.assertEqual(counts[-1], (40, whole.time, whole.evaluations))

    def test_two_simulations_in_two_threads(self):
        sims = [cayspin.Simulation(scene()) for _ in range(2)]
        threads = [threading.Thread(target=lambda sim=sim: [sim.step() for _ in range(40)])
                   for sim in sims]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for sim in sims:
            np.testing.assert_array_equal(sim.spins, stepped(scene(), 40))


class Interrupt(PackageTest):
    def interrupted(self, call):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        self.assertRaises(KeyboardInterrupt, call)
        timer.join()

    def test_state_is_whole(self):
        for keys in ({}, METHODS["ab2"], {**METHODS["tsit5"], "energy_guard": False}):
            for shape in ([7, 3, 2], [24, 24, 24]):
                with self.subTest(keys, shape=shape):
                    of = scene(lattice={"shape": shape}, integrator={"steps": None, **keys})
                    sim = cayspin.Simulation(of)
                    self.interrupted(lambda: sim.step(10**9))
                    self.assertGreater(sim.steps, 0)
                    sim.step(3)
                    np.testing.assert_array_equal(sim.spins, stepped(of, sim.steps))

    def test_file_is_whole(self):
        sim = cayspin.Simulation(scene(integrator={"steps": 10**9}, output={"every": 10**8}))
        file = self.folder / "run.h5"
        self.interrupted(lambda: sim.run(output=file))
        with cayspin.open(file) as run:
            self.assertFalse(run.complete)
            self.assertEqual(run.step[-1], sim.steps)
            np.testing.assert_array_equal(run.spins[-1], sim.spins)


if __name__ == "__main__":
    unittest.main()
