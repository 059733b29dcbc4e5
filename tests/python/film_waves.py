# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Spin waves that an antenna excites in a film have the frequencies of Kalinikos and Slavin (1986),
as in examples/film_dispersion.py, but on a smaller lattice."""

import unittest

import cayspin
import numpy as np
from package_test import PackageTest

GAMMA, MU0 = 1.76085963e11, 4e-7 * np.pi  # rad/(s T), T m/A
MS, A, FIELD, THICKNESS = 8e5, 1.3e-11, 0.05, 2e-8  # A/m, J/m, T, m
CELLS, CELL, HIGHEST = 128, 8e-9, 22e9  # count, m, Hz


def kalinikos_slavin(k, across):
    """Returns the angular frequency of the lowest branch, with unpinned spins at both faces and the
    exchange of cells of length CELL."""
    of_cells = 2 / CELL * np.sin(k * CELL / 2)
    field = GAMMA * (FIELD + 2 * A / MS * of_cells**2)
    of_moment = GAMMA * MU0 * MS
    p = 1 - (1 - np.exp(-k * THICKNESS)) / (k * THICKNESS)
    if across:
        return np.sqrt(field * (field + of_moment) + of_moment**2 * p * (1 - p))
    return np.sqrt(field * (field + of_moment * (1 - p)))


class WavesOfAFilm(PackageTest):
    def assert_dispersion(self, along, across):
        scene = cayspin.Scene(
            units="SI", system={"kind": "llg"},
            lattice={"shape": [CELLS, 2], "spacing": [CELL, CELL, THICKNESS],
                     "boundary": "periodic"},
            material={"Ms": MS, "A": A, "alpha": 1e-4, "gamma": GAMMA, "damping_form": "gilbert"},
            field={"demag": True, "applied": [FIELD * number for number in along],
                   "sources": [{"profile": [0, 0, "i == 64"],
                                "time": f"1e-3*sinc(2*pi*{HIGHEST}*(t - 1e-10))"}]},
            initial={"uniform": along}, output={"every": 5},
            integrator={"method": "rkmk4", "dt": 3e-12, "end": 4.5e-9})
        file = self.folder / "film.h5"
        cayspin.Simulation(scene).run(output=file)
        with cayspin.open(file) as run:
            found = run.dispersion([(1 / CELLS, 0, 0), (10 / CELLS, 0, 0)], component="z")
        k = 2 * np.pi * found.wave_vectors[:, 0] / CELL
        self.assertEqual(len(k), 10)
        expected = kalinikos_slavin(k, across)
        # The curve spans many times the resolution, so that a wrong one is found.
        self.assertGreater(np.ptp(expected), 15 * found.resolution)
        self.assertLess(np.abs(np.abs(found.peak()) - expected).max(), found.resolution)

    def test_backward_volume_waves(self):
        self.assert_dispersion([1, 0, 0], False)

    def test_damon_eshbach_waves(self):
        self.assert_dispersion([0, 1, 0], True)


if __name__ == "__main__":
    unittest.main()
