# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Writes demagnetizing_tensors.json: python3 tensor_table.py > ../data/demagnetizing_tensors.json,
or, with the argument `slender`, slender_demagnetizing_tensors.json.

Each entry is a second difference of the functions of Newell, Williams and Dunlop, J. Geophys. Res.
98, 9551 (1993), eqs. 27 and 32, at 160 digits, rounded to a double. Needs mpmath.
"""

import itertools
import json
import sys

from mpmath import asinh, atan, mp, mpf, pi, sqrt

mp.dps = 160

# A cube, films, needles, and cells with three different edges.
CELLS = [(1.0, 1.0, 1.0), (1.0, 1.0, 0.1), (1.0, 1.0, 0.01), (1.0, 0.001, 1.0), (10.0, 1.0, 1.0),
         (1.0, 1.0, 1000.0), (3.90625, 2.5, 3.0), (1.0, 0.3, 0.007)]

# The longest edge is more than 1000 times the shortest.
SLENDER_CELLS = [(1.0, 1.0, 1e-4), (1.0, 1e-4, 1e-4), (1.0, 0.7, 1e-6), (1e-6, 1.0, 1e-6),
                 (1.0, 1e-3, 1e-6), (1.0, 1.0, 1e-9), (1e-9, 1e-9, 1.0), (1e-5, 1.0, 1e-9)]

# Positions, in cells along each axis.
STEPS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1),
         (-2, 1, -3), (0, 15, 0), (60, -30, 0), (1000, 0, 0)]

# Positions by distance, in units of the longest edge, and direction, a vector of any length.
AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
DIAGONALS = [(1, 1, 1), (-1, 1, 0), (1, 0, -1), (0, 1, 1)]
DISTANCES = [(1.7, [(1, -2, 5)]), (3.9999, [AXES[0], DIAGONALS[0]]), (4.0001, AXES + DIAGONALS),
             (7.9999, [(1, 1, 1)]), (8.0001, AXES + DIAGONALS + [(4, -5, 4)]),
             (49.999, [(5, 3, -1)]), (50.001, AXES + [(2, 3, 6)]), (1000.0, [(7, -5, 4)])]


def f(x, y, z):
    r = sqrt(x * x + y * y + z * z)
    total = (2 * x * x - y * y - z * z) * r / 6
    if x * x + z * z > 0:
        total += y * (z * z - x * x) / 2 * asinh(y / sqrt(x * x + z * z))
    if x * x + y * y > 0:
        total += z * (y * y - x * x) / 2 * asinh(z / sqrt(x * x + y * y))
    if x != 0:
        total -= x * y * z * atan(y * z / (x * r))
    return total


def g(x, y, z):
    r = sqrt(x * x + y * y + z * z)
    total = -x * y * r / 3
    if x * x + y * y > 0:
        total += x * y * z * asinh(z / sqrt(x * x + y * y))
    if y * y + z * z > 0:
        total += y * (3 * z * z - y * y) / 6 * asinh(x / sqrt(y * y + z * z))
    if x * x + z * z > 0:
        total += x * (3 * z * z - x * x) / 6 * asinh(y / sqrt(x * x + z * z))
    if z != 0:
        total -= z**3 / 6 * atan(x * y / (z * r))
    if y != 0:
        total -= z * y * y / 2 * atan(x * z / (y * r))
    if x != 0:
        total -= z * x * x / 2 * atan(y * z / (x * r))
    return total


def entry(function, order, position, cell):
    """Returns minus the second differences of `function` along its three arguments in turn,
    divided by 4 * pi * (volume of a cell). `order`: the axes of the arguments."""
    x, y, z = (mpf(position[axis]) for axis in order)
    a, b, c = (mpf(cell[axis]) for axis in order)
    weight = {-1: -1, 0: 2, 1: -1}
    total = sum(weight[i] * weight[j] * weight[k] * function(x + i * a, y + j * b, z + k * c)
                for i, j, k in itertools.product(weight, repeat=3))
    return total / (4 * pi * a * b * c)


def tensor(position, cell):
    entries = [entry(f, order, position, cell) for order in [(0, 1, 2), (1, 0, 2), (2, 1, 0)]]
    for order in [(0, 1, 2), (0, 2, 1), (1, 2, 0)]:
        zero = position[order[0]] == 0 or position[order[1]] == 0
        entries.append(mpf(0) if zero else entry(g, order, position, cell))
    return entries


def positions(cell):
    for steps in STEPS:
        yield tuple(s * h for s, h in zip(steps, cell))
    for distance, directions in DISTANCES:
        for direction in directions:
            length = sum(d * d for d in direction) ** 0.5
            yield tuple(distance * max(cell) * d / length for d in direction)


def positions_of_slender(cell):
    yield from (tuple(s * h for s, h in zip(steps, cell)) for steps in STEPS)
    yield from (tuple(s * max(cell) for s in steps)
                for steps in [(0.0, 0.0, 0.3), (0.5, 0.1, 1.7), (3.0, 0.0, 1.0)])
    yield 0.0, 0.0, 1000 * cell[2]


def main():
    slender = sys.argv[1:] == ["slender"]
    of_cell = positions_of_slender if slender else positions
    rows = [json.dumps({"position": position, "cell": cell,
                        "tensor": [float(entry) for entry in tensor(position, cell)]})
            for cell in (SLENDER_CELLS if slender else CELLS) for position in of_cell(cell)]
    print("[\n" + ",\n".join(rows) + "\n]")


if __name__ == "__main__":
    main()
