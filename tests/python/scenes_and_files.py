# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Scenes from tables and files, fields and observers of a program, and trajectory files."""

import importlib.util
import math
import os
import subprocess
import sys
import unittest

import cayspin
import h5py
import numpy as np
from package_test import TABLES, PackageTest, scene, stepped

CLOCKS = {"wall_seconds", "step_seconds"}

# Kokkos starts once in a process, with the number of threads of the first simulation.
SERIAL_RUN = """
import sys
import cayspin
sim = cayspin.Simulation(cayspin.Scene.from_file(sys.argv[1]), space="serial")
sim.step(20)
print(sim.space, sim.threads, sim.spins.tobytes().hex())
"""


class Scenes(PackageTest):
    def test_tables_are_a_file(self):
        of = scene()
        again = cayspin.Scene.from_file(self.written(of))
        self.assertEqual((again.shape, again.method, again.dt, again.steps),
                         ((2, 3, 7), "rkmk4", 0.05, 40))
        np.testing.assert_array_equal(stepped(of, 3), stepped(again, 3))

    def test_changed_keys(self):
        file = self.written(scene())
        changed = cayspin.Scene.from_file(file, integrator={"dt": 0.025, "steps": 8},
                                          initial={"uniform": [0, 0, 1]})
        self.assertEqual((changed.dt, changed.steps, changed.method), (0.025, 8, "rkmk4"))
        self.assertTrue((cayspin.Simulation(changed).spins == [0, 0, 1]).all())
        array = np.tile([0, 1.0, 0], (2, 3, 7, 1))
        given = cayspin.Scene.from_file(file, initial=array)
        np.testing.assert_array_equal(cayspin.Simulation(given).spins, array)
        self.assert_refused(cayspin.SceneError, "integrator.dt=0: integrator.dt: 0 is not",
                            cayspin.Scene.from_file, file, integrator={"dt": 0})

    def test_every_kind_of_value(self):
        of = cayspin.Scene(**{**TABLES, "system": {"kind": 'llg', "damping": np.float32(0.5),
                                                   "precession": np.bool_(False)},
                              "lattice": {"shape": np.array([2, 3]), "spacing": (1e-9, 2e-9)},
                              "field": {"anisotropy": [{"constant": 1, "axis": [0, 0, 1]},
                                                       {"constant": 2, "axis": (1, 0, 0)}],
                                        "applied": [0, "0.1*cos(t)", 1e-7]},
                              "output": {"file": self.folder / 'a "quoted" name.h5'}})
        self.assertIn('"0.1*cos(t)"', of.text)
        self.assertEqual(of.shape, (1, 3, 2))

    def test_files_of_masks_and_numbers(self):
        mask = np.arange(42).reshape(2, 3, 7) % 5 != 0
        regions = np.arange(42).reshape(2, 3, 7) % 3
        stored = {"mask": mask, "numbers": regions, "bytes": regions.astype("u1")}
        for name, array in stored.items():
            with h5py.File(self.folder / f"{name}.h5", "w") as file:
                file["values"] = array
        by_region = {"regions": [0.5, 1.0, 2.0]}
        arrays = scene(lattice={"occupied": mask, "regions": regions},
                       field={"exchange": by_region})
        for numbers in ("numbers", "bytes"):
            files = scene(lattice={"occupied": {"file": str(self.folder / "mask.h5")},
                                   "regions": {"file": str(self.folder / f"{numbers}.h5")}},
                          field={"exchange": by_region})
            np.testing.assert_array_equal(stepped(files, 3), stepped(arrays, 3))

    def test_messages(self):
        for part, tables in {
                "field.anisotropy.konstant: unknown key, did you mean \"constant\"?":
                    {"field": {"anisotropy": {"konstant": 1, "axis": [0, 0, 1]}}},
                "integrator.dt: 0 is not positive; accepted: a number > 0":
                    {"integrator": {"dt": 0}},
                "system.damping: is of type object; accepted: bool":
                    {"system": {"damping": object()}},
                "initial.given: stands for spins": {"initial": {"given": True}},
                "thermic: unknown key": {"thermic": {"temperature": 1}}}.items():
            with self.assertRaises(cayspin.SceneError) as caught:
                scene(**tables)
            # Tables have no line numbers to name.
            self.assertEqual(str(caught.exception)[:len(part)], part)
        self.assert_refused(cayspin.SceneError, "cannot be read", cayspin.Scene.from_file,
                            self.folder / "missing.toml")
        self.assertTrue(issubclass(cayspin.SceneError, cayspin.CayspinError))
        self.assert_refused(cayspin.SceneError,
                            "integrator.method: \"auto\" is chosen by the program",
                            cayspin.Simulation,
                            scene(integrator={"method": "auto", "error": 1e-3}))


