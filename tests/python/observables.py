# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Topological charges, dispersions and averages of arrays with known answers, and of files."""

import math
import unittest

import cayspin
import h5py
import numpy as np
from package_test import PackageTest, random_spins, scene


def texture(ny, nx, radius, winding=1, helicity=0.0):
    """Returns a film (ny, nx, 3) that is down at its centre, and up from `radius` on."""
    x, y = np.meshgrid(np.arange(nx) - nx / 2 + 0.3, np.arange(ny) - ny / 2 + 0.4)
    t = np.pi * np.maximum(0, 1 - np.hypot(x, y) / radius)
    p = winding * np.arctan2(y, x) + helicity
    return np.stack((np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)), -1)


class TopologicalCharge(PackageTest):
    def test_known_textures(self):
        for boundary in (("periodic", "periodic"), ("open", "open"), ("open", "periodic")):
            for helicity in (0, np.pi / 2, 0.7):
                m = texture(31, 37, 13, 1, helicity)
                charge = cayspin.topological_charge(m, boundary)
                self.assertAlmostEqual(charge, -1, delta=1e-12)
                self.assertAlmostEqual(cayspin.topological_charge(-m, boundary), 1, delta=1e-12)
                other = cayspin.topological_charge(texture(31, 37, 13, -2), boundary)
                self.assertAlmostEqual(other, 2, delta=1e-12)
        single = texture(31, 37, 13).astype(np.float32)
        self.assertAlmostEqual(cayspin.topological_charge(single), -1, delta=1e-12)
        self.assertEqual(cayspin.topological_charge(np.broadcast_to([0.6, 0, 0.8], (4, 5, 3))), 0)

    def test_a_vortex_has_half(self):
        x, y = np.meshgrid(np.arange(33) - 15.8, np.arange(30) - 14.7)
        t = np.pi / 2 * np.minimum(1, np.hypot(x, y) / 12)
        p = np.arctan2(y, x) + np.pi / 2
        for core in (1, -1):
            m = np.stack((np.sin(t) * np.cos(p), np.sin(t) * np.sin(p),
                          core * np.where(t < np.pi / 2, np.cos(t), 0)), -1)
            self.assertAlmostEqual(cayspin.topological_charge(m), core / 2, delta=1e-12)

    def test_planes_of_any_spins(self):
        m = random_spins((2, 3, 8, 7), 5)
        periodic = cayspin.topological_charge(m, ("periodic", "periodic"))
        self.assertEqual(periodic.shape, (2, 3))
        np.testing.assert_allclose(periodic, np.rint(periodic), atol=1e-12)
        self.assertGreater(np.abs(periodic).max(), 0)
        for boundary in (("open", "open"), ("periodic", "open")):
            charges = cayspin.topological_charge(m, boundary)
            self.assertEqual(charges[1, 2], cayspin.topological_charge(m[1, 2], boundary))
        turned = cayspin.topological_charge(m.swapaxes(2, 3)[..., [1, 0, 2]], ("open", "periodic"))
        np.testing.assert_allclose(turned, cayspin.topological_charge(m, ("periodic", "open")),
                                   atol=1e-12)
        for shape in ((1, 7), (7, 1), (1, 1)):
            self.assertEqual(cayspin.topological_charge(random_spins(shape, 1), ("periodic",) * 2), 0)

    def test_the_numbers_of_the_library(self):
        # tests/observer/topological_charge.cpp has the same spins and charges.
        x, y = np.meshgrid(np.arange(7), np.arange(5))
        t, p = 1.1 * x - 0.9 * y, 0.7 * x + 0.3 * y * y
        m = np.stack((np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)), -1)
        for words, expected in ((("open", "open"), -0.10304446296151243),
                                (("periodic", "open"), -0.3669102399005671),
                                (("open", "periodic"), -0.8933656985875352)):
            self.assertAlmostEqual(cayspin.topological_charge(m, words), expected, delta=1e-12)

    def test_antiparallel_spins_enclose_nothing(self):
        sign = np.random.default_rng(1).choice([-1, 1], (40, 40, 1))
        for direction in random_spins((5,), 2):
            charge = cayspin.topological_charge(sign * direction, ("periodic", "periodic"))
            self.assertAlmostEqual(charge, 0, delta=1e-12)

    def test_wrong_calls(self):
        m = np.ones((4, 4, 3))
        for part, arguments in (("of shape (4, 3)", (m[0],)), ("of shape (4, 4, 2)", (m[..., :2],)),
                                ("'closed'", (m, ("open", "closed"))),
                                ("two words", (m, ("open",) * 3))):
            self.assert_refused(cayspin.CayspinError, part, cayspin.topological_charge, *arguments)


