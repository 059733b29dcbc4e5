# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Wrong calls of the package: each raises CayspinError with one line, and changes nothing."""

import math
import unittest

import cayspin
import numpy as np
from package_test import TABLES, PackageTest, scene, stepped

SHAPE = (2, 3, 7, 3)
UP = np.broadcast_to([0.0, 0.0, 1.0], SHAPE)
ROW = np.dtype([("flag", "u1"), ("m", "f8", 3)])  # 25 bytes, so vectors are not aligned


def vectors_in_rows(values):
    rows = np.zeros(SHAPE[:3], ROW)
    rows["m"] = values
    return rows["m"]


def unaligned(values):
    array = np.ndarray(SHAPE, float, np.zeros(8 * math.prod(SHAPE) + 1, np.uint8).data, 1)
    array[...] = values
    return array


class Arrays(PackageTest):
    WRONG = {
        "an array of complex128": UP.astype(complex),
        "an array of <U": np.full(SHAPE, "a"),
        "an array of object": np.full(SHAPE, None),
        "an array of datetime64": np.zeros(SHAPE, "M8[s]"),
        "an array of [(": np.zeros(SHAPE, ROW),
        "rows of different lengths": [[1, 2], [3]],
    }
    OTHER_SHAPES = ((7, 3, 2, 3), (2, 3, 7, 2), (2, 3, 7, 4), (0, 3, 7, 3), (1, *SHAPE), (126, 3),
                    (2, 7, 3, 3), (3, 2, 3, 7))

    def test_types_and_shapes(self):
        sim = cayspin.Simulation(scene())
        before = sim.spins.copy()
        for part, wrong in self.WRONG.items():
            self.assert_refused(cayspin.CayspinError, part, setattr, sim, "spins", wrong)
            self.assert_refused(cayspin.SceneError, part, scene, initial=wrong)
        for call in (lambda: scene(system={"damping": UP[..., 0] * 1j}),
                     lambda: sim.set("system.damping", UP[..., 0] * 1j)):
            self.assert_refused(cayspin.SceneError, "system.damping: an array of complex128; "
                                "accepted: one of real numbers", call)
        for shape in self.OTHER_SHAPES:
            part = f"an array of shape {shape}; accepted: "
            self.assert_refused(cayspin.CayspinError, part, setattr, sim, "spins", np.ones(shape))
            self.assert_refused(cayspin.SceneError, part, scene, initial=np.ones(shape))
        np.testing.assert_array_equal(sim.spins, before)

    def test_every_layout_of_real_numbers_is_taken(self):
        whole = np.random.default_rng(2).integers(1, 9, SHAPE)
        expected = cayspin.Simulation(scene(initial=whole.astype(float))).spins
        for array in (whole, whole.tolist(), whole.astype(">f8"), whole.astype(">f4"),
                      whole.astype(np.float16), whole.astype(np.longdouble), whole.astype("u1"),
                      vectors_in_rows(whole), unaligned(whole), whole.astype(float)[::-1][::-1]):
            sim = cayspin.Simulation(scene())
            sim.spins = array
            np.testing.assert_array_equal(sim.spins, expected)
            np.testing.assert_array_equal(cayspin.Simulation(scene(initial=array)).spins, expected)


class Functions(PackageTest):
    def refused(self, part, **field):
        endless = {"steps": None}
        self.assert_refused(cayspin.CayspinError, part, lambda: cayspin.Simulation(
            scene(field={"slab_demag": None, **field}, integrator=endless)).step())

    def test_uniform_fields(self):
        for wrong in ("abc", [[1], [2], [3]], [None] * 3, [1j, 0, 0]):
            self.refused("field.applied: the function returned no numbers",
                         applied=lambda t, wrong=wrong: wrong)
        for wrong in ((), (1, 2), (1, 2, 3, 4), np.zeros(4)):
            self.refused("another number of components", applied=lambda t, wrong=wrong: wrong)
        self.refused("for a field per site use an array or field.sources",
                     applied=lambda t: np.zeros(SHAPE))

    def test_nonlocal_fields(self):
        for part, function in {
                "no array": lambda m, t: m[0],
                "no array;": lambda m, t: None,
                "no array; ": lambda m, t: m.tolist(),
                "an array of another type": lambda m, t: m.astype(int),
                "an array of another type;": lambda m, t: m.astype(complex),
                "an array whose last extent is not 3": lambda m, t: m[..., :2],
                "an array of another shape": lambda m, t: m[:, :, ::2]}.items():
            self.refused(f"field.nonlocal: the function returned {part}", **{"nonlocal": function})
        self.refused("not finite", **{"nonlocal": lambda m, t: m * math.inf})

    def test_nonlocal_fields_of_any_layout(self):
        def steps_with(layout):
            return stepped(scene(field={"slab_demag": None, "nonlocal": lambda m, t: layout(
                m[::-1, :, ::-1] * [1, 2, 3])}), 5)

        expected = steps_with(np.ascontiguousarray)
        np.testing.assert_array_equal(steps_with(np.asfortranarray), expected)
        np.testing.assert_array_equal(
            steps_with(lambda h: np.ascontiguousarray(h[::-1, ::-1])[::-1, ::-1]), expected)


