# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The demo writes the files that the program writes: demo.py DEMO PROGRAM SCENE."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

DEMO, PROGRAM, SCENE = sys.argv[1:4]
METHODS = {"geometric": "euler", "classical": "classical_euler", "reference": "rkmk4"}
CLOCKS = {"wall_seconds", "step_seconds"}


def datasets(file):
    found = {}
    file.visititems(lambda name, node: found.update({name: node})
                    if isinstance(node, h5py.Dataset) else None)
    return found


def attributes(file):
    return {name: value for name, value in file.attrs.items() if name not in CLOCKS}


class Demo(unittest.TestCase):
    def assert_same_files(self, demo, program):
        here, there = demo.attrs["git_commit"], program.attrs["git_commit"]
        self.assertEqual(here, there, "built from different sources: build cayspin_demo and "
                                      "cayspin_program together, and try again")
        self.assertEqual(attributes(demo), attributes(program))
        here, there = datasets(demo), datasets(program)
        self.assertEqual(here.keys(), there.keys())
        steps = program["step"][-1]
        self.assertEqual(steps, 6000)
        for name, expected in there.items():
            self.assertEqual((here[name].dtype, here[name].shape), (expected.dtype, expected.shape))
            if name.endswith("checksum"):
                continue  # the values differ in their last bits
            size = max(1, abs(expected[:]).max())
            difference = abs(here[name][:] - expected[:]).max()
            self.assertLessEqual(difference, steps * np.finfo(float).eps * size, name)

    def test_same_as_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([DEMO, folder], check=True)
            for name, method in METHODS.items():
                demo = pathlib.Path(folder) / f"{name}.h5"
                program = demo.with_suffix(".program.h5")
                subprocess.run([PROGRAM, "run", SCENE, "--set", f'integrator.method="{method}"',
                                "--set", "integrator.dt=0.01", "--set", "output.every=2",
                                "--output", program, "--quiet"], check=True)
                with self.subTest(name), h5py.File(demo) as a, h5py.File(program) as b:
                    self.assert_same_files(a, b)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
