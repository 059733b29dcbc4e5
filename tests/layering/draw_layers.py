# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Draws the layers of check_layers.py and their includes as docs/images/architecture.svg.

Usage: draw_layers.py ROOT [--check]    --check: fails if the picture is out of date
A layer stands one row above the highest layer that it includes. An arrow that follows from others is
left out.
"""

import pathlib
import sys
from html import escape

from check_layers import LIBRARY, PROGRAMS, Tree, layer_of

PICTURE = "docs/images/architecture.svg"

# Where a layer stands from left to right, in widths of a box and its gap, and what it holds.
PLACES = {
    "numbers": (1, "vectors, SIMD packs, SI units"),
    "lattice": (2, "sites, boundaries, bonds, parts"),
    "loops over sites": (1.5, "layout, loops, sums; no physics"),
    "spins": (1.5, "the state; a site and its neighbours"),
    "contracts": (1.5, "what terms, steppers, .. have to offer"),
    "field terms": (1.5, "H and E of each term, and their sum"),
    "demagnetization": (3, "the field of all cells on all, by FFTs"),
    "generators": (1, "A of m' = A x m"),
    "rotations": (0, "Cayley map and exponential"),
    "isotropies": (0.5, "sigma, which is added along m"),
    "reductions": (2, "energy and other numbers of a state"),
    "solvers": (0.5, "exchange solved by lines, multigrid"),
    "stages": (0.5, "a stage: arrays, kernel, pass, sweep"),
    "stability": (0.5, "the largest stable step"),
    "steppers": (1, "methods and their tableaux"),
    "time": (2.5, "the loop over steps"),
    "observers": (2, "records, energy control, noise"),
    "minimisers": (1, "equilibria"),
    "modes": (2.5, "normal modes of an equilibrium"),
    "everything": (1, "all of the library"),
    "ranks": (2.75, "a part of the lattice on each rank"),
    "list of methods": (2.25, "one row for each method of scenes"),
    "the paper's steppers": (0, "forms as printed in 2002"),
    "reader and writer": (2.25, "reads TOML, writes HDF5 and OVF"),
    "simulation": (1.5, "scenes as types, the one dispatch"),
    "C interface": (0.5, "scenes for C and Fortran"),
    "program": (1.5, "the commands"),
    "paper": (2.5, "the tables and figures of 2002"),
}

WIDTH, HEIGHT, GAP, ROW, EDGE = 236, 58, 20, 94, 12
LETTERS = 33  # of a folder's name in a box
STYLE = """
text { font-family: system-ui, "Segoe UI", Helvetica, Arial, sans-serif; text-anchor: middle; }
rect { stroke-width: 1.2; }
.library rect { fill: #e3eefb; stroke: #3d78b8; }
.programs rect { fill: #e7f4e4; stroke: #4c924a; }
.layer { font-size: 14px; font-weight: 600; fill: #14212e; }
.folder { font-size: 10.5px; font-family: ui-monospace, Menlo, Consolas, monospace; fill: #3b4a59; }
.holds { font-size: 11.5px; fill: #3b4a59; }
path { fill: none; stroke: #7f8c99; stroke-width: 1.5; }
marker path { fill: #7f8c99; stroke: none; }
"""


def room_name(file):
    library = file.startswith("include/cayspin/")
    found = layer_of(LIBRARY if library else PROGRAMS, file.removeprefix("include/cayspin/"))
    return found and found[1]


def includes_of_layers(tree):
    """Returns, for each layer, the other layers that its files include."""
    found = {layer: set() for layer, _ in LIBRARY + PROGRAMS}
    for file, included in tree.includes.items():
        here = room_name(file)
        if here:
            found[here] |= {room_name(other) for other in included if other} - {here, None}
    return found


def reduced(includes):
    """Returns the includes without those that follow from others."""
    def below(layer):
        return includes[layer].union(*map(below, includes[layer]))
    return {layer: sorted(includes[layer] - set().union(*map(below, includes[layer])), key=list(
        includes).index) for layer in includes}


def rows_of(includes):
    def row(layer):
        return 1 + max(map(row, includes[layer]), default=-1)
    return {layer: row(layer) for layer in includes}


class Picture:
    def __init__(self, includes):
        self.arrows, self.rows = reduced(includes), rows_of(includes)
        self.top = max(self.rows.values())
        self.width = max(map(self.middle, includes)) + WIDTH / 2 + EDGE
        self.height = 2 * EDGE + self.top * ROW + HEIGHT
        # The middle and half width of each object in a row: of boxes, later also of arrows between
        # them.
        self.taken = {row: [(self.middle(layer), WIDTH / 2 + 9) for layer in includes
                            if self.rows[layer] == row] for row in range(self.top + 1)}

    def middle(self, layer):
        return EDGE + WIDTH / 2 + PLACES[layer][0] * (WIDTH + GAP)

    def upper(self, row):
        return EDGE + (self.top - row) * ROW

    def free(self, row, wish):
        """Reserves the free x in a row that is nearest to `wish`, and returns it."""
        places = sorted(range(EDGE, int(self.width) - EDGE + 1), key=lambda x: (abs(x - wish), x))
        place = next(x for x in places
                     if all(abs(x - middle) >= half for middle, half in self.taken[row]))
        self.taken[row].append((place, 9))
        return place

    def ends(self, layer, others, down):
        """Returns, for each of the others, where its arrow leaves or reaches the box of a layer."""
        order = sorted(others, key=lambda other: (self.middle(other), self.rows[other]))
        step = min(26, (WIDTH - 40) / max(len(order), 1))
        first = self.middle(layer) - step * (len(order) - 1) / 2
        y = self.upper(self.rows[layer]) + (HEIGHT if down else -5)
        return {other: (first + step * place, y) for place, other in enumerate(order)}

    def arrow(self, begin, end, rows):
        """Returns a smooth line from start to end, straight through the rows between them."""
        points = [begin]
        for row in rows:
            x = self.free(row, end[0])
            points += [(x, self.upper(row)), (x, self.upper(row) + HEIGHT)]
        points.append(end)
        line = f"M{begin[0]:.0f} {begin[1]:.0f}"
        for (x, y), (to_x, to_y) in zip(points[::2], points[1::2]):
            bend = (y + to_y) / 2
            line += f" C{x:.0f} {bend:.0f} {to_x:.0f} {bend:.0f} {to_x:.0f} {to_y:.0f}"
            line += f" V{to_y + HEIGHT:.0f}" if (to_x, to_y) != end else ""
        return f'<path d="{line}" marker-end="url(#head)"/>'

    def draw_arrows(self):
        users = {layer: [other for other in self.arrows if layer in self.arrows[other]]
                 for layer in self.arrows}
        begins = {layer: self.ends(layer, self.arrows[layer], True) for layer in self.arrows}
        ends = {layer: self.ends(layer, users[layer], False) for layer in self.arrows}
        for layer, others in self.arrows.items():
            for other in others:
                between = range(self.rows[layer] - 1, self.rows[other], -1)
                yield self.arrow(begins[layer][other], ends[other][layer], between)

    def draw_box(self, layer, patterns):
        x, y, name = self.middle(layer), self.upper(self.rows[layer]), ""
        for number, pattern in enumerate(patterns):
            longer = f"{name}, {pattern}" if name else pattern
            if len(longer) > (LETTERS if number == len(patterns) - 1 else LETTERS - 4):
                name += ", .."
                break
            name = longer
        texts = (("layer", 18, layer), ("folder", 34, name), ("holds", 50, PLACES[layer][1]))
        return (f'<rect x="{x - WIDTH / 2:.0f}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="6"/>'
                + "".join(f'<text class="{kind}" x="{x:.0f}" y="{y + down}">{escape(text)}</text>'
                          for kind, down, text in texts))

    def draw(self):
        lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width:.0f} '
                 f'{self.height}" role="img">',
                 "<title>The layers of cayspin: an arrow leads to what a layer includes</title>",
                 f"<style>{STYLE}</style>",
                 '<marker id="head" viewBox="0 0 8 8" refX="3" refY="4" markerWidth="7" '
                 'markerHeight="7" orient="auto"><path d="M0 0L8 4L0 8z"/></marker>',
                 *self.draw_arrows()]
        for group, layers in (("library", LIBRARY), ("programs", PROGRAMS)):
            lines += [f'<g class="{group}">', *(self.draw_box(*layer) for layer in layers), "</g>"]
        return "\n".join([*lines, "</svg>", ""])


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--check"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    root = pathlib.Path(arguments[0]).resolve()
    includes = includes_of_layers(Tree(root))
    if set(includes) != set(PLACES):
        sys.exit(f"PLACES and the layers differ: {sorted(set(includes) ^ set(PLACES))}")
    picture, file = Picture(includes).draw(), root / PICTURE
    if "--check" not in sys.argv:
        file.write_text(picture, encoding="utf-8")
    elif not file.exists() or file.read_text(encoding="utf-8") != picture:
        sys.exit(f"{PICTURE} is not that of today's includes: "
                 "python3 tests/layering/draw_layers.py . draws it again")


if __name__ == "__main__":
    main()
