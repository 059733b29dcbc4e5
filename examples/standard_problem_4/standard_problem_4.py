#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The micromagnetic standard problem 4 from Python, in SI units.

A film of permalloy rests in its S state, and two fields switch it. The demagnetising field is a
function of the program: Newell's tensor and FFTs of numpy.

Usage: standard_problem_4.py       prints <m> beside what the tests of mumax3 expect
"""
import sys

import numpy as np

import cayspin

MU0, MS, GAMMA0 = 4e-7 * np.pi, 8e5, 2.211e5  # SI
CELLS = (128, 32, 1)
SIZE = (500e-9 / 128, 125e-9 / 32, 3e-9)
FIELDS = {"field 1": (-24.6e-3, 4.3e-3, 0.0), "field 2": (-35.5e-3, -6.3e-3, 0.0)}  # T
MUMAX3 = {"at rest": ((0.9669684, 0.1252733, 0.0), 1e-4),
          "field 1": ((-0.9846124, 0.1260409, 0.0432712), 6e-3),
          "field 2": ((-0.9692332, -0.1203954, -0.0053076), 4e-3)}


def newell_f(x, y, z):
    """Returns f of Newell, Williams and Dunlop 1993, eq. 27."""
    xx, yy, zz = x * x, y * y, z * z
    r = np.sqrt(xx + yy + zz)
    with np.errstate(divide="ignore", invalid="ignore"):
        terms = (y * (zz - xx) / 2 * np.arcsinh(y / np.sqrt(xx + zz)),
                 z * (yy - xx) / 2 * np.arcsinh(z / np.sqrt(xx + yy)),
                 -x * y * z * np.arctan(y * z / (x * r)))
    return sum(np.nan_to_num(term) for term in terms) + (2 * xx - yy - zz) * r / 6


def newell_g(x, y, z):
    """Returns g of Newell, Williams and Dunlop 1993, eq. 32."""
    xx, yy, zz = x * x, y * y, z * z
    r = np.sqrt(xx + yy + zz)
    with np.errstate(divide="ignore", invalid="ignore"):
        terms = (x * y * z * np.arcsinh(z / np.sqrt(xx + yy)),
                 y * (3 * zz - yy) / 6 * np.arcsinh(x / np.sqrt(yy + zz)),
                 x * (3 * zz - xx) / 6 * np.arcsinh(y / np.sqrt(xx + zz)),
                 -z * zz / 6 * np.arctan(x * y / (z * r)),
                 -z * yy / 2 * np.arctan(x * z / (y * r)),
                 -z * xx / 2 * np.arctan(y * z / (x * r)))
    return sum(np.nan_to_num(term) for term in terms) - x * y * r / 3


def interaction(function, axes):
    """Returns an element of the tensor at offsets 0 to n - 1 along x, y and z: minus the second
    differences of `function` along the three axes in turn, divided by 4 * pi * (volume of a cell).
    """
    size = np.array(SIZE, dtype=np.longdouble) / SIZE[2]
    grid = np.meshgrid(*(np.arange(-1, n + 1) * d for n, d in zip(CELLS, size)), indexing="ij")
    values = function(*(grid[axis] for axis in axes))
    for axis in range(3):
        n = values.shape[axis]
        before, here, after = (np.take(values, range(k, n - 2 + k), axis) for k in range(3))
        values = 2 * here - before - after
    return (values / (4 * np.pi * np.prod(size))).astype(float)


class DemagnetisingField:
    """A callable that returns mu0 H of all cells in tesla, from their spins."""

    def __init__(self):
        self.tensor = {}
        for a, b, function, axes in ((0, 0, newell_f, (0, 1, 2)), (1, 1, newell_f, (1, 0, 2)),
                                     (2, 2, newell_f, (2, 1, 0)), (0, 1, newell_g, (0, 1, 2))):
            n = interaction(function, axes)[:, :, 0]
            whole = np.zeros((2 * CELLS[0], 2 * CELLS[1]))
            odd = -1 if a != b else 1  # N_xy changes its sign with x and with y
            whole[:CELLS[0], :CELLS[1]] = n
            whole[CELLS[0] + 1:, :CELLS[1]] = odd * n[:0:-1]
            whole[:CELLS[0], CELLS[1] + 1:] = odd * n[:, :0:-1]
            whole[CELLS[0] + 1:, CELLS[1] + 1:] = n[:0:-1, :0:-1]
            # For one layer N_xz and N_yz are 0, and all transforms are real.
            self.tensor[a, b] = -MU0 * MS * np.fft.rfft2(whole.T).real

    def __call__(self, spins, t):
        nx, ny, _ = CELLS
        m = [np.fft.rfft2(spins[0, :, :, c], (2 * ny, 2 * nx)) for c in range(3)]
        n = self.tensor
        h = (n[0, 0] * m[0] + n[0, 1] * m[1], n[0, 1] * m[0] + n[1, 1] * m[1], n[2, 2] * m[2])
        return np.stack([np.fft.irfft2(one)[:ny, :nx] for one in h], axis=-1)[None]


def film(demagnetising_field, alpha, **tables):
    field = {"nonlocal": demagnetising_field, **tables.pop("field", {})}
    return cayspin.Scene(
        units="SI",
        material={"Ms": MS, "A": 1.3e-11, "alpha": alpha, "damping_form": "gilbert",
                  "gamma": GAMMA0 / MU0},
        lattice={"shape": list(CELLS), "spacing": list(SIZE)}, field=field, **tables)


def relax(demagnetising_field):
    """Returns the S state, reached by overdamped motion from (1, 0.1, 0)."""
    scene = film(demagnetising_field, 1.0, system={"kind": "llg", "precession": False},
                 initial={"uniform": [1, 0.1, 0]}, integrator={"method": "heun", "dt": 1.2e-12})
    sim = cayspin.Simulation(scene)
    before = sim.spins
    while True:
        sim.step(100)
        if np.abs(sim.spins - before).max() < 1e-7:
            return sim.spins
        before = sim.spins


def main():
    demagnetising_field = DemagnetisingField()
    at_rest = relax(demagnetising_field)
    results = {"at rest": at_rest.mean(axis=(0, 1, 2))}
    for name, applied in FIELDS.items():
        scene = film(demagnetising_field, 0.02, system={"kind": "llg"}, initial=at_rest,
                     field={"applied": list(applied)},
                     integrator={"method": "rkmk4", "dt": 1e-9 / 2400, "end": 1e-9})
        sim = cayspin.Simulation(scene)
        crossing, last = [], [1.0]

        def look(sim):
            mx = sim.magnetization()[0]
            if not crossing and mx <= 0:
                crossing.append(sim.time - scene.dt * mx / (mx - last[0]))
            last[0] = mx

        sim.observe(1, look)
        sim.run()
        results[name] = sim.magnetization()
        print(f"{name}: <m_x> is zero at {1e9 * crossing[0]:.5f} ns")
    fine = True
    for name, m in results.items():
        theirs, limit = MUMAX3[name]
        apart = np.abs(np.subtract(m, theirs)).max()
        fine &= apart < limit
        print(f"{name:8} {m[0]:9.6f} {m[1]:9.6f} {m[2]:9.6f}   mumax3 "
              f"{theirs[0]:9.6f} {theirs[1]:9.6f} {theirs[2]:9.6f}   "
              f"apart {apart:.1e}, limit {limit:g}")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
