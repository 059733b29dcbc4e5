# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""OVF files that cayspin writes and reads, checked with the OVF library of the Spirit project."""

import numpy as np
from interchange_test import SHAPE, SPACING, InterchangeTest, main
from ovf import ovf

SITES = int(np.prod(SHAPE))
FORMATS = {"text": ovf.FILEFORMAT_TEXT, "binary4": ovf.FILEFORMAT_BIN4,
           "binary8": ovf.FILEFORMAT_BIN8}


def read(path):
    """Returns the header and the values (site, 3) of a file."""
    with ovf.ovf_file(str(path)) as file:
        assert file.found and file.is_ovf and file.n_segments == 1, file.get_latest_message()
        header = ovf.ovf_segment()
        assert file.read_segment_header(0, header) == ovf.OK, file.get_latest_message()
        values = np.zeros((header.N, header.valuedim))
        assert file.read_segment_data(0, header, values) == ovf.OK, file.get_latest_message()
        return header, values


def write(path, values, file_format):
    header = ovf.ovf_segment(title="m", valuedim=3, valueunits="1 1 1", valuelabels="x y z",
                             meshtype="rectangular", meshunits="nm", n_cells=SHAPE,
                             step_size=SPACING, bounds_max=np.multiply(SHAPE, SPACING))
    with ovf.ovf_file(str(path)) as file:
        assert file.write_segment(header, values, fileformat=file_format) == ovf.OK


class OvfLibrary(InterchangeTest):
    def test_reads_what_export_writes(self):
        file = self.run_scene("run.h5")
        spins = self.dataset(file, "spins").reshape(-1, SITES, 3)
        for name in FORMATS:
            self.cayspin("export", "run.h5", "--ovf", name, "--format", name, "--frames", "all")
            for frame, expected in enumerate(spins):
                header, values = read(self.folder / name / f"run_{frame:06}.ovf")
                if name == "binary4":
                    expected = expected.astype(np.float32).astype(np.float64)
                np.testing.assert_array_equal(values, expected, name)
                self.assertEqual(header.meshtype, b"rectangular")
                self.assertEqual(header.valueunits, b"1 1 1")
                self.assertEqual(tuple(header.n_cells), SHAPE)
                self.assertEqual(tuple(header.step_size), SPACING)
                self.assertEqual(tuple(header.bounds_min), (0, 0, 0))
                self.assertEqual(tuple(header.bounds_max), tuple(np.multiply(SHAPE, SPACING)))
                self.assertEqual(tuple(header.origin), tuple(np.divide(SPACING, 2)))

    def test_writes_what_a_scene_starts_from(self):
        random = np.random.default_rng(1).normal(size=(SITES, 3))
        spins = random / np.linalg.norm(random, axis=1)[:, None]
        precision = {"text": 1e-12, "binary4": 1e-7, "binary8": 4e-16}
        for name, file_format in FORMATS.items():
            write(self.folder / f"{name}.ovf", spins, file_format)
            file = self.run_scene(f"{name}.h5", "--set", f"initial={{file='{name}.ovf'}}")
            start = self.dataset(file, "spins")[0].reshape(-1, 3)
            self.assertLess(abs(start - spins).max(), precision[name], name)


main()
