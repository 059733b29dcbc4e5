# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Crystals, shapes by arrays, and grains."""

import subprocess
import unittest

import cayspin
import numpy as np
from package_test import PROGRAM, PackageTest, stepped

TABLES = {
    "system": {"kind": "llg", "damping": 0.0},
    "lattice": {"shape": [12, 6], "spacing": 0.5, "crystal": "honeycomb",
                "boundary": "periodic"},
    "field": {"couplings": {"shells": [0.5]}},
    "initial": {"random": {"seed": 3}},
    "integrator": {"method": "rkmk4", "dt": 0.05, "steps": 40},
}


def scene(lattice=None, **tables):
    return cayspin.Scene(**{**TABLES, "lattice": {**TABLES["lattice"], **(lattice or {})},
                            **tables})


class Dispersions(PackageTest):
    def test_cell_and_positions_are_those_of_the_scene(self):
        start = np.random.default_rng(1).normal(0, 0.01, (2, 1, 6, 12, 3)) + [0, 0, 1]
        file = self.folder / "run.h5"
        run_of = scene(initial=start, output={"every": 8},
                       integrator={"method": "rkmk4", "dt": 0.05, "steps": 3200})
        cayspin.Simulation(run_of).run(output=file)
        path = [(0, 0, 0), (2 / 3, 1 / 3, 0), (1, 0, 0)]
        cell = [(0.5, 0, 0), (0.25, 0.5 * np.sqrt(0.75), 0), (0, 0, 0.5)]
        with cayspin.open(file) as run:
            found = run.dispersion(path)
            expected = cayspin.dispersion(run.spins, 0.4, path, cell=cell,
                                          positions=[(0, 0, 0), (1 / 3, 1 / 3, 0)])
            edges = run.positions[0, 0, 1, 1] - run.positions[0, 0, 0, 0]
        np.testing.assert_allclose(found.intensity, expected.intensity, rtol=1e-12)
        np.testing.assert_allclose(edges, run_of.cell[0] + run_of.cell[1], atol=1e-15)
        self.assertAlmostEqual(found.corners[1], 4 * np.pi / 3 / 0.5)
        # Each peak is on one of the bands, 0.5 * (3 -+ |f|), except near Gamma, where the mode
        # involves all spins.
        h, k, _ = 2 * np.pi * found.wave_vectors.T
        f = np.abs(1 + np.exp(-1j * h) + np.exp(-1j * k))
        off = np.minimum(np.abs(found.peak() - 0.5 * (3 - f)), np.abs(found.peak() - 0.5 * (3 + f)))
        self.assertLess(off[f < 2.9].max(), found.resolution)

    def test_a_lattice_without_a_crystal(self):
        plain = cayspin.Scene(**{**TABLES, "lattice": {"shape": [4, 3], "spacing": [0.5, 2]}})
        np.testing.assert_array_equal(plain.cell, np.diag([0.5, 2, 1]))
        np.testing.assert_array_equal(plain.basis, [[0, 0, 0]])


