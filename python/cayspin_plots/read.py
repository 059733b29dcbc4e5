# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads a trajectory file into numpy arrays."""

import contextlib
from dataclasses import dataclass

import h5py
import numpy as np
from command_line import require_file, what_can_be_read
from texture import checksum, frames_in


@dataclass
class Series:
    """The observables over time: of the samples in /scalars, or of the frames."""

    time: np.ndarray
    energy: np.ndarray
    norm_defect: np.ndarray
    magnetization: np.ndarray  # (sample, 3)


@dataclass
class Trajectory:
    path: str
    time: np.ndarray  # (frame,)
    spins: np.ndarray  # (frame, nz, ny, nx, 3); for crystals, planes of one site, then of the next
    scalars: Series
    precision: str
    complete: bool
    si: bool

    def in_time_unit(self, time):
        """Times as pictures show them: ns in SI."""
        return 1e9 * time if self.si else time

    def time_label(self):
        return "time (ns)" if self.si else "time"

    def sites(self):
        return int(np.prod(self.spins.shape[1:4]))

    def site(self, number):
        """Returns the path (frame, 3) of one spin. `number` counts the sites from 0, x fastest."""
        if not 0 <= number < self.sites():
            raise SystemExit(f"{self.path}: there is no site {number}; there are {self.sites()}")
        return self.spins.reshape(len(self.spins), -1, 3)[:, number]


@contextlib.contextmanager
def opened(path, what):
    """Opens an HDF5 file for a `with`. An error ends the program with a one-line message."""
    try:
        require_file(path)
    except ValueError as error:
        raise SystemExit(f"{path}: {error}") from None
    try:
        with h5py.File(path, "r") as file:
            yield file
    except (OSError, KeyError, TypeError, ValueError) as error:
        reason = " ".join(str(error.args[-1] if error.args else error).split())
        raise SystemExit(f"{path}: cannot read the {what}: {reason}{what_can_be_read(path)}"
                         ) from None


def _dataset(file, name, rank, columns=()):
    """Returns a dataset of numbers with `rank` extents, the last of which are `columns`. Raises
    ValueError for any other."""
    dataset = file[name]
    if (not isinstance(dataset, h5py.Dataset) or dataset.dtype.kind not in "fiu"
            or len(dataset.shape or ()) != rank or dataset.shape[rank - len(columns):] != columns):
        raise ValueError(f"{name} is not the dataset of a trajectory")
    return dataset


def _series(file, group=""):
    names = [group + name for name in ("time", "energy", "norm_defect")]
    columns = [_dataset(file, name, 1)[:] for name in names]
    columns.append(_dataset(file, group + "magnetization", 2, (3,))[:])
    whole = min(len(column) for column in columns)
    return Series(*(column[:whole] for column in columns))


def read_trajectory(path):
    """Reads whole frames only. `complete` is False if the run is under way or ended early."""
    with opened(path, "trajectory") as file:
        frames = _series(file)
        rank = 6 if np.ndim(file["spins"]) == 6 else 5
        spins = _dataset(file, "spins", rank, (3,))
        count = frames_in(file)
        if count == 0:
            raise SystemExit(f"{path}: it holds no frame")
        samples = _series(file, "scalars/")
        spins = spins[:count]
        checksum.require_undamaged(file, 0, spins)
        return Trajectory(
            path=str(path),
            time=frames.time[:count],
            spins=spins.reshape(count, -1, *spins.shape[-3:]),
            scalars=samples if len(samples.time) >= count else frames,
            precision=file.attrs["precision"],
            complete=bool(file.attrs["complete"]),
            si=file.attrs.get("units") == "SI",
        )