def wave(shape, frames, dt, numbers, turns, amplitude=0.01, positions=((0, 0, 0),)):
    """Returns a spin wave of wave vector numbers / shape, (frame, site, nz, ny, nx, 3), and its
    angular frequency. The wave turns about z `turns` times in all, right-handed if `turns` is
    positive, and runs along its wave vector."""
    nx, ny, nz = shape
    z, y, x = np.meshgrid(np.arange(nz), np.arange(ny), np.arange(nx), indexing="ij")
    time = np.arange(frames) * dt
    w = 2 * np.pi * turns / (frames * dt)
    found = np.empty((frames, len(positions), nz, ny, nx, 3))
    for site, (a, b, c) in enumerate(positions):
        k = 2 * np.pi * np.divide(numbers, shape)
        phase = k[0] * (x + a) + k[1] * (y + b) + k[2] * (z + c) - w * time[:, None, None, None]
        found[:, site] = np.stack((amplitude * np.cos(phase), -amplitude * np.sin(phase),
                                   np.full(phase.shape, math.sqrt(1 - amplitude**2))), -1)
    return found, w


class Dispersions(PackageTest):
    FULL = [(-0.5, 0, 0), (0, 0, 0), (0.5, 0, 0)]

    def peak(self, found):
        """Returns the wave vector and the frequency of the peak. Expects less than 1e-3 of its
        intensity elsewhere."""
        place = np.unravel_index(found.intensity.argmax(), found.intensity.shape)
        there = np.abs(found.frequency - found.frequency[place[1]]) < 2.5 * found.resolution
        rest = found.intensity.copy()
        rest[place[0], there] = 0
        self.assertLess(rest.max(), 1e-3 * found.intensity.max())
        return found.wave_vectors[place[0]], found.frequency[place[1]]

    def test_a_magnon_is_at_its_wave_vector_and_frequency(self):
        for number in (3, -3, 0, 7):
            for turns in (10, -10, 21.3):
                m, w = wave((16, 1, 1), 128, 0.25, (number, 0, 0), turns)
                found = cayspin.dispersion(m[:, 0], 0.25, self.FULL)
                k, frequency = self.peak(found)
                self.assertEqual(k.tolist(), [number / 16, 0, 0])
                self.assertLessEqual(abs(frequency - w), found.resolution / 2 + 1e-9)

    def test_a_spin_in_a_field_has_a_positive_frequency(self):
        # The library's equation of motion is m' = -m x H: a spin precesses right-handed about H.
        w = 0.5
        of = scene(system={"kind": "llg", "damping": 0.0}, lattice={"boundary": "open"},
                   field={"exchange": None, "anisotropy": None, "slab_demag": None, "mu0": None,
                          "applied": [0, 0, w]}, initial={"uniform": [0.1, 0, 1]})
        sim, frames = cayspin.Simulation(of), []
        for _ in range(200):
            frames.append(sim.spins.copy())
            sim.step(10)
        found = cayspin.dispersion(np.array(frames), 0.5, [(0, 0, 0), (0, 0, 0.5)], about=(0, 0, 1))
        self.assertLess(abs(found.peak()[0] - w), found.resolution)

    def test_the_equal_time_sum(self):
        m = random_spins((40, 3, 4, 5), 3)
        found = cayspin.dispersion(m, 0.1, [(0, 0, 0), (0.4, 0, 0)], about=(0, 0, 1))
        window = np.sin(np.pi * (np.arange(40) + 0.5) / 40)**2
        for number in range(3):
            phase = np.exp(-2j * np.pi * number / 5 * np.arange(5))
            sums = ((m[..., 0] - 1j * m[..., 1]) * phase).sum((1, 2, 3))
            expected = (np.abs(sums)**2 * window**2).sum() / (window**2).sum() / 60
            self.assertAlmostEqual(found.intensity[number].sum() / expected, 1, delta=1e-12)
        # Two equal sites at one place double the sum. Its square is divided by twice the number of
        # sites.
        twice = cayspin.dispersion(np.stack((m, m), 1), 0.1, [(0, 0, 0), (0.4, 0, 0)],
                                   positions=np.zeros((2, 3)), about=(0, 0, 1))
        np.testing.assert_allclose(twice.intensity, 2 * found.intensity, rtol=1e-12)

    def test_sites_of_a_cell(self):
        # bcc: (1, 1, 0) is a vector of its reciprocal lattice, (1, 0, 0) is not.
        positions = [(0, 0, 0), (0.5, 0.5, 0.5)]
        m, w = wave((8, 4, 2), 96, 0.2, (2, 0, 0), 15, positions=positions)
        path = [(0, 0, 0), (2.5, 0, 0)]
        found = cayspin.dispersion(m, 0.2, path, positions=positions)
        largest = found.intensity.max(axis=1)
        self.assertEqual(found.wave_vectors[:, 0].tolist(), [i / 8 for i in range(21)])
        at = np.flatnonzero(largest > 1e-6 * largest.max())
        self.assertEqual(found.wave_vectors[at, 0].tolist(), [0.25, 2.25])
        self.assertLess(np.abs(found.peak()[at] - w).max(), found.resolution / 2 + 1e-9)
        diagonal = cayspin.dispersion(m, 0.2, [(0.25, 0, 0), (1.25, 1, 0)], positions=positions)
        largest = diagonal.intensity.max(axis=1)
        self.assertGreater(min(largest[0], largest[-1]), 0.99 * largest.max())

    def test_paths(self):
        m = np.broadcast_to([0, 0, 1.0], (6, 6, 4, 12, 3))
        cell = [[2, 0, 0], [0, 3, 0], [0, 0, 1]]
        path = [(0, 0, 0), (0.5, 0, 0), (0.5, 0.5, 0), (0, 0, 0), (1 / 3, 0, 1 / 3)]
        found = cayspin.dispersion(m, 1.0, path, cell=cell, labels="ABCAD")
        self.assertEqual(found.labels, list("ABCAD"))
        steps = [np.pi / 2, np.pi / 3, math.hypot(np.pi / 2, np.pi / 3),
                 math.hypot(np.pi / 3, 2 * np.pi / 3)]
        np.testing.assert_allclose(found.corners, np.concatenate(([0], np.cumsum(steps))))
        expected = [(i / 12, 0, 0) for i in range(7)] + [(0.5, 0.25, 0), (0.5, 0.5, 0)]
        expected += [(0.25, 0.25, 0), (0, 0, 0), (1 / 6, 0, 1 / 6), (1 / 3, 0, 1 / 3)]
        np.testing.assert_allclose(found.wave_vectors, expected, atol=1e-12)
        cartesian = found.wave_vectors * 2 * np.pi / [2, 3, 1]
        np.testing.assert_allclose(np.diff(found.distance),
                                   np.linalg.norm(np.diff(cartesian, axis=0), axis=1))
        self.assertEqual(found.intensity.shape, (len(expected), 6))
        self.assertTrue((np.diff(found.frequency) > 0).all())
        # From M to the centre of a hexagonal zone, and on to K.
        hexagonal = [[1, 0, 0], [0.5, math.sqrt(0.75), 0], [0, 0, 1]]
        found = cayspin.dispersion(m, 1.0, [(0.5, 0, 0), (0, 0, 0), (2 / 3, 1 / 3, 0)],
                                   cell=hexagonal)
        np.testing.assert_allclose(np.diff(found.corners),
                                   [2 * np.pi / math.sqrt(3), 4 * np.pi / 3])
        # A corner between the lattice's wave vectors has a place on the axis but is not in the list
        # of wave vectors.
        odd = cayspin.dispersion(m[..., :9, :], 1.0, [(0, 0, 0), (0.5, 0, 0), (0, 0, 0)])
        self.assertEqual([round(9 * k) for k in odd.wave_vectors[:, 0]],
                         [0, 1, 2, 3, 4, 4, 3, 2, 1, 0])
        self.assertEqual(odd.labels[1], "(0.5, 0, 0)")

    def test_components(self):
        m, w = wave((16, 1, 1), 64, 0.25, (3, 0, 0), 8)
        along_x = m[..., [2, 0, 1]]  # the same wave, turning about x
        path = self.FULL
        about_x = cayspin.dispersion(along_x, 0.25, path)
        np.testing.assert_allclose(about_x.intensity, cayspin.dispersion(m, 0.25, path).intensity,
                                   atol=1e-12)
        back = cayspin.dispersion(m, 0.25, path, about=(0, 0, -1))
        k, frequency = self.peak(back)
        self.assertEqual(k.tolist(), [-3 / 16, 0, 0])
        self.assertLess(abs(frequency + w), back.resolution)
        both = cayspin.dispersion(m, 0.25, path, component="y")
        self.assertLess(abs(both.peak()[8 + 3] - w), both.resolution)
        self.assertLess(abs(both.peak()[8 - 3] + w), both.resolution)

    def test_open_ends_are_windowed(self):
        # 5.5 waves fit in: without a window, the jump between the ends would show at all wave
        # vectors.
        m, _ = wave((32, 1, 1), 64, 0.25, (5.5, 0, 0), 8)
        up, open_along_x = (0, 0, 1), (False, True, True)
        sharp = cayspin.dispersion(m, 0.25, self.FULL, periodic=open_along_x, about=up)
        blunt = cayspin.dispersion(m, 0.25, self.FULL, about=up)
        far = np.abs(32 * sharp.wave_vectors[:, 0] - 5.5) > 4
        self.assertLess(sharp.intensity[far].max(), 1e-3 * sharp.intensity.max())
        self.assertGreater(blunt.intensity[far].max(), 1e-3 * blunt.intensity.max())

    def test_wrong_calls(self):
        m = np.broadcast_to([0, 0, 1.0], (8, 2, 2, 6, 3))
        turning = m * np.array([1, -1] * 4).reshape(8, 1, 1, 1, 1)
        path = [(0, 0, 0), (0.5, 0, 0)]
        for part, arguments, options in (
                ("spins of shape (2, 2, 6, 3)", (m[0], 1, path), {}),
                ("3 frames", (m[:3], 1, path), {}),
                ("dt 0", (m, 0, path), {}),
                ("a path of shape (2, 2)", (m, 1, [(0, 0), (1, 1)]), {}),
                ("stands still", (m, 1, [(0, 0, 0), (0, 0, 0)]), {}),
                ("no wave vector of 6 x 2 x 2 cells", (m, 1, [(0, 0.2, 0), (0.5, 0.2, 0)]), {}),
                ("no volume", (m, 1, path), {"cell": np.ones((3, 3))}),
                ("no positions", (np.stack((m, m), 1), 1, path), {}),
                ("accepted: (1, 3)", (m, 1, path), {"positions": np.zeros((2, 3))}),
                ("3 labels", (m, 1, path), {"labels": "ABC"}),
                ("component 'w'", (m, 1, path), {"component": "w"}),
                ("periodic (True,)", (m, 1, path), {"periodic": (True,)}),
                ("no mean direction", (turning, 1, path), {})):
            self.assert_refused(cayspin.CayspinError, part, cayspin.dispersion, *arguments,
                                **options)


