# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""cayspin.sweep gives the numbers of separate runs and of `cayspin sweep`, here and on clients."""

import multiprocessing
import os
import pathlib
import pickle
import subprocess
import unittest
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import cayspin
import h5py
import numpy as np
from package_test import PROGRAM, PackageTest, scene

OVER = {"system.damping": [0.1, 0.25, 1 / 3],
        "field.applied": [[0.3, 0.2, -0.1], np.array([0, 0, 1.5])]}
NUMBERS = ("step", "time", "energy", "norm_defect", "magnetization", "evaluations")


def separate_runs():
    """Returns the results of OVER as separate simulations have them."""
    rows = []
    for damping in OVER["system.damping"]:
        for applied in OVER["field.applied"]:
            sim = cayspin.Simulation(scene(system={"damping": damping},
                                           field={"applied": list(applied)}))
            sim.run(output=False)
            rows.append((sim.steps, sim.time, sim.energy(), sim.norm_defect(),
                         sim.magnetization(), sim.evaluations))
    return dict(zip(NUMBERS, map(np.array, zip(*rows))))


class Future:
    def __init__(self, call):
        self.call, self.cancelled = call, False

    def result(self):
        return self.call()

    def cancel(self):
        self.cancelled = True


class Remote:
    """A client that has only submit(), with futures that work when they are asked, and sends calls
    and results as bytes, as clients of other machines do. One call may end in an exception."""

    def __init__(self, failing=None, error=None):
        self.failing, self.error, self.futures = failing, error, []

    def submit(self, function, *arguments):
        sent, number = pickle.dumps((function, arguments)), len(self.futures)

        def call():
            if number == self.failing:
                raise self.error
            received, given = pickle.loads(sent)
            return pickle.loads(pickle.dumps(received(*given)))

        self.futures.append(Future(call))
        return self.futures[-1]


