#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Magnons of a honeycomb ferromagnet whose second neighbours have a DMI, which opens a gap at K."""

import argparse
import pathlib
import tempfile

import cayspin
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend has to be chosen first


def scene():
    rng = np.random.default_rng(1)
    start = rng.normal(0, 0.01, (2, 1, 36, 36, 3)) + [0, 0, 1]
    bonds = [{"between": [0, 1], "offset": [i, j, 0], "J": 1.0}
             for i, j in ((0, 0), (-1, 0), (0, -1))]
    bonds += [{"between": [site, site], "offset": [i, j, 0], "D": [0, 0, sign * 0.1]}
              for site, sign in ((0, 1), (1, -1)) for i, j in ((1, 0), (-1, 1), (0, -1))]
    return cayspin.Scene(
        system={"kind": "llg", "damping": 0.0},
        lattice={"shape": [36, 36], "crystal": "honeycomb", "boundary": "periodic"},
        field={"couplings": bonds}, initial=start,
        integrator={"method": "rkmk4", "dt": 0.05, "end": 250.0}, output={"every": 8})


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("picture", type=pathlib.Path, help="its ending chooses the kind")
    picture = parser.parse_args().picture
    corners = [(0, 0, 0), (2 / 3, 1 / 3, 0), (0.5, 0, 0), (0, 0, 0)]
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/magnons.h5"
        cayspin.Simulation(scene()).run(output=file)
        with cayspin.open(file) as run:
            found = run.dispersion(corners, about=(0, 0, 1), labels=["Γ", "K", "M", "Γ"])
    figure, axes = plt.subplots(figsize=(6, 4.2), constrained_layout=True)
    found.plot(axes)
    axes.set(title="Magnons of a honeycomb with a gap at K", ylim=(0, 6.6))
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    main()
