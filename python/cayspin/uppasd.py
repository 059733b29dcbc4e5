# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Bonds, cells and moments from the files of UppASD."""

from __future__ import annotations

import itertools
import os
from typing import Any, Sequence

import numpy as np

from cayspin import arguments
from cayspin._cayspin import CayspinError
from cayspin.bonds import File, as_float, couplings, reversed_bond, unit_of

NEAR = 0.05  # largest distance from the end of a vector to its atom, in units of alat
MOST_CELLS = 1e6  # largest component of a vector or a position, in cells

_TURN_X = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
_TURN_Z = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
_SIXTH_Z = np.array([[0.5, -np.sqrt(0.75), 0], [np.sqrt(0.75), 0.5, 0], [0, 0, 1]])
_MIRROR_X, _MIRROR_Z = np.diag([-1, 1, 1]), np.diag([1, 1, -1])
_GENERATORS: dict[int, list] = {0: [], 1: [_TURN_X, _TURN_Z, -np.eye(3)], 2: [_TURN_Z, _MIRROR_X],
                                3: [_SIXTH_Z, _MIRROR_X, _MIRROR_Z]}


def _columns(file, line, words, accepted, spare=0):
    """Returns the first words of a line, one for each name in `accepted`. These words must be
    numbers. Up to `spare` further numbers may follow; if there are more, the file is of another
    kind and is refused."""
    names = accepted.split()
    numbers = 0
    while numbers < len(words) and as_float(words[numbers]) is not None:
        numbers += 1
    if not len(names) <= numbers <= len(names) + spare:
        file.refuse(line, arguments.counted(numbers, "number"),
                    f"{arguments.counted(len(names), 'number')}, {accepted}")
    return words[:len(names)]


class _Cell:
    """The cell of UppASD and its atoms."""

    def __init__(self, posfile, cell, posfiletype):
        self.vectors = np.eye(3) if cell is None else arguments.numbers(cell, "read_uppasd: cell")
        if self.vectors.shape != (3, 3) or not abs(np.linalg.det(self.vectors)) > 0:
            raise CayspinError("read_uppasd: cell: no volume; accepted: three vectors that span a "
                               "volume")
        self.inverse = np.linalg.inv(self.vectors)
        self.spans = 1 / np.linalg.norm(self.inverse, axis=0)  # between opposite faces
        if not self.spans.min() >= 4 * NEAR:
            raise CayspinError(f"read_uppasd: cell: opposite faces are {self.spans.min():g} apart; "
                               f"accepted: at least {4 * NEAR:g}, in units of alat")
        atoms = [(1, np.zeros(3))] if posfile is None else self._read(posfile)
        self.types = np.array([kind for kind, _ in atoms])
        fractions = np.array([place for _, place in atoms])
        if posfiletype == "C":
            fractions = fractions @ self.inverse
        if not np.abs(fractions).max() <= MOST_CELLS:
            raise CayspinError(f"{posfile}: an atom at {np.abs(fractions).max():g} cells; accepted: "
                               f"at most {MOST_CELLS:g}")
        self.fractions, self.places = fractions, fractions @ self.vectors
        self._fill_bins()

    def _fill_bins(self):
        """Divides the cell into bins; an atom is in each bin from which it is at most NEAR away."""
        self.counts = np.minimum(self.spans / (4 * NEAR), 1e6).astype(int)
        self.bins: dict = {}
        for atom, place in enumerate(self.fractions):
            ends = [np.floor((place + reach) * self.counts).astype(int)
                    for reach in (-NEAR / self.spans, NEAR / self.spans)]
            touched = itertools.product(*(range(low, high + 1) for low, high in zip(*ends)))
            for key in {tuple(one) for one in (np.array(list(touched)) % self.counts).tolist()}:
                self.bins.setdefault(key, []).append(atom)

    @staticmethod
    def _read(posfile):
        file, atoms = File(posfile, "read_uppasd: posfile", "#!"), {}
        line = 1
        for line, words in file.rows:
            words = _columns(file, line, words, "site type x y z")
            atoms[file.whole(line, words[0], "site")] = (file.whole(line, words[1], "type"),
                                                         file.reals(line, words[2:], "number"))
        if not file.rows or sorted(atoms) != list(range(1, len(file.rows) + 1)):
            lines, sites = len(file.rows), len(atoms)
            file.refuse(line, f"{arguments.counted(lines, 'line')} of "
                              f"{arguments.counted(sites, 'site')}",
                        "site type x y z of sites 1, 2, .., each once")
        return [atoms[site] for site in sorted(atoms)]

    def site(self, file, line, word):
        """Returns the index, from 0, of a site that the file counts from 1."""
        site = file.whole(line, word, "site")
        if not 1 <= site <= len(self.types):
            file.refuse(line, f"site {site} of a cell of {len(self.types)}",
                        f"1 to {len(self.types)}, the sites of posfile")
        return site - 1

    def bonds(self, i, j, vector):
        """Yields (site, site, offset) for each bond with this vector, from an atom of the type of i
        to one of the type of j."""
        starts = np.flatnonzero(self.types == self.types[i])
        targets = self.fractions[starts] + vector @ self.inverse
        keys = np.floor(targets * self.counts).astype(int) % self.counts
        near = [(n, end) for n, key in enumerate(keys.tolist())
                for end in self.bins.get(tuple(key), ())]
        rows, ends = np.array(near, int).reshape(-1, 2).T
        cells = targets[rows] - self.fractions[ends]
        whole = np.rint(cells)
        distances = np.linalg.norm((cells - whole) @ self.vectors, axis=1)
        is_bond = (distances < NEAR) & (self.types[ends] == self.types[j])
        for row, end, offset in zip(rows[is_bond], ends[is_bond], whole[is_bond].astype(int)):
            yield int(starts[row]), int(end), tuple(offset.tolist())


