# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Trajectory files."""

from __future__ import annotations

import builtins
import os
from typing import Any

from cayspin import arguments
from cayspin._cayspin import CayspinError, complete_file


class Trajectory:
    """An open trajectory file. Its members are read when they are indexed: trajectory.spins[-1].

    spins (frame, nz, ny, nx, 3); time, step, energy, norm_defect (frame); magnetization (frame, 3);
    scalars: the same names at the samples. Use it in a `with`, or call close().
    """

    _names = ("spins", "time", "step", "energy", "norm_defect", "magnetization")

    def __init__(self, path: str | os.PathLike):
        import h5py

        self.path = arguments.file_name(path, "open")
        complete_file(self.path)
        try:
            self.file = h5py.File(self.path, "r")
        except (OSError, ValueError) as error:
            reason = " ".join(str(error).split())
            raise CayspinError(f"{self.path}: cannot be opened: {reason}") from None
        missing = [name for name in (*self._names, "scalars") if name not in self.file]
        if missing:
            self.file.close()
            raise CayspinError(f"{self.path}: no trajectory, it has no {missing[0]}; accepted: a "
                               "file that cayspin wrote")
        self.scalars = {name: self.file["scalars"][name] for name in self.file["scalars"]}

    def __getattr__(self, name: str) -> Any:
        if name in self._names:
            return self.file[name]
        raise AttributeError(name)

    @property
    def scene(self) -> str:
        """The TOML text of the scene that ran."""
        return self.file.attrs["scene"]

    @property
    def complete(self) -> bool:
        """Whether the run ended as planned."""
        return bool(self.file.attrs["complete"])

    def to_xarray(self):
        """An xarray.Dataset of the frames, whose variables are read when they are used."""
        import xarray
        from xarray.backends import BackendArray
        from xarray.core import indexing

        class Lazy(BackendArray):
            def __init__(self, dataset):
                self.dataset, self.shape, self.dtype = dataset, dataset.shape, dataset.dtype

            def __getitem__(self, key):
                return indexing.explicit_indexing_adapter(
                    key, self.shape, indexing.IndexingSupport.BASIC, self.dataset.__getitem__)

        axes = ("frame", "z", "y", "x", "component")
        dimensions = {"spins": axes, "magnetization": ("frame", "component")}
        variables = {name: (dimensions.get(name, ("frame",)),
                            indexing.LazilyIndexedArray(Lazy(self.file[name])))
                     for name in self._names}
        coordinates = {"component": ["x", "y", "z"], "time": ("frame", self.time[:])}
        variables.pop("time")
        attributes = {key: value for key, value in self.file.attrs.items()}
        return xarray.Dataset(variables, coordinates, attributes)

    def close(self) -> None:
        """Closes the file; arrays that were read stay."""
        self.file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __len__(self):
        return builtins.min(len(self.file["spins"]), len(self.file["time"]))

    def __repr__(self):
        nz, ny, nx = self.file["spins"].shape[1:4]
        return f"<cayspin.Trajectory {self.path}: {len(self)} frames of {nx} x {ny} x {nz}>"


def open(path: str | os.PathLike) -> Trajectory:
    """Opens the file of a run. Raises CayspinError when it is none. Needs h5py."""
    return Trajectory(path)