class Calls(PackageTest):
    def test_numbers_and_words(self):
        sim = cayspin.Simulation(scene())
        of = scene()
        calls = {
            "step: 1.5; accepted: a whole number": lambda: sim.step(1.5),
            "step: '1'": lambda: sim.step("1"),
            "step: None": lambda: sim.step(None),
            "step: 1000000000000000000000": lambda: sim.step(10**21),
            "-1 steps": lambda: sim.step(-1),
            "steps after step 0; accepted: up to step 9007199254740992":
                lambda: sim.step(2**63 - 1),
            "run: until: '1'": lambda: sim.run(until="1"),
            "t = nan": lambda: sim.run(until=math.nan),
            "t = inf; accepted: a finite time": lambda: sim.run(until=math.inf),
            "whole number of steps": lambda: sim.run(until=-1.0),
            "observe: every: 1.5": lambda: sim.observe(1.5, print),
            "observe: every -3": lambda: sim.observe(-3, print),
            "observe: a NoneType": lambda: sim.observe(1, None),
            "precision: '\\ud800'": lambda: cayspin.Simulation(of, "\ud800"),
            "precision: None": lambda: cayspin.Simulation(of, None),
            "precision \"half\"; accepted: \"double\", \"single\"": lambda: cayspin.Simulation(of, "half"),
            "space: 1": lambda: cayspin.Simulation(of, space=1),
            "space abacus: not compiled in; accepted: ": lambda: cayspin.Simulation(of, space="abacus"),
            "threads: 1.5": lambda: cayspin.Simulation(of, threads=1.5),
            "threads: 4294967296": lambda: cayspin.Simulation(of, threads=2**32),
            "0 threads; accepted": lambda: cayspin.Simulation(of, threads=0),
            "-1 threads": lambda: cayspin.Simulation(of, threads=-1),
            "Simulation: a dict": lambda: cayspin.Simulation(TABLES),
            "trade: a NoneType": lambda: cayspin.trade(None),
            "advise: a dict": lambda: cayspin.advise(TABLES, 0.1),
            "set: 'field.applied='; accepted: the name of a key":
                lambda: sim.set("field.applied=", [0, 0, 1]),
            "set: ''; accepted: the name of a key": lambda: sim.set("", 1),
            "set: 3; accepted: a string": lambda: sim.set({3: 4}),
            "error: 'x'": lambda: cayspin.advise(of, "x"),
        }
        self.assert_all_refused(cayspin.CayspinError, calls)
        self.assertEqual(sim.steps, 0)

    def test_warnings_name_no_line_of_text(self):
        large = {"dt": 5.0}
        changed = cayspin.Simulation(scene())
        changed.set("integrator.dt", 5.0)
        for sim, start in ((cayspin.Simulation(scene(integrator=large)), ""), (changed, "integrator.dt=5.0: "),
                           (cayspin.EnsembleSimulation(scene(integrator=large,
                                                             ensemble={"replicas": 2})), "replica 0: ")):
            with self.assertWarnsRegex(UserWarning, f"^{start}integrator.dt: 5 is above"):
                try:
                    sim.step()
                except cayspin.NumbersFailed:
                    pass

    def test_tables(self):
        for part, tables in {
                "lattice.shape: is of type set": {"lattice": {"shape": {1, 2}}},
                "1: is no key": {"lattice": {1: 2}},
                "no Unicode text": {"integrator": {"method": "\ud800"}},
                "a key: ": {"lattice": {"\ud800": 2}},
                "is not known": {"integrator": {"method": "a\0b"}},
                "not finite": {"system": {"damping": math.nan}},
                "64 bits": {"lattice": {"shape": [10**30]}},
                "accepted: a table": {"lattice": "x"}}.items():
            self.assert_refused(cayspin.SceneError, part, scene, **tables)
        self.assert_refused(cayspin.CayspinError, "integrator: ",
                            cayspin.Scene, **{**TABLES, "integrator": "rkmk4"})

    def test_file_names(self):
        sim = cayspin.Simulation(scene())
        (self.folder / "text.h5").write_text("no run", encoding="utf-8")
        calls = {
            "run: output": lambda name: sim.run(output=name),
            "save": sim.save,
            "restart": lambda name: cayspin.Simulation(scene(), restart=name),
            "from_file": cayspin.Scene.from_file,
            "open": cayspin.open,
        }
        for name, call in calls.items():
            with self.subTest(name):
                self.assert_refused(cayspin.CayspinError, f"{name}: 3.5", call, 3.5)
                self.assert_refused(cayspin.CayspinError, f"{name}: True", call, True)
                self.assert_refused(cayspin.CayspinError, f"{name}: '\\ud800'", call, "\ud800")
                self.assert_refused(cayspin.CayspinError, "null character", call, "a\0b.h5")
                for wrong in ("", self.folder, self.folder / "no" / "run.h5",
                              self.folder / "text.h5"):
                    if (name, wrong) != ("save", self.folder / "text.h5"):  # save may replace it
                        self.assert_refused(cayspin.CayspinError, str(wrong), call, wrong)
        self.assertEqual((self.folder / "text.h5").read_text(encoding="utf-8"), "no run")
        self.assertEqual(sim.steps, 0)

    def test_after_an_error_all_goes_on(self):
        sim = cayspin.Simulation(scene())
        sim.step(3)
        sim.observe(2, lambda sim: None)
        self.assert_all_refused(cayspin.CayspinError, {
            "-1 steps": lambda: sim.step(-1),
            "is (0, 0, 0)": lambda: setattr(sim, "spins", np.zeros(SHAPE)),
            "not a regular file": lambda: sim.run(output=self.folder),
            "a whole number of steps": lambda: sim.run(until=0.01)})
        sim.step(4)
        np.testing.assert_array_equal(sim.spins, stepped(scene(), 7))


if __name__ == "__main__":
    unittest.main()
