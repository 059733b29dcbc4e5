# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads a trajectory file for a page, also while a run writes it. Errors are ValueErrors."""

from __future__ import annotations

import fcntl
import pathlib
import time
from typing import Any, Callable

import h5py
import numpy as np

from ..command_line import require_file, what_can_be_read
from ..texture import checksum, frames_in, lattice_of, plane_of, require_trajectory
from ..texture.replica import is_ensemble

OF_SAMPLES = ("time", "energy", "magnetization")
MOST_ROWS = 20000  # in one answer


def _undamaged(file, number):
    spins = file["spins"][number:number + 1]
    checksum.require_undamaged(file, number, spins)
    return spins[0]


def _small(spins):
    """Directions as 8-bit integers; 0 where there is no spin."""
    spins = spins.astype(np.float32, copy=False)
    right, up, normal = (np.abs(spins[..., axis]) for axis in range(3))
    largest = np.maximum(np.maximum(right, up), normal)
    scale = 127 / np.where(largest > 0, largest, 1)
    return np.rint(spins * scale[..., None]).astype(np.int8)


def _is_locked(path):
    with open(path, "rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except OSError:
            return True
    return False


class Reader:
    """Reads a trajectory file, which it opens for each answer. During a run it trusts only rows
    that were there in two successive readings, because the last row may be half written."""

    def __init__(self, path: str | pathlib.Path):
        self.path = pathlib.Path(path)
        self.frames = self.samples = 0  # numbers of trusted rows
        self._seen, self._identity, self._kept = (0, 0), None, (None, None)
        try:
            require_file(path)
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None
        self._read(self._look)

    def _read(self, read: Callable) -> Any:
        """Returns the result of `read` on the open file. Retries if that fails, because a
        half-written file may soon be complete."""
        for tries_left in range(10, -1, -1):
            try:
                with h5py.File(self.path, "r", locking=False) as file:
                    if is_ensemble(file):
                        raise ValueError("the file of an ensemble; accepted: the file of a run, or "
                                         "cayspin plot --replica for one of its replicas")
                    require_trajectory(file)
                    return read(file)
            except ValueError as error:
                raise ValueError(f"{self.path}: {error}") from None
            except (OSError, KeyError, RuntimeError) as error:
                reason = " ".join(str(error.args[-1] if error.args else error).split())
            if tries_left:
                time.sleep(0.05)
        raise ValueError(f"{self.path}: cannot be read: {reason}{what_can_be_read(self.path)}")

    def _look(self, file):
        status = self.path.stat()
        if self._identity != status.st_ino:
            self._seen, self._identity, self._kept = (0, 0), status.st_ino, (None, None)
        complete = bool(file.attrs["complete"])
        scalars = file["scalars"]
        counts = frames_in(file), min(len(scalars[name]) for name in OF_SAMPLES)
        self.frames, self.samples = counts if complete else map(min, counts, self._seen)
        self._seen = counts
        if complete:
            return "complete"
        quiet = time.time() - status.st_mtime > 10 and not _is_locked(self.path)
        return "ended early" if file.attrs["wall_seconds"] > 0 or quiet else "under way"

    def news(self, frames: int, samples: int) -> dict:
        """Returns what a page that has `frames` frames and `samples` samples lacks. For 0 frames,
        that includes the description of the file."""
        def read(file):
            news = {"state": self._look(file), "file": self._identity, "frames": self.frames}
            last = min(self.samples, samples + MOST_ROWS)
            rows = np.column_stack([file["scalars"][name][samples:last] for name in OF_SAMPLES])
            news["rows"] = np.where(np.isfinite(rows), rows, None).tolist()
            news["times"] = file["time"][frames:self.frames].tolist()
            news["more"] = last < self.samples
            if not frames:
                news["about"] = self._about(file)
            return news
        return self._read(read)

    def _about(self, file):
        shape, scene = file["spins"].shape[1:], file.attrs.get("scene", "")
        plane, has_positions = plane_of(shape, None), "positions" in file
        if len(shape) == 5:
            plane.sites(file.get("positions"))
        spacing, _, si = lattice_of(scene)
        return {"name": self.path.name, "scene": scene, "extents": shape[-2:-5:-1], "si": si,
                "spacing": spacing, "crystal": has_positions, "normal": plane.normal,
                "plane": plane.number}

    def frame(self, number: int, plane: str) -> bytes:
        """Returns the spins of a plane in frame `number`, 3 bytes each, in rows from the bottom
        up."""
        if number >= self.frames:
            accepted = f"0 to {self.frames - 1}" if self.frames else "a file that holds frames"
            raise ValueError(f"frame {number}; accepted: {accepted}")
        if self._kept[0] != number:
            self._kept = number, self._read(lambda file: _small(_undamaged(file, number)))
        return plane_of(self._kept[1].shape, plane).vectors(self._kept[1]).tobytes()

    def positions(self, plane: str) -> bytes:
        """Returns the positions of a crystal's sites, 3 floats each, in the order of `frame`."""
        def read(file):
            positions = file["positions"][:]
            return plane_of(positions.shape, plane).vectors(positions)
        return self._read(read).astype("<f4").tobytes()

    def path_of(self, place: int, plane: str, first: int) -> bytes:
        """Returns the spins of one site in up to 500 frames from `first` on, 3 floats each.
        `place`: the site's number in the result of frame(), counted from 0."""
        def read(file):
            shape = file["spins"].shape[1:-1]
            numbers = np.arange(np.prod(shape)).reshape(*shape, 1)
            numbers = plane_of(numbers.shape, plane).cut(numbers).ravel()
            if place >= len(numbers):
                raise ValueError(f"place {place}; accepted: 0 to {len(numbers) - 1}")
            last = max(first, min(self.frames, first + 500))
            return file["spins"][(slice(first, last), *np.unravel_index(numbers[place], shape))]
        return self._read(read).astype("<f4").tobytes()
