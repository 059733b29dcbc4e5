# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Simulation.set: a run whose keys are changed on the way equals the program's run in stages."""

import os
import unittest
import warnings

import cayspin
import h5py
import numpy as np
from package_test import PackageTest

TABLES = {
    "system": {"kind": "llg", "damping": 0.1},
    "lattice": {"shape": [12, 3]},
    "field": {"exchange": 1.0, "applied": [0.3, -0.2, 0.1]},
    "initial": {"random": {"seed": 3}},
    "integrator": {"method": "rkmk4", "dt": 0.02, "steps": 25},
}


def scene(**tables):
    return cayspin.Scene(**{**TABLES, **tables})


class Stages(PackageTest):
    def test_the_bits_of_the_program(self):
        changes = {"field.applied": ["0.2*sin(9*t)", 0.1, 0.4],
                   "integrator": {"method": "heun", "dt": 0.01, "steps": 30}}
        for precision in ("double", "single"):
            sim = cayspin.Simulation(scene(), precision)
            sim.run()
            sim.set(changes)
            sim.run()
            self.assertEqual((sim.steps, sim.time), (55, 25 * 0.02 + 30 * 0.01))
            sim.set("field.applied", [0, 0, 0.5])
            sim.relax(1e-5)
            sim.set("system.damping", 0.3)
            self.assertEqual(sim.scene.dt, 0.01)
            sim.run()
            self.assertEqual(sim.steps, 85)
            stages = [changes_of(changes),
                      {"field": {"applied": [0, 0, 0.5]}, "relax": {"torque": 1e-5}},
                      {"system": {"damping": 0.3}}]
            whole = scene(stage=stages)
            file = self.run_program(whole, "--precision", precision)
            self.assertEqual(list(file["stage"]), [0, 0, 1, 2, 3])
            np.testing.assert_array_equal(sim.spins, file["spins"][-1])
            self.assertEqual(file["time"][-1], sim.time)

    # The time of each change has a rounding error, and these add up.
    def test_many_changes(self):
        one = {"lattice": {"shape": [1]}, "initial": {"uniform": [1, 0, 1]}}
        sim = cayspin.Simulation(scene(**one, field={"applied": [0, 0, 1]},
                                       integrator={"method": "heun", "dt": 0.017, "steps": 60000}))
        sim.observe(70, lambda s: s.set("field.applied", [0, 0, 1 + s.time / 2000]))
        sim.run()
        self.assertEqual(sim.steps, 60000)
        sim = cayspin.Simulation(scene(**one, field={"applied": [0, 0, 1]},
                                       integrator={"method": "heun", "dt": 0.017, "steps": 1}))
        for n in range(800):
            sim.set("field.applied", [0, 0, 1 + n / 800])
            sim.run(until=(n + 1) * 100 * 0.017)
        self.assertEqual(sim.steps, 80000)

    def test_what_stays(self):
        sim = cayspin.Simulation(scene())
        sim.step(7)
        before, view = sim.spins.copy(), sim.spins
        sim.set({"field.exchange": 3.0, "system": {"damping": 0.7}})
        np.testing.assert_array_equal(sim.spins, before)
        np.testing.assert_array_equal(view, before)
        self.assertEqual((sim.steps, sim.time), (7, 7 * 0.02))
        other = cayspin.Simulation(scene(field={**TABLES["field"], "exchange": 3.0},
                                         system={"kind": "llg", "damping": 0.7}))
        other.spins = before
        self.assertEqual(sim.energy(), other.energy())
        sim.step(5)
        other.step(5)
        np.testing.assert_allclose(sim.spins, other.spins, rtol=0, atol=1e-14)  # set, so normalised
        np.testing.assert_array_equal(view, before)

    def test_a_restart_after_it(self):
        sim = cayspin.Simulation(scene())
        sim.step(7)
        sim.set({"integrator.dt": 0.03})
        sim.step(5)
        path = os.path.join(self.folder, "after.h5")
        sim.save(path)
        again = cayspin.Simulation(sim.scene, restart=path)
        self.assertEqual((again.steps, again.time), (12, sim.time))
        for one in (sim, again):
            one.step(4)
        np.testing.assert_array_equal(again.spins, sim.spins)
        self.assertEqual(again.time, sim.time)

    # In SI, the reduced unit of time depends on the damping and on J.
    def test_a_restart_after_it_with_another_material(self):
        def of(dt, **changed):
            return cayspin.Scene(
                units="SI", system={"kind": "llg"},
                material={"mu_s": {"bohr_magnetons": 2.0}, "J": 1e-21, "alpha": 0.1,
                          "damping_form": "gilbert", **changed},
                lattice={"shape": [12, 3], "spacing": 3e-10}, field={"applied": [0, 0, 1.0]},
                initial={"random": {"seed": 3}},
                integrator={"method": "rkmk4", "dt": dt, "steps": 25})

        sim = cayspin.Simulation(of(1e-15))
        sim.step(7)
        sim.set({"integrator.dt": 3e-15})
        sim.step(5)
        path = os.path.join(self.folder, "after.h5")
        sim.save(path)
        for key, value in (("alpha", 0.4), ("J", 1.7e-21)):
            with self.assertWarnsRegex(UserWarning, f"differ from its scene: material.{key}"):
                again = cayspin.Simulation(of(3e-15, **{key: value}), restart=path)
            self.assertEqual(again.steps, 12)
            self.assertAlmostEqual(again.time / sim.time, 1, delta=1e-14)
            np.testing.assert_array_equal(again.spins, sim.spins)
            other = cayspin.Simulation(of(3e-15, **{key: value}))
            other.spins = sim.spins
            for one in (again, other):
                one.step(4)
            np.testing.assert_allclose(again.spins, other.spins, rtol=0, atol=1e-13)
            self.assertAlmostEqual(again.time / 3.4e-14, 1, delta=1e-14)

    def test_a_function_gives_way_to_numbers(self):
        sim = cayspin.Simulation(scene(field={"applied": lambda t: [0, 0, 5.0]}))
        sim.set("system.damping", 0.2)
        self.assertEqual(sim.field()[0, 0, 0, 2], 5)
        sim.set("field.applied", [0, 0, 0.25])
        self.assertEqual(sim.field()[0, 0, 0, 2], 0.25)

    def test_arrays(self):
        factors = 1 + 0.1 * np.arange(36.0).reshape(1, 3, 12)
        sim = cayspin.Simulation(scene())
        sim.step(3)
        sim.set("system.damping", factors)
        other = cayspin.Simulation(scene(system={"kind": "llg", "damping": factors}))
        other.spins = sim.spins
        sim.step(4)
        other.step(4)
        np.testing.assert_allclose(sim.spins, other.spins, rtol=0, atol=1e-14)

    def assert_replaced(self, table, old, key, new, **tables):
        """Expects that setting `key` of `table`, whose value is `old`, to `new` keeps nothing of
        the old value of the key."""
        first, _, inner = key.partition(".")
        expected = {**old, first: {**old[first], inner: new} if inner else new}
        with self.subTest(key=key, new=new):
            sim = cayspin.Simulation(scene(**tables, **{table: old}))
            sim.set(f"{table}.{key}", new)
            other = cayspin.Simulation(scene(**tables, **{table: expected}))
            np.testing.assert_array_equal(sim.field(), other.field())
            for one in (sim, other):
                one.step(3)
            np.testing.assert_array_equal(sim.spins, other.spins)

    def test_a_dict_replaces_the_table_of_a_dotted_key(self):
        axis = {"axis": [0, 0, 1]}
        lattice = {"shape": [12, 3], "regions": "x < 5 ? 0 : 1"}
        by_region, array = {"regions": [0.1, 0.5]}, np.arange(36.0).reshape(1, 3, 12)
        for old, new in (
                ({"anisotropy": {**axis, "constant": 1.0, "constant2": 0.3}},
                 {**axis, "constant": 2.0}),
                ({"anisotropy": {**axis, "constant": 1.0}},
                 {"cubic": 1.0, "axes": [[1, 0, 0], [0, 1, 0]]}),
                ({"anisotropy": {**axis, "constant": 1.0}}, {**axis, "constant": array}),
                ({"demag": {"strength": 0.5}}, {"periodic_images": [0, 0, 0]}),
                ({"dmi": {"bulk": 1.0}}, {"d2d": 1.0})):
            self.assert_replaced("field", old, *old, new)
        self.assert_replaced("torque", {"slonczewski": {"polarization": [0, 1, 0],
                                                        "damping_like": 0.4}},
                             "slonczewski", {"polarization": [0, 1, 0], "field_like": 0.2})
        for first, then in ((by_region, array), (array, by_region)):
            self.assert_replaced("field", {"anisotropy": {**axis, "constant": first}},
                                 "anisotropy.constant", then, lattice=lattice)

    def test_a_scene_of_a_file_takes_dotted_keys(self):
        old = {"exchange": 1.0, "dmi": {"bulk": 1.0, "free_boundary": True}}
        file = self.written(scene(field=old))
        for name, table in (("dmi", {"d2d": 1.0}), ("applied", lambda t: [0.5, 0, 1]),
                            ("nonlocal", lambda spins, t: 2 * spins)):
            dotted = cayspin.Scene.from_file(file, **{f"field.{name}": table})
            nested = cayspin.Scene.from_file(file, field={name: table})
            self.assertEqual(dotted.text, nested.text)
            field = cayspin.Simulation(dotted).field()
            np.testing.assert_array_equal(field, cayspin.Simulation(nested).field())
            self.assertFalse((field == cayspin.Simulation(scene(field=old)).field()).all())

    def test_an_array_that_was_replaced(self):
        sim = cayspin.Simulation(scene(system={"kind": "llg", "damping": np.full((1, 3, 12), 0.2)}))
        sim.set({"field.anisotropy": {"axis": [0, 0, 1], "constant": np.ones((1, 3, 12))}})
        refusal = "the scene has an array as "
        with self.assertRaisesRegex(cayspin.CayspinError, refusal + "system.damping"):
            cayspin.advise(sim.scene, 1e-3)
        sim.set("system.damping", 0.2)
        with self.assertRaisesRegex(cayspin.CayspinError, refusal + "field.anisotropy.constant"):
            cayspin.advise(sim.scene, 1e-3)
        sim.set("field.anisotropy", {"axis": [0, 0, 1], "constant": 0.5})
        self.assertLess(cayspin.advise(sim.scene, 1e-3).error, 1e-3)

    def test_a_function_that_was_replaced(self):
        sim = cayspin.Simulation(scene(field={"exchange": 1.0, "applied": lambda t: [0, 0, 5.0]}))
        sim.set("system.damping", 0.2)
        with self.assertRaisesRegex(cayspin.CayspinError, "has a function as field.applied, which"):
            cayspin.advise(sim.scene, 1e-3)
        sim.set("field.applied", [0, 0, 0.2])
        self.assertLess(cayspin.advise(sim.scene, 1e-3).error, 1e-3)

    def test_input_files_are_found_after_it(self):
        (self.folder / "states").mkdir()
        with h5py.File(self.folder / "states" / "damping.h5", "w") as file:
            file["values"] = np.full((1, 3, 12), 0.3)
        with h5py.File(self.folder / "states" / "x-is-first.h5", "w") as file:
            file["spins"] = np.broadcast_to([1.0, 0, 0], (1, 3, 12, 3))
        given = self.folder / "states" / "given.toml"
        given.write_text(scene(system={"kind": "llg", "damping": {"file": "damping.h5"}},
                               initial={"file": "x-is-first.h5"}, output={"file": "new.h5"},
                               ).text, encoding="utf-8")
        sim = cayspin.Simulation(cayspin.Scene.from_file(given))
        sim.set("field.applied", [0, 0, 1])
        advice = cayspin.advise(sim.scene, 1e-3, precision="double")
        self.assertLess(advice.error, 1e-3)
        self.assertEqual(cayspin.Simulation(advice.scene).magnetization()[0], 1)
        self.assertLess(cayspin.advise(advice.scene, 1e-2).error, 1e-2)

    def test_in_an_observer(self):
        sim = cayspin.Simulation(scene())
        sim.observe(10, lambda s: s.set("field.applied", [0, 0, 0.1 * s.steps]))
        sim.run()
        self.assertEqual(sim.steps, 25)
        self.assertAlmostEqual(sim.energies()["applied"],
                               -2.0 * sim.spins[..., 2].sum(), delta=1e-9)

    def test_a_new_dt_in_an_observer_keeps_the_end(self):
        for dt, steps in ((0.01, 10 + 80), (0.04, 10 + 20)):
            sim = cayspin.Simulation(scene(output={"every": 8, "scalars_every": 16}))
            sim.observe(10, lambda sim, dt=dt: sim.set("integrator.dt", dt)
                        if sim.steps == 10 else None)
            file = self.folder / f"{dt}.h5"
            sim.run(until=1.0, output=file)
            self.assertEqual(sim.steps, steps)
            self.assertAlmostEqual(sim.time, 1.0, 14)
            with cayspin.open(file) as run:
                self.assertEqual(list(run.step), [*range(0, steps, 8), steps])
                self.assertEqual(list(run.scalars["step"]), [*range(0, steps, 16), steps])
                np.testing.assert_array_equal(run.spins[-1], sim.spins)
                self.assertTrue(run.complete)
        sim = cayspin.Simulation(scene(integrator={"method": "rkmk4", "dt": 0.02, "end": 1.0}))
        sim.observe(10, lambda sim: sim.set("integrator.dt", 0.01) if sim.steps == 10 else None)
        sim.run()
        self.assertEqual(sim.steps, 10 + 80)
        sim = cayspin.Simulation(scene())
        sim.observe(49, lambda sim: sim.set("integrator.dt", 0.04))
        with self.assertRaisesRegex(cayspin.CayspinError, "t = 1 is 0.5 steps of dt = 0.04"):
            sim.run(until=1.0)
        self.assertEqual(sim.steps, 49)

    def test_a_new_dt_is_warned_of(self):
        sim = cayspin.Simulation(scene())
        sim.step()
        sim.set("integrator.dt", 5.0)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            with self.assertRaises(cayspin.NumbersFailed):
                sim.step(200)
        self.assertIn("above the stable", str(caught[0].message))

    def test_refusals(self):
        sim = cayspin.Simulation(scene())
        sim.step(3)
        before = sim.spins.copy()
        for keys, value, words in (
                ("lattice.shape", [5, 3], "lattice: cannot change during a run"),
                ("output.file", "a.h5", "output.file: cannot change during a run"),
                ("field.Exchange", 1, "did you mean"),
                ("integrator.dt", -1, "integrator.dt: "),
                ("integrator.method", "heun", "integrator.dt: is missing"),
                ("system.damping", -np.ones((1, 3, 12)), "^system.damping=an array: system.damping: "),
                ("field", {"dmi": {"Bulk": np.ones((1, 3, 12))}}, "^field.dmi={ Bulk = an array }: "),
                (3, None, "set: a int; accepted"),
                ({"field.applied": lambda t: [0, 0, 1]}, None, "field.applied: a function")):
            with self.assertRaisesRegex(cayspin.CayspinError, words):
                sim.set(keys, value)
        np.testing.assert_array_equal(sim.spins, before)
        with self.assertRaisesRegex(cayspin.SceneError, "a Simulation takes no run in stages"):
            cayspin.Simulation(scene(stage=[{"relax": True}]))


def changes_of(changes):
    return {"field": {"applied": changes["field.applied"]}, "integrator": changes["integrator"]}


if __name__ == "__main__":
    unittest.main()
