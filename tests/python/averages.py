# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Running means of a simulation, compared with means of its stored values."""

import unittest

import cayspin
import numpy as np
from package_test import PackageTest

SCENE = cayspin.Scene(
    system={"kind": "llg", "damping": 0.5},
    lattice={"shape": [6, 5, 4], "crystal": "bcc", "boundary": "periodic", "moments": [1, 0.5],
             "occupied": "i != 1 || s != 1"},
    field={"couplings": {"shells": [-0.4]}, "anisotropy": {"constant": 0.3, "axis": [0, 0, 1]}},
    thermal={"temperature": 0.2, "seed": 5}, initial={"random": {"seed": 3}},
    integrator={"method": "heun", "dt": 0.05})


def values(sim):
    """Returns the samples to average, from the simulation's own properties."""
    spins, energies = sim.spins, sim.energies()
    of_sites = [spins[0].reshape(-1, 3).mean(0), spins[1][:, :, [0, 2, 3, 4, 5]].reshape(-1, 3).mean(0)]
    return {"energy": sim.energy(), "magnetization": sim.magnetization(),
            "sublattice_magnetization": np.array(of_sites), **energies}


class Averages(PackageTest):
    def test_are_those_of_the_looks(self):
        sim = cayspin.Simulation(SCENE)
        all_of_them, latest = sim.averages(every=3), sim.averages(every=3, window=np.int64(200))
        self.assertTrue(np.isnan(all_of_them.energy.mean))
        self.assertEqual(all_of_them.energies, {})
        looks = []
        sim.observe(3, lambda sim: looks.append(values(sim)))
        sim.step(601)
        self.assertEqual((len(all_of_them), len(latest), len(looks)), (200, 200, 200))
        all_of_them.restart()
        self.assertEqual(len(all_of_them), 0)
        sim.step(900)
        self.assertEqual((len(all_of_them), len(latest), len(looks)), (300, 200, 500))
        for means, first in ((all_of_them, 200), (latest, 300)):
            for name in looks[0]:
                found = getattr(means, name, None) or means.energies[name]
                expected = cayspin.average([look[name] for look in looks], skip=first)
                np.testing.assert_allclose(found.mean, expected.mean, rtol=1e-12, atol=1e-14)
                np.testing.assert_allclose(found.error, expected.error, rtol=1e-6)
            self.assertGreater(means.energy.error, 0)
        self.assertEqual(set(looks[0]) - {"energy", "magnetization", "sublattice_magnetization"},
                         set(latest.energies))

    def test_sublattices_are_those_of_the_file(self):
        sim = cayspin.Simulation(SCENE)
        file = self.folder / "run.h5"
        sim.run(until=1, output=file)
        with cayspin.open(file) as run:
            np.testing.assert_allclose(sim.sublattice_magnetization(),
                                       run.sublattice_magnetization[-1], atol=1e-14)

    def test_wrong_calls(self):
        sim = cayspin.Simulation(SCENE)
        for part, call in (("window 0; accepted: at least 1", (1, 0)), ("every 0 steps", (0,))):
            self.assert_refused(cayspin.CayspinError, part, sim.averages, *call)


if __name__ == "__main__":
    unittest.main()
