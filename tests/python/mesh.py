# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shapes from surfaces of triangles."""

import importlib.util
import itertools
import struct
import unittest
from unittest import mock

import cayspin
import numpy as np
from package_test import PackageTest

CELLS = (41, 40, 39)


def sphere(parts):
    """Returns triangles: an octahedron's faces, each cut into parts^2 and projected onto the unit
    sphere. Seen from outside, their corners are counter-clockwise."""
    found = []
    for signs in itertools.product((1, -1), repeat=3):
        corners = np.diag(signs).astype(float)
        if np.prod(signs) < 0:
            corners = corners[::-1]

        def at(i, j, corners=corners):
            return corners[0] + (corners[1] - corners[0]) * i / parts \
                + (corners[2] - corners[0]) * j / parts

        for i, j in itertools.product(range(parts), repeat=2):
            if i + j < parts:
                found.append([at(i, j), at(i + 1, j), at(i, j + 1)])
            if i + j + 1 < parts:
                found.append([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
    found = np.array(found)
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


def stl(triangles):
    """Returns the bytes of a binary STL file."""
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *triangle.ravel(), 0) for triangle in triangles)


class Meshes(PackageTest):
    def test_a_sphere_is_that_of_an_expression(self):
        surface = sphere(30)
        occupied = cayspin.occupied_of_mesh(surface, CELLS, 0.06)
        self.assertEqual(occupied.shape, CELLS[::-1])
        k, j, i = np.indices(occupied.shape)
        r = 0.06 * np.sqrt((i - 20)**2 + (j - 19.5)**2 + (k - 19)**2)
        inside = r < 1
        # The triangles are flat: between their corners they are up to 2.5e-3 inside the sphere.
        self.assertLess(np.abs(r[occupied != inside] - 1).max(initial=0), 2.5e-3)
        scaled = cayspin.occupied_of_mesh(surface, CELLS, (6e-11, 6e-11, 6e-11), scale=1e-9)
        np.testing.assert_array_equal(scaled, occupied)
        placed = cayspin.occupied_of_mesh(surface + [1.23, 1.2, 1.17], CELLS, 0.06, center=False)
        np.testing.assert_array_equal(placed, occupied)
        scene = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1},
            lattice={"shape": list(CELLS), "spacing": 0.06, "occupied": occupied},
            field={"applied": [0, 0, 1]}, initial={"uniform": [0, 0, 1]})
        self.assertAlmostEqual(cayspin.Simulation(scene).energy(), -occupied.sum(), delta=1e-6)

    def test_overlapping_bodies_are_united(self):
        one = sphere(10)
        both = np.concatenate([one, one + [0.8, 0, 0]])
        wide = cayspin.occupied_of_mesh(both + [1, 1, 1], (56, 40, 40), 0.05, center=False)
        left = cayspin.occupied_of_mesh(one + [1, 1, 1], (56, 40, 40), 0.05, center=False)
        right = cayspin.occupied_of_mesh(one + [1.8, 1, 1], (56, 40, 40), 0.05, center=False)
        np.testing.assert_array_equal(wide, left | right)

    # If the size is an odd number of cells, faces and corners of the box are at centres of cells.
    def test_a_box_along_the_cells(self):
        corners = np.array(list(itertools.product((0, 1), repeat=3)), float)
        faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7),
                 (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
        box = corners[np.array(faces)]
        for size in (0.3, 0.5, 0.6, 1.0):
            occupied = cayspin.occupied_of_mesh(box, (10, 10, 10), 0.1, scale=size)
            self.assertEqual(occupied.sum(), round(10 * size)**3)
        self.assertEqual(cayspin.occupied_of_mesh(box, (10,), 0.1).sum(), 10)

    def test_wrong_meshes(self):
        for wrong in (np.zeros((4, 3)), np.zeros((0, 3, 3)), np.full((1, 3, 3), np.nan)):
            self.assert_refused(cayspin.CayspinError, "occupied_of_mesh: triangles of shape",
                                cayspin.occupied_of_mesh, wrong, (2, 2, 2))
        with mock.patch.dict("sys.modules", trimesh=None):
            self.assert_refused(cayspin.CayspinError, "files need trimesh",
                                cayspin.occupied_of_mesh, "a.stl", (2, 2, 2))

    def test_wrong_arguments(self):
        surface = sphere(2)

        def refused(part, mesh=surface, shape=(4, 4, 4), **options):
            self.assert_refused(cayspin.CayspinError, f"occupied_of_mesh: {part}",
                                cayspin.occupied_of_mesh, mesh, shape, **options)

        for shape in (30, "ab", None):
            refused(f"shape: {shape!r}; accepted: one to three whole numbers >= 1", shape=shape)
        for shape in ((), (4, 4, 4, 4)):
            refused(f"shape of {len(shape)} numbers; accepted: one to three", shape=shape)
        refused("shape: 4.5; accepted: a whole number", shape=(4.5, 4, 4))
        for shape in ([4, 0, 4], [-1]):
            refused(f"shape {shape}; accepted: one to three whole numbers >= 1", shape=shape)
        for spacing in (-1, 0, np.nan, np.inf, (1, 0, 1)):
            refused("spacing [", spacing=spacing)
        refused("spacing of 4 numbers; accepted: a number > 0", spacing=(1, 1, 1, 1))
        refused("spacing: ", spacing="a")
        refused("spacing: ", spacing=[[1], [1, 2]])
        for scale in (np.nan, np.inf, 0):
            refused("scale ", scale=scale)
        refused("scale: ", scale="a")
        refused("center: ", center=3)
        refused("triangles: rows of different lengths", mesh=[[[1, 2, 3]], [[1]]])

    @unittest.skipUnless(importlib.util.find_spec("trimesh"), "trimesh is not installed")
    def test_files(self):
        file = self.folder / "sphere.stl"
        file.write_bytes(stl(sphere(20)))
        np.testing.assert_array_equal(cayspin.occupied_of_mesh(file, CELLS, 0.06),
                                      cayspin.occupied_of_mesh(sphere(20), CELLS, 0.06))
        self.assert_refused(cayspin.CayspinError, "occupied_of_mesh: ", cayspin.occupied_of_mesh,
                            self.folder / "none.stl", (2, 2, 2))
        (self.folder / "wrong.toml").write_text("a = 1")
        self.assert_refused(cayspin.CayspinError, "occupied_of_mesh: ", cayspin.occupied_of_mesh,
                            self.folder / "wrong.toml", (2, 2, 2))


if __name__ == "__main__":
    unittest.main()
