# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Files of modes and of spin waves."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from cayspin import _cayspin, arguments, frames
from cayspin._cayspin import CayspinError
from cayspin.equilibrium import Bands, Modes
from cayspin.scene import moments_over_g

_FORMAT = "cayspin_modes_format"
_CURVATURES = ("curvature", "curvature_error", "curvature_residual", "curvature_vector")


def _opened(path):
    import h5py

    try:
        file = h5py.File(path, "r")
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise CayspinError(f"{path}: cannot be opened: {reason}") from None
    with frames.reading(file, path):
        if _FORMAT in file.attrs:
            return file
    file.close()
    raise CayspinError(f"{path}: no modes; accepted: a file of cayspin modes")


class FileOfModes:
    """Modes from a file of `cayspin modes`, in the units of the file."""

    def __init__(self, name, path, moments):
        path = arguments.file_name(path, name)
        with _opened(path) as file, frames.reading(file, path):
            if "mode" not in file:
                raise CayspinError(f"{path}: bands have no shapes; accepted: a file of cayspin "
                                   "modes without --wave-vector")
            self.path, self.scene = path, file.attrs["scene"]
            self.spins = file["spins"][:].astype(np.float64)
            parts = file["mode"][:]
            self.shape = parts[..., 0] + 1j * parts[..., 1]
            if self.shape.shape[1:] != self.spins.shape:
                raise CayspinError(f"{path}: spins of shape {self.spins.shape} and modes of shape "
                                   f"{self.shape.shape}; accepted: modes (mode, ..) of these spins")
            self.frequency, self.decay = file["frequency"][:], file["decay"][:]
            self.converged = bool(file.attrs["converged"])
            self.time_unit, self.energy_unit = 1.0, None
            if file.attrs["units"] == "SI":
                self.time_unit = float(file.attrs["time_unit"])
                self.energy_unit = float(file.attrs["energy_unit"])
        read = frames.tables(path, self.scene, "the tables", "Modes with their spins")
        self.under_current = "torque" in read and self._has_torque()
        of_material = ("Ms", "mu_s", "gamma")
        if read.get("material", {}).get("damping_form") == "gilbert":
            of_material += ("alpha",)
        differs = [f"{table}.{key}" for table, names in
                   (("lattice", ("moments", "gyromagnetic")), ("material", of_material))
                   for key in names if key in read.get(table, {})
                   and not _is_number(read[table][key])]
        if moments is not None:
            self.moments = moments
        elif differs:
            self.moments = self._moments_of_sites(differs[0])
        else:
            lattice = read["lattice"]
            self.moments = lattice.get("moments", 1.0) / lattice.get("gyromagnetic", 1.0) * (
                self.time_unit * (self.energy_unit or 1.0))

    def _has_torque(self):
        """Whether the scene has a torque other than 0. It has a table [torque]."""
        try:
            return _cayspin.Scene.parse(self.scene, self.path, [], None, {}).has_torque
        except CayspinError:
            return True

    def _moments_of_sites(self, key):
        """Returns mu / g of each site. `key`: a key of the scene that may be a file, for the
        error."""
        try:
            return moments_over_g(_cayspin.Scene.parse(self.scene, self.path, [], None, {}))
        except CayspinError as error:
            raise CayspinError(f"{self.path}: {key} of its scene cannot be read; accepted: the "
                               "argument moments, or the scene's files beside this one"
                               ) from error


def _is_number(value):
    """Whether a value is one number, possibly with a unit, as { bohr_magnetons = 2.0 }."""
    if isinstance(value, dict) and len(value) == 1:
        value = next(iter(value.values()))
    return isinstance(value, (int, float))


def read_modes(path: str | os.PathLike, moments: Any = None) -> Modes | Bands:
    """Reads the file `path` of `cayspin modes`: Bands if it was written with --wave-vector,
    otherwise Modes. Both have the state as `spins`. Needs h5py.

        modes = cayspin.read_modes("modes.h5")
        modes.frequency, modes.shape, modes.spins

    `moments`: mu / g of each site, as in linear_structure_factor(). By default they are those of
    the scene, so they are needed only if the scene has values per site in other files, which are
    not beside this one.

    Raises CayspinError for a file that cannot be read, or is not of modes, and for `moments` of
    another shape.
    """
    name = arguments.file_name(path, "read_modes")
    with _opened(name) as file, frames.reading(file, name):
        spins, cost = file["spins"][:], int(file.attrs["evaluations"])
        if "wave_vector" in file:
            return Bands(file["wave_vector"][:], file["frequency"][:], file["decay"][:], cost,
                         spins)
        residual = file["residual"][:]
        curvatures = [file[key][:] if key in file else None for key in _CURVATURES]
    if moments is not None:
        moments = arguments.numbers(moments, "read_modes: moments")
    found = FileOfModes("read_modes", name, moments)
    try:
        found.moments = np.broadcast_to(found.moments, spins.shape[:-1])
    except ValueError:
        raise CayspinError(f"read_modes: moments of shape {np.shape(found.moments)}; accepted: "
                           f"one that broadcasts to {spins.shape[:-1]}") from None
    return Modes(found.frequency, found.decay, residual, found.shape, found.converged, cost,
                 found.time_unit, found.energy_unit, found.under_current, found.moments,
                 *curvatures, spins)
