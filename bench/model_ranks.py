#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A model of the time of steps on many ranks, fitted to two ranks of this machine.

Usage: model_ranks.py BUILD_DIR [--latency S --bandwidth B] [--plot FILE.png]

The step of a part of n x n x n sites takes time for its sites, for the ghost sites that it
computes as well, and for one exchange of ghosts along z and one along y. An exchange takes a
latency plus its bytes divided by a bandwidth. The time of a site, the latency and the bandwidth are
fitted to runs of bench_ranks on two ranks, which share the memory of this machine; no lattice fits
into the caches. Predictions for many ranks use the --latency and --bandwidth of a network instead.
Ranks that exchange ghosts at each stage compute no ghosts, but each stage is a pass through memory;
the time of such steps is measured, too.
"""
import argparse
import pathlib
import sys

import numpy

from compare_ranks import better, measure

SIZES = [(128, 128, 256), (192, 192, 128), (192, 192, 256), (256, 256, 128), (256, 256, 256)]
RANKS = [8, 64, 512, 4096]
SITE_BYTES = 3 * 8
# Published number of ranks and weak efficiency, relative to one node of eight ranks, of a
# hydrodynamics application of Parthenon: arXiv 2202.12309.
PUBLISHED = (73728, 0.92)


def measured(program, repetitions):
    """Returns {method: [(sites, sites with computed ghosts, bytes, seconds, seconds in exchanges,
    stages, time by passes / time of independent ranks), ...]}, one tuple per size, for one rank and
    one step."""
    rows = {}
    for nx, ny, nz in SIZES:
        half = (nx, ny, nz // 2)
        together, apart, passes = {}, {}, {}
        for _ in range(repetitions):
            together = better(together, measure(program, 2, 1, (nx, ny, nz)))
            apart = better(apart, measure(program, 2, 1, half, "apart"))
            passes = better(passes, measure(program, 2, 1, half, "passes"))
        for name, (ns, exchange, stages) in together.items():
            sites, plane = nx * ny * nz // 2, nx * ny
            seconds = ns * 1e-9 * 2 * sites
            rows.setdefault(name, []).append(
                (sites, sites + plane * (stages - 1) / 2, SITE_BYTES * stages * plane,
                 seconds, exchange * seconds, stages, passes[name][0] / apart[name][0]))
    return rows


def relative_fit(columns, values):
    """Fits the values by least squares of the relative errors; returns coefficients and errors."""
    columns, values = numpy.array(columns, float).T, numpy.array(values, float)
    found, *_ = numpy.linalg.lstsq(columns / values[:, None], numpy.ones(len(values)), rcond=None)
    return found, columns @ found / values - 1


class Model:
    def __init__(self, site, passes, stages, latency, bandwidth):
        self.site, self.passes, self.stages = site, passes, stages
        self.latency, self.bandwidth = latency, bandwidth

    def exchange(self, n, depth):
        """Returns the seconds of an exchange: two faces along z, then two along y that include the
        ghosts along z."""
        sites = n * depth * (2 * n + 2 * depth)
        return 2 * self.latency + 2 * SITE_BYTES * sites / self.bandwidth

    def step(self, n, depth=None):
        """Returns the seconds of a step of a part with neighbours on all four sides. The part
        exchanges `depth` planes of ghosts at a time: 1, or as many as all stages of one or more
        steps need (default: of one step)."""
        depth = depth or self.stages
        sites = numpy.mean([n * (n + 2 * k)**2 for k in range(depth)])
        passes = self.passes if depth < self.stages else 1
        return passes * self.site * sites + self.stages / depth * self.exchange(n, depth)

    def efficiency(self, n, ranks):
        """Returns the weak efficiency with n^3 sites per rank; with few ranks, many of them have
        fewer than four neighbours."""
        inner = 1 - 1 / ranks**0.5  # fraction of the faces between parts
        alone = self.site * n**3
        return alone / (alone + inner * (self.step(n) - alone))


def depth_name(depth, stages):
    return "each stage" if depth == 1 else f"each {depth // stages} steps" if depth > stages \
        else "each step"


def draw(models, path):
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))
    from cayspin_plots import style

    figure, axes = style.plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    ranks = numpy.logspace(0, 12, 60, base=2)
    for (name, model), colour in zip(list(models.items())[:2], style.COMPONENTS[::2]):
        for n, line in ((256, "--"), (512, "-")):
            axes.plot(ranks, [model.efficiency(n, r) for r in ranks], line, color=colour,
                      label=f"{name}, {n}³ sites a rank (model)")
    axes.plot(*PUBLISHED, "o", color=style.INK, label="Parthenon on GPUs (measured, published)")
    axes.set(xscale="log", xlabel="ranks", ylabel="weak efficiency", ylim=(0.8, 1.005),
             title="Predicted from two ranks; nothing here was run on more")
    axes.legend(fontsize=9, loc="lower left")
    style.save(figure, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--latency", type=float, default=2e-6, help="of the network, seconds")
    parser.add_argument("--bandwidth", type=float, default=1e10, help="bytes a second of a rank")
    parser.add_argument("--plot", type=pathlib.Path)
    arguments = parser.parse_args()
    rows = measured(arguments.build / "bin" / "bench_ranks", arguments.repetitions)

    all_rows = [row for of_method in rows.values() for row in of_method]
    (latency, per_byte), errors = relative_fit(
        [[1] * len(all_rows), [row[2] for row in all_rows]], [row[4] for row in all_rows])
    print(f"exchange here: {latency * 1e6:.0f} us and {1e-9 / per_byte:.1f} GB/s a direction, "
          f"errors up to {100 * max(abs(errors)):.0f} %")
    models = {}
    for name, of_method in rows.items():
        (site,), errors = relative_fit([[row[1] for row in of_method]],
                                       [row[3] - row[4] for row in of_method])
        passes, stages = numpy.median([row[6] for row in of_method]), of_method[0][5]
        print(f"{name}: {site * 1e9:.2f} ns a site, errors up to {100 * max(abs(errors)):.0f} %; "
              f"by passes {passes:.2f} times that")
        models[name] = Model(site, passes, stages, arguments.latency, arguments.bandwidth)

    print(f"\nweak efficiency, network of {arguments.latency * 1e6:.3g} us and "
          f"{arguments.bandwidth * 1e-9:.3g} GB/s a rank")
    print(f"| sites a rank | method | {' | '.join(map(str, RANKS))} |")
    print("|---|---|" + "---|" * len(RANKS))
    for n in (256, 512):
        for name, model in models.items():
            found = " | ".join(f"{model.efficiency(n, ranks):.3f}" for ranks in RANKS)
            print(f"| {n} x {n} x {n} | {name} | {found} |")

    print("\nwhen to exchange: time of a step over that of the sites alone; * is the best")
    sizes = [16, 32, 64, 128, 256, 512]
    print(f"| method | exchange | {' | '.join(f'{n}^3' for n in sizes)} |")
    print("|---|---|" + "---|" * len(sizes))
    for name, model in models.items():
        depths = [1] + [model.stages * steps for steps in (1, 2, 4)]
        table = [[model.step(n, depth) / (model.site * n**3) for n in sizes] for depth in depths]
        for row, depth in zip(table, depths):
            cells = " | ".join(
                f"{value:.3f}" + ("*" if value == min(other[i] for other in table) else "")
                for i, value in enumerate(row))
            print(f"| {name} | {depth_name(depth, model.stages)} | {cells} |")
    if arguments.plot:
        draw(models, arguments.plot)


if __name__ == "__main__":
    main()
