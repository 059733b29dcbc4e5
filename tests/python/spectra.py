# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Structure factors of arrays with known answers, and of thermal runs against linear theory."""

import unittest

import cayspin
import numpy as np
from package_test import PackageTest, random_spins, scene
from spectra_test import (
    DAMPING, DT, FRAMES, REPLICAS, TEMPERATURE, chain, magnons, modes_of, sum_rule,
)


class Runs(PackageTest):
    def test_sum_rule(self):
        m = random_spins((12, 3, 4, 5), 1)
        for options in ({}, {"window": "none"}, {"periodic": (False, True, False)},
                        {"zones": (2, 1, 3)}):
            self.assertAlmostEqual(sum_rule(cayspin.structure_factor(m, 0.3, **options)), 1,
                                   delta=1e-12)
        some = m * (np.random.default_rng(2).random((3, 4, 5, 1)) < 0.6)  # sites without spin
        self.assertAlmostEqual(sum_rule(cayspin.structure_factor(some, 0.3)), 1, delta=1e-12)
        single = cayspin.structure_factor(m.astype(np.float32), 0.3)
        self.assertAlmostEqual(sum_rule(single), 1, delta=1e-7)

    def test_sum_rule_of_crystals(self):
        bcc = [(0, 0, 0), (0.5, 0.5, 0.5)]
        m = random_spins((10, 2, 3, 4, 5), 3)
        found = cayspin.structure_factor(m, 0.3, positions=bcc, zones=(2, 2, 2))
        self.assertEqual(found.wave_vectors.shape, (6, 8, 10, 3))
        self.assertEqual(found.intensity["xx"].shape, (6, 8, 10, 10))
        self.assertAlmostEqual(sum_rule(found), 1, delta=1e-12)
        first = cayspin.structure_factor(m, 0.3, positions=bcc)
        self.assertGreater(abs(sum_rule(first) - 1), 1e-3)
        for axis, extent in enumerate((5, 4, 3)):
            self.assertEqual(np.unique(found.wave_vectors[..., axis]).tolist(),
                             [n / extent for n in range(-extent, extent)])

    def test_the_formula(self):
        m = random_spins((10, 2, 2, 1, 3), 4)
        cell = np.array([[2.0, 0, 0], [0, 1, 0], [1, 0, 3]])
        positions = np.array([(0.1, 0.2, 0), (0.6, 0, 0.3)])
        words = ("xy", "zz", "total", "perpendicular")
        found = cayspin.structure_factor(m, 0.3, components=words, cell=cell, positions=positions,
                                         zones=(2, 1, 1))
        window = np.sin(np.pi * (np.arange(10) + 0.5) / 10)**2
        z, x = np.meshgrid(np.arange(2), np.arange(3), indexing="ij")
        corners = np.stack([x, 0 * x, z], -1)[:, None]  # (nz, ny, nx, 3)
        for index in ((0, 0, 1), (1, 0, 5), (1, 0, 3)):
            fractions = found.wave_vectors[index]
            k = 2 * np.pi * fractions @ np.linalg.inv(cell).T
            wave = sum(np.einsum("tzyxc,zyx->tc", m[:, s],
                                 np.exp(-1j * ((corners + positions[s]) @ cell) @ k))
                       for s in range(2)) / np.sqrt(12)
            for at in (0, 4, 5, 7):
                turns = np.exp(1j * found.frequency[at] * 0.3 * np.arange(10))
                f = (wave * (window * turns)[:, None]).sum(0)
                tensor = np.outer(f, f.conj()) * 0.3 / (2 * np.pi * (window**2).sum())
                across = np.eye(3) * (2 / 3 if not k.any() else 1)
                if k.any():
                    across = across - np.outer(k, k) / (k @ k)
                for word, expected in zip(words, (tensor[0, 1], tensor[2, 2], np.trace(tensor),
                                                  (across * tensor).sum())):
                    # The intensity does not depend on the time at which a run starts.
                    self.assertAlmostEqual(found.intensity[word][index][at], expected,
                                           delta=1e-12)
        for word in words:
            step = found.frequency[1] - found.frequency[0]
            np.testing.assert_allclose(found.integrated[word],
                                       found.intensity[word].sum(-1) * step, rtol=1e-12)

    def test_dispersion_has_the_same_numbers(self):
        m = random_spins((20, 2, 1, 4, 6), 5)
        options = {"positions": [(0, 0, 0), (0.3, 0.1, 0)], "periodic": (True, False, True)}
        found = cayspin.structure_factor(m, 0.2, **options)
        along = cayspin.dispersion(m, 0.2, [(0, 0, 0), (1 / 3, 0, 0)], component="y", **options)
        np.testing.assert_allclose(found.frequency, along.frequency)
        np.testing.assert_allclose(found.intensity["yy"][0, 2, 3:] * along.resolution,
                                   along.intensity, rtol=1e-10)
        both = cayspin.structure_factor(m, 0.2, components=("xx", "yy", "xy"), **options)
        right = both.intensity["xx"] + both.intensity["yy"] - 2 * both.intensity["xy"].imag
        about = cayspin.dispersion(m, 0.2, [(0, 0, 0), (1 / 3, 0, 0)], about=(0, 0, 1), **options)
        np.testing.assert_allclose(right[0, 2, 3:] * about.resolution, about.intensity, rtol=1e-9,
                                   atol=1e-15)

    def test_several_runs_are_averaged(self):
        runs = [random_spins((8, 1, 2, 4), seed) for seed in (6, 7, 8)]
        together = cayspin.structure_factor(runs, 0.5, components="zz")
        single = [cayspin.structure_factor(run, 0.5).intensity["zz"] for run in runs]
        np.testing.assert_allclose(together.intensity["zz"], np.mean(single, axis=0), rtol=1e-12)

    def test_the_mean_is_subtracted(self):
        m = random_spins((16, 1, 1, 6), 9)
        m[..., 2, :] = [0.6, 0, 0.8]
        weight = np.sin(np.pi * (np.arange(16) + 0.5) / 16)**4
        means = np.einsum("t,tzyxc->zyxc", weight / weight.sum(), m)
        found = cayspin.structure_factor(m, 0.5, subtract_mean=True)
        self.assertAlmostEqual(sum_rule(found), 1 - (means**2).sum() / 6, delta=1e-12)
        still = np.broadcast_to(random_spins((1, 1, 6), 9), (16, 1, 1, 6, 3))
        found = cayspin.structure_factor(still, 0.5, subtract_mean=True)
        self.assertLess(found.intensity["xx"].max(), 1e-28)
        elastic = cayspin.structure_factor(still, 0.5).intensity["xx"]
        self.assertLess(elastic[..., np.abs(np.arange(16) - 8) > 1].max(), 1e-28)

    def test_wrong_calls(self):
        m = random_spins((8, 1, 2, 3), 1)
        for part, arguments, options in (
                ("spins of shape (2, 3, 3)", (m[0, 0], 1), {}),
                ("3 frames", (m[:3], 1), {}),
                ("no runs", ([], 1), {}),
                ("runs of shapes", ([m, m[:5]], 1), {}),
                ("dt 0", (m, 0), {}),
                ("accepted: a number", (m, "fast"), {}),
                ("window 'flat'", (m, 1), {"window": "flat"}),
                ("subtract_mean: 2", (m, 1), {"subtract_mean": 2}),
                ("component 'xw'", (m, 1), {"components": ("xx", "xw")}),
                ("no components", (m, 1), {"components": ()}),
                ("zones (1, 0, 1)", (m, 1), {"zones": (1, 0, 1)}),
                ("zones (2, 2)", (m, 1), {"zones": (2, 2)}),
                ("no volume", (m, 1), {"cell": np.zeros((3, 3))}),
                ("no positions", (np.stack((m, m), 1), 1), {}),
                ("accepted: (1, 3)", (m, 1), {"positions": np.zeros((2, 3))}),
                ("periodic (True,)", (m, 1), {"periodic": (True,)}),
                ("no site has a spin", (0 * m, 1), {})):
            self.assert_refused(cayspin.CayspinError, part, cayspin.structure_factor, *arguments,
                                **options)


