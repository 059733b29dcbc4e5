# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Spins at one time, and the plane of them that is drawn."""

from __future__ import annotations

import dataclasses
import re
from typing import Any, Sequence

import numpy as np

from . import toml

AXES = "xyz"
OF_FRAMES = ("spins", "time", "step", "energy", "norm_defect", "magnetization", "checksum",
             "sublattice_magnetization", "shift", "stage")


@dataclasses.dataclass
class Texture:
    """Spins at one time, and where they are."""

    spins: np.ndarray  #: (nz, ny, nx, 3), for crystals (site, nz, ny, nx, 3); 0: no spin
    spacing: Sequence[float] = (1.0, 1.0, 1.0)  #: of cells along x, y and z
    boundary: Sequence[str] = ("open", "open", "open")  #: or "periodic"
    positions: np.ndarray | None = None  #: of the sites of a crystal, in the shape of `spins`
    si: bool = False  #: lengths are in m, otherwise in reduced units
    title: str = ""


@dataclasses.dataclass
class Plane:
    """A plane of a texture. Its axes, 0 to 2 for x to z: `right`, `up` and `normal`."""

    right: int
    up: int
    normal: int
    number: int  #: counted from 0 along the normal
    of: int  #: number of planes along the normal

    def cut(self, values: np.ndarray) -> np.ndarray:
        """The values of this plane, (..., up, right, 3), from values (..., nz, ny, nx, 3)."""
        return np.take(values, self.number, axis=values.ndim - 2 - self.normal)

    @property
    def axes(self) -> list[int]:
        """The axes right, up and normal, in this order."""
        return [self.right, self.up, self.normal]

    def vectors(self, values: np.ndarray) -> np.ndarray:
        """Returns the vectors of this plane, with components along right, up and the normal."""
        return self.cut(values)[..., self.axes]

    def sites(self, positions: np.ndarray | None) -> tuple[np.ndarray, float]:
        """Positions (n, 3) of the sites of a crystal along right, up and the normal, and about how
        far apart the sites are."""
        if positions is None:
            raise ValueError("the sites of the crystal have no positions; accepted: a file of a "
                             "scene")
        places = self.vectors(positions)
        places = places.reshape(-1, *places.shape[-3:])
        sites, up, right = places.shape[:3]
        edges = [places[0, 0, min(1, right - 1)] - places[0, 0, 0],
                 places[0, min(1, up - 1), 0] - places[0, 0, 0]]
        area = abs(edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0])
        apart = np.sqrt(area / sites) or np.linalg.norm(edges, axis=1).max() or 1.0
        return places.reshape(-1, 3), apart


def plane_of(shape: Sequence[int], plane: str | None) -> Plane:
    """Returns the plane that a text such as "z=0" names, or for None the middle plane across the
    axis of fewest cells. `shape`: (..., nz, ny, nx, 3)."""
    extents = shape[-2:-5:-1]
    if plane is None:
        normal = min((2, 1, 0), key=lambda axis: extents[axis])
        number = extents[normal] // 2
    else:
        found = re.fullmatch(r"\s*([xyz])\s*=\s*(\d{1,18})\s*", str(plane))
        if not found:
            raise ValueError(f"plane {plane!r}; accepted: an axis and the number of a plane, as in "
                             '"z=0"')
        normal, number = AXES.index(found[1]), int(found[2])
        if number >= extents[normal]:
            raise ValueError(f"plane {plane!r}; accepted: {found[1]}=0 to "
                             f"{found[1]}={extents[normal] - 1}")
    right, up = [axis for axis in range(3) if axis != normal]
    return Plane(right, up, normal, number, extents[normal])


def lattice_of(scene: str) -> tuple[list[float], list[str], bool]:
    """Spacing and boundary along x, y and z in the text of a scene, and whether it is in SI."""
    if not scene:
        return [1.0] * 3, ["open"] * 3, False
    try:
        tables = toml.loads(scene)
    except ImportError as error:
        raise ValueError(f"reading the text of a scene requires {error}") from None
    found = []
    for key, otherwise in (("spacing", 1.0), ("boundary", "open")):
        given = tables.get("lattice", {}).get(key, otherwise)
        given = given if isinstance(given, list) else [given] * 3
        found.append(given + [otherwise] * (3 - len(given)))
    return found[0], found[1], tables.get("units") == "SI"


def require_rectangular(scene: str) -> None:
    """Raises ValueError for the text of a scene whose cells are not boxes with one site. Files of
    paths and modes have no positions of sites."""
    lattice = toml.loads(scene).get("lattice", {}) if scene else {}
    cell = lattice.get("cell", np.eye(3))
    if "crystal" in lattice or len(lattice.get("basis", [0])) != 1 or not np.array_equal(
            cell, np.eye(3)):
        raise ValueError("its sites are not on a rectangular grid, and it has no positions; "
                         "accepted: the file of a run")


def time_text(time: float, si: bool) -> str:
    """A time for titles: in reduced units, or in s with a prefix."""
    if not si:
        return f"t = {time:.6g}"
    from matplotlib.ticker import EngFormatter

    return f"t = {EngFormatter('s')(float(f'{time:.6g}'))}"


def frames_in(file: Any) -> int:
    """The number of complete frames of an open file of a run or an ensemble. A killed run may have
    written some numbers of another frame."""
    count = min(len(file[name]) for name in OF_FRAMES if name in file)
    # Numbers of ensembles that never reached the disk are NaN, and their checksums 0.
    while count and "ensemble_format" in file.attrs and _lacks_numbers(file, count - 1):
        count -= 1
    return count


def _lacks_numbers(file, row):
    """The energy is not examined, because that of a program's own field may be NaN."""
    numbers = [file[name][row] for name in ("time", "norm_defect", "magnetization")]
    if "checksum" in file and not np.all(file["checksum"][row]):
        return True
    return file["step"][row] < 0 or any(np.isnan(one).any() for one in numbers)


def frame_number(file: Any, frame: int) -> int:
    """The number of a complete frame of an open trajectory file, counted from 0. Negative numbers
    count from the end."""
    count = frames_in(file)
    if not -count <= frame < count:
        accepted = f"{-count} to {count - 1}" if count else "a file that holds frames"
        raise ValueError(f"frame {frame}; accepted: {accepted}")
    return frame % count


def require_trajectory(file: Any) -> None:
    """Raises ValueError if the open file is not a trajectory."""
    missing = [name for name in ("spins", "time") if name not in file]
    if missing or file["spins"].ndim not in (5, 6) or file["spins"].shape[-1] != 3:
        lacks = missing[0] if missing else "frames of spins"
        raise ValueError(f"not a trajectory: it has no {lacks}; accepted: the file of a run")


def of_file(file: Any, frame: int = -1,
            before: int | None = None) -> tuple[Texture, np.ndarray | None]:
    """Returns frame number `frame` of an open trajectory file (h5py.File), and the spins of frame
    number `before`, or None. Raises ValueError for frames that are not in the file, and for a file
    that is not a trajectory."""
    require_trajectory(file)
    number = frame_number(file, frame)
    spacing, boundary, si = lattice_of(file.attrs.get("scene", ""))
    title = f"frame {number}"
    if "converged" not in file.attrs:  # in a file of cayspin relax, `time` is the state's number
        title += f", {time_text(file['time'][number], si)}"
    other = None
    if before is not None:
        before = frame_number(file, before)
        other, title = file["spins"][before], f"{title}, difference from frame {before}"
    positions = file["positions"][:] if "positions" in file else None
    return Texture(file["spins"][number], spacing, boundary, positions, si, title), other
