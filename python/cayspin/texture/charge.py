# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The solid angles of spins on a plane (Berg and Luescher 1981)."""

from __future__ import annotations

from typing import Sequence

import numpy as np


def _half_solid_angle(a, b, c):
    """Returns half the solid angle of three spins, from -pi to pi; 0 if they are coplanar to
    round-off."""
    def dot(u, v):
        return np.einsum("...i,...i", u, v)

    of_a, of_b, of_c = (np.sqrt(dot(u, u)) for u in (a, b, c))
    volume, lengths = dot(a, np.cross(b, c)), of_a * of_b * of_c
    rest = lengths + dot(a, b) * of_c + dot(b, c) * of_a + dot(c, a) * of_b
    return np.where(np.abs(volume) < 1e-15 * lengths + 1e-300, 0, np.arctan2(volume, rest))


def half_solid_angles(spins: np.ndarray, boundary: Sequence[str]) -> np.ndarray:
    """Returns, for each square of neighbouring spins, half the sum of the solid angles of its two
    triangles. `spins`: (..., ny, nx, 3). The result is (..., ny - 1, nx - 1), one larger along
    periodic axes of two or more spins. `boundary`: "open" or "periodic" for x and y. The sum of the
    result, divided by 2 pi, is the topological charge."""
    for axis, word in zip((-2, -3), boundary):
        if word == "periodic" and spins.shape[axis] > 1:
            spins = np.concatenate((spins, spins.take([0], axis)), axis)
    here, east = spins[..., :-1, :-1, :], spins[..., :-1, 1:, :]
    north, beyond = spins[..., 1:, :-1, :], spins[..., 1:, 1:, :]
    return _half_solid_angle(here, east, north) + _half_solid_angle(beyond, north, east)