class Sweeping(PackageTest):
    def assert_same_bits(self, table, expected):
        for name in NUMBERS:
            np.testing.assert_array_equal(table[name], expected[name], name)
        self.assertEqual(table["status"].tolist(), [0] * len(table))

    def test_here(self):
        table = cayspin.sweep(scene(), over=OVER)
        self.assert_same_bits(table, separate_runs())
        self.assertEqual(table["system.damping"].tolist(), [0.1, 0.1, 0.25, 0.25, 1 / 3, 1 / 3])
        self.assertEqual(table["field.applied"][0], [0.3, 0.2, -0.1])
        np.testing.assert_array_equal(table["field.applied"][5], [0, 0, 1.5])
        self.assertEqual(table["magnetization"].shape, (6, 3))
        self.assertEqual(set(table["message"]), {""})
        self.assertTrue((table["step_seconds"] > 0).all())

    def test_on_clients(self):
        expected = separate_runs()
        with ThreadPoolExecutor(2) as client:
            self.assert_same_bits(cayspin.sweep(scene(), OVER, client), expected)
        spawned = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(2, mp_context=spawned) as client:
            self.assert_same_bits(cayspin.sweep(scene(), OVER, client, threads=1), expected)
        remote = Remote()
        self.assert_same_bits(cayspin.sweep(scene(), OVER, client=remote), expected)
        self.assertEqual(len(remote.futures), 6)

    def test_the_table_of_the_program(self):
        for precision in ("double", "single"):
            file = self.folder / f"{precision}.h5"
            subprocess.run([PROGRAM, "sweep", self.written(scene()), "--output", file, "--quiet",
                            "--over", f"system.damping=0.1,0.25,{1 / 3!r}", "--over",
                            "field.applied=[0.3,0.2,-0.1],[0,0,1.5]", "--precision", precision],
                           check=True)
            table = cayspin.sweep(scene(), OVER, precision=precision)
            with h5py.File(file) as data:
                for name in (*NUMBERS, "status"):
                    np.testing.assert_array_equal(table[name], data[name], name)
                np.testing.assert_array_equal(table["system.damping"],
                                              data["parameters/system.damping"])

    def test_input_files_are_found_from_other_folders(self):
        start = scene(initial={"random": {"seed": 5}}, output={"file": "none.h5"})
        cayspin.Simulation(start).run(output=self.folder / "start.h5")
        text = self.written(scene())
        table = {"initial": {"file": "start.h5"}}
        self.addCleanup(os.chdir, pathlib.Path.cwd())
        os.chdir(self.folder)
        found = cayspin.sweep(cayspin.Scene.from_file(text.name, **table),
                              {"system.damping": [0.1]}, Remote())
        expected = cayspin.Simulation(cayspin.Scene.from_file(text, **table))
        expected.run()
        self.assertEqual(found["energy"][0], expected.energy())
        self.assertFalse((self.folder / "none.h5").exists())

    def test_failed_runs_are_recorded(self):
        over = {"integrator.method": ["rkmk4", "classical_euler"],
                "field.applied": [[0, 0, 1], [0, 0, 1e30]]}
        for client in (None, Remote()):
            table = cayspin.sweep(scene(), over, client)
            self.assertEqual(table["integrator.method"].tolist(),
                             ["rkmk4"] * 2 + ["classical_euler"] * 2)
            self.assertEqual((table["status"][0], table["step"][0]), (0, 40))
            self.assertEqual((table["status"][3], table["step"][3]), (3, 0))
            self.assertTrue(np.isnan(table["energy"][3]))
            self.assertTrue(np.isnan(table["magnetization"][3]).all())
            self.assertRegex(table["message"][3], "^[^/]*not finite|non-finite")
        warned = cayspin.sweep(scene(integrator={"energy_guard": False}),
                               {"integrator.dt": [0.01, 50.0]})
        self.assertEqual(warned["message"][0], "")
        self.assertEqual(warned["status"].tolist(), [0, 0])
        self.assertRegex(warned["message"][1], "^[^/]*dt")

    def test_scenes_that_fail_only_at_their_run_are_recorded(self):
        over = {"integrator.refuse_unstable": [False, True], "integrator.dt": [0.05, 50.0]}
        table = cayspin.sweep(scene(), over)
        self.assertEqual(table["status"][[0, 2, 3]].tolist(), [0, 0, 2])
        self.assertIn("dt", table["message"][3])
        self.assertEqual(table["integrator.refuse_unstable"].tolist(), [False, False, True, True])

    def test_exceptions_of_a_client_end_the_sweep(self):
        for error in (OSError("lost"), KeyboardInterrupt()):
            client = Remote(2, error)
            with self.assertRaises(type(error)):
                cayspin.sweep(scene(), OVER, client)
            self.assertEqual(len(client.futures), 6)
            self.assertTrue(all(future.cancelled for future in client.futures))
        closed = ThreadPoolExecutor(1)
        closed.shutdown()
        with self.assertRaises(RuntimeError):
            cayspin.sweep(scene(), OVER, closed)

    def test_refusals(self):
        error, call, damping = cayspin.CayspinError, cayspin.sweep, {"system.damping": [0.1]}
        self.assert_all_refused(error, {
            "sweep: a dict; accepted: a Scene": lambda: call({}, damping),
            "over {}; accepted: a dict of keys": lambda: call(scene(), {}),
            "over 'a=b'; accepted: the name of a key": lambda: call(scene(), {"a=b": [1]}),
            "over system.damping: 0.1; accepted: a list":
                lambda: call(scene(), {"system.damping": 0.1}),
            "an empty list; accepted": lambda: call(scene(), {"system.damping": []}),
            "over has both system and system.damping; accepted":
                lambda: call(scene(), {"system": [{"kind": "llg", "damping": 1}], **damping}),
            "1000000 runs; accepted: at most 100000":
                lambda: call(scene(), {f"field.{name}": range(100) for name in "abc"}),
            "client 3; accepted: an object with submit()": lambda: call(scene(), damping, 3),
            "the scene has a function as field.applied, which cannot be passed":
                lambda: call(scene(field={"applied": lambda t: [0, 0, t]}), damping),
            "the scene has no end; accepted":
                lambda: call(scene(integrator={"steps": None}), damping),
            "precision": lambda: call(scene(), damping, precision="half"),
        })
        self.assert_all_refused(cayspin.SceneError, {
            "sweep: with system.damping=-1: system.damping: -1 is negative; accepted":
                lambda: call(scene(), {"system.damping": [1, -1]}),
            "system.damp: unknown key": lambda: call(scene(), {"system.damp": [1]}),
            "is of type object; accepted": lambda: call(scene(), {"system.damping": [object()]}),
            "takes no ensemble; accepted":
                lambda: call(scene(field={"slab_demag": None}, ensemble={"replicas": 2}), damping),
        })


if __name__ == "__main__":
    unittest.main()
