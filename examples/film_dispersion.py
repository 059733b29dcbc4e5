#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Spin waves that an antenna excites in a permalloy film, compared with the dispersion of Kalinikos
and Slavin (1986): waves along the magnetization (backward volume) and across it (Damon-Eshbach)."""

import argparse
import pathlib
import tempfile

import cayspin
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend has to be chosen first

GAMMA, MU0 = 1.76085963e11, 4e-7 * np.pi  # rad/(s T), T m/A
MS, A, FIELD, THICKNESS = 8e5, 1.3e-11, 0.05, 2e-8  # A/m, J/m, T, m
CELLS, CELL, TO, HIGHEST = 1000, 4e-9, 4e-9, 30e9  # count, m, s, Hz


def scene(along):
    """Returns a scene with waves along x in a film that is magnetized along `along`."""
    return cayspin.Scene(
        units="SI", system={"kind": "llg"},
        lattice={"shape": [CELLS], "spacing": [CELL, 1e-7, THICKNESS], "boundary": "periodic"},
        material={"Ms": MS, "A": A, "alpha": 1e-4, "gamma": GAMMA,
                  "damping_form": "gilbert"},
        field={"demag": {"periodic_images": [20, 500, 0]}, "applied": list(FIELD * along),
               "sources": [{"profile": [0, 0, "exp(-((i - 499.5)/4)^2)"],
                            "time": f"1e-3*sinc(2*pi*{HIGHEST}*(t - 1e-10))"}]},
        initial={"uniform": list(along)},
        integrator={"method": "rkmk4", "dt": 1e-12, "end": TO}, output={"every": 10})


def kalinikos_slavin(k, across):
    """Returns the angular frequency of the lowest branch, with unpinned spins at both faces."""
    field = GAMMA * (FIELD + 2 * A / MS * k**2)
    of_moment = GAMMA * MU0 * MS
    p = 1 - (1 - np.exp(-k * THICKNESS)) / (k * THICKNESS)
    if across:
        return np.sqrt(field * (field + of_moment) + of_moment**2 * p * (1 - p))
    return np.sqrt(field * (field + of_moment * (1 - p)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("picture", type=pathlib.Path, help="its ending chooses the kind")
    picture = parser.parse_args().picture
    figure, both = plt.subplots(1, 2, figsize=(8, 3.6), sharey=True, constrained_layout=True)
    geometries = {"backward volume": ([1, 0, 0], False), "Damon-Eshbach": ([0, 1, 0], True)}
    for axes, (name, (along, across)) in zip(both, geometries.items()):
        with tempfile.TemporaryDirectory() as folder:
            cayspin.Simulation(scene(np.array(along))).run(output=f"{folder}/film.h5")
            with cayspin.open(f"{folder}/film.h5") as run:
                found = run.dispersion([(0.002, 0, 0), (0.06, 0, 0)], component="z")
        k = 2 * np.pi * found.wave_vectors[:, 0] / CELL
        expected = kalinikos_slavin(k, across)
        off = np.abs(np.abs(found.peak()) - expected)
        print(f"{name}: {len(k)} wave vectors, at most {off.max() / found.resolution:.2f} of the "
              "resolution from Kalinikos and Slavin")
        shown = (found.frequency > 0) & (found.frequency < 2 * np.pi * HIGHEST)
        axes.pcolormesh(k / 1e6, found.frequency[shown] / (2e9 * np.pi),
                        np.log10(found.intensity[:, shown].T), shading="nearest", cmap="Greys",
                        rasterized=True)
        axes.plot(k / 1e6, expected / (2e9 * np.pi), "--", color="C3", label="Kalinikos, Slavin")
        axes.set(title=name, xlabel="k, rad/um", ylim=(0, HIGHEST / 1e9))
    both[0].set_ylabel("frequency, GHz")
    both[0].legend()
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    main()
