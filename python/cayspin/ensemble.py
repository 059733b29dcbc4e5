# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Files of ensembles."""

from __future__ import annotations

import os
from typing import Any, Sequence

from cayspin import arguments, texture
from cayspin._cayspin import CayspinError
from cayspin.frames import Frames, at_equal_steps, found_in, reading, texture_of, with_lattice
from cayspin.spectra import StructureFactor, structure_factor


class Ensemble:
    """The open file of a scene with [ensemble], from open(). Its arrays are read when they are
    indexed: ensemble.spins[-1, 5]. Use it in a `with`, or call close(). Numbers are in the units of
    the scene.

    - `spins`: (frame, replica, nz, ny, nx, 3), for a crystal with several sites in a cell
      (frame, replica, site, nz, ny, nx, 3)
    - `time`, `step`: (frame)
    - `energy`, summed over the sites of a replica, and `norm_defect`: (frame, replica)
    - `magnetization`: (frame, replica, 3)
    - `sublattice_magnetization`: (frame, replica, site, 3), for a crystal with several sites in a
      cell
    - `torque`, `converged`, `evaluations`: (replica), in files of `cayspin relax`

    Arrays come from h5py as they are in the file. Only plot() and structure_factor() compare spins
    with their checksums, and raise CayspinError for a damaged frame.

    Raises AttributeError for an array that the file does not have.
    """

    _names = ("spins", "time", "step", "energy", "norm_defect", "magnetization")
    _of_some = {"sublattice_magnetization": "a file of a crystal with several sites in a cell",
                **dict.fromkeys(("torque", "converged", "evaluations"), "a file of cayspin relax")}

    def __init__(self, path: str | os.PathLike, file: Any):
        self.path: str | os.PathLike = path  #: name of the file
        self.file: Any = file  #: the open h5py.File
        #: time, step, energy, norm_defect and magnetization at the samples
        self.scalars: dict[str, Any] = {}
        #: the values, (replica), of each varied key
        self.vary: dict[str, Any] = {}
        with reading(file, path):
            self._require_arrays()
            self.scalars.update(file["scalars"])
            self.vary.update((name, values[:]) for name, values in file["vary"].items())

    def _require_arrays(self):
        import h5py

        some = [name for name in self._of_some if name in self.file]
        groups = ("scalars", "vary")
        found = found_in(self.file, (*self._names, *some, *groups))
        missing = [name for name, one in found.items()
                   if not isinstance(one, h5py.Group if name in groups else h5py.Dataset)]
        missing += [f"attribute {name}" for name in ("replicas", "scene", "complete")
                    if name not in self.file.attrs]
        if missing:
            raise CayspinError(f"{self.path}: not an ensemble: it has no {missing[0]}; accepted: "
                               "the file of an ensemble")

    def __getattr__(self, name: str) -> Any:
        if name in self._names:
            with reading(self.file, self.path):
                return self.file[name]
        if name in self._of_some:
            with reading(self.file, self.path):
                if name in self.file:
                    return self.file[name]
            raise AttributeError(f"{self.path}: it has no {name}; accepted: {self._of_some[name]}")
        raise AttributeError(name)

    @property
    def replicas(self) -> int:
        """The number of replicas."""
        with reading(self.file, self.path):
            return int(self.file.attrs["replicas"])

    @property
    def scene(self) -> str:
        """The TOML text of the scene that ran."""
        with reading(self.file, self.path):
            return self.file.attrs["scene"]

    @property
    def complete(self) -> bool:
        """Whether the run ended as planned."""
        with reading(self.file, self.path):
            return bool(self.file.attrs["complete"])

    def structure_factor(self, replicas: Sequence[int] | None = None,
                         frames: slice = slice(None), **options: Any) -> StructureFactor:
        """S(k, w) at all wave vectors of the lattice, from the frames that the slice `frames`
        selects, averaged over `replicas`; see cayspin.structure_factor(), which also has the other
        options. If no key is varied, `replicas` may be omitted: all replicas are then used. By
        default the boundaries, the cell and the positions of its sites are those of the scene.

        Raises CayspinError as that function does, for replicas that do not exist, and for frames
        that are not equally spaced in time.
        """
        if replicas is None:
            if self.vary:
                raise CayspinError(f"structure_factor: replicas differ in {', '.join(self.vary)}; "
                                   "accepted: replicas=[0, ..], those to average over")
            replicas = range(self.replicas)
        chosen = [arguments.whole(one, "structure_factor: replicas") for one in arguments.entries(
            replicas, "structure_factor: replicas", "a list of whole numbers")]
        for one in chosen:
            if not -self.replicas <= one < self.replicas:
                raise CayspinError(f"structure_factor: replica {one}; accepted: {-self.replicas} "
                                   f"to {self.replicas - 1}")
        shown, dt = at_equal_steps(self.file, self.path, len(self), frames, "structure_factor")
        runs = [Frames(self.spins, shown, one % self.replicas) for one in chosen]
        return structure_factor(runs, dt, **with_lattice(self.path, self.scene, options))

    def plot(self, replica: int = 0, frame: int = -1, axes: Any = None, **options: Any) -> Any:
        """Draws the spins of a replica into matplotlib axes, which it returns.

        `replica` and `frame` count from 0, or from the end if they are negative. `axes` and the
        other options, such as plane="z=0", are those of texture.draw().

        Raises CayspinError for a replica, frame, plane or option that does not exist.
        """
        replica = arguments.whole(replica, "plot: replica")
        frame = arguments.whole(frame, "plot: frame")
        arguments.options(options, texture.OPTIONS, "plot")
        shown, _ = texture_of(self.file, self.path, frame, replica=replica)
        try:
            return texture.draw(shown, axes, **options)
        except ValueError as error:
            raise CayspinError(f"{self.path}: {error}") from None

    def __len__(self) -> int:
        """The number of complete frames; a killed run may have written part of another one."""
        with reading(self.file, self.path):
            return texture.frames_in(self.file)

    def __enter__(self) -> Ensemble:
        return self

    def __exit__(self, *exception: Any) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file."""
        self.file.close()
