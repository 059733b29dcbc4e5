# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shared code of the tests of spectra: anisotropic chains, their linear theory, the sum rule."""

import cayspin
import numpy as np

EXCHANGE, ANISOTROPY, TEMPERATURE, DAMPING = 1.0, 1.0, 0.002, 0.02
SITES, REPLICAS, FRAMES, DT = 32, 32, 256, 0.4


def chain(**tables):
    """Returns a periodic chain with an easy axis along z."""
    return cayspin.Scene(**{
        "system": {"kind": "llg", "damping": DAMPING},
        "lattice": {"shape": [SITES], "boundary": "periodic"},
        "field": {"exchange": EXCHANGE,
                  "anisotropy": {"constant": ANISOTROPY, "axis": [0, 0, 1]}},
        "initial": {"uniform": [0, 0, 1]},
        "integrator": {"method": "heun", "dt": 0.05}, **tables})


def magnons(found, exchange=EXCHANGE, anisotropy=ANISOTROPY):
    """Returns the frequencies of linear theory at the wave vectors along x."""
    k = 2 * np.pi * found.wave_vectors[0, 0, :, 0]
    return 2 * exchange * (1 - np.cos(k)) + anisotropy


def sum_rule(found):
    return sum(found.integrated[word].mean() for word in ("xx", "yy", "zz"))


def modes_of(made):
    """Returns all modes of a scene, and its equilibrium."""
    sim = cayspin.Simulation(made)
    sim.relax()
    return sim.modes(int(np.prod(made.shape))), sim.spins
