# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The checksums of frames in files of runs and ensembles, as docs/reference/file_format.md
describes them."""

import numpy as np

MASK = (1 << 64) - 1
WEIGHTS = np.arange(1 << 18, 0, -1.0)  # few enough for sums to be exact in doubles


def fletcher32(data):
    """Returns the checksum of an even number of bytes."""
    words = np.frombuffer(data, ">u2")
    total = total_of_totals = 0
    for first in range(0, len(words), len(WEIGHTS)):
        block = words[first:first + len(WEIGHTS)].astype(np.float64)
        weighted = int(np.einsum("i,i", WEIGHTS[-len(block):], block))
        total_of_totals = _folded(total_of_totals + len(block) * total + weighted)
        total = _folded(total + int(block.sum()))
    return total_of_totals << 16 | total


def _folded(total):
    """Reduces a sum modulo 65535, except that a multiple of 65535 other than 0 becomes 65535."""
    return (total - 1) % 65535 + 1 if total else 0


def _mixed(total, checksum):
    total = ((total ^ checksum) * 0x9E3779B97F4A7C15) & MASK
    return total ^ total >> 32


def of_frame(step, numbers, spins, more=None):
    """The 64-bit checksum of a frame. `numbers`: time, energy, norm_defect, magnetization;
    `more`: numbers that only some files have: the sublattices' magnetizations, the shift and the
    stage."""
    row = np.array([step], "<i8").tobytes() + np.array(numbers, "<f8").tobytes()
    of_row = _mixed(0, fletcher32(row))
    of_spins = _mixed(of_row, fletcher32(spins.tobytes()))
    if more is not None and len(more):
        of_row = _mixed(of_row, fletcher32(np.asarray(more, "<f8").tobytes()))
    halves = [max(1, total & 0xFFFFFFFF) for total in (of_row, of_spins)]
    return halves[0] << 32 | halves[1]


def require_undamaged(file, first, spins):
    """Compares frames of an open trajectory file, or of a Replica, from frame `first` on, with
    their checksums. Raises ValueError for a damaged frame. Files of early versions have no
    checksums, and pass. `spins`: the spins of these frames."""
    known = Checksums(file, first, len(spins))
    for number, one in enumerate(spins, first):
        known.require_undamaged(number, one)


class Checksums:
    """The checksums of `count` frames of an open trajectory file or of a Replica, from frame
    `first` on, and the numbers that they cover beside the spins, read once."""

    def __init__(self, file, first, count):
        self.first, self.rows = first, []
        number = getattr(file, "number", None)
        self.of_replica = "" if number is None else f"replica {number} of "
        if "checksum" not in file:
            return
        those = slice(first, first + count)
        stored, steps = file["checksum"][those], file["step"][those]
        numbers = np.column_stack([file[name][those] for name in (
            "time", "energy", "norm_defect", "magnetization")])
        more = np.concatenate([np.empty((count, 0)), *(
            np.asarray(file[name][those], np.float64).reshape(count, -1)
            for name in ("sublattice_magnetization", "shift", "stage") if name in file)], axis=1)
        self.rows = list(zip(stored, steps, numbers, more))

    def require_undamaged(self, frame, spins):
        """Raises ValueError if the frame with these spins is damaged."""
        if not self.rows:  # a file of an early version
            return
        known, step, numbers, more = self.rows[frame - self.first]
        if of_frame(step, numbers, spins, more) != int(known):
            raise ValueError(f"{self.of_replica}frame {frame} is damaged: its checksum differs")