def _orbit(vector, generators):
    images = [vector]
    for image in images:
        for turn in generators:
            turned = turn @ image
            if all(np.abs(turned - other).max() > 1e-6 for other in images):
                images.append(turned)
    return images


def _both_ends(file, cell, names, posfiletype, maptype, sym):
    """{(i, j, offset): (line, values)} of a jfile or dmfile, from both ends of each bond."""
    found: dict = {}
    for line, words in file.rows:
        words = _columns(file, line, words, f"site site x y z {names}", spare=1)
        i, j = (cell.site(file, line, word) for word in words[:2])
        vector = file.reals(line, words[2:5], "number")
        values = file.reals(line, words[5:], names.partition("_")[0])
        if maptype == 2:
            vector = cell.places[j] - cell.places[i] + vector @ cell.vectors
        elif posfiletype == "D":
            vector = vector @ cell.vectors
        if not np.abs(vector @ cell.inverse).max() <= MOST_CELLS:
            file.refuse(line, "a vector that is too long", f"one of at most {MOST_CELLS:g} cells")
        is_bond = False
        for image in _orbit(vector, _GENERATORS[sym]):
            for key in cell.bonds(i, j, image):
                is_bond = True
                if reversed_bond(key) == key:
                    file.refuse(line, "couples an atom to itself", "a vector to another atom")
                first, other = found.setdefault(key, (line, values))
                if (other != values).any():
                    file.refuse(line, f"another value for the bond of line {first}",
                                "one value for each vector from a type of atoms")
        if not is_bond:
            place = ", ".join(f"{part:g}" for part in vector)
            file.refuse(line, f"no atom of the type of site {j + 1} is at ({place}) from one of "
                        f"the type of site {i + 1}", "vectors between atoms of posfile")
    return found


def _once(file, both, sign):
    """Returns the bonds of _both_ends(), each only once, with the mean of the values at its two
    ends. `sign`: ratio of these values, 1 for J and -1 for D."""
    once: dict = {}
    largest = max((np.abs(values).max() for _, values in both.values()), default=0)
    for key, (line, values) in both.items():
        back = reversed_bond(key)
        if back in once:
            continue
        if back not in both:
            file.refuse(line, "a bond that is not written from its other end", "both ends of each "
                        "bond" + (", or the sym of inpsd.dat" if sign == 1 else ""))
        other_line, other = both[back]
        if np.abs(values - sign * other).max() > 1e-4 * largest:
            file.refuse(line, f"differs from line {other_line}, the other end of its bond",
                        "the same J" if sign == 1 else "-D there")
        once[key] = (values + sign * other) / 2
    return once


def _moments(momfile, cell):
    file, moments = File(momfile, "read_uppasd: momfile", "#!"), {}
    for line, words in file.rows:
        words = _columns(file, line, words, "site species moment x y z", spare=1)
        site = cell.site(file, line, words[0])
        if file.whole(line, words[1], "species") != 1 or site in moments:
            file.refuse(line, "a second moment of a site", "one for each site, no alloys")
        moments[site] = file.real(line, words[2], "moment")
        if not moments[site] > 0:
            file.refuse(line, f"moment {words[2]}", "a number > 0 of Bohr magnetons")
    if len(moments) != len(cell.types):
        file.refuse(len(file.rows), f"{len(moments)} moments", f"{len(cell.types)}, one for each "
                    "site of posfile")
    return [moments[site] for site in sorted(moments)]


