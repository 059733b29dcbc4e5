# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Scenes in SI: times in s, fields in T, energies in J, also in functions and in files."""

import math
import unittest

import cayspin
import h5py
import numpy as np
from package_test import PackageTest

MU0 = 1.25663706127e-6
MS, CELL, DT = 8e5, (4e-9, 5e-9, 3e-9), 2e-13
FIELD = (0.02, -0.01, 0.3)  # T
FREQUENCY = 2 * math.pi * 5e9


def film(field, **tables):
    return cayspin.Scene(
        units="SI",
        material={"Ms": MS, "A": 1.3e-11, "alpha": 0.1, "damping_form": "gilbert"},
        system={"kind": "llg"}, lattice={"shape": [6, 5, 1], "spacing": list(CELL)}, field=field,
        initial={"random": {"seed": 4}}, integrator={"method": "rkmk4", "dt": DT, "end": 40 * DT},
        **tables)


class SiScenes(PackageTest):
    def test_times_fields_and_energies(self):
        of = film({"applied": list(FIELD)})
        self.assertAlmostEqual(of.dt / DT, 1, delta=1e-14)
        sim = cayspin.Simulation(of)
        sim.step(30)
        self.assertAlmostEqual(sim.time / (30 * DT), 1, delta=1e-13)
        zeeman = -MS * math.prod(CELL) * (sim.spins @ np.array(FIELD)).sum()
        energies = sim.energies()
        self.assertAlmostEqual(energies["applied"] / zeeman, 1, delta=1e-12)
        self.assertAlmostEqual(sum(energies.values()) / sim.energy(), 1, delta=1e-12)
        sim.run(until=40 * DT)
        self.assertEqual(sim.steps, 40)
        self.assert_refused(cayspin.CayspinError, "t = 7.2e-12", sim.run, until=7.131e-12)

    def test_field_is_in_tesla(self):
        # Parallel spins: to round-off, exchange adds nothing to the field, not even a multiple of
        # the spin.
        sim = cayspin.Simulation(film({"applied": list(FIELD)}))
        sim.spins = [0.0, 0.6, 0.8]
        np.testing.assert_allclose(sim.field(), np.broadcast_to(FIELD, (1, 5, 6, 3)), atol=1e-13)

    def test_applied_arrays_are_in_tesla(self):
        array = np.random.default_rng(3).normal(size=(1, 5, 6, 3))
        sim = cayspin.Simulation(film({"applied": array}))
        np.testing.assert_allclose(sim.field() - cayspin.Simulation(film({})).field(), array,
                                   atol=1e-13)
        expected = -MS * math.prod(CELL) * (sim.spins * array).sum()
        self.assertAlmostEqual(sim.energies()["sources"] / expected, 1, delta=1e-12)

    def test_functions_are_in_the_scenes_units(self):
        typed = cayspin.Simulation(film({"applied": [f"0.1*cos({FREQUENCY!r}*t)", 0.05, 0],
                                         "slab_demag": {"normal": [0, 0, 1]}}))

        def uniform(t):
            return 0.1 * math.cos(FREQUENCY * t), 0.05, 0.0

        def demagnetising_field(spins, t):
            return -MU0 * MS * spins * [0, 0, 1]

        own = cayspin.Simulation(film({"applied": uniform, "nonlocal": demagnetising_field}))
        typed.step(40)
        own.step(40)
        np.testing.assert_allclose(own.spins, typed.spins, atol=1e-12)
        start = cayspin.Simulation(film({})).spins
        self.assertGreater(np.abs(own.spins - start).max(), 0.1)
        self.assertAlmostEqual(own.energy() / typed.energy(), 1, delta=1e-11)

    def test_files(self):
        of = film({"applied": list(FIELD)}, output={"every": 20, "xdmf": True, "table": True,
                                                    "compression": 4})
        sim = cayspin.Simulation(of)
        sim.run(output=self.folder / "film.h5")
        ran = self.run_program(of)
        with h5py.File(self.folder / "film.h5") as file:
            np.testing.assert_array_equal(file["spins"], ran["spins"])
            for name in ("time", "energy", "scalars/energy"):
                np.testing.assert_array_equal(file[name], ran[name])
            self.assertEqual(file["spins"].compression, "gzip")
            self.assertEqual(file.attrs["units"], ran.attrs["units"])
            self.assertAlmostEqual(file["time"][-1] / (40 * DT), 1, delta=1e-13)
            self.assertAlmostEqual(file["energy"][-1] / sim.energy(), 1, delta=1e-12)
        for extension in (".txt", ".xdmf"):
            mine = (self.folder / "film").with_suffix(extension).read_text()
            theirs = (self.folder / "program1").with_suffix(extension).read_text()
            self.assertEqual(mine, theirs.replace("program1", "film"))


if __name__ == "__main__":
    unittest.main()
