# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Truth values, numbers, words and sequences as arguments: those of NumPy mean the same as those of
Python, and unsuitable ones are refused with one line."""

import decimal
import fractions
import math
import pathlib
import unittest

import cayspin
import numpy as np
from cayspin import arguments
from package_test import PackageTest, random_spins, scene, stepped

TRUE = (True, np.True_, np.bool_(1), np.array(True), 1, np.int64(1), np.array(1))
FALSE = (False, np.False_, np.array(False), 0, np.uint8(0))
NO_TRUTHS = ("no", "", b"1", None, 1.0, 2, -1, np.float64(1), [], [True], np.array([True]),
             np.array([]), np.str_("x"))
TWO = (2, np.int8(2), np.uint64(2), np.array(2), np.array(2, "u1"))
NO_WHOLE_NUMBERS = ("2", b"2", None, 2.0, np.float32(2), np.array(2.0), [2], np.array([2]), 2j,
                    np.array("2"), np.str_("2"), math.nan, fractions.Fraction(2))
HALF = (0.5, np.float64(0.5), np.float32(0.5), np.float16(0.5), np.longdouble(0.5), np.array(0.5),
        np.array(0.5, "f4"), fractions.Fraction(1, 2), decimal.Decimal("0.5"))
NO_NUMBERS = ("0.5", b"0.5", bytearray(b"1"), memoryview(b"1"), None, [0.5], np.array([0.5]), 1j,
              np.complex64(1), np.complex128(1), np.array(1j), np.array("0.5"), np.str_("1"),
              np.datetime64(1, "s"), {}, print)
NO_SEQUENCES = ("open", "periodic", b"xy", bytearray(b"xy"), None, 3, np.array(1),
                {"open": 1, "periodic": 2}, {1, 2}, np.str_("open"))


class Arguments(PackageTest):
    def refused(self, call, wrong):
        for thing in wrong:
            self.assert_refused(cayspin.CayspinError, "name: ", call, thing, "name")

    def test_truths(self):
        for truth in TRUE:
            self.assertIs(arguments.flag(truth, "name"), True)
        for truth in FALSE:
            self.assertIs(arguments.flag(truth, "name"), False)
        self.refused(arguments.flag, NO_TRUTHS)
        for truth in (False, np.False_, np.array(False)):
            self.assertTrue(arguments.is_false(truth))
        for other in (0, 0.0, "", None, [], np.array([]), np.array([False]), True):
            self.assertFalse(arguments.is_false(other))

    def test_numbers(self):
        for number in TWO:
            value = arguments.whole(number, "name")
            self.assertEqual((type(value), value), (int, 2))
        self.refused(arguments.whole, NO_WHOLE_NUMBERS)
        for number in (*HALF, *TWO):
            value = arguments.real(number, "name")
            self.assertEqual((type(value), value), (float, 2.0 if number == 2 else 0.5))
        self.refused(arguments.real, NO_NUMBERS)

    def test_words_and_names(self):
        for text in ("abc", np.str_("abc"), np.array("abc")):
            for read in (arguments.word, arguments.file_name):
                value = read(text, "name")
                self.assertEqual((type(value), value), (str, "abc"))
        self.assertEqual(arguments.file_name(pathlib.Path("abc"), "name"), "abc")
        self.assertEqual(arguments.file_name(b"abc", "name"), "abc")
        self.refused(arguments.word, (b"abc", None, 1, ["abc"], np.array(["abc"]), "\ud800"))
        self.refused(arguments.file_name, (None, 1, True, np.True_, ["abc"], np.array(["abc"])))

    def test_sequences(self):
        def entries(things, name):
            return arguments.entries(things, name, "two")

        for things in (("a", "b"), ["a", "b"], np.array(["a", "b"]), iter("ab")):
            self.assertEqual(entries(things, "name"), ["a", "b"])
        self.refused(entries, NO_SEQUENCES)


class Observers(PackageTest):
    def steps_with(self, answer):
        sim = cayspin.Simulation(scene())
        sim.observe(3, lambda sim: answer)
        sim.step(10)
        return sim.steps

    def test_true_ends_a_run_and_nothing_else_does(self):
        for answer in (True, np.True_, np.bool_(True), np.array(True), np.float64(2) > 1,
                       np.ones(3).all()):
            self.assertEqual(self.steps_with(answer), 3, repr(answer))
        for answer in (False, None, np.False_, np.array(False), 1, 1.0, np.int64(1), "True",
                       np.ones(3), [True], np.float64(1), np.array(1)):
            self.assertEqual(self.steps_with(answer), 10, repr(answer))

    def test_several_truths_are_refused(self):
        for answer in (np.array([True]), np.ones(3) > 0, np.zeros((2, 2), bool)):
            self.assert_refused(cayspin.CayspinError, "; accepted: one boolean", self.steps_with,
                                answer)

    def test_in_a_run_with_a_file(self):
        sim = cayspin.Simulation(scene())
        sim.observe(7, lambda sim: sim.magnetization()[0] < np.float64(2))
        sim.run(output=self.folder / "run.h5")
        self.assertEqual(sim.steps, 7)
        with cayspin.open(self.folder / "run.h5") as file:
            self.assertEqual(file.step[-1], 7)


class Calls(PackageTest):
    """Passes values of each kind to the arguments of functions."""

    def accepted(self, call, things):
        for thing in things:
            with self.subTest(repr(thing)):
                call(thing)

    def refused(self, part, call, things):
        for thing in things:
            self.assert_refused(cayspin.CayspinError, part, call, thing)

    def test_simulation(self):
        of = scene()
        sim = cayspin.Simulation(of)
        file = self.folder / "run.h5"
        self.accepted(lambda n: sim.step(n), TWO)
        self.refused("step: ", sim.step, NO_WHOLE_NUMBERS)
        self.accepted(lambda t: cayspin.Simulation(of).run(until=t), HALF)
        self.refused("run: until: ", lambda t: sim.run(until=t),
                     [thing for thing in NO_NUMBERS if thing is not None])
        self.accepted(lambda word: cayspin.Simulation(of, word), ("double", np.str_("single"),
                                                                  np.array("double")))
        for truth in TRUE:
            cayspin.Simulation(of).run(until=0.05, output=file, overwrite=truth)
        for truth in FALSE:
            self.assert_refused(cayspin.CayspinError, "or overwrite with overwrite=True",
                                cayspin.Simulation(of).run, until=0.05, output=file,
                                overwrite=truth)
        self.refused("run: overwrite: ", lambda truth: sim.run(overwrite=truth), NO_TRUTHS)
        for no_file in (False, np.False_, np.array(False)):
            cayspin.Simulation(of).run(until=0.05, output=no_file)
        self.refused("run: output: ", lambda name: cayspin.Simulation(of).run(output=name),
                     (True, np.True_, 0, 1, ["a.h5"]))

    def test_relax(self):
        sim = cayspin.Simulation(scene(initial={"uniform": [0, 0.1, 1]}))
        self.accepted(lambda torque: sim.relax(torque, 3), HALF)
        self.refused("relax: torque: ", sim.relax, NO_NUMBERS)
        self.refused("relax: evaluations: ", lambda n: sim.relax(evaluations=n), NO_WHOLE_NUMBERS)
        self.accepted(lambda truth: sim.relax(1.0, 3, keep_saddles=truth), TRUE + FALSE)
        self.refused("relax: keep_saddles: ", lambda truth: sim.relax(keep_saddles=truth),
                     NO_TRUTHS)
        for applied in ((0, 0, 1), [0.0, 0, 1], np.array([0, 0, 1]), np.array([0, 0, 1], "f4"),
                        (np.float32(0), np.int8(0), np.array(1.0))):
            sim.relax(1.0, 3, applied)
        self.refused("relax: applied", lambda h: sim.relax(applied=h),
                     ("xyz", "001", ["0", "0", "1"], 1.0, (0, 1), [1j, 0, 0], {}, np.eye(3)))

    def test_observe_and_averages(self):
        sim = cayspin.Simulation(scene())
        self.accepted(lambda n: sim.observe(n, print), TWO)
        self.refused("observe: every: ", lambda n: sim.observe(n, print), NO_WHOLE_NUMBERS)
        self.accepted(lambda n: cayspin.Simulation(scene()).averages(n, n), TWO)
        self.refused("averages: window: ", lambda n: sim.averages(1, n),
                     [thing for thing in NO_WHOLE_NUMBERS if thing is not None])
        self.accepted(lambda n: cayspin.average(np.arange(9.0), n), TWO)
        self.refused("average: skip: ", lambda n: cayspin.average([1, 2, 3], n), NO_WHOLE_NUMBERS)
        self.refused("average: an array of ", cayspin.average, ("123", ["1", "2"], [1j, 2]))

    def test_topological_charge(self):
        m = random_spins((5, 6), 1)
        expected = cayspin.topological_charge(m, ("open", "periodic"))
        for boundary in (["open", "periodic"], np.array(["open", "periodic"]),
                         (np.str_("open"), np.array("periodic"))):
            self.assertEqual(cayspin.topological_charge(m, boundary), expected)
        run = self.run_program(scene(output={"every": 20}))
        with cayspin.open(run.filename) as file:
            expected = file.topological_charge(["open", "periodic"])
            found = file.topological_charge(iter(["open", "periodic"]))
            np.testing.assert_array_equal(found, expected)
            self.assertEqual(len(found), 3)
        self.refused("topological_charge: boundary", lambda b: cayspin.topological_charge(m, b),
                     (*NO_SEQUENCES, ["open", 1], [["open"], ["open"]], (True, False)))

    def test_dispersion(self):
        m, path = random_spins((8, 1, 1, 6), 1), [(0, 0, 0), (0.5, 0, 0)]

        def call(**options):
            return cayspin.dispersion(m, **{"dt": 0.1, "path": path, "about": (0, 0, 1), **options})

        expected = call().intensity
        for dt in (np.float64(0.1), np.array(0.1), fractions.Fraction(1, 10)):
            np.testing.assert_array_equal(call(dt=dt).intensity, expected)
        self.refused("dispersion: dt: ", lambda dt: call(dt=dt), NO_NUMBERS)
        for periodic in ([True] * 3, np.ones(3, bool), np.ones(3, int),
                         (np.True_, 1, np.array(True))):
            np.testing.assert_array_equal(call(periodic=periodic).intensity, expected)
        self.refused("dispersion: periodic", lambda p: call(periodic=p),
                     (*NO_SEQUENCES, "xyz", True, ["open"] * 3, ("", "", ""), [None] * 3))
        self.assertEqual(call(labels=["G", "X"]).labels, ["G", "X"])
        self.assertEqual(call(labels=np.array(["G", "X"])).labels, ["G", "X"])
        self.assertEqual(call(labels="GX").labels, ["G", "X"])
        self.refused("dispersion: labels: ", lambda words: call(labels=words),
                     [thing for thing in NO_SEQUENCES if thing is not None
                      and not isinstance(thing, str)])
        self.refused("dispersion: component", lambda word: call(component=word),
                     ("xy", "w", 1, ["x"], np.array(["x", "y"]), None, np.eye(2)))
        self.refused(" path", lambda p: call(path=p), ("GX", None, 1.0, [("a", 0, 0)] * 2))

    def test_trade_and_advise(self):
        of = scene()
        self.refused("error: ", lambda number: cayspin.advise(of, number), NO_NUMBERS)
        self.refused("seconds: ", lambda number: cayspin.trade(of, number), NO_NUMBERS)
        self.refused("threads: ", lambda number: cayspin.trade(of, threads=number),
                     [thing for thing in NO_WHOLE_NUMBERS if thing is not None])
        self.refused("precision: ", lambda word: cayspin.trade(of, precision=word), (1, ["double"]))
        self.refused("space: ", lambda word: cayspin.advise(of, 0.1, space=word), (1, True))

    def test_plot(self):
        sim = cayspin.Simulation(scene())
        sim.run(output=self.folder / "run.h5")
        for of in (sim, cayspin.open(self.folder / "run.h5")):
            self.refused("limit ", lambda limit: of.plot(quantity="spins", limit=limit),
                         ("3", b"3", [1, 2], -1, math.nan))
            self.refused("quantity ", lambda word: of.plot(quantity=word),
                         (1, None, ["spins"], np.array(["spins", "charge"])))
            self.refused("colors ", lambda word: of.plot(colors=word), (1, np.array(["hue", "x"])))
            self.refused("plane ", lambda plane: of.plot(plane=plane), (0, "0", ["z=0"]))
        self.refused("a difference from an array of ", lambda m: sim.plot(before=m),
                     ("m", np.full(sim.spins.shape, "a")))
        with cayspin.open(self.folder / "run.h5") as file:
            self.refused("plot: frame: ", file.plot, NO_WHOLE_NUMBERS)
            for frames in ("0:3", 3, slice("0", "3"), slice(0.0, 3.0), slice(0, 3, 0)):
                self.assert_refused(cayspin.CayspinError, "dispersion: frames ", file.dispersion,
                                    [(0, 0, 0), (0.5, 0, 0)], frames)


class Tables(PackageTest):
    def test_values_of_any_kind(self):
        expected = stepped(scene(), 5)
        for dt in (np.float64(0.05), np.array(0.05), np.longdouble("0.05").astype("f8"),
                   np.longdouble(0.05)):
            np.testing.assert_array_equal(stepped(scene(integrator={"dt": dt}), 5), expected)
        for steps in (40, np.int8(40), np.array(40), np.uint64(40)):
            self.assertEqual(scene(integrator={"steps": steps}).steps, 40)
        for shape in ([7, 3, 2], (7, 3, 2), np.array([7, 3, 2]), (np.int64(7), np.array(3), 2)):
            self.assertEqual(scene(lattice={"shape": shape}).shape, (2, 3, 7))
        for truth in (np.True_, np.array(True)):
            self.assertIn("compensated = true", scene(integrator={"compensated": truth}).text)
        for word in (np.str_("rkmk4"), np.array("rkmk4")):
            self.assertEqual(scene(integrator={"method": word}).method, "rkmk4")
        whole = scene(field={"applied": [1, 0, 2], "exchange": 1})
        real = scene(field={"applied": [1.0, 0.0, 2.0], "exchange": 1.0})
        np.testing.assert_array_equal(stepped(whole, 5), stepped(real, 5))

    def test_wrong_kinds_are_named(self):
        for part, tables in {
                "anisotropy.axis": {"field": {"anisotropy": {"constant": 1.0, "axis": "xyz"}}},
                "lattice.shape": {"lattice": {"shape": "732"}},
                "field.applied": {"field": {"applied": "001"}},
                "integrator.dt": {"integrator": {"dt": "0.05"}},
                "integrator.dt:": {"integrator": {"dt": b"1"}},
                "integrator.steps": {"integrator": {"steps": 40.0}},
                "integrator.compensated": {"integrator": {"compensated": 1}},
                "lattice.boundary": {"lattice": {"boundary": np.array([1, 2, 3])}},
                "system.damping": {"system": {"damping": 1j}},
                "initial": {"initial": {"givn": True}}}.items():
            self.assert_refused(cayspin.SceneError, part, scene, **tables)

    def test_no_message_lists_a_key_that_nobody_types(self):
        for initial in ({"nokey": 1}, {"uniform": [0, 0, 1], "nokey": 1}):
            with self.assertRaises(cayspin.SceneError) as caught:
                scene(initial=initial)
            self.assertIn("accepted: uniform, expression, random, file", str(caught.exception))
            self.assertNotIn("given", str(caught.exception))

    def test_arrays_where_none_is_taken(self):
        array = np.ones((2, 3, 7))
        for key, tables in {"output.every": {"output": {"every": array}},
                            "initial": {"initial": {"random": array}},
                            "field.slab_demag": {"field": {"slab_demag": array}}}.items():
            self.assert_refused(cayspin.SceneError, key, scene, **tables)
            with self.assertRaises(cayspin.SceneError) as caught:
                scene(**tables)
            self.assertNotIn("given", str(caught.exception))


class Functions(PackageTest):
    def stepped(self, result):
        return stepped(scene(field={"slab_demag": None, "applied": lambda t: result},
                             integrator={"steps": None}), 3)

    def test_uniform_fields_of_any_kind(self):
        expected = self.stepped([0.5, 0.0, 1.0])
        for result in ((0.5, 0, 1), np.array([0.5, 0, 1]), np.array([0.5, 0, 1], "f4"),
                       [np.float32(0.5), np.array(0), np.True_],
                       (fractions.Fraction(1, 2), 0, True),
                       [decimal.Decimal("0.5"), np.uint8(0), np.longdouble(1)]):
            np.testing.assert_array_equal(self.stepped(result), expected)

    def test_other_results_are_refused(self):
        for wrong in (None, 1.0, np.float64(1), np.array(1.0), {0: 1, 1: 2, 2: 3}, {1, 2, 3},
                      iter([1, 2, 3]), "001", b"001", np.eye(3), np.ones((3, 1)), [1j, 0, 0],
                      np.array([1j, 0, 0], "c8"), np.array(["1", "2", "3"]), [[1], [2], [3]]):
            self.assert_refused(cayspin.CayspinError, "field.applied: the function returned ",
                                self.stepped, wrong)


if __name__ == "__main__":
    unittest.main()
