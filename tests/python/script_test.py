# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shared code of drawing tests. Arguments: FOLDER_OF_SCRIPTS WRITER_OF_TRAJECTORIES."""

import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import h5py
import matplotlib.image
import numpy as np

SCRIPTS, WRITER = map(pathlib.Path, sys.argv[1:3])
sys.path.insert(0, str(SCRIPTS))

BLUE, RED = (0x1B, 0x5F, 0xA7), (0xCF, 0x3F, 0x2B)
PIXELS_PER_INCH = 160


def write(path, sites=5, length=1.0, cell_sites=1):
    subprocess.run([WRITER, path, str(sites), str(length), str(cell_sites)], check=True)
    return path


def dimensions(png):
    content = png.read_bytes()
    assert content[:8] == b"\x89PNG\r\n\x1a\n" and content[12:16] == b"IHDR", content[:16]
    return struct.unpack(">II", content[16:24])


class ScriptTest(unittest.TestCase):
    fonts = tempfile.TemporaryDirectory()  # where Matplotlib lists the fonts, only once

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def replace_spins(self, file, spins, **datasets):
        with h5py.File(file, "r+") as data:
            del data["spins"], data["checksum"]
            data["spins"] = spins
            for name, values in datasets.items():
                data[name] = values

    def film(self):
        """Writes a film of 10 x 8: +x at the lower left, -x at the lower right, -z above and one
        empty site; +y in the first frame."""
        spins = np.zeros((20, 1, 8, 10, 3))
        spins[..., :4, :5, 0], spins[..., :4, 5:, 0], spins[..., 4:, :, 2] = 1, -1, -1
        spins[0] = [0, 1, 0]
        spins[:, 0, 7, 9] = 0
        file = write(self.folder / "film.h5")
        self.replace_spins(file, spins)
        return file, spins

    def text_file(self, name="text.h5"):
        """Returns a file that is no trajectory."""
        file = self.folder / name
        file.write_text("not a trajectory\n")
        return file

    def run_script(self, name, *arguments, path=os.environ["PATH"], **options):
        return subprocess.run([sys.executable, "-B", SCRIPTS / name, *map(str, arguments)],
                              env=os.environ | {"MPLCONFIGDIR": self.fonts.name, "PATH": path},
                              capture_output=True, text=True, **options)

    def assert_drawn(self, png, inches, colors, result):
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout, f"{png}\n")
        self.assertEqual(dimensions(png), tuple(round(PIXELS_PER_INCH * side) for side in inches))
        self.assertTrue(15_000 < png.stat().st_size < 3_000_000, png.stat().st_size)
        for color in colors:
            self.assert_has_color(png, color)

    def assert_has_color(self, png, color):
        pixels = np.round(255 * matplotlib.image.imread(png)[..., :3]).astype(int)
        count = int(np.all(abs(pixels - color) <= 2, axis=-1).sum())
        self.assertGreater(count, 300, f"{png.name}: pixels of the color {color}")

    def assert_refused(self, png, file, part, result):
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith(f"{file}: "), result.stderr)
        self.assertIn(part, result.stderr)
        self.assertFalse(png.exists())
