# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""cayspin.path from one state finds a way out of it: checked by the gradients and Hessians of small
clusters, and beside saddles that Newton's method finds from random states."""

import unittest

import cayspin
import numpy as np
from package_test import PackageTest


class Cluster:
    """A chain of spins with E = s.M s / 2 - h.s up to a constant, as M and h of all components."""

    def __init__(self, seed):
        draw = np.random.default_rng(seed)
        n = int(draw.integers(1, 5))
        exchange, applied = draw.uniform(0.05, 0.4), draw.uniform(-0.15, 0.15, 3)
        axes = draw.normal(size=(2, 3))
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        easy, hard = draw.uniform(0.8, 1.5, n), draw.uniform(0.2, 0.5)
        self.count = n
        self.scene = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1}, lattice={"shape": [n]},
            field={"exchange": exchange, "applied": list(applied),
                   "anisotropy": [{"constant": easy[None, None],
                                   "axis": list(axes[0])},
                                  {"constant": -hard, "axis": list(axes[1])}]},
            initial={"random": {"seed": int(draw.integers(1000))}})
        self.matrix = np.zeros((3 * n, 3 * n))
        for i in range(n):
            mine = slice(3 * i, 3 * i + 3)
            self.matrix[mine, mine] = (hard * np.outer(axes[1], axes[1]) -
                                       easy[i] * np.outer(axes[0], axes[0]))
            if i + 1 < n:
                next_one = slice(3 * i + 3, 3 * i + 6)
                self.matrix[mine, next_one] = self.matrix[next_one, mine] = -exchange * np.eye(3)
        self.applied = np.tile(applied, n)

    def energy(self, s):
        return s @ self.matrix @ s / 2 - self.applied @ s

    def tangent(self, s):
        """Returns the gradient and the Hessian in a basis of the tangent planes, and the basis."""
        basis = np.zeros((3 * self.count, 2 * self.count))
        gradient = self.matrix @ s - self.applied
        along = np.zeros_like(self.matrix)
        for i in range(self.count):
            mine = slice(3 * i, 3 * i + 3)
            spin = s[mine]
            one = np.cross(spin, np.eye(3)[np.argmin(np.abs(spin))])
            one /= np.linalg.norm(one)
            basis[mine, 2 * i], basis[mine, 2 * i + 1] = one, np.cross(spin, one)
            along[mine, mine] = spin @ gradient[mine] * np.eye(3)
        return basis.T @ gradient, basis.T @ (self.matrix - along) @ basis, basis

    def moved(self, s, step):
        spins = (s + step).reshape(-1, 3)
        return (spins / np.linalg.norm(spins, axis=1)[:, None]).ravel()

    def saddles(self, draw, tries=60):
        """Returns some saddles with one direction of descent, found by Newton's method."""
        found = []
        for _ in range(tries):
            s = self.moved(draw.normal(size=3 * self.count), 0)
            for _ in range(60):
                gradient, hessian, basis = self.tangent(s)
                if np.abs(gradient).max() < 1e-13:
                    break
                step = np.linalg.lstsq(hessian, -gradient, rcond=None)[0]
                s = self.moved(s, basis @ step * min(1, 0.4 / np.linalg.norm(step)))
            gradient, hessian, basis = self.tangent(s)
            values, vectors = np.linalg.eigh(hessian)
            if (np.abs(gradient).max() < 1e-11 and (values < 0).sum() == 1 and
                    all(np.abs(s - other).max() > 1e-5 for other, _ in found)):
                found.append((s, basis @ vectors[:, 0]))
        return found

    def fallen(self, s):
        for _ in range(4000):
            gradient, _, basis = self.tangent(s)
            s = self.moved(s, basis @ (-0.1 * gradient))
            if np.abs(gradient).max() < 1e-9:
                break
        return s


class Escapes(PackageTest):
    def test_the_lowest_saddle_of_random_clusters(self):
        scenes, lowest, found = 24, 0, 0
        for seed in range(scenes):
            with self.subTest(seed=seed):
                cluster = Cluster(seed)
                start = cayspin.Simulation(cluster.scene).spins
                try:
                    path = cayspin.path(cluster.scene, start, torque=1e-9)
                except cayspin.NumbersFailed as none:
                    self.assertRegex(str(none), "path: no saddle found, after")
                    continue
                self.assertTrue(path.converged, path.end)
                found += 1
                ends = [path.spins[image].astype(float).ravel() for image in (0, -1)]
                saddle = path.saddle.astype(float).ravel()
                for end in ends:
                    gradient, hessian, _ = cluster.tangent(end)
                    self.assertLess(np.abs(gradient).max(), 1e-8)
                    self.assertGreater(np.linalg.eigvalsh(hessian)[0], 0)
                self.assertGreater(np.abs(ends[0] - ends[1]).max(), 0.1)
                gradient, hessian, basis = cluster.tangent(saddle)
                self.assertLess(np.abs(gradient).max(), 1e-8)
                values, vectors = np.linalg.eigh(hessian)
                self.assertLess(values[0], 0)
                self.assertGreater(values[1], 0)
                self.assertAlmostEqual(path.saddle_curvature, values[0], delta=1e-5)
                barrier = cluster.energy(saddle) - cluster.energy(ends[0])
                self.assertAlmostEqual(path.barrier_forward, barrier, delta=1e-11)
                self.assertEqual(path.energy.max(), path.saddle_energy)
                if len(path.saddles) == 1:  # the energy falls from the saddle to both ends
                    down = basis @ vectors[:, 0]
                    sides = [cluster.fallen(cluster.moved(saddle, way * down))
                             for way in (0.01, -0.01)]
                    apart = [[np.abs(side - end).max() for end in ends] for side in sides]
                    self.assertLess(min(max(apart[0][0], apart[1][1]),
                                        max(apart[0][1], apart[1][0])), 1e-5)
                barriers = []
                for state, down in cluster.saddles(np.random.default_rng(1000 + seed)):
                    sides = [cluster.fallen(cluster.moved(state, way * down))
                             for way in (0.01, -0.01)]
                    back = [np.abs(side - ends[0]).max() < 1e-5 for side in sides]
                    if sum(back) == 1:
                        barriers.append(cluster.energy(state) - cluster.energy(ends[0]))
                lowest += path.barrier_forward < min(barriers, default=np.inf) + 1e-9
        self.assertGreaterEqual(found, 0.9 * scenes)
        self.assertGreaterEqual(lowest, 0.8 * scenes)

    def test_refusals(self):
        error, cluster = cayspin.CayspinError, Cluster(1)
        state = np.tile([0.0, 0.0, 1.0], (1, 1, cluster.count, 1))
        self.assert_refused(error, "path: modes 3: `end` is given; accepted: one of them",
                            cayspin.path, cluster.scene, state, -state, modes=3)
        self.assert_refused(error, "path: start", cayspin.path, cluster.scene, None)
        self.assert_refused(error, "path: modes 0; accepted: a whole number from 1 to 100",
                            cayspin.path, cluster.scene, state, modes=0)
        self.assert_refused(error, "path: modes: 2.5; accepted: a whole number", cayspin.path,
                            cluster.scene, state, modes=2.5)


if __name__ == "__main__":
    unittest.main()
