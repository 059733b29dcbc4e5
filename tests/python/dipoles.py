# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Energies of point dipoles, compared with closed forms, known lowest states of lattices, and tests
of other programs. The unit of energy is mu^2/(4 pi a^3), as in most papers."""

import itertools
import math
import unittest

import cayspin
import numpy as np
from package_test import PackageTest

BOHR_MAGNETON = 9.2740100657e-24  # J/T


def simulation(lattice, initial, dipoles=True, **tables):
    return cayspin.Simulation(cayspin.Scene(
        **{"system": {"kind": "llg", "damping": 0.5}, "lattice": lattice, "initial": initial,
           "field": {"dipoles": dipoles}, **tables}))


def energy_per_site(lattice, initial, dipoles=True):
    sim = simulation(lattice, initial, dipoles)
    return 4 * math.pi * sim.energy() / (sim.spins**2).sum()


def direct_energy(places, moments):
    """Returns the energy of moments at positions, summed over pairs."""
    total = 0.0
    for i in range(1, len(places)):
        r = places[i] - places[:i]
        d = np.linalg.norm(r, axis=1)
        total += (moments[:i] @ moments[i] / d**3
                  - 3 * (r @ moments[i]) * (r * moments[:i]).sum(1) / d**5).sum()
    return total


class ClosedForms(PackageTest):
    # Two spins on the x axis: along it, parallel and antiparallel, and across it (LAMMPS issue
    # 4717). mu0 * mu_B^2 / (4 pi) is 0.0536814 meV Angstrom^3.
    def test_two_spins(self):
        apart, moment, meV = 3.0, 2.2, 1.602176634e-22
        pair = moment**2 * 0.0536814 / apart**3
        for first, second, expected in (([1, 0, 0], [1, 0, 0], -2), ([1, 0, 0], [-1, 0, 0], 2),
                                        ([0, 0, 1], [0, 0, 1], 1), ([0, 0, 1], [0, 0, -1], -1),
                                        ([1, 0, 0], [0, 1, 0], 0)):
            sim = simulation(
                {"shape": [2, 1, 1], "spacing": apart * 1e-10}, np.array([[[first, second]]], float),
                system={"kind": "llg"}, units="SI",
                material={"mu_s": {"bohr_magnetons": moment}, "alpha": 0.1,
                          "damping_form": "gilbert"})
            self.assertAlmostEqual(sim.energy() / meV, expected * pair, delta=1e-5 * pair)

    # Spins point along the ring: a pair at the distance r, whose spins are at the angle f, has the
    # energy -(3 + cos f) / (2 r^3).
    def test_rings(self):
        for count in (3, 6, 11):
            f = 2 * np.pi * np.arange(count) / count
            basis = np.stack([0.5 + 0.4 * np.cos(f), 0.5 + 0.4 * np.sin(f), 0 * f], 1)
            spins = np.stack([-np.sin(f), np.cos(f), 0 * f], 1).reshape(count, 1, 1, 1, 3)
            r = 0.8 * np.sin(f[1:] / 2)
            expected = -((3 + np.cos(f[1:])) / (4 * r**3)).sum()
            found = energy_per_site({"shape": [1, 1, 1], "basis": basis.tolist()}, spins)
            self.assertAlmostEqual(found / expected, 1, delta=1e-13)

    # Open chains, and the infinite chain, whose energy per site is -2 zeta(3).
    def test_chains(self):
        for count in (2, 9):
            expected = -2 * sum((count - n) / n**3 for n in range(1, count)) / count
            found = energy_per_site({"shape": [count]}, {"uniform": [1, 0, 0]})
            self.assertAlmostEqual(found, expected, delta=1e-13)
        whole = energy_per_site({"shape": [4], "boundary": "periodic"}, {"uniform": [1, 0, 0]})
        self.assertAlmostEqual(whole, -2 * 1.2020569031595942, delta=1e-12)


class LowestStates(PackageTest):
    def lowest(self, lattice, dipoles=True):
        found = []
        for seed in range(4):
            sim = simulation(lattice, {"random": {"seed": seed}}, dipoles)
            sim.relax(torque=1e-6)
            found.append(4 * math.pi * sim.energy() / (sim.spins**2).sum())
        return min(found)

    # Lowest energies per dipole by Luttinger and Tisza, Phys. Rev. 70, 954 (1946), in units of n
    # mu^2, where n is the number of dipoles in a^3: those of antiparallel states in spheres, and
    # that of parallel dipoles in long needles, -2 pi / 3.
    def test_three_dimensions(self):
        cells = {"shape": [2, 2, 2], "boundary": "periodic"}
        sphere = {"demagnetizing_factors": [1 / 3] * 3}
        self.assertAlmostEqual(self.lowest(cells, sphere), -2.676, delta=1e-3)
        self.assertAlmostEqual(self.lowest(cells), -2.676, delta=1e-3)
        bcc = {**cells, "crystal": "bcc"}
        self.assertAlmostEqual(self.lowest(bcc, sphere) / 2, -1.985, delta=1e-3)
        self.assertAlmostEqual(self.lowest(bcc) / 2, -2 * math.pi / 3, delta=1e-10)
        fcc = {**cells, "crystal": "fcc"}
        self.assertAlmostEqual(self.lowest(fcc) / 4, -2 * math.pi / 3, delta=1e-10)
        # The lowest state of an fcc sphere has dipoles in (1, 1, 1) planes, opposite in adjacent
        # planes.
        basis = cayspin.Scene(system={"kind": "llg", "damping": 0.5}, lattice=fcc, field={},
                              initial={"uniform": [1, 0, 0]}).basis
        of_cell = np.indices((2, 2, 2)).sum(0)
        plane = np.rint(of_cell + basis.sum(1)[:, None, None, None])
        planes = (1 - 2 * (plane % 2))[..., None] * [1.0, -1.0, 0.0]
        self.assertAlmostEqual(energy_per_site(fcc, planes, sphere) / 4, -1.808, delta=1e-3)

    # With all images, the lowest state of a square lattice has the energy -2.549, and that of a
    # triangular lattice -11.034 / 4.
    def test_planes(self):
        square = {"shape": [2, 2], "boundary": "periodic"}
        self.assertAlmostEqual(self.lowest(square), -2.549, delta=6e-4)
        triangular = {"shape": [3, 3], "boundary": "periodic",
                      "cell": [[1, 0, 0], [0.5, math.sqrt(0.75), 0], [0, 0, 1]]}
        self.assertAlmostEqual(self.lowest(triangular), -11.0341754 / 4, delta=1e-6)


class OtherPrograms(PackageTest):
    # Sunny's test_ewald.jl: one dipole in a cube has the energy -1/6 without a surface, and so does
    # each of several cells. A surface adds M.(N M) / (2 V).
    def test_sunny(self):
        for shape in ([1, 1, 1], [2, 3, 4]):
            lattice = {"shape": [max(2, n) for n in shape], "boundary": "periodic"}
            found = energy_per_site(lattice, {"uniform": [0.6, 0, 0.8]}) / (4 * math.pi)
            self.assertAlmostEqual(found, -1 / 6, delta=1e-13)
        cell = [[1.1, 0, 0], [-0.08, 0.9, 0], [0.02, 0.07, 0.8]]
        basis, factors = [[0, 0.01, 0.01], [0.1, 0.01, 0.01], [0.6, 0.4, 0.5]], [0.2, 0.5, 0.3]
        spins = np.random.default_rng(1).normal(size=(3, 1, 1, 1, 3))
        spins /= np.linalg.norm(spins, axis=-1, keepdims=True)
        moments = [1.0, 1.5, 2.0]
        energies = {}
        for shape in ([2, 2, 2], [4, 6, 2]):
            lattice = {"shape": shape, "boundary": "periodic", "cell": cell, "basis": basis,
                       "moments": moments}
            start = np.broadcast_to(spins, (3, *shape[::-1], 3)).copy()
            for of in (None, factors):
                dipoles = True if of is None else {"demagnetizing_factors": of}
                energies[shape[0], of is None] = \
                    simulation(lattice, start, dipoles).energy() / np.prod(shape)
        total = np.tensordot(moments, spins[:, 0, 0, 0], 1)
        surface = total @ (factors * total) / (2 * np.linalg.det(cell))
        for size in (2, 4):
            self.assertAlmostEqual(energies[size, False] - energies[size, True], surface,
                                   delta=1e-12)
        self.assertAlmostEqual(energies[2, True], energies[4, True], delta=1e-12)

    # Spirit's physics_ddi: two atoms in an oblique cell (its pull request 486 corrected their
    # positions). The sample is open, or has images along the first vector: four on each side, or
    # all.
    def test_spirit(self):
        cell = np.array([[3, 0, -1], [0, 1, 0], [0.3, -2, 1]], float)
        basis = np.array([[0, 0, 0], [0.5, 0.2, 0.7]])
        lattice = {"shape": [5, 5, 5], "cell": cell.tolist(), "basis": basis.tolist()}
        sim = simulation(lattice, {"random": {"seed": 4}})
        spins = sim.spins.copy()
        index = np.stack(np.indices((5, 5, 5))[::-1], -1)
        places = (index[None] + basis[:, None, None, None]) @ cell
        found = 4 * math.pi * sim.energy()
        m = spins.reshape(-1, 3)
        expected = direct_energy(places.reshape(-1, 3), m)
        self.assertAlmostEqual(found, expected, delta=1e-11 * abs(expected))

        def with_images(images):
            sim = simulation({**lattice, "boundary": ["periodic", "open", "open"]}, spins,
                             images and {"periodic_images": [images, 0, 0]} or True)
            return 4 * math.pi * sim.energy()

        # Each pair of cells counts with the nearest image along the first vector, and with four
        # more on each side.
        total, n = 0.0, 5
        for shift in range(-2 - 4 * n, 3 + 4 * n):
            for a, b in itertools.product(range(n), repeat=2):
                apart = a - b
                nearest = apart - n * round(apart / n)
                if (shift - nearest) % n:
                    continue
                r = (places[:, :, :, :1].reshape(-1, 1, 3)
                     - places[:, :, :, :1].reshape(1, -1, 3)) + shift * cell[0]
                d = np.linalg.norm(r, axis=-1)
                u, v = spins[:, :, :, a].reshape(-1, 3), spins[:, :, :, b].reshape(-1, 3)
                with np.errstate(divide="ignore", invalid="ignore"):
                    pairs = (u @ v.T) / d**3 - 3 * np.einsum("ic,ijc->ij", u, r) \
                        * np.einsum("jc,ijc->ij", v, r) / d**5
                total += pairs[d > 0].sum() / 2
        self.assertAlmostEqual(with_images(4), total, delta=1e-10 * abs(total))
        # The sum beyond n images falls as n^-2.
        off = [with_images(images) - with_images(None) for images in (50, 100)]
        self.assertAlmostEqual(off[0] / off[1], 4, delta=0.1)
        self.assertLess(abs(off[1] / total), 1e-4)


if __name__ == "__main__":
    unittest.main()