class Spaces(PackageTest):
    def test_space_by_name(self):
        for precision in ("double", "single"):
            sims = [cayspin.Simulation(scene(), precision)]
            sims.append(cayspin.Simulation(scene(), precision, space=sims[0].space))
            for sim in sims:
                sim.step(20)
                self.assertEqual(sim.space, os.environ.get("CAYSPIN_SPACE", sims[0].space))
            np.testing.assert_array_equal(sims[0].spins, sims[1].spins)

    def test_serial_runs_on_one_thread_with_the_bits_of_the_default_space(self):
        sim = cayspin.Simulation(scene())
        if sim.space not in ("openmp", "threads"):
            self.skipTest(f"the default space, {sim.space}, has one thread or is a device")
        sim.step(20)
        serial = subprocess.run([sys.executable, "-B", "-c", SERIAL_RUN, self.written(scene())],
                                env={**os.environ, "OMP_NUM_THREADS": "2"}, check=True,
                                capture_output=True, text=True).stdout
        self.assertEqual(serial.split(), ["serial", "1", sim.spins.tobytes().hex()])


class OwnFields(PackageTest):
    def test_uniform_field_is_its_expression(self):
        own = scene(field={"applied": lambda t: (0.1 * math.cos(t), 0, t)})
        typed = scene(field={"applied": ["0.1*cos(t)", 0, "t"]})
        self.assertIn("# field.applied: a function", own.text)
        for precision in ("double", "single"):
            sims = [cayspin.Simulation(one, precision) for one in (own, typed)]
            for sim in sims:
                sim.step(20)
            np.testing.assert_array_equal(sims[0].spins, sims[1].spins)
            self.assertEqual(sims[0].energies(), sims[1].energies())

    def test_nonlocal_field_is_that_of_the_slab(self):
        def slab(spins, t):
            self.assertTrue(spins.flags.c_contiguous)
            return -1.2 * spins * [0, 0, 1]

        own = scene(field={"slab_demag": None, "nonlocal": slab})
        sims = [cayspin.Simulation(one) for one in (own, scene())]
        for sim in sims:
            sim.step(40)
        np.testing.assert_allclose(sims[0].spins, sims[1].spins, rtol=0, atol=40 * 64 * 2.0**-52)
        self.assertAlmostEqual(sims[0].energies()["nonlocal"], sims[1].energies()["slab_demag"])

    def test_a_nonlocal_field_is_multirate_between_substeps(self):
        calls = []

        def slab(spins, t):
            calls.append(t)
            if t > 0.37:
                raise ZeroDivisionError("at half past")
            return -1.2 * spins * [0, 0, 1]

        sim = cayspin.Simulation(scene(
            field={"slab_demag": None, "nonlocal": slab},
            integrator={"method": "rkmk4", "dt": 0.05, "substeps": 3, "steps": None}))
        sim.step(1)
        calls.clear()
        sim.step(5)
        np.testing.assert_allclose(calls, [0.1, 0.15, 0.2, 0.25, 0.3])
        sim.step(1)
        before = np.array(sim.spins)
        self.assert_refused(ZeroDivisionError, "at half past", sim.step, 1)
        self.assertEqual(sim.steps, 7)
        np.testing.assert_array_equal(sim.spins, before)
        self.assert_refused(cayspin.CayspinError, "no term of the field is expensive",
                            lambda: cayspin.Simulation(scene(integrator={"substeps": 3})))

    def test_what_a_function_raises_and_returns(self):
        def failing(t):
            if t > 0.5:
                raise ZeroDivisionError("at half past")
            return 0, 0, 1

        endless = {"steps": None}  # with an end, the field would be sampled up to it first
        sim = cayspin.Simulation(scene(field={"applied": failing}, integrator=endless))
        self.assert_refused(ZeroDivisionError, "at half past", sim.step, 40)
        self.assertEqual(sim.steps, 10)
        np.testing.assert_array_equal(sim.spins, stepped(scene(field={"applied": [0, 0, "1"]}), 10))
        for part, field in {"another number of components": {"applied": lambda t: (1, 2)},
                            "not finite": {"applied": lambda t: (0, 0, math.nan)},
                            "another shape": {"slab_demag": None,
                                              "nonlocal": lambda m, t: m[:1]}}.items():
            self.assert_refused(cayspin.CayspinError, part, lambda f=field:
                                stepped(scene(field=f), 1))

    def test_a_function_may_not_step(self):
        sims = []
        of = scene(field={"applied": lambda t: sims[0].step() if sims else (0, 0, 1)})
        sims.append(cayspin.Simulation(of))
        self.assert_refused(cayspin.CayspinError, "this run is taking a step: a field function",
                            sims[0].step)