def _one_of(accepted, number, name):
    number = arguments.whole(number, f"read_uppasd: {name}")
    if number not in accepted:
        words = ", ".join(str(one) for one in accepted)
        raise CayspinError(f"read_uppasd: {name} {number}; accepted: {words}")
    return number


def read_uppasd(jfile: str | os.PathLike, *, posfile: str | os.PathLike | None = None,
                momfile: str | os.PathLike | None = None, dmfile: str | os.PathLike | None = None,
                cell: Sequence[Sequence[float]] | None = None, posfiletype: str = "C",
                maptype: int = 1, sym: int = 0, dm_sign: int = -1,
                unit: float | None = None) -> dict[str, Any]:
    """Reads the bonds, the cell and the moments of UppASD's files, as tables of a scene.

        iron = cayspin.read_uppasd("jfile", posfile="posfile", momfile="momfile", sym=1)
        scene = cayspin.Scene(
            units="SI", system={"kind": "llg"}, field=iron["field"],
            material={**iron["material"], "alpha": 0.01, "damping_form": "gilbert"},
            lattice={**iron["lattice"], "shape": [20, 20, 20], "spacing": 2.87e-10},
            initial={"uniform": [0, 0, 1]})

    `jfile` has lines of site, site, x, y, z and J in mRy, `dmfile` of D_x, D_y, D_z in place of J.
    `posfile` has the atoms of the cell (default: one at 0) and `momfile` their moments in Bohr
    magnetons. `cell` has the three vectors of the cell (default: unit vectors). Lengths are in
    units of alat. The next three arguments are keys of inpsd.dat:

    - `posfiletype`: "C" for Cartesian numbers, "D" for multiples of the cell's vectors
    - `maptype`: 1 for vectors between atoms, 2 for the cells between them
    - `sym`: 0 for none, 1 cubic, 2 cubic in the plane, 3 hexagonal; it is applied only to J

    As in UppASD, a line applies to all atoms with the types of its two sites.

    UppASD counts each bond in both orders, so J and D of the result are twice those of the files.
    Each bond is in the result once, with the mean of the values at its two ends. `dm_sign` is the
    sign of D.(m x m') in UppASD's energy: -1 in its manual and up to version 6.0.2, 1 in its source
    of August 2026.

    Returns {"lattice": {"cell", "basis"}, "field": {"couplings"}} and, with `momfile`, also
    "material": {"mu_s"}. Energies are { mRy = .. } and moments { bohr_magnetons = .. }, for a scene
    with units = "SI". With `unit`, an energy in mRy, energies are numbers in units of `unit`, for a
    scene in reduced units, and `momfile` gives lattice.moments in Bohr magnetons.

    Raises CayspinError, with file and line, for an invalid file, for alloys, for a bond with only
    one end or whose ends differ by more than 1e-4 of the largest number, and for a vector that ends
    farther than 0.05 alat from any atom. Directions in `momfile` are not read.
    """
    posfiletype = arguments.word(posfiletype, "read_uppasd: posfiletype")
    if posfiletype not in ("C", "D"):
        raise CayspinError(f'read_uppasd: posfiletype {posfiletype!r}; accepted: "C" or "D"')
    maptype, sym, dm_sign = (_one_of(accepted, value, name) for name, value, accepted in (
        ("maptype", maptype, (1, 2)), ("sym", sym, (0, 1, 2, 3)), ("dm_sign", dm_sign, (-1, 1))))
    unit = unit_of(unit, "read_uppasd: unit")
    atoms = _Cell(posfile, cell, posfiletype)
    file = File(jfile, "read_uppasd: jfile", "#!")
    exchange = _once(file, _both_ends(file, atoms, "J", posfiletype, maptype, sym), 1)
    exchange = {key: 2 * value[0] for key, value in exchange.items()}
    dmi = {}
    if dmfile is not None:
        file = File(dmfile, "read_uppasd: dmfile", "#!")
        both = _both_ends(file, atoms, "D_x D_y D_z", posfiletype, maptype, 0)
        for key, value in _once(file, both, -1).items():
            back, value = reversed_bond(key), -2 * dm_sign * value
            if back in exchange:
                key, value = back, -value
            dmi[key] = value
    if not exchange and not dmi:
        file.refuse(1, "no bonds", "lines of site site x y z J")
    lattice = {"cell": atoms.vectors.tolist(), "basis": atoms.fractions.tolist()}
    tables = {"lattice": lattice, "field": {"couplings": couplings(exchange, dmi, unit, "mRy")}}
    if momfile is not None:
        moments = _moments(momfile, atoms)
        if unit is None:
            of_cell = moments if len(moments) > 1 else moments[0]
            tables["material"] = {"mu_s": {"bohr_magnetons": of_cell}}
        else:
            lattice["moments"] = moments
    return tables
