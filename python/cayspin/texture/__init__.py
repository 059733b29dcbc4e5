# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Pictures of spin textures, with only numpy and matplotlib. Errors are ValueErrors of one line.

    axes = draw(of_file(h5py.File("film.h5"), frame=-1)[0])
"""

from .pictures import OPTIONS, draw, largest
from .spins import (Texture, frame_number, frames_in, lattice_of, of_file, plane_of,
                    require_rectangular, require_trajectory, time_text)

__all__ = ["OPTIONS", "Texture", "draw", "frame_number", "frames_in", "largest", "lattice_of",
           "of_file", "plane_of", "require_rectangular", "require_trajectory", "time_text"]
