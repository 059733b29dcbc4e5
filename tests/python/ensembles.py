# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Ensembles in the package: their files, pictures and simulations."""

import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import cayspin
import h5py
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
        subprocess.run([PROGRAM, command, "scene.toml", "--quiet", "--overwrite", "-o", file],
                       cwd=self.folder, check=True)
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

    def test_varied_values_may_be_of_any_kind_of_sequence(self):
        def text_of(values, replicas=3):
            return scene(ensemble={"replicas": replicas,
                                   "vary": {"field.applied.0": values}}).text

        expected = text_of([0, 1, 2])
        for values in ((0, 1, 2), range(3), np.arange(3), list(np.arange(3, dtype=np.int16)),
                       tuple(np.arange(3, dtype=np.uint8))):
            self.assertEqual(text_of(values, np.int32(3)), expected)
        self.assertEqual(text_of(np.arange(3.0)), text_of([0.0, 1.0, 2.0]))
        self.assertEqual(text_of({"from": np.int64(0), "to": np.float32(0.5)}),
                         text_of({"from": 0, "to": 0.5}))
        with self.assertRaisesRegex(cayspin.SceneError, "has 4 entries; accepted: as many numbers"):
            text_of(range(4))

    def test_sublattices_are_those_of_runs(self):
        tables = {"lattice": {"shape": [3, 2, 2], "crystal": "bcc"},
                  "field": {"couplings": {"shells": [-1.0]}}}
        file = self.run_program("run", scene(**tables, ensemble={"replicas": 2}))
        with cayspin.open(file) as ensemble:
            self.assertEqual(ensemble.sublattice_magnetization.shape, (4, 2, 2, 3))
            np.testing.assert_allclose(ensemble.sublattice_magnetization[:],
                                       ensemble.spins[:].mean(axis=(3, 4, 5)), atol=1e-15)
        file = self.run_program("run", scene(ensemble={"replicas": 2}))
        with cayspin.open(file) as ensemble, self.assertRaisesRegex(
                AttributeError, "accepted: a file of a crystal with several sites in a cell"):
            ensemble.sublattice_magnetization

    def test_damaged_spins_of_a_replica_are_noticed(self):
        for tables in ({}, {"lattice": {"shape": [3, 2, 2], "crystal": "bcc"},
                            "field": {"couplings": {"shells": [-1.0]}}}):
            file = self.run_program("run", scene(**tables, ensemble={"replicas": 3}))
            with cayspin.open(file) as ensemble:
                ensemble.structure_factor()
                place = (2, 1, *[0] * (ensemble.spins.ndim - 3))
            with h5py.File(file, "r+") as changed:
                changed["spins"][place] = [0, 0, 1]
            with cayspin.open(file) as ensemble:
                ensemble.plot(replica=0, frame=2)
                ensemble.plot(replica=1, frame=1)
                ensemble.structure_factor(replicas=[0, 2])
                for call in (lambda: ensemble.plot(replica=1, frame=2),
                             lambda: ensemble.structure_factor(replicas=[1])):
                    with self.assertRaisesRegex(cayspin.CayspinError,
                                                "replica 1 of frame 2 is damaged"):
                        call()

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

    def test_a_frame_that_a_kill_left_unfinished_does_not_count(self):
        file = self.run_program("run", scene(ensemble={"replicas": 2}))
        with h5py.File(file, "r+") as killed:
            for name in ("spins", "time", "step", "energy", "norm_defect", "magnetization"):
                killed[name].resize(6, axis=0)
        with cayspin.open(file) as ensemble:
            self.assertEqual(len(ensemble), 4)
            ensemble.plot(1)
            with self.assertRaisesRegex(cayspin.CayspinError, "frame 4; accepted: -4 to 3"):
                ensemble.plot(0, 4)
        with h5py.File(file, "r+") as killed:
            killed["energy"].resize(3, axis=0)
        with cayspin.open(file) as ensemble:
            self.assertEqual(len(ensemble), 3)

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


