# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Files of UppASD and Spirit: energies of the scenes, compared with sums over the files' bonds. The
keys that replace those of Sunny: frequencies of magnons."""

import itertools
import unittest

import cayspin
import numpy as np
from package_test import PackageTest

MRY, MEV, MU_B = 2.1798723611030e-21, 1.602176634e-22, 9.2740100657e-24
HEXAGONAL = np.array([[1, 0, 0], [0.5, np.sqrt(0.75), 0], [0, 0, 1.4]])
CUBE = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
# Two sites of one type: each is the other's neighbour.
BCC = "1 1 0 0 0\n2 1 0.5 0.5 0.5\n"


def text_of(rows):
    return "".join(" ".join(repr(float(one)) if isinstance(one, float) else str(one)
                            for one in row) + "\n" for row in rows)


def spiral(lattice, shape, turns, normal):
    """Returns spins of a crystal that turn about `normal` by 2 pi q.r, and q in turns per cell."""
    q = np.array(turns) / shape
    side = np.cross(normal, [0.3, -0.7, 0.2])
    first = side / np.linalg.norm(side)
    second = np.cross(normal, first)
    cells = np.stack(np.meshgrid(*map(np.arange, shape[::-1]), indexing="ij"), -1)[..., ::-1]
    phase = np.stack([2 * np.pi * (cells + site) @ q for site in np.array(lattice["basis"])])
    return np.cos(phase)[..., None] * first + np.sin(phase)[..., None] * second, q


def energy(tables, shape, spins, **further):
    """Returns the energy per site."""
    of_scene = cayspin.Scene(
        system={"kind": "llg", **({} if "units" in further else {"damping": 0.0})},
        lattice={**tables["lattice"], "shape": list(shape), "boundary": "periodic",
                 **({"spacing": 3e-10} if "units" in further else {})},
        field=tables["field"], initial=spins, **further)
    return cayspin.Simulation(of_scene).energy() / (spins.size / 3)


class Files(PackageTest):
    def file(self, text, name="jfile"):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def pairs(self, jfile, **options):
        return cayspin.read_uppasd(self.file(jfile), **options)["field"]["couplings"]["pairs"]


class UppasdEnergies(Files):
    def test_iron_in_joules(self):
        tables = cayspin.read_uppasd(
            self.file("1 1 0.5 0.5 0.5 1.3d0 ! first\n1 1 1.0 0 0 0.7\n"), sym=1,
            posfile=self.file(BCC, "posfile"),
            momfile=self.file("1 1 2.2 0 0 1\n2 1 2.1 0 0 1\n", "momfile"))
        self.assertEqual(tables["material"], {"mu_s": {"bohr_magnetons": [2.2, 2.1]}})
        spins = np.broadcast_to([0.0, 0, 1], (2, 3, 4, 5, 3))
        si = {"units": "SI", "material": {**tables["material"], "alpha": 0.0}}
        # Bonds to 8 and to 6 neighbours, each in both orders
        self.assertAlmostEqual(energy(tables, (5, 4, 3), spins, **si) / MRY, -(8 * 1.3 + 6 * 0.7),
                               delta=1e-12)
        field = {**tables["field"], "applied": [0, 0, 10.0]}
        self.assertAlmostEqual(energy({**tables, "field": field}, (5, 4, 3), spins, **si) / MRY,
                               -(8 * 1.3 + 6 * 0.7) - 2.15 * MU_B * 10 / MRY, delta=1e-11)

    def test_spirals_of_all_ways_to_write_bonds(self):
        """With dm_sign = -1, the E of a site is minus the sum over all r of (J(r) cos(q.r) +
        n.D(r) sin(q.r)), q in radians."""
        random = np.random.default_rng(5)
        cell, shape = HEXAGONAL, (4, 6, 3)
        basis = np.array([[0, 0, 0], [1 / 3, 1 / 3, 0.25]])  # of two types
        bonds = []  # from both ends: site, site, cells, J, D
        for i, j, cells in ((0, 0, (1, 0, 0)), (0, 1, (0, 0, 0)), (0, 1, (-1, 0, 1)),
                            (1, 1, (1, -2, 1))):
            J, D = random.normal(), random.normal(size=3)
            bonds += [(i, j, np.array(cells), J, D), (j, i, -np.array(cells), J, -D)]
        normal = np.array([2, -1, 2]) / 3
        for kind, maptype in (("C", 1), ("D", 1), ("C", 2), ("D", 2)):
            rows_J, rows_D = [], []
            for i, j, cells, J, D in bonds:
                vector = cells if maptype == 2 else cells + basis[j] - basis[i]
                vector = vector.astype(float) @ (cell if (kind, maptype) == ("C", 1) else np.eye(3))
                rows_J.append((i + 1, j + 1, *vector, J))
                rows_D.append((i + 1, j + 1, *vector, *D))
            places = basis @ cell if kind == "C" else basis
            for sign in (-1, 1):
                tables = cayspin.read_uppasd(
                    self.file(text_of(rows_J)), dmfile=self.file(text_of(rows_D[::-1]), "dmfile"),
                    posfile=self.file(text_of((n + 1, n + 1, *place)
                                              for n, place in enumerate(places)), "posfile"),
                    cell=cell, posfiletype=kind, maptype=maptype, dm_sign=sign, unit=1)
                spins, q = spiral(tables["lattice"], shape, (1, 2, -1), normal)
                angles = [2 * np.pi * (cells + basis[j] - basis[i]) @ q
                          for i, j, cells, _, _ in bonds]
                expected = -sum(J * np.cos(angle) - sign * D @ normal * np.sin(angle)
                                for angle, (_, _, _, J, D) in zip(angles, bonds)) / 2
                with self.subTest(f"{kind} {maptype} {sign}"):
                    found = energy(tables, shape, spins)
                    self.assertLess(abs(found - expected), 1e-12 * abs(expected))

    def test_the_handedness_of_one_bond(self):
        """With dm_sign = -1, a chain that turns from x to y has 2 D less energy per site, as both
        orders count."""
        along, back = "1 1 1 0 0 0 0 0.3\n", "1 1 -1 0 0 0 0 -0.3\n"
        for sign, expected in ((-1, -0.6), (1, 0.6)):
            tables = cayspin.read_uppasd(
                self.file("1 1 1 0 0 0\n1 1 -1 0 0 0\n"), unit=1, dm_sign=sign,
                dmfile=self.file(along + back, "dmfile"))
            quarter = np.array([[[[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]]])
            self.assertAlmostEqual(energy(tables, (4, 1, 1), quarter), expected, delta=1e-15)
            self.assertAlmostEqual(energy(tables, (4, 1, 1), quarter[:, :, ::-1]), -expected,
                                   delta=1e-15)


class UppasdFiles(Files):
    def test_symmetries(self):
        cubic = self.pairs("1 1 1 2 3 0.5\n", sym=1, unit=1)
        expected = {tuple(np.array(one) * sign) for one in itertools.permutations((1, 2, 3))
                    for sign in itertools.product((1, -1), repeat=3)}
        found = {tuple(pair["offset"]) for pair in cubic}
        self.assertEqual(len(found), 24)
        self.assertEqual(found | {tuple(-np.array(one)) for one in found}, expected)
        self.assertEqual({pair["J"] for pair in cubic}, {1.0})
        numpy = {"sym": np.array(1), "maptype": np.uint8(1), "dm_sign": np.array(-1)}
        self.assertEqual(self.pairs("1 1 1 2 3 0.5\n", unit=np.float32(1), **numpy), cubic)
        plane = self.pairs("1 1 1 2 3 0.5\n1 1 -1 -2 -3 0.5\n", sym=2)
        self.assertEqual(len(plane), 8)
        self.assertEqual({abs(pair["offset"][2]) for pair in plane}, {3})
        self.assertEqual(plane[0]["J"], {"mRy": 1.0})
        vector = np.array([1, 2, 1]) @ HEXAGONAL
        hexagonal = self.pairs(text_of([(1, 1, *vector, 0.5)]), sym=3, cell=HEXAGONAL)
        lengths = [np.linalg.norm(pair["offset"] @ HEXAGONAL) for pair in hexagonal]
        np.testing.assert_allclose(lengths, [np.linalg.norm(vector)] * 12)
        self.assertEqual(len(self.pairs("1 1 1 0 0 0.5\n", sym=3, cell=HEXAGONAL)), 3)

    def test_lines_are_of_types(self):
        """Only one of two sites of a type has a neighbour along +x."""
        posfile = self.file("2 4 0.3 0 0\n1 4 0 0 0\n", "posfile")
        found = self.pairs("1 1 0.3 0 0 2.0\n2 1 -0.3 0 0 2.0\n", posfile=posfile, unit=4)
        self.assertEqual(found, [{"between": [0, 1], "offset": [0, 0, 0], "J": 1.0}])

    def test_positions_and_vectors_of_few_digits(self):
        """Atoms in a row are up to 0.02 off whole numbers, and the vectors are whole numbers."""
        places = np.arange(40) + np.random.default_rng(3).uniform(-0.02, 0.02, 40)
        posfile = self.file(text_of((n + 1, 1, place, 0, 0) for n, place in enumerate(places)),
                            "posfile")
        found = self.pairs("1 1 1 0 0 1\n1 1 -1 0 0 1\n", posfile=posfile,
                           cell=np.diag([40, 1, 1]))
        self.assertEqual([(*pair["between"], pair["offset"][0]) for pair in found],
                         [(n, (n + 1) % 40, n // 39) for n in range(40)])

    def test_ends_that_differ_by_their_last_digit(self):
        found = self.pairs("1 1 1 0 0 2.0001\n1 1 -1 0 0 2.0003\n", unit=1)
        self.assertAlmostEqual(found[0]["J"], 4.0004, delta=1e-15)
        self.assertEqual(len(found), 1)

    def test_reduced_units_have_the_moments_in_the_lattice(self):
        tables = cayspin.read_uppasd(self.file("1 1 1 0 0 1\n"), sym=1, unit=2,
                                     momfile=self.file("1 1 2.5 1 0 0 2.0\n", "momfile"))
        self.assertEqual(tables["lattice"]["moments"], [2.5])
        self.assertNotIn("material", tables)

    def test_refusals(self):
        good = "1 1 1 0 0 0.5\n1 1 -1 0 0 0.5\n"
        for text, part, options in (
                ("", "jfile:1: no bonds", {}),
                ("1 1 1 0 0\n", "jfile:1: 5 numbers; accepted: 6 numbers, site site x y z J", {}),
                ("1 1 1 1 1 0 0 0.5\n", "jfile:1: 8 numbers", {}),
                ("1 1 1 0 0 0.5\n1 1 1 0 0 0.6\n", "jfile:2: another value for the bond of line 1",
                 {}),
                ("1 1 1 0 0 0.5\n\n1 1 0 1 0 0.6\n", "jfile:1: a bond that is not written from its "
                 "other end; accepted: both ends of each bond, or the sym", {}),
                ("1 1 1 0 0 0.5\n1 1 -1 0 0 0.6\n", "jfile:1: differs from line 2", {}),
                ("1 1 0 0 0 0.5\n", "jfile:1: couples an atom to itself", {}),
                ("1 2 1 0 0 0.5\n", "jfile:1: site 2 of a cell of 1; accepted: 1 to 1", {}),
                ("1 1 0.4 0 0 0.5\n", "is at (0.4, 0, 0) from one of the type of site 1", {}),
                ("1 1 0.5 0 0 0.5\n", "jfile:1: no atom of the type of site 1 is at (0.5, 0, 0)",
                 {"posfile": self.file("1 1 0 0 0\n2 2 0.5 0 0\n", "two")}),
                ("1 1 1 0 0 nan\n", "jfile:1: J nan; accepted: a finite number", {}),
                ("x 1 1 0 0 1\n", "jfile:1: 0 numbers", {}),
                ("1.5 1 1 0 0 1\n", "jfile:1: site 1.5; accepted: a whole number", {}),
                (good, "posfiletype 'E'; accepted: \"C\" or \"D\"", {"posfiletype": "E"}),
                (good, "maptype 3; accepted: 1, 2", {"maptype": 3}),
                (good, "sym 4; accepted: 0, 1, 2, 3", {"sym": 4}),
                (good, "dm_sign 0; accepted: -1, 1", {"dm_sign": 0}),
                (good, "unit: 0; accepted: a number > 0", {"unit": 0}),
                (good, "cell: no volume; accepted: three vectors that span a volume",
                 {"cell": np.ones((3, 3))}),
                (good, "faces are 3e-10 apart; accepted: at least 0.2, in units of alat",
                 {"cell": np.diag([1, 1, 3e-10])}),
                ("1 1 1e300 0 0 0.5\n", "jfile:1: a vector that is too long", {}),
                (good, "far: an atom at 2e+06 cells", {"posfile": self.file("1 1 2e6 0 0\n", "far")}),
                (good, "nowhere: cannot be read: No such file", {"dmfile": self.folder / "nowhere"}),
                (good, "posfile:2: 2 lines of 1 site",
                 {"posfile": self.file("1 1 0 0 0\n1 1 0.5 0 0\n", "posfile")}),
                (good, "momfile:1: moment 0", {"momfile": self.file("1 1 0 0 0 1\n", "momfile")}),
                (good, "m2:2: a second moment",
                 {"momfile": self.file("1 1 1 0 0 1\n1 2 1 0 0 1\n", "m2")}),
                (good, "dmfile:1: differs from line 2, the other end of its bond; accepted: -D",
                 {"dmfile": self.file("1 1 1 0 0 0 0 1\n1 1 -1 0 0 0 0 1\n", "dmfile")})):
            self.assert_refused(cayspin.CayspinError, part, self.pairs, text, **options)


PAIRS = """  # Comments, and a column of no meaning
shell j Dijz i da dc db Jij Dijy Dijx
1 1 0.5 0 0 0 0 10.0 -0.25 1.0
1 0 2.0 0 1 0 0 4.0 0.0 0.0
2 0 0.5 1 1 0 2 -3.0 0.125 0.0   # back
"""


class Spirit(Files):
    def read(self, text, **options):
        return cayspin.read_spirit_pairs(self.file(text, "pairs.txt"), **options)

    def test_columns_in_any_order(self):
        self.assertEqual(self.read(PAIRS)["pairs"], [
            {"between": [0, 1], "offset": [0, 0, 0], "J": {"meV": 10.0},
             "D": {"meV": [1.0, -0.25, 0.5]}},
            {"between": [0, 0], "offset": [1, 0, 0], "J": {"meV": 4.0}, "D": {"meV": [0, 0, 2.0]}},
            {"between": [1, 0], "offset": [1, 2, 0], "J": {"meV": -3.0},
             "D": {"meV": [0, 0.125, 0.5]}}])
        only = self.read("i j da Dijx Dijy Dijz Dij\n0 0 1 0 3 4 10\n", unit=2)
        self.assertEqual(only, {"pairs": [{"between": [0, 0], "offset": [1, 0, 0],
                                           "D": [0.0, 3.0, 4.0]}]})

    def test_input_files(self):
        head = "mu_s 2.0\n### Pairs\nn_interaction_pairs 2\n"
        rows = "i j da db dc Jij\n0 0 1 0 0 1.5\n0 0 0 1 0 2.5\n"
        found = self.read(head + rows + "llg_dt 1e-3\n", unit=1)["pairs"]
        self.assertEqual([pair["J"] for pair in found], [1.5, 2.5])

    def test_pairs_that_are_there_twice_are_summed(self):
        found = self.read("i j da Jij Dijx Dijy Dijz\n0 1 1 2 0 0 1\n1 0 -1 3 0 0 -0.5\n", unit=1)
        self.assertEqual(found["pairs"], [{"between": [0, 1], "offset": [1, 0, 0], "J": 5.0,
                                           "D": [0, 0, 1.5]}])

    def test_the_energy_of_a_spiral(self):
        """The E of a cell is minus the sum over pairs of (J cos(q.r) + n.D sin(q.r)). A cell has
        two sites."""
        basis = [[0, 0, 0], [0.25, 0.5, 0.125]]
        tables = {"lattice": {"cell": HEXAGONAL.tolist(), "basis": basis},
                  "field": {"couplings": self.read(PAIRS, unit=1)}}
        normal, shape = np.array([2, -1, 2]) / 3, (4, 6, 3)
        spins, q = spiral(tables["lattice"], shape, (1, 2, -1), normal)
        expected = 0
        for i, j, cells, J, D in ((0, 1, (0, 0, 0), 10, (1, -0.25, 0.5)),
                                  (0, 0, (1, 0, 0), 4, (0, 0, 2)),
                                  (1, 0, (1, 2, 0), -3, (0, 0.125, 0.5))):
            angle = 2 * np.pi * (np.array(cells) + basis[j] - np.array(basis[i])) @ q
            expected -= (J * np.cos(angle) + normal @ D * np.sin(angle)) / 2
        self.assertLess(abs(energy(tables, shape, spins) - expected), 1e-12 * abs(expected))
        tables["field"] = {"couplings": self.read(PAIRS)}
        si = {"units": "SI", "material": {"mu_s": {"bohr_magnetons": 2}, "alpha": 0.0}}
        self.assertLess(abs(energy(tables, shape, spins, **si) / MEV - expected), 1e-12)

    def test_refusals(self):
        for text, part in (
                ("", "pairs.txt:1: no pairs"),
                ("i j da db dc\n0 0 1 0 0\n", "pairs.txt:1: columns i j da db dc; accepted: some"),
                ("i j da Dijx Dijy\n0 0 1 0 0\n", "pairs.txt:1: columns"),
                ("i j da Jij Dij\n0 0 1 0 1\n", "pairs.txt:1: columns"),
                ("i i j da Jij\n0 0 0 1 1\n", "pairs.txt:1: columns"),
                ("i j da Dija Dijb Dijc\n0 0 1 0 0 1\n", "pairs.txt:1: columns Dija, Dijb or Dijc; "
                 "accepted: the Cartesian"),
                ("i j da Jij\n0 0 1\n", "pairs.txt:2: 3 columns; accepted: 4"),
                ("i j da Jij\n0 0 1.5 1\n", "pairs.txt:2: da 1.5; accepted: a whole number"),
                ("i j da Jij\n0 0 1 x\n", "pairs.txt:2: Jij x; accepted: a finite number"),
                ("i j da Jij\n0 0 0 1\n", "pairs.txt:2: couples a site to itself"),
                ("i j da Jij\n-1 0 0 1\n", "pairs.txt:2: sites -1 and 0"),
                ("i j da Jij\n0 0 1 0\n", "pairs.txt:1: no pair with Jij or D"),
                ("i j da Dij Dijx Dijy Dijz\n0 0 1 1 0 0 0\n", "pairs.txt:2: Dij of no direction"),
                ("n_interaction_pairs 3\ni j da Jij\n0 0 1 1\n", "pairs.txt:1: 3 pairs, and 1 rows"),
                ("interaction_pairs_file a.txt\n", "pairs.txt:1: names another file; accepted: "
                 "that file, a.txt")):
            self.assert_refused(cayspin.CayspinError, part, self.read, text)
        self.assert_refused(cayspin.CayspinError, "unit: -1; accepted", self.read, PAIRS, unit=-1)


class SunnyModes(unittest.TestCase):
    def test_magnons_of_a_chain_in_a_field(self):
        # Sunny's E is J sum S.S' + mu_B g B.S, here with J < 0; m is opposite to S.
        joule, hbar, g, tesla = 1e-21, 1.054571817e-34, 2.2, 1.5
        k = 2 * np.pi * np.arange(8) / 8
        for spin in (1.0, 2.5):
            sim = cayspin.Simulation(cayspin.Scene(
                units="SI", system={"kind": "llg"},
                material={"mu_s": {"bohr_magnetons": g * spin}, "alpha": 0,
                          "gamma": g * MU_B / hbar},
                lattice={"shape": [8], "spacing": 3e-10, "boundary": "periodic"},
                field={"couplings": [{"offset": [1, 0, 0], "J": spin**2 * joule}],
                       "applied": [0, 0, tesla]},
                initial={"uniform": [0, 0, 1]}))
            expected = (2 * spin * joule * (1 - np.cos(k)) + g * MU_B * tesla) / hbar
            np.testing.assert_allclose(2 * np.pi * sim.modes(8).frequency, np.sort(expected),
                                       rtol=1e-8)


if __name__ == "__main__":
    unittest.main()
