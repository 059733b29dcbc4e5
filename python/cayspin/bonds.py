# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Reads the files of other programs, and converts bonds to the form of a scene."""

from __future__ import annotations

from typing import Any

import numpy as np

from cayspin import arguments
from cayspin._cayspin import CayspinError


def as_float(word):
    """Returns a word as a float, also one in Fortran's form 1.0d-3. Returns None if it is no
    number."""
    try:
        return float(word.lower().replace("d", "e"))
    except ValueError:
        return None


class File:
    """The lines of a text file, split into words, without comments. Errors name the line."""

    def __init__(self, path, name, comments="#"):
        self.path = arguments.file_name(path, name)
        try:
            with open(self.path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise CayspinError(f"{self.path}: cannot be read: {reason}") from None
        self.rows = []
        for line, content in enumerate(text.split("\n"), 1):
            for mark in comments:
                content = content.partition(mark)[0]
            if content.split():
                self.rows.append((line, content.split()))

    def refuse(self, line, wrong, accepted):
        raise CayspinError(f"{self.path}:{line}: {wrong}; accepted: {accepted}")

    def whole(self, line, word, name):
        try:
            return int(word)
        except ValueError:
            self.refuse(line, f"{name} {word}", "a whole number")

    def real(self, line, word, name):
        value = as_float(word)
        if value is None or not np.isfinite(value):
            self.refuse(line, f"{name} {word}", "a finite number")
        return value

    def reals(self, line, words, name):
        return np.array([self.real(line, word, name) for word in words])


def _energy(value, unit, name):
    """Returns an energy, or a vector of energies, in the form of a scene: with `unit` the number
    value / unit, otherwise {name: value}, where `name` names the unit of `value`, such as meV."""
    value = np.asarray(value, float)
    return {name: value.tolist()} if unit is None else (value / unit).tolist()


def unit_of(unit, name):
    if unit is None:
        return None
    unit = arguments.real(unit, name)
    if not 0 < unit < np.inf:
        raise CayspinError(f"{name}: {unit:g}; accepted: a number > 0")
    return unit


def reversed_bond(key):
    i, j, offset = key
    return j, i, tuple(-cells for cells in offset)


def couplings(exchange, dmi, unit, name):
    """Returns the table field.couplings for bonds: `exchange` is {(i, j, offset): J}, and `dmi` is
    {(i, j, offset): D}."""
    pairs = []
    for key in dict.fromkeys((*exchange, *dmi)):
        pair: dict[str, Any] = {"between": list(key[:2]), "offset": list(key[2])}
        if key in exchange:
            pair["J"] = _energy(exchange[key], unit, name)
        if key in dmi:
            pair["D"] = _energy(dmi[key], unit, name)
        pairs.append(pair)
    return {"pairs": pairs}
