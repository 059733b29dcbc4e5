# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads the file of a sweep into numpy arrays."""

from dataclasses import dataclass

import numpy as np

from .read import opened


@dataclass
class Sweep:
    """A sweep. The arrays have one axis for each key, in the order of `keys`."""

    path: str
    keys: list  # of names
    values: list  # for each key, its values as typed
    numbers: list  # for each key, its values as floats, or None
    done: np.ndarray  # bool
    failed: np.ndarray  # bool; runs still to do are neither done nor failed
    energy: np.ndarray
    magnetization: np.ndarray  # (..., 3)
    complete: bool


def read_sweep(path):
    """Reads a sweep. Runs that failed or are still to do have NaN as results."""
    with opened(path, "sweep") as file:
        if "sweep_format" not in file.attrs:
            raise ValueError("it has no sweep")
        keys = [name.decode() for name in file["keys"][:]]
        columns = [[value.decode() for value in column] for column in file["values"][:].T]
        values = [list(dict.fromkeys(column)) for column in columns]
        # One number for each typed value: 0.1 and 0.10 count as two values.
        numbers = [list(dict(zip(column, file["parameters"][key][:])).values())
                   if key in file["parameters"] else None for key, column in zip(keys, columns)]
        shape = [len(value) for value in values]
        status = file["status"][:].reshape(shape)  # exit status, or -1 without a run
        done = status == 0
        magnetization = file["magnetization"][:].reshape(*shape, 3)
        return Sweep(
            path=str(path),
            keys=keys,
            values=values,
            numbers=numbers,
            done=done,
            failed=status > 0,
            energy=np.where(done, file["energy"][:].reshape(shape), np.nan),
            magnetization=np.where(done[..., None], magnetization, np.nan),
            complete=bool(file.attrs["complete"]),
        )
