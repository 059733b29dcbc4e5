# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shared code of the tests in this folder. Usage of a test: SCRIPT PROGRAM FOLDER_OF_PACKAGES"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py

PROGRAM, PACKAGES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
sys.path.insert(0, str(PACKAGES))

# Extents and spacings that differ along every axis.
SHAPE, SPACING = (5, 4, 3), (0.5, 1.0, 2.0)
SCENE = f"""
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = {list(SHAPE)}
spacing = {list(SPACING)}
[field]
exchange = 1.0
applied = [0.3, -0.2, 0.1]
[initial]
random = {{ seed = 3 }}
[integrator]
method = "rkmk4"
dt = 0.02
steps = 25
[output]
every = 10
"""


class InterchangeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.toml").write_text(SCENE, encoding="utf-8")

    def cayspin(self, *words):
        result = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, text=True,
                                capture_output=True)
        self.assertEqual((result.returncode, result.stderr), (0, ""), words)
        return result.stdout

    def run_scene(self, file, *words):
        """Runs the scene, writes `file` in the test's folder, and returns its path."""
        self.cayspin("run", "scene.toml", "--quiet", "--output", file, *words)
        return self.folder / file

    @staticmethod
    def dataset(path, name):
        with h5py.File(path) as file:
            return file[name][:]


def main():
    unittest.main(argv=sys.argv[:1])
