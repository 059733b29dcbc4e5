#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Three pictures of what a scene can hold: a crystal, a wall in a current, a dispersion. Runs the
scenes by the cayspin package."""

import argparse
import pathlib
import tempfile

import cayspin
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend has to be chosen before

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"


def run(scene, folder, name):
    file = folder / name
    cayspin.Simulation(scene).run(output=file)
    return cayspin.open(file)


def draw_crystal(axis, folder):
    with run(cayspin.Scene.from_file(SCENES / "honeycomb.toml"), folder, "honeycomb.h5") as file:
        places, spins = file.positions[:], file.spins[-1]
    for site, marker in enumerate("oh"):
        x, y = places[site, 0, :14, :14, 0], places[site, 0, :14, :14, 1]
        m = spins[site, 0, :14, :14]
        axis.scatter(x, y, c=m[..., 2], cmap="cividis", vmin=-1, vmax=1, s=70 - 30 * site,
                     marker=marker)
    axis.set_title("A honeycomb of two moments, cooled: m_z")
    axis.set_aspect("equal")
    axis.grid(False)


def draw_wall(axis, folder):
    scene = cayspin.Scene.from_file(SCENES / "wall_under_current.toml")
    with run(scene, folder, "wall.h5") as file:
        time, spins = file.time[:], file.spins[:, 0, 0]
        x = 0.25 * (np.arange(spins.shape[1]) + 0.5)
        for frame, color in zip((0, len(time) // 2, -1), ("#8b9199", "#1b5fa7", "#cf3f2b")):
            axis.plot(x, spins[frame, :, 2], color=color)
            place = np.interp(0, -spins[frame, :, 2], x)
            axis.annotate(f"t = {time[frame]:g}", (place, 0), (5, 12), color=color,
                          textcoords="offset points")
    axis.set(title="A wall in a current", xlabel="x", ylabel="m_z")


def draw_dispersion(axis, folder):
    rng = np.random.default_rng(1)
    start = rng.normal(0, 0.01, (2, 1, 36, 36, 3)) + [0, 0, 1]
    bonds = [{"between": [0, 1], "offset": [i, j, 0], "J": 1.0}
             for i, j in ((0, 0), (-1, 0), (0, -1))]
    bonds += [{"between": [site, site], "offset": [i, j, 0], "D": [0, 0, sign * 0.1]}
              for site, sign in ((0, 1), (1, -1)) for i, j in ((1, 0), (-1, 1), (0, -1))]
    scene = cayspin.Scene(
        system={"kind": "llg", "damping": 0.0},
        lattice={"shape": [36, 36], "crystal": "honeycomb", "boundary": "periodic"},
        field={"couplings": bonds}, initial=start,
        integrator={"method": "rkmk4", "dt": 0.05, "end": 250.0}, output={"every": 8})
    corners = [(0, 0, 0), (2 / 3, 1 / 3, 0), (0.5, 0, 0), (0, 0, 0)]
    with run(scene, folder, "magnons.h5") as file:
        found = file.dispersion(corners, about=(0, 0, 1), labels=["Γ", "K", "M", "Γ"])
    found.plot(axis)
    axis.set(title="Magnons of a honeycomb with a gap at K", ylim=(0, 6.6))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="where the pictures go")
    folder = parser.parse_args().folder
    with tempfile.TemporaryDirectory() as runs:
        for name, draw in (("crystal", draw_crystal), ("wall", draw_wall),
                           ("dispersion", draw_dispersion)):
            figure, axis = plt.subplots(figsize=(6, 4.2), constrained_layout=True)
            draw(axis, pathlib.Path(runs))
            figure.savefig(folder / f"scene_{name}.png", dpi=120)


if __name__ == "__main__":
    main()
