# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The dynamic structure factor, from runs and from normal modes, with the same
normalisation."""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Sequence

import numpy as np

from cayspin import arguments, frames
from cayspin._cayspin import CayspinError
from cayspin.modes_file import FileOfModes
from cayspin.observables import checked_lattice, hann, window_in_space

_BOLTZMANN = 1.380649e-23  # J/K
_PAIRS = tuple(a + b for a in "xyz" for b in "xyz")


@dataclasses.dataclass(frozen=True)
class StructureFactor:
    """S(k, w) at all wave vectors of a lattice, from structure_factor() and
    linear_structure_factor(). The dicts have an entry for each of the components."""

    wave_vectors: np.ndarray  #: (kz, ky, kx, 3), in fractions of the reciprocal vectors, rising
    frequency: np.ndarray  #: (w,), angular, in radians / unit of time, rising
    intensity: dict[str, np.ndarray]  #: S, (kz, ky, kx, w), in units of time / radian
    integrated: dict[str, np.ndarray]  #: the integral of S over all w, (kz, ky, kx), dimensionless


class _Waves:
    """The wave vectors of a lattice, and the Fourier amplitudes of vectors on its sites."""

    def __init__(self, name, shape, components, cell, positions, periodic, zones):
        *of_cell, nz, ny, nx = shape
        self.sites, self.grid = of_cell[0] if of_cell else 1, (nz, ny, nx)
        cell, positions, periodic = checked_lattice(name, self.sites, cell, positions, periodic)
        self.components = _words(name, components)
        zones = [arguments.whole(one, f"{name}: zones") for one in arguments.entries(
            zones, f"{name}: zones", "three whole numbers > 0")]
        if len(zones) != 3 or min(zones) < 1:
            raise CayspinError(f"{name}: zones {tuple(zones)}; accepted: three whole numbers > 0")
        self.window = window_in_space((nx, ny, nz), periodic)
        numbers = [np.arange(count * extent) - count * extent // 2
                   for count, extent in zip(zones[::-1], self.grid)]
        at = np.meshgrid(*numbers, indexing="ij")
        self.wave_vectors = np.stack([at[2] / nx, at[1] / ny, at[0] / nz], -1)
        self.shape = self.wave_vectors.shape[:-1]
        flat = self.wave_vectors.reshape(-1, 3)
        self.of_fft = tuple(one.ravel() % extent for one, extent in zip(at, self.grid))
        self.phases = np.exp(-2j * np.pi * positions @ flat.T)  # (site, k)
        across = flat @ np.linalg.inv(cell).T
        length = np.linalg.norm(across, axis=1, keepdims=True)
        self.along = across / np.where(length > 0, length, 1)
        self.at_zero = length[:, 0] == 0

    def weight(self, spins):
        """The squared window, summed over the sites that have a spin."""
        there = spins.reshape(self.sites, *self.grid, 3).any(-1)
        return (there * self.window**2).sum()

    def amplitudes(self, vectors):
        """Returns the Fourier amplitudes of vectors v on the sites r, (k, 3): the sum over sites of
        window * v * exp(-i k.r)."""
        vectors = vectors.reshape(self.sites, *self.grid, 3) * self.window[..., None]
        found = np.fft.fftn(vectors, axes=(1, 2, 3))[(slice(None), *self.of_fft)]
        return np.einsum("sk,skc->kc", self.phases, found)

    def products(self, word, amplitude):
        """Returns the product of amplitudes (..., k, 3) for a component such as "xy" or "total",
        (..., k)."""
        if word in _PAIRS:
            a, b = ("xyz".index(letter) for letter in word)
            if a == b:
                return np.abs(amplitude[..., a])**2
            return amplitude[..., a] * amplitude[..., b].conj()
        total = (np.abs(amplitude)**2).sum(-1)
        if word == "total":
            return total
        along = np.abs((amplitude * self.along).sum(-1))**2
        return np.where(self.at_zero, total * (2 / 3), total - along)


def _words(name, components):
    accepted = '"xx", "xy", .. "zz", "total", "perpendicular", or several of them'
    if isinstance(components, str):
        components = (components,)
    words = [arguments.word(one, f"{name}: components")
             for one in arguments.entries(components, f"{name}: components", accepted)]
    for word in words:
        if word not in (*_PAIRS, "total", "perpendicular"):
            raise CayspinError(f"{name}: component {word!r}; accepted: {accepted}")
    if not words:
        raise CayspinError(f"{name}: no components; accepted: {accepted}")
    return words


def _runs(spins):
    """Returns the runs to average over as a list. Raises CayspinError if their shapes differ."""
    runs = list(spins) if isinstance(spins, (list, tuple)) else [spins]
    if not runs:
        raise CayspinError("structure_factor: no runs; accepted: one or more arrays of frames")
    runs = [one if hasattr(one, "shape") else arguments.numbers(one, "structure_factor: spins")
            for one in runs]
    for one in runs:
        shape = tuple(one.shape)
        if len(shape) not in (5, 6) or shape[-1] != 3 or 0 in shape:
            raise CayspinError(f"structure_factor: spins of shape {shape}; accepted: (frame, nz, "
                               "ny, nx, 3) or (frame, site, nz, ny, nx, 3), or a list of these")
        if shape != tuple(runs[0].shape):
            raise CayspinError(f"structure_factor: runs of shapes {tuple(runs[0].shape)} and "
                               f"{shape}; accepted: runs of one shape")
    if runs[0].shape[0] < 4:
        raise CayspinError(f"structure_factor: {runs[0].shape[0]} frames; accepted: at least 4")
    return runs


def structure_factor(spins: Any, dt: float, *, components: str | Sequence[str] = ("xx", "yy", "zz"),
                     window: str = "hann", subtract_mean: bool = False, cell: Any = None,
                     positions: Any = None, periodic: Sequence[bool] = (True, True, True),
                     zones: Sequence[int] = (1, 1, 1)) -> StructureFactor:
    """The dynamic structure factor S(k, w) at all wave vectors of the lattice, from runs.

    `spins`: frames (frame, nz, ny, nx, 3) at times `dt` apart, or (frame, site, nz, ny, nx, 3) with
    several sites in a cell; or a list of such runs, over which S is averaged. They are read frame
    by frame, also from datasets of h5py.

    With m(k, t) = sum over sites of m(r, t) exp(-i k.r) / sqrt(N), for N sites with a spin,

        S_ab(k, w) = 1 / (2 pi) integral of <m_a(k, t) m_b(k, 0)*> exp(i w t) dt

    A wave exp(i (k.r - w t)) has its line at (k, w). The integral of S_aa over w is <|m_a(k)|^2>.
    Sum rule: that integral, averaged over k and summed over a = x, y, z, is <|m|^2> = 1. It holds
    to round-off.

    `components`: "xx", "xy", .. "zz" (complex where the letters differ); "total": xx + yy + zz;
    "perpendicular": the part normal to k, which scatters neutrons, the sum over a and b of
    (delta_ab - k_a k_b / k^2) S_ab. At k = 0 it is 2/3 of the total.
    `window`: in time, "hann" or "none". S is divided by the mean square of the window. A sharp line
    is four steps of frequency wide with "hann", and has long tails with "none".
    `subtract_mean`: removes the mean in time (weighted by the squared window) of each run's
    m(k, t), and so the elastic line at w = 0. The sum rule then lacks the squares of the means.
    `cell`: the three vectors of the cell, along x, y and z of the array (default: unit cubes).
    `positions`: of the sites of a cell, (site, 3), in fractions of its vectors.
    `periodic`: whether each axis is periodic; along one that is not, a Hann window is applied to
    the spins.
    `zones`: the number of Brillouin zones along each reciprocal vector. The waves of several sites
    in a cell interfere differently in each zone, and the sum rule holds for the mean over enough of
    them: positions times zones have to be whole numbers, as with (2, 2, 2) for bcc.

    Frequencies are angular, 2 pi / (frames * dt) apart, up to pi / dt. Faster motion is aliased.

    Raises CayspinError for arrays, words and numbers that do not fit, and fewer than four frames.
    """
    runs = _runs(spins)
    count, name = runs[0].shape[0], "structure_factor"
    dt = arguments.real(dt, f"{name}: dt")
    if not 0 < dt < np.inf:
        raise CayspinError(f"{name}: dt {dt:g}; accepted: a number > 0")
    window = arguments.word(window, f"{name}: window")
    if window not in ("hann", "none"):
        raise CayspinError(f'{name}: window {window!r}; accepted: "hann" or "none"')
    subtract_mean = arguments.flag(subtract_mean, f"{name}: subtract_mean")
    waves = _Waves(name, runs[0].shape[1:-1], components, cell, positions, periodic, zones)
    in_time = hann(count) if window == "hann" else np.ones(count)
    share = in_time**2 / (in_time**2).sum()

    intensity = {word: 0.0 for word in waves.components}
    for run in runs:
        amplitude, weight = np.empty((count, *waves.along.shape), complex), 0.0
        for frame in range(count):
            m = arguments.numbers(run[frame], f"{name}: spins").astype(np.float64, copy=False)
            weight = weight or waves.weight(m)
            amplitude[frame] = waves.amplitudes(m)
        if not weight > 0:
            raise CayspinError(f"{name}: no site has a spin; accepted: spins")
        if subtract_mean:
            amplitude -= np.einsum("t,tkc->kc", share, amplitude)
        amplitude *= in_time[:, None, None]
        amplitude = np.fft.fftshift(np.fft.ifft(amplitude, axis=0, norm="forward"), axes=0)
        scale = dt / (2 * np.pi * weight * (in_time**2).sum() * len(runs))
        for word in intensity:
            intensity[word] = intensity[word] + scale * waves.products(word, amplitude)

    frequency = 2 * np.pi * np.fft.fftshift(np.fft.fftfreq(count, dt))
    intensity = {word: np.moveaxis(values, 0, -1).reshape(*waves.shape, count)
                 for word, values in intensity.items()}
    step = 2 * np.pi / (count * dt)
    integrated = {word: values.sum(-1) * step for word, values in intensity.items()}
    return StructureFactor(waves.wave_vectors, frequency, intensity, integrated)


def linear_structure_factor(modes: Any, temperature: float, frequency: Any, *, spins: Any = None,
                            moments: Any = None, width: float = 0.0,
                            components: str | Sequence[str] = ("xx", "yy", "zz"), cell: Any = None,
                            positions: Any = None, periodic: Sequence[bool] | None = None,
                            zones: Sequence[int] = (1, 1, 1)) -> StructureFactor:
    """The dynamic structure factor S(k, w) of normal modes in classical thermal equilibrium, in the
    normalisation of structure_factor().

    `modes`: the file of `cayspin modes`, or the Modes of Simulation.modes() with `spins`, the state
    (nz, ny, nx, 3) that they belong to. Modes of read_modes() have this state. Only these modes
    contribute: compute all of them if S is to be compared with a run. `temperature` is that of
    thermal.temperature, in K in SI. `frequency`: the frequencies of S, (w,), angular and rising, as
    those of structure_factor().

    The mean energy of each mode is k_B T. A deviation Re(c v exp(i w_n t)), where v is the shape of
    mode n and w_n its frequency, has the energy |c|^2 w_n Q / 4, with
    Q = sum of (mu / g) i m.(v* x v). With v(k) = sum of v exp(-i k.r) / sqrt(N), for N sites with a
    spin, the mode contributes

        S_ab(k, w) = k_B T / (w_n Q) (u_a(k) u_b(k)* L(w - w_n) + v_a(k) v_b(k)* L(w + w_n))

    where u(k) is computed from v* in place of v, and L is a Lorentzian of area 1 whose half width
    at half maximum is the decay of the mode plus `width`. `integrated` has the areas of all lines.
    In linear theory, these areas are exact without damping and for circular precession; otherwise
    they hold for small damping. The elastic line of the state itself and longitudinal fluctuations
    are not included.

    `moments`: mu / g of each site, an array that broadcasts to the spins without their last axis.
    By default they are those of the scene, so they are needed only if the scene of a file has
    values per site in other files, which are not beside it. In reduced units, mu and g are
    lattice.moments and lattice.gyromagnetic. In SI, mu / g is mu_s / gamma in J s, with `Ms` times
    the volume of a cell in place of mu_s; with the damping_form "gilbert", it is multiplied by
    1 + alpha^2.

    `components`, `cell`, `positions`, `periodic` and `zones` are those of structure_factor(); if
    `modes` is a file, the lattice is the scene's by default.

    Raises CayspinError for a mode that does not oscillate or lowers the energy, for modes that did
    not converge or are under [torque], for a file of bands, for Modes without spins, and for
    arrays, words and numbers that do not fit.
    """
    name = "linear_structure_factor"
    temperature = arguments.real(temperature, f"{name}: temperature")
    width = arguments.real(width, f"{name}: width")
    for label, value in (("temperature", temperature), ("width", width)):
        if not 0 <= value < np.inf:
            raise CayspinError(f"{name}: {label} {value:g}; accepted: a number >= 0")
    frequency = arguments.numbers(frequency, f"{name}: frequency").astype(np.float64)
    if frequency.ndim != 1 or not len(frequency) or not np.isfinite(frequency).all() or (
            np.diff(frequency) <= 0).any():
        raise CayspinError(f"{name}: frequency of shape {frequency.shape}; accepted: rising "
                           "numbers (w,)")
    lattice = {"cell": cell, "positions": positions, "periodic": periodic}
    time_unit, source = 1.0, name
    if isinstance(modes, (str, os.PathLike)):
        if spins is not None:
            raise CayspinError(f"{name}: spins beside a file that has them; accepted: Modes with "
                               "spins, or a file")
        modes = FileOfModes(name, modes, moments)
        source = modes.path
        spins = modes.spins
        given = {key: value for key, value in lattice.items() if value is not None}
        lattice = frames.with_lattice(modes.path, modes.scene, given)
    elif not all(hasattr(modes, part) for part in ("frequency", "decay", "shape")):
        raise CayspinError(f"{name}: a {type(modes).__name__}; accepted: Modes with spins, or the "
                           "name of a file of cayspin modes")
    elif spins is None and (spins := getattr(modes, "spins", None)) is None:
        raise CayspinError(f"{name}: Modes without spins; accepted: spins=sim.spins")
    if getattr(modes, "under_current", False):
        raise CayspinError(f"{source}: the scene has a torque, and no thermal equilibrium; "
                           "accepted: modes of a scene without [torque]")
    if not getattr(modes, "converged", True):
        raise CayspinError(f"{source}: the modes did not converge; accepted: modes that converged")
    rates, decay = np.asarray(modes.frequency), np.asarray(modes.decay)
    if energy_unit := getattr(modes, "energy_unit", None):
        time_unit = modes.time_unit
        temperature *= _BOLTZMANN / energy_unit
        rates, decay = 2 * np.pi * rates * time_unit, decay * time_unit
    if lattice["periodic"] is None:
        lattice["periodic"] = (True, True, True)
    spins = arguments.numbers(spins, f"{name}: spins").astype(np.float64, copy=False)
    if spins.ndim not in (4, 5) or modes.shape.shape[1:] != spins.shape or not len(modes.shape):
        raise CayspinError(f"{name}: spins of shape {spins.shape} and modes of shape "
                           f"{modes.shape.shape}; accepted: modes (mode, ..) of these spins")
    waves = _Waves(name, spins.shape[:-1], components, zones=zones, **lattice)
    if moments is None:
        moments = getattr(modes, "moments", None)
    weights = arguments.numbers(1.0 if moments is None else moments, f"{name}: moments")
    if energy_unit and moments is not None:
        weights = weights.astype(np.float64) / (energy_unit * time_unit)
    try:
        weights = np.broadcast_to(weights, spins.shape[:-1])
    except ValueError:
        raise CayspinError(f"{name}: moments of shape {weights.shape}; accepted: one that "
                           f"broadcasts to {spins.shape[:-1]}") from None
    decay = decay + width * time_unit
    # The energies of modes of amplitude 1, divided by their frequencies.
    turning = spins * np.cross(modes.shape.real, modes.shape.imag)
    actions = -(weights[..., None] * turning).reshape(len(turning), -1).sum(1) / 2
    fastest = rates.max()
    for number, (rate, half, action) in enumerate(zip(rates, decay, actions)):
        if not rate > 1e-7 * fastest:
            raise CayspinError(f"{name}: mode {number} does not oscillate; accepted: modes with "
                               "frequencies > 0")
        if not action > 0:
            raise CayspinError(f"{name}: mode {number} lowers the energy; accepted: modes of a "
                               "minimum of the energy")
        if not half > 0:
            raise CayspinError(f"{name}: mode {number} is a line without width; accepted: a "
                               "width > 0")

    norm = waves.weight(spins)
    flat = {word: np.zeros((len(frequency), len(waves.along)), complex)
            for word in waves.components}
    areas = {word: np.zeros(len(waves.along), complex) for word in waves.components}
    reduced = frequency * time_unit
    for rate, half, action, shape in zip(rates, decay, actions, modes.shape):
        scale = temperature / (4 * action * rate * norm)
        for sign, wave in ((1, shape.conj()), (-1, shape)):
            line = half / np.pi / ((reduced - sign * rate)**2 + half**2) * time_unit
            amplitude = waves.amplitudes(wave)
            for word in waves.components:
                product = scale * waves.products(word, amplitude)
                flat[word] += line[:, None] * product
                areas[word] += product

    def shaped(values, word, *more):
        values = values if word in _PAIRS and word[0] != word[1] else values.real
        return np.moveaxis(values, 0, -1).reshape(*waves.shape, *more) if more else (
            values.reshape(waves.shape))

    return StructureFactor(
        waves.wave_vectors, frequency,
        {word: shaped(values, word, len(frequency)) for word, values in flat.items()},
        {word: shaped(values, word) for word, values in areas.items()})
