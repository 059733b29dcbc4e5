# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Functions of spins and of time series, which need only numpy."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple, Sequence

import numpy as np

from cayspin import arguments
from cayspin._cayspin import CayspinError
from cayspin.texture.charge import half_solid_angles


def topological_charge(spins: Any, boundary: Sequence[str] = ("open", "open")) -> np.ndarray:
    """The topological charge Q of each plane (x, y) of `spins` (..., ny, nx, 3), as an array (...).

    Q = sum m.(d_x m x d_y m) / (4 pi), computed as the sum of the solid angles of triangles of
    neighbouring spins, two triangles for each plaquette, divided by 4 pi (Berg and Luescher 1981).
    A skyrmion whose core points down, among spins up, has Q = -1. The lengths of the spins do not
    matter. `boundary`: "open" or "periodic" along x and y; the charge of a plane that is periodic
    along both is a whole number, to round-off.

    Raises CayspinError for an array of another shape, and for an invalid `boundary`.
    """
    spins = arguments.numbers(spins, "topological_charge").astype(np.float64, copy=False)
    if spins.ndim < 3 or spins.shape[-1] != 3:
        raise CayspinError(f"topological_charge: an array of shape {spins.shape}; accepted: "
                           "(..., ny, nx, 3)")
    accepted = 'two words, each "open" or "periodic"'
    boundary = tuple(arguments.word(one, "topological_charge: boundary") for one in
                     arguments.entries(boundary, "topological_charge: boundary", accepted))
    if len(boundary) != 2 or not set(boundary) <= {"open", "periodic"}:
        raise CayspinError(f"topological_charge: boundary {boundary!r}; accepted: {accepted}")
    return half_solid_angles(spins, boundary).sum((-2, -1)) / (2 * np.pi)


@dataclasses.dataclass(frozen=True)
class Dispersion:
    """S(k, w) along a path of wave vectors, from dispersion()."""

    wave_vectors: np.ndarray  #: (k, 3), in fractions of the reciprocal vectors
    distance: np.ndarray  #: (k,), length of the path up to k, in radians / unit of `cell`
    frequency: np.ndarray  #: (w,), angular, in radians / unit of `dt`, rising
    intensity: np.ndarray  #: (k, w), dimensionless
    corners: np.ndarray  #: (corner,), distances of the corners of the path
    labels: list[str]  #: names of the corners

    @property
    def resolution(self) -> float:
        """The spacing of angular frequencies. A sharp line is four spacings wide."""
        return float(self.frequency[1] - self.frequency[0])

    def peak(self) -> np.ndarray:
        """The angular frequency of the largest intensity at each wave vector, (k,)."""
        return self.frequency[self.intensity.argmax(axis=1)]

    def plot(self, axes: Any = None) -> Any:
        """Draws the logarithm of S(k, w) into matplotlib `axes` (default: new ones), which it
        returns. Raises ImportError without matplotlib."""
        axes = arguments.axes(axes)
        floor = self.intensity.max() * 1e-8
        axes.pcolormesh(self.distance, self.frequency,
                        np.log10(np.maximum(self.intensity.T, floor)), shading="nearest")
        axes.set_xticks(self.corners, self.labels)
        axes.set_xlabel("wave vector")
        axes.set_ylabel("angular frequency")
        return axes


def _on_segment(begin, end, shape):
    """Returns the wave vectors of a lattice of `shape` cells that lie on the way from the corner
    `begin` of a path to the corner `end`: their positions along the way, rising from 0 to 1, and
    the wave vectors, (k, 3) whole numbers in units of 1 / shape."""
    step = (end - begin) * shape
    axis = np.abs(step).argmax()
    first, last = sorted((begin[axis] * shape[axis], end[axis] * shape[axis]))
    candidates = np.arange(np.ceil(first - 1e-6), np.floor(last + 1e-6) + 1)
    part = np.sort((candidates - begin[axis] * shape[axis]) / step[axis])
    numbers = begin * shape + part[:, None] * step
    whole = np.rint(numbers)
    on_it = (np.abs(numbers - whole) < 1e-6).all(axis=1)
    return part[on_it], whole[on_it].astype(int)


