# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Frames of a file at equal steps of time, and the lattice of the scene that wrote them."""

from __future__ import annotations

from typing import Any

import numpy as np

from cayspin import arguments
from cayspin._cayspin import CayspinError
from cayspin.scene import Scene
from cayspin.texture import toml


class Frames:
    """Some of the frames of a dataset, read one by one; of one replica where its frames have
    several."""

    def __init__(self, dataset: Any, frames: range, replica: int | None = None):
        self.dataset, self.frames, self.replica = dataset, frames, replica
        self.shape = (len(frames), *dataset.shape[1 if replica is None else 2:])

    def __getitem__(self, frame: int) -> np.ndarray:
        if self.replica is None:
            return self.dataset[self.frames[frame]]
        return self.dataset[self.frames[frame], self.replica]


def at_equal_steps(file: Any, path: Any, count: int, frames: Any,
                   name: str) -> tuple[range, float]:
    """The frames that a slice chooses from a file of `count`, and the time from one to the next."""
    if not isinstance(frames, slice):
        raise CayspinError(f"{name}: frames {frames!r}; accepted: a slice")
    try:
        chosen = range(count)[frames]
    except (TypeError, ValueError):
        raise CayspinError(f"{name}: frames {frames!r}; accepted: a slice of whole numbers"
                           ) from None
    if chosen.step < 0:
        raise CayspinError(f"{name}: frames {frames!r} go back in time; accepted: a slice "
                           "with a step above 0")
    if len(chosen) < 4:
        raise CayspinError(f"{name}: {len(chosen)} frames; accepted: at least 4")
    time = file["time"][:][chosen]
    dt = (time[-1] - time[0]) / (len(time) - 1)
    if not (np.abs(np.diff(time) - dt) < 1e-6 * dt).all():
        raise CayspinError(f"{path}: frames at unequal steps of time; accepted: equal "
                           "ones, as in frames=slice(0, -1)")
    return chosen, dt


def tables(path: Any, text: str, key: str, otherwise: str) -> dict:
    """The tables of a scene, from which a key is read; `otherwise` is accepted in its place."""
    try:
        return toml.loads(text)
    except ImportError as error:
        raise CayspinError(f"{path}: to read {key} of its scene takes {error}; accepted: "
                           f"{otherwise}") from None


def along_axes(path: Any, text: str, key: str, default: Any, argument: str) -> list:
    """The scene's lattice.KEY for x, y and z: one for all axes, or one for each."""
    read = tables(path, text, f"lattice.{key}", f"the argument {argument}")
    given = read.get("lattice", {}).get(key, default)
    given = given if isinstance(given, list) else [given] * 3
    return given + [default] * (3 - len(given))


def crystal(path: Any, text: str, argument: str) -> Scene:
    """A scene with only these cells."""
    read = tables(path, text, "lattice.cell", f"the argument {argument}")
    lattice = read.get("lattice", {})
    cells = {key: lattice[key] for key in ("crystal", "cell", "basis") if key in lattice}
    cells["shape"] = [*lattice["shape"], 1, 1][:3]
    cells["spacing"] = along_axes(path, text, "spacing", 1.0, argument)
    return Scene(system={"kind": "llg", "damping": 0.0}, lattice=cells,
                 initial={"uniform": [0, 0, 1]})


def with_lattice(path: Any, text: str, options: dict) -> dict:
    """Options with periodic, cell and positions of the scene where they are not given."""
    options = dict(options)
    if "periodic" not in options:
        words = along_axes(path, text, "boundary", "open", "periodic")
        options["periodic"] = [word == "periodic" for word in words]
    for key, attribute in (("cell", "cell"), ("positions", "basis")):
        if key not in options:
            options[key] = getattr(crystal(path, text, key), attribute)
    return options
