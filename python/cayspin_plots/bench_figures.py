# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The pictures of a run of the benchmarks."""

from cayspin_plots import style

EDGES = (5, 10, 16, 24, 32, 48, 64, 96, 128, 192, 256, 292)
PRECISIONS = ("f64", "f32")
METHODS = {
    "Euler": (style.GREY, "o-"),
    "Heun": (style.BLUE, "o-"),
    "Heun tangent": (style.COMPONENTS[1], "o-"),
    "hand-written Heun": (style.INK, "s:"),
    "RKMK4": ("#7a4fa3", "^-"),
    "RKMK4 tangent": (style.RED, "^-"),
    "hand-written RK4": (style.INK, "v:"),
}


def bytes_of(precision):
    return 8 if precision == "f64" else 4


def draw_caches(axis, context, precision):
    """Marks the sizes at which the spins fill the cache of one core (L2) or the shared cache
    (L3)."""
    for name, key in (("L2", "l2_bytes"), ("L3", "l3_bytes")):
        spins = int(context.get(key, 0)) / (3 * bytes_of(precision))
        if spins > 0:
            axis.axvline(spins, color=style.GREY, linewidth=1, linestyle="--")
            axis.annotate(f"spins fill {name}", (spins, 1), (3, -3), rotation=90, va="top",
                          xycoords=("data", "axes fraction"), textcoords="offset points",
                          color=style.GREY, fontsize=8)


def draw_memory_limit(axis, results, precision, method, color):
    """Draws the limit that the speed of memory sets beyond the caches, computed for the largest
    size."""
    case = f"{precision}/{method}/{EDGES[-1]}"
    words = results.median(case, "words")
    if words:
        file = results.files(case)[0]
        limit = 1e9 * words * bytes_of(precision) / results.copy_rate(file)
        axis.plot((1e6, EDGES[-1]**3 * 1.3), (limit, limit), color=color, linewidth=0.8,
                  linestyle=(0, (1, 1)))


def draw_sizes(results, path):
    figure, axes = style.plt.subplots(1, 2, figsize=(13, 6.4), sharey=True,
                                      constrained_layout=True)
    for axis, precision in zip(axes, PRECISIONS):
        for method, (color, marker) in METHODS.items():
            cases = {edge: results.median(f"{precision}/{method}/{edge}", "ns/spin")
                     for edge in EDGES}
            points = [(edge**3, value) for edge, value in cases.items() if value is not None]
            if points:
                axis.loglog(*zip(*points), marker, color=color, markersize=4, linewidth=1.4,
                            label=method)
            draw_memory_limit(axis, results, precision, method, color)
        draw_caches(axis, next(iter(results.context.values())), precision)
        axis.set_title({"f64": "double", "f32": "float"}[precision])
        axis.set_xlabel("spins")
    axes[0].set_ylabel("ns per spin and step")
    axes[0].legend(fontsize=9)
    figure.suptitle("Stepping cubes of spins; short dotted lines: the numbers that must be moved "
                    "at the speed of a non-temporal copy")
    style.save(figure, path)


def draw_threads(results, path):
    sizes = (64, 128)
    figure, axes = style.plt.subplots(2, len(sizes), figsize=(11, 8), squeeze=False,
                                      constrained_layout=True)
    for row, precision in zip(axes, PRECISIONS):
        for axis, size in zip(row, sizes):
            for method, (color, marker) in METHODS.items():
                case = f"{precision}/{method}/{size}"
                points = [(results.threads(file), 1e3 / results.median(case, "ns/spin", file))
                          for file in (*results.files(case), "one_thread")
                          if results.median(case, "ns/spin", file)]
                if len(points) > 1:
                    points.sort()
                    axis.plot(*zip(*points), marker, color=color, markersize=4, label=method)
                    last = points[-1][0] / points[0][0] * points[0][1]
                    axis.plot((points[0][0], points[-1][0]), (points[0][1], last), color=color,
                              linewidth=0.6, alpha=0.5)
                    axis.set_xticks([point[0] for point in points])
            axis.set_ylim(bottom=0)
            axis.set_title(f"{size}$^3$, {precision}")
            axis.set_xlabel("threads")
        row[0].set_ylabel("million spin steps per second")
    axes[0, 0].legend(fontsize=9)
    figure.suptitle("Speed over threads; thin: as many times the speed of one")
    style.save(figure, path)
