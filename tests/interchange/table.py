# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The table of samples, as numpy reads it, agrees with /scalars."""

import numpy as np
from interchange_test import InterchangeTest, main


class Table(InterchangeTest):
    def test_columns_are_the_scalars(self):
        file = self.run_scene("run.h5", "--set", "output.table=true", "--set",
                              "output.scalars_every=2")
        table = self.folder / "run.txt"
        names = table.read_text(encoding="utf-8").splitlines()[0]
        self.assertEqual(names, "# t ()\tmx ()\tmy ()\tmz ()\tE_total ()\tnorm_defect ()")
        columns = np.loadtxt(table)
        self.assertEqual(columns.shape, (14, 6))  # steps 0, 2, .., 24 and 25
        np.testing.assert_array_equal(columns[:, 0], self.dataset(file, "scalars/time"))
        np.testing.assert_array_equal(columns[:, 1:4], self.dataset(file, "scalars/magnetization"))
        np.testing.assert_array_equal(columns[:, 4], self.dataset(file, "scalars/energy"))
        np.testing.assert_array_equal(columns[:, 5], self.dataset(file, "scalars/norm_defect"))


main()
