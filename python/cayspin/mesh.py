# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Shapes from surfaces of triangles."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from cayspin import _cayspin, arguments


def _triangles(mesh):
    if isinstance(mesh, (str, os.PathLike)):
        try:
            import trimesh
        except ImportError:
            raise _cayspin.CayspinError(
                "occupied_of_mesh: files need trimesh; install it (pip install trimesh), or give "
                "an array of triangles (count, 3, 3)") from None
        try:
            mesh = trimesh.load_mesh(mesh)
        except (OSError, ValueError, NotImplementedError) as error:
            raise _cayspin.CayspinError(f"occupied_of_mesh: {mesh}: {error}") from None
    corners = arguments.numbers(getattr(mesh, "triangles", mesh), "occupied_of_mesh: triangles")
    corners = corners.astype(np.float64, copy=False)
    if corners.ndim != 3 or corners.shape[1:] != (3, 3) or not len(corners) \
            or not np.isfinite(corners).all():
        raise _cayspin.CayspinError(
            f"occupied_of_mesh: triangles of shape {corners.shape}; accepted: finite numbers of "
            "shape (count, 3, 3)")
    return corners


def _up_to_three(values, name, accepted):
    """Returns the one to three values given for x, y and z as a list."""
    values = arguments.entries(values, f"occupied_of_mesh: {name}", accepted)
    if not 1 <= len(values) <= 3:
        raise _cayspin.CayspinError(f"occupied_of_mesh: {name} of {len(values)} numbers; "
                                    f"accepted: {accepted}")
    return values


def _cells(shape):
    accepted = "one to three whole numbers >= 1"
    cells = [arguments.whole(one, "occupied_of_mesh: shape")
             for one in _up_to_three(shape, "shape", accepted)]
    if min(cells) < 1:
        raise _cayspin.CayspinError(f"occupied_of_mesh: shape {cells}; accepted: {accepted}")
    return np.array([*cells, 1, 1][:3])


def _edges(spacing):
    accepted = "a number > 0, or one to three of them"
    if not np.iterable(spacing):
        spacing = [spacing] * 3
    edges = [arguments.real(one, "occupied_of_mesh: spacing")
             for one in _up_to_three(spacing, "spacing", accepted)]
    if not all(0 < edge < np.inf for edge in edges):
        raise _cayspin.CayspinError(f"occupied_of_mesh: spacing {edges}; accepted: {accepted}")
    return np.array([*edges, 1.0, 1.0][:3])


def occupied_of_mesh(mesh: Any, shape: tuple[int, ...], spacing: float | tuple[float, ...] = 1.0, *,
                     scale: float = 1.0, center: bool = True) -> np.ndarray:
    """Finds the cells of a lattice whose centre is inside a closed surface. Returns an array
    (nz, ny, nx) for lattice.occupied, which is True for these cells.

    `mesh` is a file of triangles (STL, OBJ, PLY, ..; read by trimesh), an object with an attribute
    `triangles`, or an array (count, 3, 3) of corners. `shape` (nx, ny, nz) and `spacing` are those
    of the lattice; the corners times `scale` are in the unit of `spacing`. With `center` the mesh's
    bounding box is centred in the lattice; otherwise the origin of the mesh is the lattice's
    corner. Bodies that overlap are united, if the corners of all triangles are counter-clockwise
    seen from outside.

    Raises CayspinError for a mesh that cannot be read, for other arguments, and where trimesh is
    missing.
    """
    cells, edges = _cells(shape), _edges(spacing)
    scale = arguments.real(scale, "occupied_of_mesh: scale")
    if not 0 < abs(scale) < np.inf:
        raise _cayspin.CayspinError(f"occupied_of_mesh: scale {scale}; accepted: a finite number "
                                    "other than 0")
    corners = _triangles(mesh) * scale
    if arguments.flag(center, "occupied_of_mesh: center"):
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        corners = corners - (low + high) / 2 + cells * edges / 2
    corners = corners / edges - 0.5  # in units of cells, from the middle of the first cell
    # Shifts the mesh slightly, so that no line along z through the middle of a cell meets an edge
    # or lies in a face.
    corners = corners + [1.234567e-7, 2.718281e-7, 3.141592e-7]
    first = np.maximum(np.ceil(corners.min(axis=1)[:, :2]), 0).astype(int)
    last = np.minimum(np.floor(corners.max(axis=1)[:, :2]), cells[:2] - 1).astype(int)
    wide = np.maximum(last - first + 1, 0)
    count = wide.prod(axis=1)  # columns of cells that each triangle may meet
    of = np.repeat(np.arange(len(corners)), count)
    turn = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
    x, y = first[of, 0] + turn % wide[of, 0], first[of, 1] + turn // wide[of, 0]
    a, (b, c) = corners[:, 0], np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 0)
    area = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
    dx, dy = x - a[of, 0], y - a[of, 1]
    with np.errstate(divide="ignore", invalid="ignore"):  # for triangles parallel to z
        of_b = (dx * c[of, 1] - dy * c[of, 0]) / area[of]
        of_c = (b[of, 0] * dy - b[of, 1] * dx) / area[of]
        met = (of_b >= 0) & (of_c >= 0) & (of_b + of_c <= 1)
    of, x, y = of[met], x[met], y[met]
    z = a[of, 2] + of_b[met] * b[of, 2] + of_c[met] * c[of, 2]
    below = np.clip(np.ceil(z), 0, cells[2]).astype(int)  # cells whose middle is below
    turns = np.zeros((cells[2] + 1, cells[1], cells[0]), dtype=int)
    np.add.at(turns, (below, y, x), np.where(area[of] > 0, 1, -1))
    # A cell is inside if more surfaces above it lead out of the body than into it (fewer, if the
    # mesh is inside out).
    above = np.cumsum(turns[::-1], axis=0)[::-1][1:]
    return above != 0