class Arrays(PackageTest):
    def test_are_what_expressions_say(self):
        shape = [7, 4, 3]
        site, k, j, i = np.indices(scene({"shape": shape}).shape)
        self.assertEqual(site.shape, (2, 3, 4, 7))
        typed, given = (
            scene({"shape": shape, "occupied": occupied, "frozen": frozen},
                  system={"kind": "llg", "damping": damping},
                  field={"couplings": {"shells": [0.5]},
                         "anisotropy": [{"constant": 0.2, "axis": [0, 0, 1]},
                                        {"constant": constant, "axis": [1, 0, 0]}]})
            for occupied, frozen, damping, constant in (
                ("i != 2 || s != 1 || k != 1", "j == 0", "0.1 + 0.02*j", "0.1*i + s"),
                ((i != 2) | (site != 1) | (k != 1), j == 0, 0.1 + 0.02 * j, 0.1 * i + site)))
        spins = stepped(given, 40)
        np.testing.assert_array_equal(stepped(typed, 40), spins)
        vacant = (spins == 0).all(-1)
        np.testing.assert_array_equal(vacant, (i == 2) & (site == 1) & (k == 1))
        part = "an array as system.damping"
        self.assert_refused(cayspin.CayspinError, part, cayspin.advise, given, error=1e-3)

    def test_are_not_needed_for_an_export(self):
        mask = np.ones((1, 1, 4))
        mask[0, 0, 1] = 0
        of_sites = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1}, lattice={"shape": [4], "occupied": mask},
            field={"anisotropy": [{"constant": np.full((1, 1, 4), 0.3), "axis": [0, 0, 1]}]},
            initial={"uniform": [1, 0, 0]}, integrator={"method": "heun", "dt": 0.1, "steps": 1})
        file = self.folder / "run.h5"
        cayspin.Simulation(of_sites).run(output=file)
        folder = self.folder / "ovf"
        subprocess.run([PROGRAM, "export", file, "--ovf", folder], check=True,
                       stdout=subprocess.DEVNULL)
        self.assertEqual([one.name for one in folder.iterdir()], ["run_000001.ovf"])

    def test_in_place_of_the_keys_of_a_file(self):
        file = self.written(scene())
        mask = np.zeros(scene().shape)
        mask[1, 0, 4, 5] = 1
        sim = cayspin.Simulation(cayspin.Scene.from_file(file, lattice={"occupied": mask}))
        self.assertEqual(int((sim.spins != 0).any(-1).sum()), 1)
        self.assertTrue((sim.spins[1, 0, 4, 5] != 0).any())

    def test_wrong_ones(self):
        for mask, part in ((np.ones((2, 1, 6, 11)), "lattice.occupied: an array of shape (2, 1, "),
                           (np.ones((12, 1, 12)), "an array of shape (12, 1, 12); accepted: (2, "),
                           (np.full((2, 1, 6, 12), "a"), "lattice.occupied: an array of <U1"),
                           (np.ones((6, 12)), "lattice.occupied: is an array; accepted: ")):
            self.assert_refused(cayspin.CayspinError, part, scene, lattice={"occupied": mask})
        self.assert_refused(cayspin.SceneError, "leaves no spin", cayspin.Simulation,
                            scene(lattice={"occupied": np.zeros((2, 1, 6, 12))}))
        self.assert_refused(cayspin.SceneError, "a program gives, and none did", scene,
                            lattice={"frozen": {"given": True}})


class Modes(PackageTest):
    def test_shapes_have_the_sites_first(self):
        """All spins are frozen but those of the second site in the plane k = 1."""
        frozen = "s == 0 || k != 1"
        of = scene({"shape": [3, 2, 2], "frozen": frozen}, initial={"uniform": [0, 0, 1]},
                   field={"applied": [0, 0, 1]})
        shape = cayspin.Simulation(of).modes(1).shape
        self.assertEqual(shape.shape, (1, *of.shape, 3))
        moving = np.abs(shape[0]).max(-1) > 1e-9
        self.assertTrue(moving.any())
        self.assertFalse(moving[0].any() or moving[1, 0].any())


class Grains(PackageTest):
    def test_the_values_of_expressions(self):
        solid = scene({"shape": [7, 4, 3]})
        site, k, j, i = np.indices(solid.shape)
        np.testing.assert_array_equal(solid.at_sites("i + 10*j + 100*k + 1000*s"),
                                      i + 10 * j + 100 * k + 1000 * site)
        of = scene()
        grains = of.at_sites("grain(1.5, 1)")
        self.assertEqual(grains.shape, of.shape)
        self.assertEqual(set(grains.flat), set(range(4 * 2)))
        random = of.at_sites("random(grain(1.5, 1), 2)")
        for grain in range(4 * 2):
            self.assertEqual(len(set(random[grains == grain])), 1)
        self.assertEqual(len(set(random.flat)), 4 * 2)
        for text, part in (("grain(-1, 1)", "grain of size -1"), ("i +", 'expression "i +": '),
                           (3, "at_sites: 3; accepted: a string")):
            self.assert_refused(cayspin.CayspinError, part, of.at_sites, text)


if __name__ == "__main__":
    unittest.main()
