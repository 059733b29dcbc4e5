#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The barrier to the collapse of a skyrmion, by cayspin and by Spirit's GNEB, from the same states.

    python3 -m pip install spirit
    OMP_NUM_THREADS=1 python3 bench/barrier_beside_spirit.py [--repeat 3]

The skyrmion is that of Spirit's tests: 16 x 16 sites, periodic, with an exchange of 10 meV, a Bloch
DMI of 6 meV and a field of 2.894190905 meV (25 T on 2 Bohr magnetons). Both programs relax the ends
and use 16 images. Spirit starts from its homogeneous transition. As its manual recommends, it
relaxes the path roughly before the highest image climbs. Both stop when max |m x H| at the saddle
is below a bound. One evaluation computes H at all sites of one image."""

import argparse
import pathlib
import tempfile
import time

import numpy as np

SITES, IMAGES = 16, 16
CONFIG = f"""bravais_lattice sc
n_basis_cells {SITES} {SITES} 1
mu_s 2
boundary_conditions 1 1 0
external_field_magnitude 25
external_field_normal 0 0 1
anisotropy_magnitude 0
n_shells_exchange 1
jij 10
n_shells_dmi 1
dij 6
dm_chirality 1
ddi_method none
llg_force_convergence 1e-12
gneb_force_convergence 1e-12
output_file_tag x
"""


def by_spirit(solver, bound, most=20000):
    """Returns evaluations, seconds, barrier, torque at the saddle, and the skyrmion before it was
    relaxed."""
    from spirit import (chain, configuration, log, simulation, state, system, transition)
    from spirit.parameters import gneb

    def iterate(p, method, done, image=-1):
        """Iterates until done(), at most `most` times; returns the number of iterations."""
        simulation.start(p, method, solver, n_iterations=10 * most, single_shot=True, idx_image=image)
        count = 0
        while not done() and count < most:
            simulation.n_shot(p, 5, idx_image=image)
            count += 5
        simulation.stop_all(p)
        return count

    def torque(p, image):
        m = np.array(system.get_spin_directions(p, idx_image=image))
        system.update_data(p, idx_image=image)
        return np.linalg.norm(np.cross(m, np.array(system.get_effective_field(p, idx_image=image))),
                              axis=-1).max()

    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder, "input.cfg")
        config.write_text(CONFIG)
        with state.State(str(config), quiet=True) as p:
            configuration.plus_z(p)
            configuration.skyrmion(p, 5, phase=-90)
            start = np.array(system.get_spin_directions(p)).reshape(1, SITES, SITES, 3).copy()
            begin = time.perf_counter()
            evaluations = iterate(p, simulation.METHOD_LLG, lambda: torque(p, 0) < bound, 0)
            chain.image_to_clipboard(p)
            chain.set_length(p, IMAGES)
            configuration.plus_z(p, idx_image=IMAGES - 1)
            transition.homogeneous(p, 0, IMAGES - 1)
            chain.update_data(p)
            rough = 0.3  # meV: once the largest force is below this, the highest image climbs
            inner = range(1, IMAGES - 1)
            force = lambda: simulation.get_max_torque_norm(p)
            count = iterate(p, simulation.METHOD_GNEB, lambda: 0 < force() < rough)
            top = int(np.argmax(chain.get_energy(p)))
            gneb.set_climbing_falling(p, gneb.IMAGE_CLIMBING, top)
            count += iterate(p, simulation.METHOD_GNEB, lambda: torque(p, top) < bound)
            evaluations += count * len(inner)
            seconds = time.perf_counter() - begin
            chain.update_data(p)
            energy = chain.get_energy(p)
            left = torque(p, top)
    return evaluations, seconds, energy[top] - energy[0], left, start


def by_cayspin(start, bound):
    import cayspin

    scene = cayspin.Scene(
        system={"kind": "llg", "damping": 0.1},
        lattice={"shape": [SITES, SITES], "boundary": "periodic"},
        field={"exchange": 10, "dmi": {"bulk": 6}, "applied": [0, 0, 2.894190905]},
        initial={"uniform": [0, 0, 1]})
    end = np.zeros_like(start)
    end[..., 2] = 1
    begin = time.perf_counter()
    path = cayspin.path(scene, start, end, images=IMAGES, torque=bound, threads=1)
    return path.evaluations, time.perf_counter() - begin, path.barrier_forward, path.end


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many (default: 3)")
    parser.add_argument("--bounds", type=float, nargs="+", default=[1e-3, 1e-6],
                        help="on max |m x H| at the saddle, in meV (default: 1e-3 1e-6)")
    arguments = parser.parse_args()
    from spirit import simulation

    solvers = {"Spirit, VP": simulation.SOLVER_VP, "Spirit, LBFGS-OSO": simulation.SOLVER_LBFGS_OSO}
    print(f"{'':<18} {'bound':>6} {'evaluations':>11} {'ms':>8} {'barrier, meV':>14} {'torque':>8}")
    for bound in arguments.bounds:
        for name, solver in solvers.items():
            runs = [by_spirit(solver, bound) for _ in range(arguments.repeat)]
            evaluations, seconds, barrier, left, start = min(runs, key=lambda run: run[1])
            print(f"{name:<18} {bound:>6.0e} {evaluations:>11} {1e3 * seconds:>8.1f} "
                  f"{barrier:>14.8f} {left:>8.1e}")
        runs = [by_cayspin(start, bound) for _ in range(arguments.repeat)]
        evaluations, seconds, barrier, end = min(runs, key=lambda run: run[1])
        print(f"{'cayspin':<18} {bound:>6.0e} {evaluations:>11} {1e3 * seconds:>8.1f} "
              f"{barrier:>14.8f} {end:>8}")


if __name__ == "__main__":
    main()