def _along(path, shape, reciprocal):
    """Returns the wave vectors on a path, (k, 3) whole numbers in units of 1 / shape, their
    distances along the path, and the distances of the path's corners."""
    corners = arguments.numbers(path, "dispersion: path").astype(np.float64)
    if corners.ndim != 2 or corners.shape[1] != 3 or len(corners) < 2:
        raise CayspinError(f"dispersion: a path of shape {corners.shape}; accepted: two or more "
                           "points, each of three fractions of the reciprocal vectors")
    lengths = np.linalg.norm(np.diff(corners, axis=0) @ reciprocal, axis=1)
    if not (np.isfinite(lengths) & (lengths > 0)).all():
        raise CayspinError("dispersion: a path that stands still; accepted: points that differ "
                           "from those before them")
    at = np.concatenate(([0], np.cumsum(lengths)))
    distances, numbers = [], []
    for begin, end, start, length in zip(corners, corners[1:], at, lengths):
        part, found = _on_segment(begin, end, shape)
        if not len(part):
            extents = " x ".join(str(extent) for extent in shape)
            raise CayspinError(
                f"dispersion: no wave vector of {extents} cells lies on the way from "
                f"{tuple(begin.tolist())} to {tuple(end.tolist())}; accepted: fractions of these "
                "extents")
        distances.append(start + length * part)
        numbers.append(found)
    distance = np.concatenate(distances)
    # A wave vector at a corner ends one part of the path and starts the next. It is kept once.
    once = np.diff(distance, prepend=-np.inf) > 1e-9 * at[-1]
    return np.concatenate(numbers)[once], distance[once], at


def _combination(component, about, mean):
    """Returns the coefficients of m_x, m_y and m_z in the component that dispersion()
    transforms."""
    component = arguments.word(component, "dispersion: component")
    if component in ("x", "y", "z"):
        return np.eye(3)["xyz".index(component)].astype(complex)
    if component != "transverse":
        raise CayspinError(f'dispersion: component {component!r}; accepted: "transverse", "x", '
                           '"y" or "z"')
    direction = mean if about is None else arguments.numbers(about, "dispersion: about")
    length = np.linalg.norm(direction)
    if direction.shape != (3,) or not np.isfinite(length) or length < (1e-3 if about is None else
                                                                       1e-300):
        raise CayspinError("dispersion: the spins have no mean direction, or `about` has none; "
                           "accepted: about=(x, y, z), which the spins precess about")
    direction = direction / length
    side = np.eye(3)[np.abs(direction).argmin()]
    first = np.cross(side, direction)
    first /= np.linalg.norm(first)
    return first - 1j * np.cross(direction, first)


def hann(count: int) -> np.ndarray:
    """Hann's window."""
    return np.sin(np.pi * (np.arange(count) + 0.5) / count)**2


def window_in_space(shape: Any, periodic: Sequence[bool]) -> np.ndarray:
    """Returns an array (nz, ny, nx): Hann's window along the axes that are not periodic. `shape`:
    (nx, ny, nz)."""
    window = np.ones(tuple(shape[::-1]))
    for axis, closed in enumerate(periodic):
        if not closed and shape[axis] > 1:
            of_axis = hann(shape[axis])
            window *= of_axis.reshape([-1 if place == 2 - axis else 1 for place in range(3)])
    return window