class EnsembleSimulations(unittest.TestCase):
    def alone(self, replica, **tables):
        return cayspin.Simulation(scene(
            field={"exchange": 1.0, "applied": [FIELDS[replica], 0, 0.5]},
            initial={"random": {"seed": 4 + replica}}, **tables))

    def together(self, precision="double", **tables):
        made = scene(ensemble={"replicas": 3, "vary": {"field.applied.0": FIELDS}}, **tables)
        return cayspin.EnsembleSimulation(made, precision)

    def test_replicas_have_the_bits_of_their_own_runs(self):
        for thermal in ({}, {"thermal": {"temperature": 0.01, "seed": 2}}):
            sim = self.together(**thermal)
            self.assertEqual((sim.replicas, sim.steps, sim.spins.shape), (3, 0, (3, 1, 4, 6, 3)))
            sim.step(7)
            sim.run()
            self.assertEqual(sim.steps, 30)
            self.assertEqual(sim.time, 0.6)
            for replica in range(3):
                if thermal:
                    thermal["thermal"] = {"temperature": 0.01, "seed": 2 + replica}
                alone = self.alone(replica, **thermal)
                alone.run()
                np.testing.assert_array_equal(sim.spins[replica], alone.spins)
                self.assertEqual(sim.energy()[replica], alone.energy())
                self.assertEqual(sim.norm_defect()[replica], alone.norm_defect())
                np.testing.assert_array_equal(sim.magnetization()[replica], alone.magnetization())

    def test_single_precision(self):
        sim = self.together("single")
        sim.run(until=0.2)
        self.assertEqual((sim.steps, sim.precision, sim.spins.dtype), (10, "single", np.float32))
        self.assertLess(sim.norm_defect().max(), 1e-6)

    def test_restarts_with_the_bits_of_one_run(self):
        whole = self.together()
        whole.run()
        made = scene(ensemble={"replicas": 3, "vary": {"field.applied.0": FIELDS}})
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "part.h5")
            text = pathlib.Path(folder, "scene.toml")
            text.write_text(made.text, encoding="utf-8")
            subprocess.run([PROGRAM, "run", text, "--quiet", "--output", file, "--set",
                            "integrator.steps=11"], check=True)
            sim = cayspin.EnsembleSimulation(made, restart=file)
            self.assertEqual((sim.steps, sim.time), (11, 11 * 0.02))
            sim.run()
            np.testing.assert_array_equal(sim.spins, whole.spins)
            with self.assertRaisesRegex(cayspin.CayspinError, "3 replicas, and the scene has 2"):
                cayspin.EnsembleSimulation(scene(ensemble={"replicas": 2}), restart=file)

    def test_each_relaxes_by_itself(self):
        sim = self.together()
        found = sim.relax(torque=1e-8)
        self.assertEqual(len(found), 3)
        for replica, minimum in enumerate(found):
            alone = self.alone(replica)
            self.assertEqual(alone.relax(torque=1e-8), minimum)
            self.assertTrue(minimum.converged)
            np.testing.assert_array_equal(sim.spins[replica], alone.spins)
            field = np.array([FIELDS[replica], 0, 0.5])
            np.testing.assert_allclose(sim.magnetization()[replica],
                                       field / np.linalg.norm(field), atol=1e-7)

    def test_fields_and_starts_of_the_program_count_in_a_search(self):
        def made(constant, **more):
            return cayspin.Scene(
                system={"kind": "llg", "damping": 0.1}, lattice={"shape": [4]},
                field={"anisotropy": {"constant": constant, "axis": [0, 0, 1]},
                       "applied": lambda t: [1.9, 0, 0]},
                initial=np.tile([0.3, 0.1, 0.9], (1, 1, 4, 1)), **more)

        constants = [1.0, 1.1, 1.2]
        together = cayspin.EnsembleSimulation(made(1.0, ensemble={
            "replicas": 3, "vary": {"field.anisotropy.constant": constants}}))
        together.relax(torque=1e-9)
        for replica, constant in enumerate(constants):
            alone = cayspin.Simulation(made(constant))
            alone.relax(torque=1e-9)
            np.testing.assert_array_equal(together.spins[replica], alone.spins)
            self.assertAlmostEqual(together.energy()[replica], -4 * 1.9, 12)

    def test_threads_take_turns(self):
        sim = cayspin.EnsembleSimulation(scene(
            lattice={"shape": [8]}, ensemble={"replicas": 64},
            integrator={"method": "heun", "dt": 0.02}))
        ended = threading.Event()
        counts = []

        def look():
            while not ended.is_set():
                counts.append((sim.spins.shape, len(sim.energy()), sim.evaluations, sim.steps))

        thread = threading.Thread(target=look)
        thread.start()
        try:
            for _ in range(300):
                sim.step(3)
            sim.relax(torque=1e-6)
        finally:
            ended.set()
            thread.join()
        self.assertEqual(sim.steps, 900)
        self.assertEqual({(shape, energies) for shape, energies, *_ in counts},
                         {((64, 1, 1, 8, 3), 64)})

    def test_wrong_calls_are_one_line(self):
        for call, part in ((lambda: cayspin.EnsembleSimulation(scene()), "has no .ensemble."),
                           (lambda: cayspin.EnsembleSimulation("scene"), "accepted: a Scene"),
                           (lambda: self.together("half"), "double"),
                           (lambda: self.together().step(-1), "step"),
                           (lambda: self.together().run(until=0.013), "whole number of steps"),
                           (lambda: self.together(integrator=None).run(until=0.5),
                            "^run: the scene has no integrator; accepted: relax"),
                           (lambda: self.together(integrator=None).step(),
                            "^step: the scene has no integrator; accepted: relax"),
                           (lambda: self.together().relax(torque=-1), "torque")):
            with self.assertRaisesRegex(cayspin.CayspinError, part) as caught:
                call()
            self.assertEqual(len(str(caught.exception).splitlines()), 1)
        with self.assertRaisesRegex(cayspin.NumbersFailed, "replica 1"):
            cayspin.EnsembleSimulation(scene(
                integrator={"method": "classical_euler", "dt": 0.02, "steps": 3000},
                ensemble={"replicas": 2, "vary": {"field.applied.0": [0.1, 1e300]}})).run()

if __name__ == "__main__":
    unittest.main()
