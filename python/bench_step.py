# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""What one step() from Python takes beside a step within one long call of the library.

    OMP_NUM_THREADS=1 python3 python/bench_step.py
"""

import sys
import time

sys.path.pop(0)  # the package beside this file has no module; take the installed one
import cayspin  # noqa: E402

SIZES = {"100 spins": ([100], 500, 200), "128 x 128 x 128": ([128, 128, 128], 4, 9)}


def seconds_per_step(call, steps):
    begin = time.perf_counter()
    call()
    return (time.perf_counter() - begin) / steps


def main():
    print("rkmk4, exchange, anisotropy, applied; the least of many rounds\n"
          f"{'':<34}{'one call':>12}{'step()':>16}{'more':>16}")
    for name, (shape, steps, rounds) in SIZES.items():
        scene = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1}, lattice={"shape": shape},
            field={"exchange": 1.0, "anisotropy": {"constant": 1.0, "axis": [0, 0, 1]},
                   "applied": [0.1, 0.0, 0.0]},
            initial={"random": {"seed": 1}}, integrator={"method": "rkmk4", "dt": 0.01})
        sim = cayspin.Simulation(scene)
        sim.step(steps)

        def one_by_one():
            for _ in range(steps):
                sim.step()

        pairs = [(seconds_per_step(lambda: sim.step(steps), steps),
                  seconds_per_step(one_by_one, steps)) for _ in range(rounds)]
        whole, single = (min(side) for side in zip(*pairs))
        print(f"{name:<20}{sim.threads:>3} threads {whole * 1e6:>12.3f} us{single * 1e6:>13.3f} us"
              f"{(single - whole) * 1e6:>13.3f} us {100 * (single / whole - 1):>8.2f} %")



if __name__ == "__main__":
    main()