def checked_lattice(name: str, sites: int, cell: Any, positions: Any,
                    periodic: Any) -> tuple[np.ndarray, np.ndarray, tuple[bool, ...]]:
    """Checks and returns the cell, the positions of its sites and, for each axis, whether it is
    periodic. `sites`: their number in a cell."""
    cell = np.eye(3) if cell is None else arguments.numbers(cell, f"{name}: cell")
    if cell.shape != (3, 3) or not abs(np.linalg.det(cell)) > 0:
        raise CayspinError(f"{name}: cell: no volume; accepted: three vectors that "
                           "span a volume")
    if positions is None:
        if sites > 1:
            raise CayspinError(f"{name}: {sites} sites in a cell, and no positions; accepted: "
                               "positions (site, 3) in fractions of the cell")
        positions = np.zeros((1, 3))
    positions = arguments.numbers(positions, f"{name}: positions")
    if positions.shape != (sites, 3):
        raise CayspinError(f"{name}: positions of shape {positions.shape}; accepted: "
                           f"{(sites, 3)}")
    accepted = "True or False for each of x, y, z"
    periodic = tuple(arguments.flag(one, f"{name}: periodic") for one in
                     arguments.entries(periodic, f"{name}: periodic", accepted))
    if len(periodic) != 3:
        raise CayspinError(f"{name}: periodic {periodic!r}; accepted: {accepted}")
    return cell, positions, periodic


def dispersion(spins: Any, dt: float, path: Any, *, labels: Sequence[str] | None = None,
               cell: Any = None, positions: Any = None,
               periodic: Sequence[bool] = (True, True, True), component: str = "transverse",
               about: Any = None) -> Dispersion:
    """The dynamic structure factor S(k, w) along a path of wave vectors.

    `spins`: frames (frame, nz, ny, nx, 3) at times `dt` apart, or (frame, site, nz, ny, nx, 3) with
    several sites in a cell. They are read frame by frame, also from a dataset of h5py.
    `path`: the corners, each (h, k, l) in fractions of the reciprocal vectors of the cell. They may
    lie beyond the first zone. S is given at the lattice's own wave vectors on the path, multiples
    of (1 / nx, 1 / ny, 1 / nz), without interpolation between them. `labels`: names of the corners.
    `cell`: the three vectors of the cell, along x, y and z of the array (default: unit cubes).
    `positions`: of the sites of a cell, (site, 3), in fractions of its vectors.
    `periodic`: whether each axis is periodic; along one that is not, a Hann window is applied to
    the spins.

    `component` "transverse": S is proportional to |A|^2, where A is the sum over sites and frames
    of (m_1 - i m_2) exp(-i (k.r - w t)), with m_1 and m_2 normal to the mean direction of all
    spins, or to `about`, and right-handed with it. Right-handed motion about that direction, such
    as precession about a field, has w > 0, and its wave exp(i (k.r - w t)) runs along k.
    Left-handed motion appears at (-k, -w). Components "x", "y" and "z" are real, so either motion
    appears at both (k, w) and (-k, -w).

    The time window is Hann's. The sum of S over w is |B|^2 / (number of sites), averaged over the
    frames with the squared window as weight, where B is the sum over sites of
    (m_1 - i m_2) exp(-i k.r). Frequencies are angular, 2 pi / (frames * dt) apart, up to pi / dt.
    Faster motion is aliased: its frequency appears shifted by a multiple of 2 pi / dt.

    Raises CayspinError for arrays and words that do not fit, fewer than four frames, and a path
    without wave vectors of the lattice.
    """
    if not hasattr(spins, "shape"):
        spins = arguments.numbers(spins, "dispersion: spins")
    if len(spins.shape) not in (5, 6) or spins.shape[-1] != 3 or 0 in spins.shape:
        raise CayspinError(f"dispersion: spins of shape {tuple(spins.shape)}; accepted: (frame, "
                           "nz, ny, nx, 3) or (frame, site, nz, ny, nx, 3)")
    frames, sites = spins.shape[0], spins.shape[1] if len(spins.shape) == 6 else 1
    if frames < 4:
        raise CayspinError(f"dispersion: {frames} frames; accepted: at least 4")
    dt = arguments.real(dt, "dispersion: dt")
    if not 0 < dt < np.inf:
        raise CayspinError(f"dispersion: dt {dt:g}; accepted: a number > 0")
    shape = np.array(spins.shape[-2:-5:-1])
    cell, positions, periodic = checked_lattice("dispersion", sites, cell, positions, periodic)
    reciprocal = 2 * np.pi * np.linalg.inv(cell).T
    numbers, distance, corners = _along(path, shape, reciprocal)
    if labels is not None:
        if not isinstance(labels, str):  # "GXM": a letter for each
            labels = arguments.entries(labels, "dispersion: labels", "a list of words")
    else:
        labels = [f"({', '.join(f'{part:.4g}' for part in corner)})" for corner in path]
    if len(labels) != len(corners):
        raise CayspinError(f"dispersion: {len(labels)} labels; accepted: {len(corners)}, one for "
                           "each corner")

    window = window_in_space(shape, periodic)
    window /= np.sqrt(sites * (window**2).sum())
    wave_vectors = numbers / shape
    phases = np.exp(-2j * np.pi * positions @ wave_vectors.T)  # (site, k)
    x, y, z = (numbers % shape).T
    waves, mean = np.empty((frames, len(numbers), 3), complex), np.zeros(3)
    for frame in range(frames):
        m = arguments.numbers(spins[frame], "dispersion: spins").reshape(sites, *shape[::-1], 3)
        mean += m.mean(axis=(0, 1, 2, 3), dtype=np.float64)
        found = np.fft.fftn(m * window[..., None], axes=(1, 2, 3))[:, z, y, x]
        waves[frame] = np.einsum("sk,skc->kc", phases, found)

    wave = waves @ _combination(component, about, mean / frames)
    in_time = hann(frames)
    of_time = np.fft.ifft(wave * in_time[:, None], axis=0) * frames
    intensity = np.abs(np.fft.fftshift(of_time, axes=0))**2 / (frames * (in_time**2).sum())
    frequency = 2 * np.pi * np.fft.fftshift(np.fft.fftfreq(frames, dt))
    return Dispersion(wave_vectors, distance, frequency, intensity.T, corners,
                      [str(label) for label in labels])


