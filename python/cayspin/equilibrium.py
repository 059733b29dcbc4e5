# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Results of searches for an equilibrium and for its normal modes."""

from __future__ import annotations

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Minimum:
    """Result of Simulation.relax(), in the units of the scene."""

    end: str  #: "converged", "stagnated" (by round-off) or "evaluation limit"
    torque: float  #: max |m x H|, in the unit of H, T in SI
    energy: float  #: summed over sites, in the scene's unit, J in SI
    iterations: int  #: steps of the search
    evaluations: int  #: of the field of all sites
    saddles: int  #: saddles met during the search
    #: upper bound of the lowest curvature, in energy / rad^2, if converged; inf with `keep_saddles`
    curvature: float

    @property
    def converged(self) -> bool:
        """Whether the torque is below its bound and, without `keep_saddles`, the energy falls in no
        direction."""
        return self.end == "converged"


@dataclasses.dataclass(frozen=True)
class Modes:
    """Result of Simulation.modes(): normal modes, the slowest first."""

    frequency: np.ndarray  #: (mode,), angular in reduced units; in Hz in SI
    decay: np.ndarray  #: (mode,), in 1/s in SI; negative where the motion grows
    residual: np.ndarray  #: (mode,), relative errors of the shapes
    #: complex, (mode, nz, ny, nx, 3) or (mode, site, ..); the longest vector of a mode has length 1
    shape: np.ndarray
    #: whether all residuals, with `hessian` also `curvature_residual`, are below `tolerance` or
    #: round-off
    converged: bool
    evaluations: int  #: of the field of all sites
    time_unit: float = 1.0  #: in SI the unit of reduced times, in s; 1 in reduced units
    energy_unit: float | None = None  #: in SI the unit of reduced energies, in J; else None
    under_current: bool = False  #: whether the state is under a current, [torque]
    #: mu / g of each site, (nz, ny, nx) or (site, ..), as linear_structure_factor() takes them
    moments: np.ndarray | None = None
    #: with `hessian`: (mode,), the lowest eigenvalues of the Hessian of the energy, in energy / rad^2
    curvature: np.ndarray | None = None
    #: (mode,), estimates of the errors of `curvature`, in its unit
    curvature_error: np.ndarray | None = None
    curvature_residual: np.ndarray | None = None  #: (mode,), relative errors of the eigenvectors
    #: the eigenvectors, (mode, nz, ny, nx, 3) or (mode, site, ..)
    curvature_vector: np.ndarray | None = None
    #: the equilibrium, (nz, ny, nx, 3) or with sites first; only from read_modes()
    spins: np.ndarray | None = None

    @property
    def negative_curvatures(self) -> int | None:
        """The number of curvatures that are negative beyond their errors. If it is above 0, the
        state is a saddle, or a maximum of the energy. None without curvatures."""
        if self.curvature is None or self.curvature_error is None:
            return None
        return int((self.curvature < -self.curvature_error).sum())


@dataclasses.dataclass(frozen=True)
class Bands:
    """Result of Simulation.bands(): spin waves exp(i (k.r - w t)), the branches of each wave vector
    in the order of their frequencies."""

    wave_vector: np.ndarray  #: (wave, 3), in cycles per cell
    frequency: np.ndarray  #: (wave, branch), angular in reduced units; in Hz in SI; may be negative
    decay: np.ndarray  #: (wave, branch), in 1/s in SI; negative where the motion grows
    evaluations: int  #: of the field of all sites
    #: the equilibrium, (nz, ny, nx, 3) or with sites first; only from read_modes()
    spins: np.ndarray | None = None
