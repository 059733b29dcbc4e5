# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Means over time while a simulation runs."""

from __future__ import annotations

import collections
from typing import TYPE_CHECKING, Any

import numpy as np

from cayspin.observables import Average, average

if TYPE_CHECKING:
    from cayspin.simulation import Simulation


class Averages:
    """Running means from Simulation.averages(), over all samples or over the latest ones.

    Each mean is an Average with a standard error, as from average(). Mean and error are NaN before
    the first sample. Numbers are in the units of the scene."""

    def __init__(self, window: int | None):
        def looks():
            return collections.deque(maxlen=window)

        self._looks = {name: looks() for name in ("energy", "magnetization", "sublattices")}
        self._terms: collections.defaultdict[str, Any] = collections.defaultdict(looks)

    def _look(self, sim: Simulation) -> None:
        energy, _, magnetization = sim._run.sample()
        self._looks["energy"].append(energy)
        self._looks["magnetization"].append(magnetization)
        self._looks["sublattices"].append(sim.sublattice_magnetization())
        for name, value in sim.energies().items():
            self._terms[name].append(value)

    @staticmethod
    def _average(looks):
        return average(looks) if looks else Average(np.nan, np.nan, 0)

    def restart(self) -> None:
        """Discards all samples, for example once the simulation has reached equilibrium."""
        for looks in (*self._looks.values(), *self._terms.values()):
            looks.clear()

    def __len__(self) -> int:
        """The number of samples in the means."""
        return len(self._looks["energy"])

    @property
    def magnetization(self) -> Average:
        """The mean of Simulation.magnetization(), (3,)."""
        return self._average(self._looks["magnetization"])

    @property
    def sublattice_magnetization(self) -> Average:
        """The mean of Simulation.sublattice_magnetization(), (site, 3)."""
        return self._average(self._looks["sublattices"])

    @property
    def energy(self) -> Average:
        """The mean of the energy, summed over sites."""
        return self._average(self._looks["energy"])

    @property
    def energies(self) -> dict[str, Average]:
        """The mean of the energy of each term, by the term's name in Simulation.energies()."""
        return {name: self._average(looks) for name, looks in self._terms.items()}

    def __repr__(self):
        return f"<cayspin.Averages over {len(self)} looks>"
