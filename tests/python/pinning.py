# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The field that drives a wall from a soft half of a chain into its hard half (Heistracher et al.,
J. Magn. Magn. Mater. 548, 168875), compared with its closed form and the chain's own equations."""

import math
import unittest

import cayspin

MU0 = 4e-7 * math.pi
HARD = {"Ms": 1 / MU0, "A": 1e-11, "Ku": 1e6}
SOFT = {"Ms": 0.25 / MU0, "A": 2.5e-12, "Ku": 1e5}
LETTERS = {"Ms": "j", "A": "a", "Ku": "k"}  # of what jumps, in the name of a case

# Relative errors of the discrete equations for 80 cells of 1 nm: Newton's method finds the fold of
# their solutions. Cases a and aj exceed 2 %, since walls in the soft half have a width of only
# sqrt(A/K) = 1.6 cells. With an exact solution between the two cells at the boundary the error
# would be 8 %.
OF_EQUATIONS = {"k": 0.00477, "a": 0.02072, "ak": 0.01456, "akj": 0.00427, "aj": 0.03152,
                "kj": 0.00311}


def ratio(case, key):
    return SOFT[key] / HARD[key] if LETTERS[key] in case else 1


def closed_form(case):
    a, k, j = (ratio(case, key) for key in ("A", "Ku", "Ms"))
    return 2 * HARD["Ku"] / HARD["Ms"] * (1 - a * k) / (1 + math.sqrt(a * j))**2


def error(case, cells, cell):
    """Returns the relative error of the largest field in which the wall stays, compared with the
    closed form. The field is found by bisection with relax()."""
    of_regions = {key: {"regions": [ratio(case, key) * value, value]}
                  for key, value in HARD.items()}
    sim = cayspin.Simulation(cayspin.Scene(
        units="SI", system={"kind": "llg"},
        lattice={"shape": [cells], "spacing": [cell, 1e-9, 1e-9], "regions": "x < 0.5 ? 0 : 1"},
        material={**of_regions, "axis": [1, 0, 0], "alpha": 1.0, "damping_form": "gilbert"},
        initial={"state": "two_domains", "directions": [[1, 0, 0], [-1, 0, 0]],
                 "wall": [0, 1, 0], "width": 2e-9, "position": 0.45}))
    field = closed_form(case)
    sim.set("field.applied", [0.5 * field, 0, 0])
    sim.relax(torque=1e-9)
    holds, moves = 0.5, 1.3
    while moves - holds > 2e-6:
        held, middle = sim.spins, (holds + moves) / 2
        sim.set("field.applied", [middle * field, 0, 0])
        sim.relax(torque=1e-9)
        if sim.magnetization()[0] > 0.999:
            moves = middle
            sim.spins = held
        else:
            holds = middle
    return holds - 1


class Pinning(unittest.TestCase):
    def test_published_figures_are_those_of_the_closed_form(self):
        for case, tesla in {"k": 0.565, "a": 0.838, "ak": 1.089, "akj": 1.568, "aj": 1.206,
                            "kj": 1.005}.items():
            self.assertAlmostEqual(closed_form(case), tesla, delta=6e-4)

    def test_the_equations_of_cells_of_a_nanometre_are_solved(self):
        for case, expected in OF_EQUATIONS.items():
            with self.subTest(case):
                found = error(case, 80, 1e-9)
                self.assertAlmostEqual(found, expected, delta=1e-5)
                self.assertLess(found, {"a": 0.021, "aj": 0.032}.get(case, 0.02))

    # The chains of 120 nm are long enough for their ends not to matter.
    def test_the_error_is_of_order_two_in_the_cell(self):
        for case in OF_EQUATIONS:
            with self.subTest(case):
                half, quarter = error(case, 240, 5e-10), error(case, 480, 2.5e-10)
                self.assertLess(abs(half), 0.006)
                self.assertAlmostEqual(math.log2(half / quarter), 2, delta=0.2)


if __name__ == "__main__":
    unittest.main()
