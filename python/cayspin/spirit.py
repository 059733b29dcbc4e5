# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Bonds from the files of Spirit."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from cayspin.bonds import File, couplings, reversed_bond, unit_of

_VECTOR = ("dijx", "dijy", "dijz")
_WHOLE = ("i", "j", "da", "db", "dc")


def _spirit_table(file):
    """Returns the header and the rows below it, each as the number of its line and its words."""
    for n, (line, words) in enumerate(file.rows):
        if words[0] == "n_interaction_pairs":
            count = file.whole(line, words[1] if len(words) > 1 else "", "n_interaction_pairs")
            rows = file.rows[n + 1:n + 2 + count]
            if count < 1 or len(rows) < count + 1:
                file.refuse(line, f"{count} pairs, and {max(len(rows) - 1, 0)} rows below",
                            "a header, and as many rows as n_interaction_pairs says")
            return rows[0], rows[1:]
        if words[0] == "interaction_pairs_file":
            file.refuse(line, "names another file", f"that file, {' '.join(words[1:])}")
    if len(file.rows) < 2:
        file.refuse(1, "no pairs", "a header and rows below it, or n_interaction_pairs")
    return file.rows[0], file.rows[1:]


def read_spirit_pairs(path: str | os.PathLike, *, unit: float | None = None) -> dict[str, Any]:
    """Reads the pairs of Spirit, from a separate file or from an input file with
    n_interaction_pairs, as the value of field.couplings in a scene.

        field = {"couplings": cayspin.read_spirit_pairs("pairs.txt")}

    `path` has a header that names columns, in any order: i, j, da, db, dc, Jij, Dijx, Dijy, Dijz
    and Dij. With Dij, the length of D, the vector gives only its direction. Other columns are not
    read. Numbers are in meV, and D is Cartesian. E = -J m.m' - D.(m x m') with each pair once, as
    in a scene. A pair that is listed twice, or from both ends, gets the sum of both entries, as in
    Spirit.

    Energies are { meV = .. }, for a scene with units = "SI". With `unit`, an energy in meV, they
    are numbers in units of `unit`, for a scene in reduced units. Sites i and j count as in
    lattice.basis, from 0.

    Raises CayspinError, with file and line, for a file without such a table, and for columns Dija,
    Dijb and Dijc, which mean something else in Spirit's documentation than in its source.
    """
    unit = unit_of(unit, "read_spirit_pairs: unit")
    file = File(path, "read_spirit_pairs: path")
    (header, names), rows = _spirit_table(file)
    names = [name.lower() for name in names]
    accepted = "i j da db dc Jij Dij Dijx Dijy Dijz"
    if {"dija", "dijb", "dijc"} & set(names):
        file.refuse(header, "columns Dija, Dijb or Dijc", "the Cartesian Dijx, Dijy and Dijz")
    known = [name for name in names if name in accepted.lower().split()]
    parts = [name in names for name in _VECTOR]
    if not ("jij" in names or all(parts)) or len(set(known)) < len(known) or \
            any(parts) != all(parts) or ("dij" in names and not all(parts)):
        file.refuse(header, f"columns {' '.join(names)}",
                    f"some of {accepted}, Jij or all of Dijx Dijy Dijz among them")
    exchange: dict = {}
    dmi: dict = {}
    for line, words in rows:
        if len(words) != len(names):
            file.refuse(line, f"{len(words)} columns", f"{len(names)}, as in the header")
        given = dict(zip(names, words))
        i, j, *offset = (file.whole(line, given.get(name, "0"), name) for name in _WHOLE)
        key = i, j, tuple(offset)
        if min(i, j) < 0:
            file.refuse(line, f"sites {i} and {j}", "numbers from 0")
        if reversed_bond(key) == key:
            file.refuse(line, "couples a site to itself", "another site, or da, db, dc")
        strength = file.real(line, given.get("jij", "0"), "Jij")
        vector = file.reals(line, [given.get(name, "0") for name in _VECTOR], "Dij")
        if "dij" in given:
            length, norm = file.real(line, given["dij"], "Dij"), np.linalg.norm(vector)
            if length and not norm:
                file.refuse(line, "Dij of no direction", "Dijx, Dijy, Dijz not all 0")
            vector = vector * (length / norm if norm else 0)
        back = reversed_bond(key)
        sign = 1
        if back in exchange or back in dmi:
            key, sign = back, -1
        if strength:
            exchange[key] = exchange.get(key, 0) + strength
        if vector.any():
            dmi[key] = dmi.get(key, 0) + sign * vector
    if not exchange and not dmi:
        file.refuse(header, "no pair with Jij or D", "at least one")
    return couplings(exchange, dmi, unit, "meV")
