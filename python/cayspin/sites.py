# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The two orders of vectors of crystals with several sites in a cell. The library has
(nz * sites, ny, nx, 3), where plane k * sites + s holds site s of the cells in plane k; the package
has (site, nz, ny, nx, 3)."""

from __future__ import annotations

import numpy as np


def by_site(vectors: np.ndarray, sites: int) -> np.ndarray:
    """Returns an array of the library in the order of the package: a view."""
    if sites == 1:
        return vectors
    planes, *rest = vectors.shape
    return vectors.reshape(planes // sites, sites, *rest).swapaxes(0, 1)


def by_plane(vectors: np.ndarray, sites: int) -> np.ndarray:
    """Returns an array of the package in the order of the library: a copy if there are several
    sites."""
    if sites == 1:
        return vectors
    vectors = vectors.swapaxes(0, 1)
    return vectors.reshape(vectors.shape[0] * sites, *vectors.shape[2:])


def shape_by_site(shape: tuple[int, ...], sites: int) -> tuple[int, ...]:
    """The shape of an array (nz, ny, nx) of the library in the order of the package, with sites
    first."""
    planes, *rest = shape
    return shape if sites == 1 else (sites, planes // sites, *rest)