def correlated(count, factor, generator):
    """Returns numbers of variance 1, each `factor` times the previous one plus noise: AR(1)."""
    noise = generator.standard_normal(count) * math.sqrt(1 - factor**2)
    values, value = np.empty(count), generator.standard_normal()
    for i in range(count):
        value = factor * value + noise[i]
        values[i] = value
    return values


class Averages(PackageTest):
    def test_errors_of_correlated_numbers(self):
        generator = np.random.default_rng(11)
        for factor in (0.0, 0.5, 0.9):
            count = 30000
            runs = np.stack([correlated(count, factor, generator) for _ in range(16)], 1)
            found = cayspin.average(runs)
            known = math.sqrt((1 + factor) / (1 - factor) / count)
            self.assertAlmostEqual(np.sqrt((found.error**2).mean()) / known, 1, delta=0.06)
            self.assertLess(np.abs(found.error / known - 1).max(), 0.25)
            self.assertLess(np.abs(found.mean).max(), 4 * known)
            expected = (2 * count * ((1 + factor) / (1 - factor))**2)**(1 / 3)
            self.assertTrue(((found.block > expected / 2) & (found.block < 4 * expected)).all())

    def test_shapes_and_skipped_values(self):
        values = np.random.default_rng(2).standard_normal((3000, 2, 3))
        values[:100] = 50
        found = cayspin.average(values, skip=100)
        self.assertEqual((found.mean.shape, found.error.shape, found.block.shape), ((2, 3),) * 3)
        one = cayspin.average(values[100:, 1, 2])
        self.assertAlmostEqual(found.mean[1, 2], one.mean, delta=1e-14)
        self.assertEqual((found.error[1, 2], found.block[1, 2]), (one.error, one.block))
        self.assertIsInstance(one.mean, float)

    def test_few_and_equal_values(self):
        mean, error, block = cayspin.average(np.arange(64.0))  # one long drift
        self.assertEqual((mean, block), (31.5, 0))
        self.assertTrue(math.isnan(error))
        self.assertTrue(math.isnan(cayspin.average([3.0]).error))
        self.assertEqual(cayspin.average([0.1] * 50)[1:], (0, 1))
        self.assert_refused(cayspin.CayspinError, "without the first 2", cayspin.average, [1, 2], 2)
        self.assert_refused(cayspin.CayspinError, "of shape ()", cayspin.average, 1.0)


