# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A process that was forked from one with runs on several threads refuses to compute, instead of
waiting forever for these threads. After runs on one thread, a forked process computes."""

import os
import pathlib
import select
import signal
import subprocess
import sys
import unittest

import cayspin
import numpy as np
from package_test import ON_DEVICE, PackageTest, scene, stepped

LONGEST = 60  # seconds for a forked process, even on a busy machine
ON_ONE_THREAD = """
import cayspin
from forks import answer_of_fork
from package_test import scene, stepped
sim = cayspin.Simulation(scene(), threads=1)
sim.step(3)
print(sim.threads, answer_of_fork(lambda: (stepped(scene(), 3) == sim.spins).all()))
"""


def answer_of_fork(call):
    """Returns what a call returns or raises in a forked process, as text, or None if it takes too
    long."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            text = str(call())
        except BaseException as error:
            text = f"{type(error).__name__}: {error}"
        os.write(write, text.encode())
        os._exit(0)
    try:
        if select.select([read], [], [], LONGEST)[0]:
            return os.read(read, 4096).decode()
        return None
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        os.close(read)
        os.close(write)


class Forks(PackageTest):
    def test_are_refused_after_runs_on_several_threads(self):
        sim = cayspin.Simulation(scene())
        many = cayspin.EnsembleSimulation(scene(field={"slab_demag": None},
                                                ensemble={"replicas": 2}))
        sim.step(3)
        if sim.threads == 1 and not ON_DEVICE:
            self.skipTest("this space has one thread")
        for name, call in {"opens": lambda: cayspin.Simulation(scene()), "steps": sim.step,
                           "relaxes": sim.relax, "measures": sim.energy, "looks": lambda: sim.spins,
                           "steps an ensemble": many.step}.items():
            with self.subTest(name):
                answer = str(answer_of_fork(call))
                self.assertIn("CayspinError: this process was forked from one with runs on several "
                              "threads or on a device; accepted: a new process", answer)
                self.assertNotIn("\n", answer)
        sim.step(4)
        np.testing.assert_array_equal(sim.spins, stepped(scene(), 7))

    @unittest.skipIf(ON_DEVICE, "a forked process has no device")
    def test_compute_after_runs_on_one_thread(self):
        done = subprocess.run([sys.executable, "-B", "-c", ON_ONE_THREAD], text=True,
                              cwd=pathlib.Path(__file__).resolve().parent, capture_output=True)
        self.assertEqual((done.stdout.split(), done.returncode), (["1", "True"], 0), done.stderr)


if __name__ == "__main__":
    unittest.main()