class Average(NamedTuple):
    """The mean of numbers over time, from average(). Each field is a number, or an array (...) if
    the values are (time, ...)."""

    mean: Any  #: in the unit of the values
    error: Any  #: standard error of the mean; NaN where the values are too few to tell
    #: number of values in a block, so large that blocks are nearly uncorrelated; 0 where the error
    #: is NaN
    block: Any


def _block_error(values):
    """Returns the standard error of the mean, and the length of the blocks from which the error is
    computed."""
    count, length, alone = len(values), 1, 0.0
    if count > 1 and (values == values[0]).all():
        return 0.0, 1
    while len(values) > 1:
        squared = values.var(ddof=1) / len(values)
        alone = alone or squared
        if length**3 > 2 * count * (squared / alone)**2:
            return np.sqrt(squared), length
        even = len(values) // 2 * 2
        values, length = (values[:even:2] + values[1:even:2]) / 2, 2 * length
    return np.nan, 0


def average(values: Any, skip: int = 0) -> Average:
    """The mean over time of `values` (time, ...), without the first `skip` of them, and the
    standard error of this mean.

    Successive values are correlated, so the error is that of means of blocks
    (Flyvbjerg and Petersen 1989). For n values, the length of blocks is doubled from 1 until it is
    B with B^3 > 2 n (error_B / error_1)^4, where error_B is the error from blocks of length B
    (Lee et al. 2011). At this length, the error due to the correlation of blocks and that due to
    their small number are balanced. B is about (2 n (2 tau)^2)^(1/3) for a correlation time of tau
    values. The values have to be in equilibrium, at equal steps in time. If they span too few
    correlation times, the error is NaN.

    Raises CayspinError when no values are left, or they are not real numbers.
    """
    values = arguments.numbers(values, "average").astype(np.float64, copy=False)
    skip = arguments.whole(skip, "average: skip")
    if values.ndim < 1 or not 0 <= skip < len(values):
        raise CayspinError(f"average: values of shape {values.shape} without the first {skip}; "
                           "accepted: one or more left")
    values = values[skip:]
    columns = values.reshape(len(values), -1).T
    found = [_block_error(column) for column in columns]
    error = np.array([one for one, _ in found]).reshape(values.shape[1:])
    block = np.array([length for _, length in found]).reshape(values.shape[1:])
    return Average(values.mean(axis=0)[()], error[()], block[()])