class Thermal(PackageTest):
    """Uses replicas of a chain in thermal equilibrium at a low temperature."""

    @classmethod
    def setUpClass(cls):
        ensemble = cayspin.EnsembleSimulation(chain(
            thermal={"temperature": TEMPERATURE, "seed": 5}, ensemble={"replicas": REPLICAS}))
        ensemble.step(4000)  # the slowest mode forgets its start as exp(-2 * 0.02 * 200)
        spins = []
        for _ in range(FRAMES):
            ensemble.step(8)
            spins.append(ensemble.spins)
        cls.found = cayspin.structure_factor(list(np.stack(spins, 1)), DT)
        modes, at_rest = modes_of(chain())
        cls.step = cls.found.frequency[1] - cls.found.frequency[0]
        fine = np.arange(cls.found.frequency[0] - 10, -cls.found.frequency[0] + 10, cls.step / 8)
        cls.linear = cayspin.linear_structure_factor(modes, TEMPERATURE, fine, spins=at_rest)
        cls.across = (cls.found.intensity["xx"] + cls.found.intensity["yy"])[0, 0]
        hann = np.sin(np.pi * (np.arange(FRAMES) + 0.5) / FRAMES)**2
        cls.hann, cls.share = hann, hann**2 / (hann**2).sum()

    def test_sum_rule(self):
        self.assertAlmostEqual(sum_rule(self.found), 1, delta=1e-12)

    def test_integrals_are_those_of_linear_theory(self):
        w = magnons(self.found)
        linear = (self.linear.integrated["xx"] + self.linear.integrated["yy"])[0, 0]
        np.testing.assert_allclose(linear, 2 * TEMPERATURE / w, rtol=1e-10)
        measured = (self.found.integrated["xx"] + self.found.integrated["yy"])[0, 0]
        # The intensity of a mode has an exponential distribution, and its correlation falls as
        # exp(-2 * damping * w * t). `integrated` has the mean of the modes k and -k.
        apart = np.abs(np.subtract.outer(np.arange(FRAMES), np.arange(FRAMES))) * DT
        variance = np.array([self.share @ np.exp(-2 * DAMPING * one * apart) @ self.share
                             for one in w]) / REPLICAS
        k = self.found.wave_vectors[0, 0, :, 0]
        variance[(k != 0) & (k != -0.5)] /= 2
        off = (measured / linear - 1) / np.sqrt(variance)
        once = off[k <= 0]  # values at k and -k are equal
        self.assertLess(np.abs(once).max(), 4)
        self.assertLess((once**2).mean(), 1 + 4 * np.sqrt(2 / len(once)))
        weights = 1 / variance[k <= 0]
        mean = (weights * (measured / linear - 1)[k <= 0]).sum() / weights.sum()
        self.assertLess(abs(mean), 4 / np.sqrt(weights.sum()))
        self.assertLess(4 / np.sqrt(weights.sum()), 0.07)

    def test_peaks_are_on_the_dispersion(self):
        above = self.found.frequency > 0
        peaks = self.found.frequency[above][self.across[:, above].argmax(1)]
        self.assertLess(np.abs(peaks - magnons(self.found)).max(), 1.5 * self.step)

    def test_lines_are_those_of_linear_theory(self):
        # The lines of linear theory, as the window of the run broadens them.
        fine = self.linear.frequency
        lines = (self.linear.intensity["xx"] + self.linear.intensity["yy"])[0, 0]
        waves = self.hann[:, None] * np.exp(-1j * np.outer(np.arange(FRAMES) * DT, fine))
        seen = np.fft.fftshift(np.abs(np.fft.ifft(waves, axis=0, norm="forward"))**2, axes=0)
        seen *= DT / (2 * np.pi * (self.hann**2).sum())
        expected = lines @ seen.T * (fine[1] - fine[0])
        inside = (self.found.frequency > 0) & (expected > 0.1 * expected.max(1, keepdims=True))
        ratio = self.across[inside] / expected[inside]
        # Intensities have an exponential distribution. With Hann's window, they have correlations
        # of 4/9 and 1/36 with the next two bins.
        error = np.sqrt((1 + 2 * (4 / 9 + 1 / 36)) / (REPLICAS * inside.sum()))
        self.assertLess(4 * error, 0.07)
        self.assertLess(abs(ratio.mean() - 1), 4 * error)
        self.assertLess(abs(ratio.std() * np.sqrt(REPLICAS) - 1), 0.3)


