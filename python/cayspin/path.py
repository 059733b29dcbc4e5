# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Minimum-energy paths between two states, or out of one."""

from __future__ import annotations

import dataclasses
import os

import numpy as np

from cayspin import _cayspin, arguments, sites
from cayspin.scene import Scene


@dataclasses.dataclass(frozen=True)
class MinimumEnergyPath:
    """Result of path(). Energies are in the scene's unit, J in SI. Without a saddle, the values of
    the saddle are None. `prefactor_*` and `langer_*` are the prefactors in
    rate = prefactor * T^((n - n_s) / 2) * exp(-barrier / kT), where n and n_s are the numbers of
    zero modes of the state that is left and of the saddle."""

    spins: np.ndarray  #: (image, nz, ny, nx, 3), for a crystal (image, site, nz, ny, nx, 3)
    energy: np.ndarray  #: (image,), summed over sites
    #: (image,), length of the path from the first image, in radians: between neighbouring images
    #: the root of the sum of the squared angles of all spins
    distance: np.ndarray
    saddle: np.ndarray | None  #: spins of the highest saddle, (nz, ny, nx, 3) or with sites first
    saddle_energy: float | None  #: energy of the highest saddle, in the unit of `energy`
    barrier_forward: float | None  #: saddle_energy - energy[0], in the unit of `energy`
    barrier_backward: float | None  #: saddle_energy - energy[-1], in the unit of `energy`
    #: lowest curvature of the highest saddle, about 0 or less, in energy / rad^2
    saddle_curvature: float | None
    #: (saddle,), highest first, with the fields energy, curvature, next_curvature and image
    saddles: np.ndarray
    end: str  #: "converged", or why the search ended before
    converged: bool  #: whether the path and all of its saddles have converged
    evaluations: int  #: of the field of all sites
    prefactor_forward: float | None  #: with `rates`; in SI in 1/s with T in K
    prefactor_backward: float | None  #: for the way back, in the same unit
    langer_forward: float | None  #: of Langer's theory, with damping, in the same unit
    langer_backward: float | None  #: of Langer's theory, for the way back, in the same unit
    zero_modes: tuple[int, int, int] | None  #: with `rates`: of the start, the saddle and the end


_SADDLE = [("energy", float), ("curvature", float), ("next_curvature", float), ("image", int)]


def _end(state, name, shape, cell_sites):
    """Returns an end of the path: the name of a file, or an array in the library's order of sites
    (sites.py)."""
    if isinstance(state, (str, bytes, os.PathLike)):
        return arguments.file_name(state, f"path: {name}")
    spins = arguments.numbers(state, f"path: {name}")
    if spins.shape != (*shape, 3):
        raise _cayspin.CayspinError(f"path: {name}: an array of shape {spins.shape}; accepted: "
                                    f"{(*shape, 3)}, or the name of a file")
    return sites.by_plane(spins, cell_sites)


def path(scene: Scene, start: np.ndarray | str | os.PathLike,
         end: np.ndarray | str | os.PathLike | None = None, images: int = 16, torque: float = 1e-6,
         evaluations: int = 1000000, rates: bool = False, precision: str = "double",
         space: str | None = None, threads: int | None = None,
         modes: int | None = None) -> MinimumEnergyPath:
    """Finds the minimum-energy path between two states, and the saddle that determines its barrier,
    as `cayspin path` does.

        found = cayspin.path(scene, skyrmion, uniform)
        found.barrier_forward, found.saddle

    `scene` needs no integrator. `start` and `end` are arrays in the shape of Simulation.spins, or
    files as initial.file takes them. Both ends are relaxed first. `images` is the number of images,
    including both ends, from 3 to 1000. `torque` bounds max |m x H| of the ends and saddles, in the
    unit of H, T in SI. `evaluations` limits the evaluations of the field of all sites. `rates` adds
    prefactors of rates, for at most 4096 sites. `precision`, `space` and `threads` are those of
    Simulation.

    Without `end`, climbs from `start` along its `modes` (default 4) modes of lowest curvature, in
    both directions. The result is the path over the lowest saddle reached, to the state beyond it.

        cayspin.path(scene, skyrmion).barrier_forward

    If the search ends early, `converged` is False, and the result has what was found so far. Raises
    NumbersFailed if there is no path (an end cannot be relaxed, or both ends relax to the same
    state), and for rates that cannot be computed. Raises SceneError for rigid bodies, temperatures,
    torques of currents and fields that depend on t, CayspinError for wrong options and ends. Ctrl-C
    raises KeyboardInterrupt.
    """
    if not isinstance(scene, Scene):
        raise _cayspin.CayspinError(f"path: a {type(scene).__name__}; accepted: a Scene")
    options = (arguments.whole(images, "path: images"), arguments.real(torque, "path: torque"),
               arguments.whole(evaluations, "path: evaluations"),
               arguments.flag(rates, "path: rates"))
    run = _cayspin.Run(scene._scene, arguments.word(precision, "precision"),
                       None if space is None else arguments.word(space, "space"),
                       None if threads is None else arguments.whole(threads, "threads", 32), None)
    shape, cell_sites = run.scene.shape, run.scene.cell_sites
    if end is None:
        modes = 4 if modes is None else arguments.whole(modes, "path: modes")
    elif modes is not None:
        raise _cayspin.CayspinError(f"path: modes {arguments.shown(modes)}: `end` is given; "
                                    "accepted: one of them")
    of_sites = sites.shape_by_site(shape, cell_sites)
    ends = [_end(start, "start", of_sites, cell_sites),
            None if end is None else _end(end, "end", of_sites, cell_sites)]
    try:
        found = run.path(*ends, *options, modes)
    except (_cayspin.SceneError, _cayspin.NumbersFailed):
        raise
    except _cayspin.CayspinError as error:
        raise _cayspin.CayspinError(f"path: {error}") from None
    if not found["energy"] or found["end"] == "both ends relaxed to the same state":
        raise _cayspin.NumbersFailed(f"path: {found['end']}, after {found['evaluations']} "
                                     "evaluations")
    real = np.float32 if run.precision == "single" else np.float64

    def states(numbers):
        planes = numbers.reshape(-1, *shape, 3).astype(real, copy=False)
        return np.stack([sites.by_site(state, cell_sites) for state in planes])

    saddles = np.array(found["saddles"], _SADDLE)
    energy = np.array(found["energy"])
    highest = (None,) * 5
    if len(saddles):
        top, curvature = float(saddles["energy"][0]), float(saddles["curvature"][0])
        highest = (states(found["saddle"])[0], top, top - float(energy[0]), top - float(energy[-1]),
                   curvature)
    *prefactors, modes = found.get("rates", (None,) * 5)
    return MinimumEnergyPath(states(found["spins"]), energy, np.array(found["distance"]), *highest,
                             saddles, found["end"], found["converged"], found["evaluations"],
                             *prefactors, None if modes is None else tuple(modes))
