# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The rate of a particle across its barrier in thermal runs, compared with cayspin.path and the
lowest eigenvalue of Brown's equation, whose only approximation is a finite basis."""

import unittest

import cayspin
import numpy as np
from package_test import PackageTest

EASY, DAMPING = 1.0, 0.5


def brown(barrier, functions=24):
    """Returns the lowest eigenvalue of -[(1 - x^2) f']' - 2 * barrier * x * (1 - x^2) f' for odd
    f."""
    x, weight = np.polynomial.legendre.leggauss(200)
    weight = weight * np.exp(barrier * (x**2 - 1))
    degrees = 2 * np.arange(functions) + 1
    f = np.array([np.polynomial.legendre.Legendre.basis(n)(x) for n in degrees])
    slope = np.array([np.polynomial.legendre.Legendre.basis(n).deriv()(x) for n in degrees])
    stiffness = (slope * weight * (1 - x**2)) @ slope.T
    return np.linalg.eigvals(np.linalg.solve((f * weight) @ f.T, stiffness)).real.min()


def scene(shape, **tables):
    return cayspin.Scene(system={"kind": "llg", "damping": DAMPING}, lattice={"shape": shape},
                         field={"anisotropy": {"constant": EASY, "axis": [0, 0, 1]}},
                         initial={"uniform": [0, 0, 1]}, **tables)


class SwitchingRates(PackageTest):
    def langer(self, barrier):
        """Returns the rate of cayspin.path at the temperature at which the barrier is `barrier` *
        kT."""
        up = np.array([[[[0, 0, 1.0]]]])
        path = cayspin.path(scene([1]), up, -up, torque=1e-9, rates=True)
        self.assertEqual(path.zero_modes, (0, 1, 0))
        temperature = path.barrier_forward / barrier
        return path.langer_forward / np.sqrt(temperature) * np.exp(-barrier)

    def exact(self, barrier):
        return 0.5 * DAMPING * (0.5 * EASY / barrier) * brown(barrier)

    def test_high_barriers(self):
        # The ratio is 1 + 1 / barrier up to terms of higher order.
        for barrier in (12, 20):
            self.assertAlmostEqual(self.langer(barrier) / self.exact(barrier), 1 + 1 / barrier,
                                   delta=4 / barrier**2)

    def test_thermal_runs(self):
        for barrier, end in ((4, 40.0), (6, 160.0)):
            temperature = 0.5 * EASY / barrier
            sim = cayspin.Simulation(scene(
                [256, 256], thermal={"temperature": temperature, "seed": 7},
                integrator={"method": "heun", "dt": 0.025}))
            sim.run(until=10.0, output=False)  # each well is in equilibrium
            first = sim.spins[..., 2].ravel().copy()
            sim.run(until=10.0 + end, output=False)
            last = sim.spins[..., 2].ravel()

            def rate(chosen):
                return 0.5 * np.log(first[chosen].mean() / last[chosen].mean()) / end

            blocks = np.arange(first.size) % 64
            others = np.array([rate(blocks != one) for one in range(64)])
            error = np.sqrt(63 * np.mean((others - others.mean())**2))
            measured, exact = rate(blocks >= 0), self.exact(barrier)
            self.assertLess(error, 0.015 * exact)
            self.assertLess(abs(measured - exact), 3 * error, (barrier, measured / exact))
            self.assertAlmostEqual(self.langer(barrier) / measured, 1 + 1 / barrier,
                                   delta=4 / barrier**2)


if __name__ == "__main__":
    unittest.main()
