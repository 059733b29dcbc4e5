# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The present spins of a simulation as a texture, to draw."""

from __future__ import annotations

from typing import Any

import numpy as np

from cayspin import texture


def texture_of(simulation: Any) -> texture.Texture:
    """Returns the present spins of a Simulation to draw. Includes the positions of the sites if
    these do not form a rectangular grid."""
    scene, spins = simulation.scene, simulation.spins
    _, boundary, si = texture.lattice_of(scene.text)
    cell, places = scene.cell, None
    if spins.ndim == 5 or np.count_nonzero(cell - np.diag(np.diag(cell))):
        numbers = np.stack(np.meshgrid(*map(np.arange, spins.shape[-4:-1]), indexing="ij"), -1)
        places = np.stack([(numbers[..., ::-1] + site) @ cell for site in scene.basis])
        places = places.reshape(spins.shape)
    return texture.Texture(spins, np.diag(cell), boundary, places, si,
                           texture.time_text(simulation.time, si))