class Files(PackageTest):
    def test_a_trajectory(self):
        file = self.folder / "run.h5"
        made = scene(lattice={"boundary": ["periodic", "open", "open"]}, output={"every": 2})
        cayspin.Simulation(made).run(output=file)
        with cayspin.open(file) as run:
            found = run.structure_factor(slice(1, None), components="total")
            expected = cayspin.structure_factor(
                run.spins[1:], 0.1, components="total", cell=made.cell,
                periodic=(True, False, False))
            np.testing.assert_allclose(found.intensity["total"], expected.intensity["total"],
                                       rtol=1e-12)
            self.assert_refused(cayspin.CayspinError, "structure_factor: 3 frames",
                                run.structure_factor, slice(0, 3))
            self.assert_refused(cayspin.CayspinError, "accepted: a slice", run.structure_factor, 3)

    def test_an_ensemble(self):
        tables = {"thermal": {"temperature": 0.1}, "output": {"every": 2},
                  "integrator": {"method": "heun", "dt": 0.05, "steps": 20}}
        runs = self.run_program(chain(**tables, ensemble={"replicas": 3})).filename
        with cayspin.open(runs) as ensemble:
            spins = ensemble.spins[:]
            for chosen, shown in ((None, [0, 1, 2]), ([-1, 0], [2, 0])):
                found = ensemble.structure_factor(chosen)
                expected = cayspin.structure_factor([spins[:, one] for one in shown], 0.1)
                np.testing.assert_allclose(found.intensity["xx"], expected.intensity["xx"],
                                           rtol=1e-12)
            self.assert_refused(cayspin.CayspinError, "replica 3; accepted: -3 to 2",
                                ensemble.structure_factor, [3])
            self.assert_refused(cayspin.CayspinError, "no runs", ensemble.structure_factor, [])
        varied = self.run_program(chain(**tables, ensemble={
            "replicas": 2, "vary": {"thermal.temperature": [0.1, 0.2]}})).filename
        with cayspin.open(varied) as ensemble:
            self.assert_refused(cayspin.CayspinError, "differ in thermal.temperature",
                                ensemble.structure_factor)
            self.assertAlmostEqual(sum_rule(ensemble.structure_factor([1])), 1, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
