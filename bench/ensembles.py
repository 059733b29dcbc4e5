#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Cost of [ensemble]: ns per spin and step for many small lattices and for one large lattice with
as many spins, and their ratio. The time of a step is found from two runs, one with three times the
steps of the other. All of them run in turn; the shortest time of each counts. Also prints the
seconds of a sweep of short runs."""

import argparse
import math
import pathlib
import subprocess
import tempfile
import time

# name: shape of a replica, replicas, shape of the large lattice
CASES = {
    "chains of 100": ((100,), 1000, (100000,)),
    "films of 16 x 16": ((16, 16), 1000, (512, 500)),
    "chains of 8": ((8,), 5000, (40000,)),
    "single spins": ((1,), 40000, (40000,)),
}


def scene(shape, method, noise, steps, replicas=None, vary=None):
    return (
        '[system]\nkind = "llg"\ndamping = 0.1\n'
        f"[lattice]\nshape = {list(shape)}\n"
        "[field]\nexchange = 1.0\napplied = [0.1, 0, 0.2]\n"
        "anisotropy = { constant = 0.1, axis = [0, 0, 1] }\n"
        "[initial]\nrandom = { seed = 1 }\n"
        f'[integrator]\nmethod = "{method}"\ndt = 0.05\nsteps = {steps}\n'
        f"[output]\nevery = {steps}\nscalars_every = {steps}\n"
        + ("[thermal]\ntemperature = 0.01\nseed = 1\n" if noise else "")
        + (f"[ensemble]\nreplicas = {replicas}\n" if replicas else "")
        + (f'vary."{vary}" = {{ from = 0.05, to = 0.2 }}\n' if replicas and vary else "")
    )


def seconds(command):
    begin = time.perf_counter()
    subprocess.run(command, capture_output=True, check=True)
    return time.perf_counter() - begin


def run_seconds(asked, folder, *scene_of):
    file = folder / "scene.toml"
    file.write_text(scene(*scene_of))
    return seconds(
        [asked.program, "run", file, "--output", folder / "run.h5", "--overwrite",
         "--quiet", "--precision", asked.precision, "--threads", str(asked.threads)]
    )  # fmt: skip


def nanoseconds(asked, folder, method, noise, lattices):
    """Returns the ns per spin and step of each lattice, given as (shape, replicas)."""
    shape, replicas = lattices[0]
    spins = math.prod(shape) * replicas
    steps = max(2, int(2e8 / spins / (1 if method == "heun" else 2) / (4 if noise else 1)))
    runs = [
        (shape, method, noise, count, replicas, asked.vary)
        for shape, replicas in lattices
        for count in (steps, 3 * steps)
    ]
    turns = [[run_seconds(asked, folder, *run) for run in runs] for _ in range(asked.rounds)]
    least = [min(of_run) for of_run in zip(*turns, strict=True)]
    return [1e9 * (least[i + 1] - least[i]) / (2 * steps * spins) for i in range(0, len(least), 2)]


def sweep_seconds(asked, folder, runs):
    file = folder / "scene.toml"
    file.write_text(scene((100,), "heun", False, 1000))
    dampings = ",".join(f"{0.1 + 1e-4 * run:.4f}" for run in range(runs))
    return seconds(
        [asked.program, "sweep", file, "--over", f"system.damping={dampings}", "--output",
         folder / "sweep.h5", "--overwrite", "--quiet"]
    )  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", nargs="?", default="build/release/bin/cayspin")
    parser.add_argument("--methods", default="heun,rkmk4")
    parser.add_argument("--vary", help="a key whose values differ between replicas")
    parser.add_argument("--precision", default="double")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--sweep", type=int, default=1000, help="runs of the sweep; 0: none")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, (shape, replicas, large) in CASES.items():
            for method in asked.methods.split(","):
                for noise in (False, True):
                    of_replicas, of_one = nanoseconds(
                        asked, folder, method, noise, [(shape, replicas), (large, None)]
                    )
                    print(
                        f"{replicas} {name}, {method}{', noise' if noise else ''}: "
                        f"{of_replicas:.2f} ns a spin and step, one lattice {of_one:.2f}, "
                        f"ratio {of_replicas / of_one:.2f}",
                        flush=True,
                    )
        if asked.sweep:
            print(f"sweep of {asked.sweep} runs: {sweep_seconds(asked, folder, asked.sweep):.2f} s")


if __name__ == "__main__":
    main()
