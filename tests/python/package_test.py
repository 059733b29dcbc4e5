# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shared code of the tests of the package."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import cayspin
import h5py
import numpy as np

PROGRAM = os.environ["CAYSPIN_PROGRAM"]
ON_DEVICE = os.environ.get("CAYSPIN_SPACE") == "host_device"

TABLES = {
    "system": {"kind": "llg", "damping": 0.1},
    "lattice": {"shape": [7, 3, 2], "spacing": [1.0, 0.9, 1.1],
                "boundary": ["periodic", "open", "open"]},
    "field": {"exchange": 0.7, "anisotropy": {"constant": 0.4, "axis": [0, 1, 2]},
              "applied": [0.3, 0.2, -0.1],
              "slab_demag": {"normal": [0, 0, 1], "strength": 0.8, "where": "host"},
              "mu0": 1.5},
    "initial": {"random": {"seed": 3}},
    "integrator": {"method": "rkmk4", "dt": 0.05, "steps": 40},
}


def scene(**tables):
    """Returns the scene of TABLES, with keys of its tables replaced; None removes a key."""
    changed = {**TABLES}
    for name, table in tables.items():
        if isinstance(table, dict) and name != "initial":
            table = {**TABLES.get(name, {}), **table}
            table = {key: value for key, value in table.items() if value is not None}
        changed[name] = table
    return cayspin.Scene(**changed)


def random_spins(shape, seed):
    m = np.random.default_rng(seed).standard_normal((*shape, 3))
    return m / np.linalg.norm(m, axis=-1, keepdims=True)


def stepped(of_scene, steps, precision="double"):
    """Returns the spins after `steps` steps."""
    sim = cayspin.Simulation(of_scene, precision)
    sim.step(steps)
    return sim.spins


class PackageTest(unittest.TestCase):
    programs = 0  # runs of the program so far

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def written(self, of_scene, name="scene.toml"):
        """Writes a scene, and returns its file."""
        file = self.folder / name
        file.write_text(of_scene.text, encoding="utf-8")
        return file

    def run_program(self, of_scene, *options, command="run"):
        """Returns the open file that a command of the program, by default `run`, writes for a
        scene."""
        self.programs += 1
        text = self.written(of_scene, f"program{self.programs}.toml")
        output = text.with_suffix(".h5")
        subprocess.run([PROGRAM, command, text, "--output", output, "--quiet", *options],
                       check=True)
        file = h5py.File(output)
        self.addCleanup(file.close)
        return file

    def assert_refused(self, error, part, call, /, *arguments, **options):
        with self.subTest(part):
            with self.assertRaises(error) as caught:
                call(*arguments, **options)
            message = str(caught.exception)
            self.assertIn(part, message)
            self.assertNotIn("\n", message)

    def assert_all_refused(self, error, calls):
        """Checks the error that each call of {part of the message: call} raises."""
        for part, call in calls.items():
            self.assert_refused(error, part, call)