class Observers(PackageTest):
    def test_steps_of_the_calls(self):
        sim, seen = cayspin.Simulation(scene()), []
        sim.observe(4, lambda s: seen.append((s.steps, s.spins)))
        sim.step(10)
        sim.step(3)
        sim.run()
        self.assertEqual([step for step, _ in seen], list(range(4, 41, 4)))
        other = cayspin.Simulation(scene())
        for _, spins in seen:
            other.step(4)
            np.testing.assert_array_equal(spins, other.spins)

    def test_true_ends_the_run(self):
        sim = cayspin.Simulation(scene())
        sim.observe(3, lambda s: s.steps == 9)
        sim.run()
        self.assertEqual(sim.steps, 9)
        self.assert_refused(cayspin.CayspinError, "at least 1", sim.observe, 0, print)

    def test_an_ended_run_has_one_sample_a_step(self):
        sim = cayspin.Simulation(scene(output={"every": 20, "scalars_every": 3}))
        sim.observe(3, lambda s: s.steps == 9)
        output = self.folder / "ended.h5"
        sim.run(output=output)
        with cayspin.open(output) as run:
            self.assertEqual(list(run.scalars["step"]), [0, 3, 6, 9])
            self.assertEqual(list(run.step), [0, 9])


class Files(PackageTest):
    def test_the_file_of_the_program(self):
        for precision in ("double", "single"):
            of = scene(output={"every": 7, "scalars_every": 3})
            program = self.run_program(of, "--precision", precision)
            output = self.folder / f"{precision}.h5"
            cayspin.Simulation(of, precision).run(output=output)
            with h5py.File(output) as here:
                attributes = {key: (here.attrs[key], value) for key, value in program.attrs.items()}
                for key, (mine, theirs) in attributes.items():
                    if key not in CLOCKS | {"threads", "git_commit"}:
                        self.assertEqual(mine, theirs, key)
                program.visititems(lambda name, node: isinstance(node, h5py.Group) or
                                   np.testing.assert_array_equal(here[name], node, name))

    def test_regions_terms_and_the_shift(self):
        # The lattice follows a wall that starts three cells off the middle.
        of = scene(lattice={"shape": [12, 4], "spacing": 1.0, "boundary": "open",
                            "regions": "j % 2", "follow": {"axis": "x", "quantity": "mz"}},
                   field={"anisotropy": {"constant": 2.0, "axis": [0, 0, 1]}, "applied": None,
                          "slab_demag": None, "mu0": None},
                   initial={"expression": ["1/cosh(i - 8.5)", "0", "-tanh(i - 8.5)"]},
                   output={"every": 10, "scalars_every": 5, "regions": True, "terms": True})
        program = self.run_program(of)
        sim = cayspin.Simulation(of)
        output = self.folder / "run.h5"
        sim.run(output=output)
        with cayspin.open(output) as run:
            self.assertEqual(run.terms, ["exchange", "anisotropy"])
            for name in ("region_magnetization", "region_energy", "term_energy", "shift"):
                np.testing.assert_array_equal(run.scalars[name], program["scalars"][name], name)
            self.assertEqual(run.scalars["region_magnetization"].shape, (9, 2, 3))
            self.assertEqual(list(sim.energies().values()),
                             list(run.scalars["term_energy"][-1]))
            means = [sim.spins[0, row::2].reshape(-1, 3).mean(0) for row in range(2)]
            np.testing.assert_allclose(run.scalars["region_magnetization"][-1], means, atol=1e-14)
            self.assertEqual((run.shift[0], run.shift[-1]), (0, 3))
        cayspin.Simulation(scene()).run(output=self.folder / "plain.h5")
        with cayspin.open(self.folder / "plain.h5") as run:
            self.assertEqual(run.terms, [])
            with self.assertRaisesRegex(AttributeError, "the file of a scene with lattice.follow"):
                run.shift

    def test_scene_names_the_file(self):
        output = self.folder / "named.h5"
        of = scene(output={"file": output})
        cayspin.Simulation(of).run(output=False)
        self.assertFalse(output.exists())
        cayspin.Simulation(of).run()
        self.assert_refused(cayspin.CayspinError, "named.h5", cayspin.Simulation(of).run)
        cayspin.Simulation(of).run(overwrite=True)

    def test_open(self):
        output = self.folder / "run.h5"
        sim = cayspin.Simulation(scene(output={"every": 10}))
        sim.run(output=output)
        with cayspin.open(output) as run:
            self.assertIsInstance(run.spins, h5py.Dataset)
            self.assertEqual((len(run), run.spins.shape), (5, (5, 2, 3, 7, 3)))
            self.assertTrue(run.complete)
            np.testing.assert_array_equal(run.time[:], [0, 0.5, 1, 1.5, 2])
            np.testing.assert_array_equal(run.spins[-1], sim.spins)
            self.assertEqual(run.energy[-1], sim.energy())
            self.assertEqual(run.scene, sim.scene.text)
            if importlib.util.find_spec("xarray"):
                data = run.to_xarray()
                self.assertEqual(dict(data.sizes)["frame"], 5)
                np.testing.assert_array_equal(data.spins.isel(frame=-1), sim.spins)
        with h5py.File(output, "r+") as killed:
            killed["spins"].resize(6, 0)
        with cayspin.open(output) as run:
            self.assertEqual(len(run), 5)
            if importlib.util.find_spec("xarray"):
                data = run.to_xarray()
                self.assertEqual(dict(data.sizes)["frame"], 5)
                np.testing.assert_array_equal(data.spins.values, run.spins[:5])
        with h5py.File(output, "r+") as killed:
            killed["energy"].resize(4, 0)
        with cayspin.open(output) as run:
            self.assertEqual(len(run), 4)
        with h5py.File(output, "r+") as killed:
            killed["checksum"].resize(3, 0)
        with cayspin.open(output) as run:
            self.assertEqual(len(run), 3)
            self.assert_refused(cayspin.CayspinError, "frame 3; accepted: -3 to 2", run.plot, 3)
        self.assert_refused(cayspin.CayspinError, "cannot be opened", cayspin.open,
                            self.folder / "missing.h5")
        cayspin.Simulation(scene(output={"every": 10, "sync": True})).run(output=output,
                                                                          overwrite=True)
        with cayspin.open(output) as run:
            self.assertEqual((len(run), run.complete), (5, True))
        self.assertFalse(output.with_name("run.h5.journal").exists())
        with h5py.File(self.folder / "other.h5", "w"):
            pass
        self.assert_refused(cayspin.CayspinError, "it has no spins", cayspin.open,
                            self.folder / "other.h5")


if __name__ == "__main__":
    unittest.main()
