# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Files of ensembles."""

from __future__ import annotations

import os
from typing import Any

from cayspin import arguments, texture
from cayspin._cayspin import CayspinError
from cayspin.texture.replica import Replica


class Ensemble:
    """An open file of a scene with [ensemble]. Its members are read when they are indexed:
    ensemble.spins[-1, 5].

    spins (frame, replica, nz, ny, nx, 3), of crystals with several sites in a cell (frame, replica,
    site, nz, ny, nx, 3); time, step (frame); energy, norm_defect (frame, replica); magnetization
    (frame, replica, 3); scalars: these five at the samples; vary: the values (replica) of each
    varied key. Of `cayspin relax`: torque, converged, evaluations (replica). Use it in a `with`, or
    call close().
    """

    _names = ("spins", "time", "step", "energy", "norm_defect", "magnetization")
    _of_searches = ("torque", "converged", "evaluations")

    def __init__(self, path: str | os.PathLike, file: Any):
        self.path, self.file = path, file
        self.scalars = {name: file["scalars"][name] for name in file["scalars"]}
        self.vary = {name: file["vary"][name][:] for name in file["vary"]}

    def __getattr__(self, name: str) -> Any:
        if name in self._names:
            return self.file[name]
        if name in self._of_searches:
            if name in self.file:
                return self.file[name]
            raise AttributeError(f"{self.path}: it has no {name}; accepted: a file of cayspin relax")
        raise AttributeError(name)

    @property
    def replicas(self) -> int:
        """The number of replicas."""
        return int(self.file.attrs["replicas"])

    @property
    def scene(self) -> str:
        """The TOML text of the scene that ran."""
        return self.file.attrs["scene"]

    @property
    def complete(self) -> bool:
        """Whether the run ended as planned."""
        return bool(self.file.attrs["complete"])

    def plot(self, replica: int = 0, frame: int = -1, axes: Any = None, **options: Any) -> Any:
        """Draws the spins of a replica in a frame, as Trajectory.plot does. Raises CayspinError for
        other replicas, frames, planes and words."""
        replica = arguments.whole(replica, "plot: replica")
        frame = arguments.whole(frame, "plot: frame")
        try:
            shown, options["before"] = texture.of_file(Replica(self.file, replica), frame)
            return texture.draw(shown, axes, **options)
        except ValueError as error:
            raise CayspinError(f"{self.path}: {error}") from None

    def __len__(self) -> int:
        """Whole frames: a killed run may leave the spins of one without its scalars."""
        return min(len(self.file[name]) for name in self._names)

    def __enter__(self) -> Ensemble:
        return self

    def __exit__(self, *exception: Any) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file."""
        self.file.close()
