# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Two threads open scenes, run them, write files and read them, all at the same time, and observers
open scenes. CAYSPIN_ROUNDS is the number of rounds. A hang ends the test with a failure."""

import faulthandler
import os
import threading
import time
import unittest

import cayspin
import numpy as np
from package_test import PackageTest, scene

ROUNDS = int(os.environ.get("CAYSPIN_ROUNDS", 60))
LONGEST = 120  # seconds for a round, even on a busy machine


class Course:
    """The scene and the file of one thread, and the results."""

    def __init__(self, folder, name, initial, precision, **tables):
        self.file, self.precision, self.spins, self.energy = folder / name, precision, None, None
        self.tables = {"initial": initial, "output": {"every": 1}, **tables}

    def round(self):
        """Returns the last spins of the run, of its file, of its restart and of an observed run,
        and the energies of the scenes that the observer opened."""
        seen = []

        def look(sim):
            started = cayspin.Simulation(scene(initial={"file": str(self.file)}), self.precision)
            seen.append(started.energy())

        sim = cayspin.Simulation(scene(**self.tables), self.precision)
        sim.run(until=1.0, output=self.file, overwrite=True)
        sim.save(self.file.with_suffix(".saved.h5"))
        with cayspin.open(self.file) as file:
            read = file.spins[-1]
        watched = cayspin.Simulation(scene(**self.tables), self.precision)
        watched.observe(10, look)
        watched.run(until=1.0)
        again = cayspin.Simulation(scene(**self.tables), self.precision,
                                   restart=self.file.with_suffix(".saved.h5"))
        return np.array(sim.spins), read, np.array(again.spins), np.array(watched.spins), seen


class Threads(PackageTest):
    def setUp(self):
        super().setUp()
        first = Course(self.folder, "a.h5", {"random": {"seed": 3}}, "double",
                       integrator={"method": "ab2"},
                       output={"every": 1, "checkpoint_every": "5 steps"})
        first.expected = first.round()
        start = self.folder / "start.h5"
        start.write_bytes(first.file.read_bytes())
        second = Course(self.folder, "b.h5", {"file": str(start)}, "single",
                        field={"applied": lambda t: [0.3, 0.2 * t, -0.1]})
        second.expected = second.round()
        self.courses = first, second

    def tearDown(self):
        faulthandler.cancel_dump_traceback_later()

    def test_two_threads_at_the_same_time(self):
        errors, begin = [], threading.Barrier(2)

        def work(course):
            try:
                for number in range(ROUNDS):
                    begin.wait()
                    faulthandler.dump_traceback_later(LONGEST, exit=True)
                    for found, expected in zip(course.round(), course.expected):
                        np.testing.assert_array_equal(found, expected, f"round {number}")
            except BaseException as error:
                errors.append(error)
                begin.abort()

        threads = [threading.Thread(target=work, args=[course]) for course in self.courses]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(errors, [])

    # Freeing spins waits for the kernels of all threads. The replicas of this ensemble run in one
    # kernel, which asks Python from time to time whether Ctrl-C was pressed.
    def test_freeing_while_another_thread_steps(self):
        faulthandler.dump_traceback_later(LONGEST, exit=True)
        strengths = [0.1 * n for n in range(8)]
        ensemble = cayspin.EnsembleSimulation(scene(
            field={"slab_demag": None},
            ensemble={"replicas": 8, "vary": {"field.applied.0": strengths}}))
        waste = [cayspin.Simulation(scene()) for _ in range(50)]
        views = [sim.spins for sim in waste[:20]]
        for sim in waste[:20]:
            sim.step()
        thread = threading.Thread(target=ensemble.step, args=[20000])
        thread.start()
        while waste:
            waste.pop()
            if views:
                views.pop()
            time.sleep(0.005)
        thread.join()
        self.assertEqual(ensemble.steps, 20000)


if __name__ == "__main__":
    unittest.main()
