# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Searches for modes and spin waves about the present spins of a simulation."""

from __future__ import annotations

from typing import Any

import numpy as np

from cayspin import _cayspin, arguments, sites
from cayspin.equilibrium import Bands, Modes
from cayspin.scene import moments_over_g


def _of_modes(vectors, spins, cell_sites, *more):
    """Returns one array of vectors of the library in the order of the package, with the modes first.
    `spins`: those of the library."""
    parts = np.array(vectors).reshape((len(vectors), *spins.shape, *more))
    if cell_sites > 1 and len(vectors):
        return np.stack([sites.by_site(one, cell_sites) for one in parts])
    return parts


def modes_of(run: Any, scene: Any, count: int, tolerance: float, evaluations: int,
             hessian: bool) -> Modes:
    """Returns what Simulation.modes() returns. `scene`: the Scene that runs."""
    options = (arguments.whole(count, "modes: count"),
               arguments.real(tolerance, "modes: tolerance"),
               arguments.whole(evaluations, "modes: evaluations"))
    hessian = arguments.flag(hessian, "modes: hessian")
    of_scene = scene._scene
    if hessian and of_scene.has_torque:
        raise _cayspin.CayspinError("modes: hessian: under the torque of a current there is no "
                                    "energy; accepted: hessian=False")
    *numbers, shapes, converged, cost = run.modes(*options)
    spins, cell_sites = run.spins(), of_scene.cell_sites
    parts = _of_modes(shapes, spins, cell_sites, 2)
    curvatures = ()
    if hessian:
        *values, vectors, has_all, more = run.curvatures(*options)
        curvatures = (*(np.array(each) for each in values),
                      _of_modes(vectors, spins, cell_sites))
        converged, cost = converged and has_all, cost + more
    is_si, time_unit, energy_unit = of_scene.units
    return Modes(*(np.array(each) for each in numbers), parts[..., 0] + 1j * parts[..., 1],
                 converged, cost, time_unit, energy_unit if is_si else None, of_scene.has_torque,
                 moments_over_g(of_scene), *curvatures)


def bands_of(run: Any, wave_vectors: Any) -> Bands:
    """Returns what Simulation.bands() returns."""
    waves = arguments.numbers(wave_vectors, "bands: wave_vectors").astype(np.float64)
    if waves.ndim != 2 or waves.shape[1] != 3 or not len(waves) or not np.isfinite(waves).all():
        raise _cayspin.CayspinError(f"bands: wave_vectors of shape {waves.shape}; accepted: finite "
                                    "numbers (wave, 3)")
    try:
        frequency, decay, cost = run.bands(waves.tolist())
    except _cayspin.CayspinError as error:
        # Messages name the option of `cayspin modes`.
        text = str(error).replace(", also between corners (--points)", "")
        text = text.replace("accepted with --wave-vector", "accepted for bands")
        raise type(error)(text.replace("--wave-vector", "bands: wave_vectors")) from None
    return Bands(waves, np.array(frequency), np.array(decay), cost)
