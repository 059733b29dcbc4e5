# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Damaged files, as the drawing scripts read them."""

import os
import sys
import unittest

import h5py
import numpy as np
from script_test import ScriptTest, write

from cayspin_plots.read import read_trajectory


class CorruptFile(ScriptTest):
    def setUp(self):
        super().setUp()
        self.file = write(self.folder / "a.h5")

    def assert_file_refused(self, part="cannot read the trajectory: "):
        """Reads in this process, since starting Matplotlib for each of many files takes long."""
        with self.assertRaises(SystemExit) as caught:
            read_trajectory(self.file)
        self.assertNotIn("\n", caught.exception.code)
        self.assertTrue(caught.exception.code.startswith(f"{self.file}: {part}"),
                        caught.exception.code)

    def change(self, change):
        with h5py.File(self.file, "r+") as file:
            change(file)

    def test_no_file(self):
        self.file.unlink()
        self.assert_file_refused("there is no such file")

    def test_truncated(self):
        size = self.file.stat().st_size
        for kept in (size - 1, size // 2, 600, 4, 0):
            with self.subTest(kept=kept):
                os.truncate(self.file, kept)
                self.assert_file_refused()

    def test_checksum(self):
        with h5py.File(self.file) as file:
            known = file["spins"][3].tobytes()
        content = bytearray(self.file.read_bytes())
        content[content.index(known)] ^= 1
        self.file.write_bytes(content)
        self.assert_file_refused()

    def test_something_missing(self):
        for name in ("spins", "time", "scalars/energy", "scalars", "precision", "complete"):
            with self.subTest(name):
                write(self.file)
                self.change(lambda file: (file if name in file else file.attrs).pop(name))
                self.assert_file_refused()

    def test_no_frame(self):
        for name in ("checksum", "time"):
            self.change(lambda file: file[name].resize(0, axis=0))
            self.assert_file_refused("it holds no frame")

    def test_wrong_extents(self):
        for name, values in (("spins", np.zeros((20, 15))), ("spins", np.float64(1)),
                             ("spins", np.zeros((20, 1, 1, 5, 2))), ("spins", np.bytes_("text")),
                             ("magnetization", np.zeros(20)), ("time", np.zeros((20, 2))),
                             ("scalars", np.zeros(20))):
            with self.subTest(name, shape=values.shape):
                write(self.file)

                def replace(file):
                    del file[name]
                    file[name] = values

                self.change(replace)
                self.assert_file_refused()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
