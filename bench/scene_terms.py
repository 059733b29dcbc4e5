#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Cost of terms in scenes: ns per spin and step of a plain scene, which has only exchange, one
anisotropy axis and an applied field, and how many times as long a step of a scene with one change
takes. Scenes of the same shape and method run in turn; the shortest time of each counts."""

import argparse
import pathlib
import re
import subprocess
import tempfile

AXIS = "{ constant = 0.1, axis = [0, 0, 1] }"
CUBIC = "{ cubic = 1e-9, axes = [[1, 0, 0], [0, 1, 0]] }"
PLAIN = {"exchange": "1.0", "anisotropy": AXIS, "applied": "[0.1, 0, 0.2]"}
# name: keys that differ from the plain scene in [field], in [lattice], in [system]
TERMS = {
    "plain": ({}, {}, {}),
    "interfacial DMI": ({"dmi": "{ interfacial = 1e-9, normal = [0, 0, 1] }"}, {}, {}),
    "bulk DMI": ({"dmi": "{ bulk = 1e-9 }"}, {}, {}),
    "cubic axes": ({"anisotropy": f"[{AXIS}, {CUBIC}]"}, {}, {}),
    "constants of sites": (
        {"anisotropy": AXIS.replace("0.1", "'0.1 + 0.01*i/64'")},
        {},
        {},
    ),
    "exchange of sites": ({"exchange": "'1 + 1e-9*i'"}, {}, {}),
    "damping of sites": ({}, {}, {"damping": "'0.1 + 1e-9*i'"}),
    "vacancies": ({}, {"occupied": "'i + j > 2'"}, {}),
    "frozen": ({}, {"frozen": "'i + j < 2'"}, {}),
    "moments": ({}, {"moments": "2"}, {}),
    "moments of sites": ({}, {"moments": "'1 + 0.1*i/64'"}, {}),
    "moments and exchange of sites": (
        {"exchange": "'1 + 1e-9*i'"},
        {"moments": "'1 + 0.1*i/64'"},
        {},
    ),
}
SHAPES = {"64^3": (64, 64, 64), "128^3": (128, 128, 128), "256^2": (256, 256)}
METHODS = ("heun", "rkmk4", "projected_rk4", "tsit5")


def scene(terms, shape, method, steps):
    field, lattice, system = TERMS[terms]
    tables = {
        "system": {"kind": '"llg"', "damping": "0.1", **system},
        "lattice": {"shape": list(shape), **lattice},
        "field": {**PLAIN, **field},
        "initial": {"random": "{ seed = 1 }"},
        "integrator": {"method": f'"{method}"', "dt": "0.05", "steps": steps},
        "output": {"every": steps, "scalars_every": steps},
    }
    if method in ("tsit5", "dp5", "bs3"):
        tables["integrator"] |= {"tolerance": "1e-2", "max_dt": "0.05"}
    return "".join(
        f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
        for name, keys in tables.items()
    )


def nanoseconds(program, folder, terms, shape, method, threads):
    spins = 1
    for extent in shape:
        spins *= extent
    steps = max(4, int(4e7 / spins / (1 if method == "heun" else 2)))
    (folder / "scene.toml").write_text(scene(terms, shape, method, steps))
    run = subprocess.run(
        [program, "run", folder / "scene.toml", "--output", folder / "run.h5", "--overwrite",
         "--threads", str(threads)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    rate, unit = re.search(r"stepping at ([0-9.]+) ([kMG])spin", run.stdout + run.stderr).groups()
    return 1e9 / (float(rate) * {"k": 1e3, "M": 1e6, "G": 1e9}[unit])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", nargs="?", default="build/release/bin/cayspin")
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--shapes", default=",".join(SHAPES))
    parser.add_argument("--terms", default=",".join(TERMS), help="after the plain scene")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    asked = parser.parse_args()
    names = list(dict.fromkeys(["plain", *asked.terms.split(",")]))
    with tempfile.TemporaryDirectory() as folder:
        for shape in asked.shapes.split(","):
            for method in asked.methods.split(","):
                best = dict.fromkeys(names, float("inf"))
                for _ in range(asked.rounds):
                    for terms in names:
                        took = nanoseconds(asked.program, pathlib.Path(folder), terms,
                                           SHAPES[shape], method, asked.threads)  # fmt: skip
                        best[terms] = min(best[terms], took)
                print(f"{shape} {method}: plain {best['plain']:.2f} ns", end="")
                for terms in names[1:]:
                    print(f", {terms} {best[terms] / best['plain']:.2f}", end="")
                print(flush=True)


if __name__ == "__main__":
    main()
