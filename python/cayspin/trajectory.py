# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Trajectory files."""

from __future__ import annotations

import os
from typing import Any, Sequence

import numpy as np

from cayspin import arguments, observables, texture
from cayspin._cayspin import CayspinError, complete_file
from cayspin.ensemble import Ensemble
from cayspin.frames import (Frames, along_axes, at_equal_steps, found_in, reading, texture_of,
                            with_lattice)
from cayspin.spectra import StructureFactor, structure_factor


class Trajectory:
    """An open trajectory file, from open(). Its arrays are read when they are indexed:
    trajectory.spins[-1]. Use it in a `with`, or call close(). Numbers are in the units of the
    scene.

    - `spins`: (frame, nz, ny, nx, 3), for a crystal with several sites in a cell
      (frame, site, nz, ny, nx, 3)
    - `time`, `step`: (frame)
    - `energy`, summed over sites, and `norm_defect`, the largest | |m| - 1 |: (frame)
    - `magnetization`: the mean spin, (frame, 3)
    - `sublattice_magnetization`: (frame, site, 3), for a crystal with several sites in a cell
    - `positions`: in the shape of a frame of `spins`, if the sites are not on a rectangular grid
    - `shift`: (frame), the cells by which a lattice with lattice.follow has moved
    - `stage`: (frame), for a run in stages

    Arrays come from h5py as they are in the file. Only the methods that compute from spins compare
    them with their checksums, and raise CayspinError for a damaged frame.

    Raises AttributeError for an array that the file does not have.
    """

    _names = ("spins", "time", "step", "energy", "norm_defect", "magnetization")
    _of_some = {"sublattice_magnetization": "a crystal with several sites in a cell",
                "positions": "a crystal", "shift": "a scene with lattice.follow",
                "stage": "a run in stages"}

    def __init__(self, path: str | os.PathLike):
        import h5py

        self.path: str = arguments.file_name(path, "open")  #: name of the file
        complete_file(self.path)
        try:
            self.file: Any = h5py.File(self.path, "r")  #: the open h5py.File
        except BlockingIOError:
            raise CayspinError(f"{self.path}: a program is writing it; accepted: the file of a run "
                               "that has ended, or view() while it runs") from None
        except (OSError, ValueError) as error:
            reason = " ".join(str(error).split())
            raise CayspinError(f"{self.path}: cannot be opened: {reason}") from None
        #: time, step, energy, norm_defect and magnetization at the samples; where the scene asks
        #: for them, also region_magnetization, (sample, region, 3), region_energy,
        #: (sample, region), term_energy, (sample, term), and shift, (sample)
        self.scalars: dict[str, Any] = {}
        try:
            with reading(self.file, self.path):
                self._require_arrays()
                self.scalars.update(self.file["scalars"])
        except CayspinError:
            self.file.close()
            raise

    def _require_arrays(self):
        import h5py

        some = [name for name in self._of_some if name in self.file]
        found = found_in(self.file, (*self._names, *some, "scalars"))
        if getattr(found["spins"], "ndim", 0) == 6:
            found.setdefault("sublattice_magnetization", None)
        missing = [name for name, one in found.items()
                   if not isinstance(one, h5py.Group if name == "scalars" else h5py.Dataset)]
        if not missing and (found["spins"].ndim not in (5, 6) or found["spins"].shape[-1] != 3):
            missing.append("frames of spins")
        if missing:
            raise CayspinError(f"{self.path}: not a trajectory: it has no {missing[0]}; "
                               "accepted: the file of a run")

    def __getattr__(self, name: str) -> Any:
        if name in self._names:
            with reading(self.file, self.path):
                return self.file[name]
        if name in self._of_some:
            with reading(self.file, self.path):
                if name in self.file:
                    return self.file[name]
            raise AttributeError(f"{self.path}: it has no {name}; accepted: the file of "
                                 f"{self._of_some[name]}")
        raise AttributeError(name)

    @property
    def scene(self) -> str:
        """The TOML text of the scene that ran."""
        with reading(self.file, self.path):
            return self.file.attrs["scene"]

    @property
    def terms(self) -> list[str]:
        """The names of the terms of scalars["term_energy"]; empty if the file has none."""
        if "term_energy" not in self.scalars:
            return []
        with reading(self.file, self.path):
            return [name.decode() for name in self.scalars["term_energy"].attrs["terms"]]

    @property
    def complete(self) -> bool:
        """Whether the run ended as planned."""
        with reading(self.file, self.path):
            return bool(self.file.attrs["complete"])

    def topological_charge(self, boundary: Sequence[str] | None = None) -> np.ndarray:
        """The topological charge of each plane, as defined by cayspin.topological_charge(). The
        array has the shape (frame, nz), or (frame, site, nz) for a crystal. `boundary` defaults to
        that of the scene.

        Raises CayspinError for an invalid `boundary`. Reading the scene's boundary needs tomli on
        Python versions before 3.11; if it is missing, CayspinError is raised, too.
        """
        if boundary is None:
            boundary = along_axes(self.path, self.scene, "boundary", "open", "boundary")[:2]
        elif not isinstance(boundary, str):
            boundary = arguments.entries(boundary, "topological_charge: boundary",
                                         'two words, each "open" or "periodic"')
        spins = Frames(self.spins, range(len(self)))
        none = observables.topological_charge(np.empty((0, *spins.shape[1:])), boundary)
        return np.array([observables.topological_charge(spins[frame], boundary)
                         for frame in range(len(self))]).reshape(-1, *none.shape[1:])

    def dispersion(self, path: Any, frames: slice = slice(None),
                   **options: Any) -> observables.Dispersion:
        """S(k, w) of the frames that the slice `frames` selects, along a `path` of wave vectors;
        see cayspin.dispersion(), which also has the other options. By default the boundaries, the
        cell and the positions of its sites are those of the scene.

        Raises CayspinError as that function does, and for frames that are not equally spaced in
        time.
        """
        chosen, dt = at_equal_steps(self.file, self.path, len(self), frames, "dispersion")
        return observables.dispersion(Frames(self.spins, chosen), dt, path,
                                      **with_lattice(self.path, self.scene, options))

    def structure_factor(self, frames: slice = slice(None), **options: Any) -> StructureFactor:
        """S(k, w) of the frames that the slice `frames` selects, at all wave vectors of the
        lattice; see cayspin.structure_factor(), which also has the other options. By default the
        boundaries, the cell and the positions of its sites are those of the scene.

        Raises CayspinError as that function does, and for frames that are not equally spaced in
        time.
        """
        chosen, dt = at_equal_steps(self.file, self.path, len(self), frames, "structure_factor")
        return structure_factor(Frames(self.spins, chosen), dt,
                                **with_lattice(self.path, self.scene, options))

    def plot(self, frame: int = -1, axes: Any = None, *, difference_to: int | None = None,
             **options: Any) -> Any:
        """Draws the spins of a `frame` into matplotlib `axes` (default: new ones), which it
        returns: films and planes as colours with arrows, crystals by their sites, chains as lines.
        `difference_to`: another frame; the |difference| of the spins is drawn. Frames count from 0,
        or from the end if negative. Lengths are in the units of the scene.

        Options are those of texture.draw(): plane="z=0", quantity="charge", colors="safe", limit,
        key. Raises CayspinError for a frame, plane or option that does not exist.
        """
        frame = arguments.whole(frame, "plot: frame")
        if difference_to is not None:
            difference_to = arguments.whole(difference_to, "plot: difference_to")
        accepted = [name for name in texture.OPTIONS if name != "before"]
        arguments.options(options, ["difference_to", *accepted], "plot")
        shown, before = texture_of(self.file, self.path, frame, difference_to)
        try:
            return texture.draw(shown, axes, before=before, **options)
        except ValueError as error:
            raise CayspinError(f"{self.path}: {error}") from None

    def to_xarray(self) -> Any:
        """An xarray.Dataset of the frames, whose variables are read when they are used, so keep the
        file open. Raises ImportError without xarray."""
        import xarray
        from xarray.backends import BackendArray
        from xarray.core import indexing

        class Lazy(BackendArray):
            def __init__(self, dataset, length):
                self.dataset, self.dtype = dataset, dataset.dtype
                self.shape = (length, *dataset.shape[1:])

            def __getitem__(self, key):
                return indexing.explicit_indexing_adapter(
                    key, self.shape, indexing.IndexingSupport.BASIC, self.read)

            def read(self, key):
                first, *others = key
                if isinstance(first, slice):  # a kill may leave one more row than is counted
                    first = slice(*first.indices(self.shape[0]))
                return self.dataset[(first, *others)]

        frames, variables = len(self), {}
        of_cell = ("site",) if self.spins.ndim == 6 else ()
        axes = (*of_cell, "z", "y", "x", "component")
        dimensions = {"spins": ("frame", *axes), "magnetization": ("frame", "component"),
                      "sublattice_magnetization": ("frame", "site", "component"),
                      "positions": axes}
        names = (*self._names, *(name for name in self._of_some if name in self.file))
        for name in names:
            dataset, axes_of = self.file[name], dimensions.get(name, ("frame",))
            length = frames if axes_of[0] == "frame" else len(dataset)
            variables[name] = axes_of, indexing.LazilyIndexedArray(Lazy(dataset, length))
        coordinates = {"component": ["x", "y", "z"], "time": ("frame", self.time[:frames])}
        variables.pop("time")
        attributes = {key: value for key, value in self.file.attrs.items()}
        return xarray.Dataset(variables, coordinates, attributes)

    def close(self) -> None:
        """Closes the file; arrays that were read remain valid."""
        self.file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __len__(self) -> int:
        """The number of complete frames; a killed run may have written part of another one."""
        with reading(self.file, self.path):
            return texture.frames_in(self.file)

    def __repr__(self):
        if not self.file:
            return f"<cayspin.Trajectory {self.path}: closed>"
        *of_cell, nz, ny, nx = self.file["spins"].shape[1:-1]
        crystal = f" cells of {of_cell[0]} sites" if of_cell else ""
        return (f"<cayspin.Trajectory {self.path}: {len(self)} frames of "
                f"{nx} x {ny} x {nz}{crystal}>")


def open(path: str | os.PathLike) -> Trajectory | Ensemble:
    """Opens the file `path` of a run, or of an ensemble. Needs h5py.

    Raises CayspinError for a file that cannot be opened, such as that of a run under way, or is
    neither. read_modes() reads files of modes.
    """
    import h5py

    from cayspin.texture.replica import is_ensemble

    name = arguments.file_name(path, "open")
    try:
        file = h5py.File(name, "r")
    except (OSError, ValueError):
        return Trajectory(path)  # completes it, or says why it cannot be opened
    try:
        with reading(file, name):
            if is_ensemble(file):
                return Ensemble(name, file)
            if "cayspin_modes_format" in file.attrs:
                raise CayspinError(f"{name}: a file of modes; accepted: the file of a run, or "
                                   "read_modes() for this file")
    except CayspinError:
        file.close()
        raise
    file.close()
    return Trajectory(path)
