# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""What one step() from Python takes beside a step within one long call of the library.

    OMP_NUM_THREADS=1 python3 python/bench_step.py
"""

import statistics
import time

import cayspin

SIZES = {"100 spins": ([100], 20_000), "128 x 128 x 128": ([128, 128, 128], 20)}
ROUNDS = 7


def seconds_per_step(call, steps):
    begin = time.perf_counter()
    call()
    return (time.perf_counter() - begin) / steps


def main():
    print(f"{'rkmk4, exchange, anisotropy, applied':<38}{'one call':>12}{'step()':>12}{'more':>12}")
    for name, (shape, steps) in SIZES.items():
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
                  seconds_per_step(one_by_one, steps)) for _ in range(ROUNDS)]
        whole, single = (min(side) for side in zip(*pairs))
        more = statistics.median(pair[1] / pair[0] - 1 for pair in pairs)
        print(f"{name:<20}{sim.threads:>8} threads  {whole * 1e6:>9.3f} us{single * 1e6:>9.3f} us"
              f"{(single - whole) * 1e6:>9.3f} us  median {100 * more:.2f} %")


if __name__ == "__main__":
    main()
