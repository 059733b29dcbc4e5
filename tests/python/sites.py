# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Arrays of crystals' sites, tested without the module: sites.py PATH_OF_SITES."""

import importlib.util
import sys
import unittest

import numpy as np

SPEC = importlib.util.spec_from_file_location("sites", sys.argv.pop(1))
sites = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(sites)


class Sites(unittest.TestCase):
    def test_what_the_library_has_is_seen_and_not_copied(self):
        for order in "CF":
            library = np.arange(6 * 5 * 4 * 3.0).reshape(6, 5, 4, 3).copy(order)
            library.flags.writeable = False
            seen = sites.by_site(library, 3)
            self.assertEqual(seen.shape, (3, 2, 5, 4, 3))
            self.assertTrue(np.shares_memory(seen, library))
            self.assertFalse(seen.flags.writeable)
            for site in range(3):
                for cell in range(2):
                    np.testing.assert_array_equal(seen[site, cell], library[3 * cell + site])
            np.testing.assert_array_equal(sites.by_plane(seen, 3), library)

    def test_broadcast_arrays_are_taken(self):
        of_sites = np.arange(9.0).reshape(3, 1, 1, 1, 3)
        planes = sites.by_plane(np.broadcast_to(of_sites, (3, 2, 5, 4, 3)), 3)
        self.assertEqual(planes.shape, (6, 5, 4, 3))
        np.testing.assert_array_equal(planes[4], np.broadcast_to([3.0, 4.0, 5.0], (5, 4, 3)))

    def test_one_site_in_a_cell_changes_nothing(self):
        library = np.zeros((6, 5, 4, 3))
        self.assertIs(sites.by_site(library, 1), library)
        self.assertIs(sites.by_plane(library, 1), library)
        self.assertEqual(sites.shape_by_site((6, 5, 4), 1), (6, 5, 4))
        self.assertEqual(sites.shape_by_site((6, 5, 4), 3), (3, 2, 5, 4))


unittest.main()
