# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads frames at equal time steps from a file, and the lattice of the scene in the file."""

from __future__ import annotations

import contextlib
from typing import Any, Iterable, Iterator

import numpy as np

from cayspin import arguments, texture
from cayspin._cayspin import CayspinError
from cayspin.scene import Scene
from cayspin.texture import checksum, toml
from cayspin.texture.replica import Replica


@contextlib.contextmanager
def reading(file: Any, path: Any) -> Iterator[None]:
    """Turns errors of h5py, and of the text of a scene, into a CayspinError with a one-line
    message. Also raises CayspinError for a closed file."""
    if not file:
        raise CayspinError(f"{path}: the file is closed; accepted: an open one")
    try:
        yield
    except (ArithmeticError, AttributeError, LookupError, OSError, RuntimeError, TypeError,
            ValueError) as error:
        reason = " ".join(str(error.args[-1] if error.args else error).split())
        raise CayspinError(f"{path}: cannot be read: {reason}") from None


def found_in(file: Any, names: Iterable[str]) -> dict[str, Any]:
    """Returns the arrays and groups of a file with these names, None for those that are missing.
    Unlike file.get(), raises KeyError for a damaged array or group."""
    return {name: file[name] if name in file else None for name in names}


def texture_of(file: Any, path: Any, frame: int, before: int | None = None,
               replica: int | None = None) -> tuple[texture.Texture, np.ndarray | None]:
    """Returns a frame to draw, and the spins of the frame `before`, if it is given. `replica`: only
    for the file of an ensemble."""
    with reading(file, path):
        try:
            if replica is not None:
                file = Replica(file, replica)
            shown, other = texture.of_file(file, frame, before)
            _require_undamaged(file, frame, shown.spins)
            if before is not None:
                _require_undamaged(file, before, other)
            return shown, other
        except ValueError as error:
            raise CayspinError(f"{path}: {error}") from None


def _require_undamaged(file, frame, spins):
    checksum.require_undamaged(file, texture.frame_number(file, frame), spins[np.newaxis])


class Frames:
    """Some of the frames of a dataset, each read when it is indexed. With `replica`, the dataset is
    that of an ensemble, and only this replica is read. Otherwise it is that of a trajectory. A
    damaged frame raises CayspinError."""

    def __init__(self, dataset: Any, frames: range, replica: int | None = None):
        self.dataset, self.frames, self.replica = dataset, frames, replica
        self.path, self.checksums = dataset.file.filename, None
        self.shape = (len(frames), *dataset.shape[1 if replica is None else 2:])

    def __getitem__(self, frame: int) -> np.ndarray:
        place = self.frames[frame]
        with reading(self.dataset, self.path):
            file, spins = self.dataset.file, self.dataset
            if self.replica is not None:
                file = Replica(file, self.replica)
                spins = file["spins"]
            if self.checksums is None:
                self.checksums = checksum.Checksums(file, 0, max(self.frames) + 1)
            spins = spins[place]
            self.checksums.require_undamaged(place, spins)
            return spins


def at_equal_steps(file: Any, path: Any, count: int, frames: Any,
                   name: str) -> tuple[range, float]:
    """Returns the frames that a slice chooses from a file of `count` frames, and the time between
    successive ones. Raises CayspinError if that time is not constant."""
    if not isinstance(frames, slice):
        raise CayspinError(f"{name}: frames {arguments.shown(frames)}; accepted: a slice")
    try:
        chosen = range(count)[frames]
    except (TypeError, ValueError):
        raise CayspinError(f"{name}: frames {arguments.shown(frames)}; accepted: a slice of whole numbers"
                           ) from None
    if chosen.step < 0:
        raise CayspinError(f"{name}: frames {arguments.shown(frames)} go back in time; accepted: a slice "
                           "with a step above 0")
    if len(chosen) < 4:
        raise CayspinError(f"{name}: {len(chosen)} frames; accepted: at least 4")
    with reading(file, path):
        time = file["time"][:][chosen]
    dt = (time[-1] - time[0]) / (len(time) - 1)
    if not (np.abs(np.diff(time) - dt) < 1e-6 * dt).all():
        raise CayspinError(f"{path}: frames at unequal steps of time; accepted: equal "
                           "ones, as in frames=slice(0, -1)")
    return chosen, dt


def tables(path: Any, text: str, key: str, otherwise: str) -> dict:
    """Parses the TOML text of a scene. If no TOML parser is installed, the error says that `key`
    could not be read, and names `otherwise`, which the caller accepts instead."""
    try:
        return toml.loads(text)
    except ValueError as error:
        raise CayspinError(f"{path}: its scene cannot be read: {error}") from None
    except ImportError as error:
        raise CayspinError(f"{path}: reading {key} of its scene requires {error}; accepted: "
                           f"{otherwise}") from None


def along_axes(path: Any, text: str, key: str, default: Any, argument: str) -> list:
    """The three values of the scene's lattice.KEY, for x, y and z."""
    read = tables(path, text, f"lattice.{key}", f"the argument {argument}")
    lattice = read.get("lattice")
    given = lattice.get(key, default) if isinstance(lattice, dict) else default
    given = given if isinstance(given, list) else [given] * 3
    return given + [default] * (3 - len(given))


def crystal(path: Any, text: str, argument: str) -> Scene:
    """Returns a Scene with the cells of the scene `text`: their number, spacing, vectors and sites.
    The system and the initial state are arbitrary, because a Scene needs both."""
    read = tables(path, text, "lattice.cell", f"the argument {argument}")
    lattice = read.get("lattice")
    if not isinstance(lattice, dict) or not isinstance(lattice.get("shape"), list):
        raise CayspinError(f"{path}: its scene has no lattice.shape; accepted: the argument "
                           f"{argument}")
    cells = {key: lattice[key] for key in ("crystal", "cell", "basis") if key in lattice}
    cells["shape"] = [*lattice["shape"], 1, 1][:3]
    cells["spacing"] = along_axes(path, text, "spacing", 1.0, argument)
    return Scene(system={"kind": "llg", "damping": 0.0}, lattice=cells,
                 initial={"uniform": [0, 0, 1]})


def with_lattice(path: Any, text: str, options: dict) -> dict:
    """Returns the options. Takes periodic, cell and positions from the scene if they are not
    given."""
    options = dict(options)
    if "periodic" not in options:
        words = along_axes(path, text, "boundary", "open", "periodic")
        options["periodic"] = [word == "periodic" for word in words]
    for key, attribute in (("cell", "cell"), ("positions", "basis")):
        if key not in options:
            options[key] = getattr(crystal(path, text, key), attribute)
    return options