class Files(PackageTest):
    def run_file(self, **tables):
        file = self.folder / "run.h5"
        cayspin.Simulation(scene(**tables)).run(output=file, overwrite=True)
        return file

    def test_charges_take_the_boundary_of_the_scene(self):
        with cayspin.open(self.run_file(output={"every": 10})) as run:
            expected = cayspin.topological_charge(run.spins[:], ("periodic", "open"))
            np.testing.assert_array_equal(run.topological_charge(), expected)
            self.assertEqual(expected.shape, (5, 2))
            other = cayspin.topological_charge(run.spins[:])
            self.assertGreater(np.abs(other - expected).max(), 0.01)
            np.testing.assert_array_equal(run.topological_charge(("open", "open")), other)

    def test_dispersion_of_a_chain(self):
        start = np.zeros((1, 1, 24, 3))
        start[..., :2] = 1e-3 * np.random.default_rng(1).standard_normal((1, 1, 24, 2))
        start[..., 2] = 1
        file = self.folder / "magnons.h5"
        chain = cayspin.Scene(
            system={"kind": "llg", "damping": 0.0},
            lattice={"shape": [24], "spacing": 0.5, "boundary": "periodic"},
            field={"exchange": 0.7, "applied": [0, 0, 0.5],
                   "anisotropy": {"constant": 0.3, "axis": [0, 0, 1]}},
            initial=start, integrator={"method": "rkmk4", "dt": 0.05, "steps": 6001},
            output={"every": 4})
        cayspin.Simulation(chain).run(output=file)
        with cayspin.open(file) as run:
            self.assert_refused(cayspin.CayspinError, "slice(0, -1)", run.dispersion,
                                [(0, 0, 0), (0.5, 0, 0)])
            found = run.dispersion([(-0.5, 0, 0), (0.5, 0, 0)], frames=slice(0, -1))
            self.assert_refused(cayspin.CayspinError, "3 frames", run.dispersion,
                                [(0, 0, 0), (0.5, 0, 0)], slice(0, 3))
            self.assert_refused(cayspin.CayspinError, "back in time", run.dispersion,
                                [(0, 0, 0), (0.5, 0, 0)], slice(-2, None, -1))
        self.assertEqual(len(found.distance), 25)
        self.assertAlmostEqual(found.corners[-1], 2 * np.pi / 0.5)
        k = 2 * np.pi * found.wave_vectors[:, 0]
        scale = 0.7 / 0.5**2
        expected = 2 * scale * (1 - np.cos(k)) + 0.3 + 0.5
        self.assertLess(np.abs(found.peak() - expected).max(), found.resolution)

    def test_the_file_of_a_crystal(self):
        file = self.run_file(output={"every": 10})
        with cayspin.open(file) as run:
            self.assert_refused(AttributeError, "no sublattice_magnetization", getattr, run,
                                "sublattice_magnetization")
        means = random_spins((5, 2), 3)
        spins = random_spins((5, 2, 1, 3, 7), 4)
        with h5py.File(file, "r+") as changed:
            del changed["spins"], changed["checksum"]
            changed["spins"] = spins
            changed["sublattice_magnetization"] = means
        with cayspin.open(file) as run:
            np.testing.assert_array_equal(run.sublattice_magnetization[:], means)
            self.assertEqual(run.topological_charge().shape, (5, 2, 1))
            self.assertIn("7 x 3 x 1", repr(run))


if __name__ == "__main__":
    unittest.main()
