# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Executes the notebooks, which contain assertions: notebooks.py FOLDER."""

import os
import pathlib
import sys
import unittest

try:
    import ipykernel  # noqa: F401  the kernel that nbclient starts
    import nbclient
    import nbformat
except ImportError as missing:
    print(f"not run: {missing} (Debian: python3-nbclient, python3-ipykernel)")
    sys.exit(77)

FOLDER = pathlib.Path(sys.argv[1])
os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"


class Notebooks(unittest.TestCase):
    def test_each(self):
        files = sorted(FOLDER.glob("*.ipynb"))
        self.assertEqual(len(files), 3)
        for file in files:
            with self.subTest(file.name):
                notebook = nbformat.read(file, as_version=4)
                code = [cell for cell in notebook.cells if cell.cell_type == "code"]
                self.assertTrue(all(not cell.outputs for cell in code), "outputs are committed")
                nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
                pictures = sum("image/png" in output.get("data", {})
                               for cell in code for output in cell.outputs)
                self.assertGreater(pictures, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
