#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A model of the main kernels on a GPU, from the counts of tests/cuda/expected_sass.txt.

Usage: model_gpu.py [--edge N] [--measured DIR]

The time of a kernel is that of the resource that limits it: the bandwidth of the memory, of the
second-level or of the first-level cache, issue slots, lanes for arithmetic or for integers, or the
latency of the memory with as many warps as the registers allow. This is a lower bound, because
resources do not overlap perfectly. The lattice is a cube with N sites along each edge. --measured:
the folder with the results of bench/run.sh, whose times are printed beside those of the model.
"""
import argparse
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
COUNTS = ROOT / "tests" / "cuda" / "expected_sass.txt"

# Assumed values for the SXM cards: both have the chip GH100 and differ only in memory.
CARDS = {"H100": 3.35e12, "H200": 4.8e12}  # memory bandwidth, bytes/s, from the data sheets
PROCESSORS = 132  # multiprocessors
CLOCK = 1.755e9  # Hz; a busy card does not keep up its boost clock of 1.98 GHz
SCHEDULERS, LANES = 4, 32  # per multiprocessor, each with one instruction a clock; per warp
ARITHMETIC = {"f64": 64, "f32": 128}  # lanes per multiprocessor
INTEGERS = 64
FIRST_CACHE = 128  # bytes a clock, per multiprocessor
SECOND_CACHE = 5.5e12  # bytes a second: a cautious 60 % of 5120 bytes a clock
LATENCY = 800e-9  # seconds that a site's loads take from a busy memory: twice those of an idle one
LAUNCH = 2.5e-6  # seconds from one launch to the next
REGISTERS, WARPS = 65536, 64  # per multiprocessor
SECTOR = 32  # bytes: the smallest transfer of the second-level cache

SIZE = {"f64": 8, "f32": 4}
WIDTH, HEIGHT, WALK = 32, 12, 32  # threads of a team and planes of its walk: TilesOfTeams
# For two stages in one kernel: values that a site reads from memory or writes to it. With one stage,
# the kernel takes two steps.
PAIRS = {
    "LieEulerInPairs": {"0+0": 6}, "LieHeunInPairs": {"0+1": 6}, "Rkmk4InPairs": {"0+1": 12, "2+3": 15},
    "StereographicHeunInPairs": {"0+1": 6}, "StereographicRk4InPairs": {"0+1": 9, "2+3": 12}}
FILM = 64  # sites along an edge of a small film
TILE = 16  # threads along an edge of its tiles: TilesOfSteps
STAGES = {"Euler": 1, "Heun": 2, "RKMK4": 4, "Heun tangent": 2, "RKMK4 tangent": 4}
METHODS = {  # for each method of the counts, the case of bench_throughput
    "LieEuler": "Euler", "LieHeun": "Heun", "Rkmk4": "RKMK4",
    "StereographicHeun": "Heun tangent", "StereographicRk4": "RKMK4 tangent",
    "LieEulerInPairs": "Euler in pairs", "LieHeunInPairs": "Heun in pairs", "Rkmk4InPairs": "RKMK4 in pairs",
    "StereographicHeunInPairs": "Heun tangent in pairs",
    "StereographicRk4InPairs": "RKMK4 tangent in pairs"}


class Kernel:
    """A line of the counts. For each site a kernel reads the spins at 7 sites, and other arrays
    only at that site."""

    def __init__(self, line):
        self.name, *numbers = line.split()
        (self.total, self.arithmetic, self.loads, self.shared, self.integer, self.stores,
         self.constants, self.registers) = map(int, numbers)
        self.precision, self.method, self.stage = self.name.split("_")
        self.loop = (self.arithmetic + self.loads + self.shared + self.integer + self.stores +
                     self.constants)

    @property
    def is_pair(self):
        return self.stage in PAIRS.get(self.method, ())

    @property
    def is_step_in_tiles(self):
        return self.method.endswith("InTiles")

    @property
    def steps(self):
        """Steps that a launch takes."""
        return 2 if self.stage == "0+0" else 1

    @property
    def words(self):
        """Values that a site reads from memory or writes to it. The 18 loads of the spins at its
        six neighbours are from caches."""
        return PAIRS[self.method][self.stage] if self.is_pair else self.loads - 18 + self.stores

    @property
    def memory_bytes(self):
        return self.words * SIZE[self.precision]

    @property
    def warps(self):
        """Warps that fit on a multiprocessor. A thread gets registers in multiples of 8, and
        warps are allocated four at a time, or a team at a time."""
        each = (self.registers + 7) // 8 * 8 * LANES
        together = WIDTH * HEIGHT // LANES if self.is_pair else 4
        return min(WARPS // together, REGISTERS // each // together) * together


def walk(edge):
    """Returns the number of sites that a thread handles, as in DeviceTiles."""
    return min(max(edge**3 >> 19, 1), 8)


def seconds_of_pair(kernel, bandwidth):
    """Like seconds(), for two stages of a large lattice in one kernel. The threads at the border of
    a tile, and those of the planes at the ends of a walk, repeat work of the tiles beside it."""
    size, own = SIZE[kernel.precision], (WIDTH - 2) * (HEIGHT - 2)
    repeats = WIDTH * HEIGHT / own * (WALK + 2) / WALK
    once = (kernel.total - kernel.loop) / WALK
    clocks = repeats / (PROCESSORS * CLOCK)
    reads = kernel.words - kernel.stores
    # The first stage also reads the spins around the border.
    around = (WIDTH + 2) * (HEIGHT + 2) / (WIDTH * HEIGHT)
    from_second = repeats * (reads - 3 + 3 * around) + kernel.stores
    return {
        "memory": kernel.memory_bytes / bandwidth,
        "second cache": from_second * size / SECOND_CACHE,
        "issue": (kernel.loop + once) / LANES / SCHEDULERS * clocks,
        "arithmetic": kernel.arithmetic / ARITHMETIC[kernel.precision] * clocks,
        "integers": (kernel.integer + once) / INTEGERS * clocks,
        "first cache": ((kernel.loads + kernel.shared + kernel.stores) * size +
                        6 * FIRST_CACHE / 32) / FIRST_CACHE * clocks,
        "latency": LATENCY / (kernel.warps * LANES * PROCESSORS) * repeats,
    }


def seconds(kernel, bandwidth, edge):
    """Returns the seconds per site that each resource needs."""
    if kernel.is_pair:
        return seconds_of_pair(kernel, bandwidth)
    size, sites = SIZE[kernel.precision], walk(edge)
    once = (kernel.total - kernel.loop) / sites  # instructions outside a thread's loop, per site
    clocks = 1 / (PROCESSORS * CLOCK)
    # A tile of 32 x 4 x `sites` sites also reads spins beside it: along y, two rows in each layer;
    # along z, two layers; along x, a sector at each end of its rows.
    stencil = 3 * (size * (1 + 2 / 4 + 2 / sites) + 2 * SECTOR / 32)
    return {
        "memory": kernel.memory_bytes / bandwidth,
        "second cache": (stencil + (kernel.words - 3) * size) / SECOND_CACHE,
        "issue": (kernel.loop + once) / LANES / SCHEDULERS * clocks,
        "arithmetic": kernel.arithmetic / ARITHMETIC[kernel.precision] * clocks,
        "integers": (kernel.integer + once) / INTEGERS * clocks,
        # The neighbours along x are not aligned: each of these six loads takes one more line.
        "first cache": ((kernel.loads + kernel.stores) * size + 6 * FIRST_CACHE / 32) /
                       FIRST_CACHE * clocks,
        "latency": LATENCY / (kernel.warps * LANES * PROCESSORS),
    }


def read_all_kernels():
    return [Kernel(line) for line in COUNTS.read_text().splitlines() if not line.startswith("#")]


def read_kernels():
    return [kernel for kernel in read_all_kernels() if not kernel.is_step_in_tiles]


def print_kernels(kernels, edge):
    print(f"picoseconds for each site at {edge}^3, walks of {walk(edge)} sites\n")
    columns = [name for name in seconds(kernels[0], 1, edge) if name != "memory"]
    cards = [f"memory, {card}" for card in CARDS]
    print(f"| kernel | bytes | instructions | warps | {' | '.join(cards + columns)} |")
    print("|---|" + "---|" * (3 + len(cards) + len(columns)))
    for kernel in kernels:
        rest = seconds(kernel, 1, edge)
        once = (kernel.total - kernel.loop) / walk(edge)
        times = [kernel.memory_bytes / rate for rate in CARDS.values()]
        times += [rest[column] for column in columns]
        print(f"| {kernel.name} | {kernel.memory_bytes} "
              f"| {kernel.loop + once:.0f} | {kernel.warps} "
              f"| {' | '.join(f'{time * 1e12:.1f}' for time in times)} |")


def seconds_in_batch(kernel):
    """Like seconds(), for a small lattice in a batch: each thread has one site, and the spins stay
    in the first cache, which passes each store on to the second."""
    times = seconds(kernel, bandwidth=math.inf, edge=1)
    return {
        **{name: times[name] for name in ("issue", "arithmetic", "integers", "first cache")},
        "second cache": kernel.stores * SIZE[kernel.precision] / SECOND_CACHE,
    }


def slowest(kernels, seconds_of):
    """Returns {(precision, method): (seconds per site and step, resources that limit the kernels)}.
    seconds_of(kernel): the seconds per site that each resource needs."""
    found = {}
    for kernel in kernels:
        times = seconds_of(kernel)
        bound = max(times, key=times.get)
        key = kernel.precision, METHODS[kernel.method]
        time, bounds = found.get(key, (0, []))
        time += times[bound] / kernel.steps
        found[key] = time, bounds if bound in bounds else [*bounds, bound]
    return found


def steps(kernels, bandwidth, edge):
    """Returns {(precision, method): (seconds per site, seconds per site if only memory limited the
    kernels, resources that limit them)}."""
    found = slowest(kernels, lambda kernel: seconds(kernel, bandwidth, edge))
    memory = slowest(kernels, lambda kernel: {"memory": kernel.memory_bytes / bandwidth})
    return {key: (time, memory[key][0], bounds) for key, (time, bounds) in found.items()}


def print_steps(kernels, edge):
    print(f"\na step of {edge}^3 spins: ps a spin (share of the bandwidth)\n")
    columns = [(card, precision) for card in CARDS for precision in SIZE]
    print(f"| | {' | '.join(' '.join(column) for column in columns)} |")
    print("|---" * (1 + len(columns)) + "|")
    found = {card: steps(kernels, bandwidth, edge) for card, bandwidth in CARDS.items()}
    for method in METHODS.values():
        cells = [found[card][precision, method][:2] for card, precision in columns]
        print(f"| {method} | "
              f"{' | '.join(f'{t * 1e12:.1f} ({memory / t:.2f})' for t, memory in cells)} |")


def print_replicas(kernels):
    print("\na step of many small lattices, in batches: ps a spin (what limits it)\n")
    print("| | " + " | ".join(SIZE) + " |")
    print("|---" * (1 + len(SIZE)) + "|")
    found = slowest([kernel for kernel in kernels if not kernel.is_pair], seconds_in_batch)
    for method in METHODS.values():
        cells = [found[precision, method] for precision in SIZE if (precision, method) in found]
        if cells:
            print(f"| {method} | " + " | ".join(
                f"{time * 1e12:.1f} ({', '.join(names)})" for time, names in cells) + " |")


def seconds_in_film(kernel, threads):
    """Returns the seconds of a launch over a small film: at least those between launches, or the
    loads of a thread and the instructions of the warps of a scheduler."""
    warps = math.ceil(threads / LANES / SCHEDULERS / PROCESSORS)
    return max(LAUNCH, LATENCY + warps * kernel.total / CLOCK)


def film_steps(kernels):
    """Returns {(precision, method): (steps a second of a film with a launch for each stage, with all
    stages in one launch)}."""
    found = {}
    for kernel in kernels:
        if kernel.is_pair:
            continue
        method = METHODS[kernel.method.removesuffix("InTiles")]
        passes, tiles = found.get((kernel.precision, method), (0, None))
        if kernel.is_step_in_tiles:
            teams = math.ceil(FILM / (TILE - 2 * (STAGES[method] - 1))) ** 2
            # Each team is on one multiprocessor.
            tiles = seconds_in_film(kernel, math.ceil(teams / PROCESSORS) * PROCESSORS * TILE**2)
        else:
            passes += seconds_in_film(kernel, FILM**2)
        found[kernel.precision, method] = passes, tiles
    return {key: (1 / passes, 1 / tiles if tiles else None)
            for key, (passes, tiles) in found.items()}


def print_film(kernels):
    print(f"\nsteps a second of a film of {FILM} x {FILM} spins, at most: with a launch for each "
          "stage, and in one launch\n")
    print("| | " + " | ".join(f"{precision} {way}" for precision in SIZE
                              for way in ("stages", "one launch")) + " |")
    print("|---" * (1 + 2 * len(SIZE)) + "|")
    found = film_steps(kernels)
    for method in STAGES:
        rates = [rate for precision in SIZE for rate in found[precision, method]]
        print(f"| {method} | " +
              " | ".join("-" if rate is None else f"{rate:.2g}" for rate in rates) + " |")


def card_of(context):
    """Returns the GPU that a benchmark ran on; without one, its execution space."""
    configuration = context.get("kokkos_configuration", "")
    found = re.search(r"Kokkos::Cuda\[ \d+ \] (.*?) : Selected", configuration)
    return found[1] if found else context["execution_space"]


def print_measured(kernels, folder):
    sys.path.insert(0, str(ROOT / "python"))
    from cayspin_plots.bench import Results

    results = Results(folder)
    name = card_of(next(iter(results.context.values())))
    card = next((card for card in CARDS if card in name), "H100")
    copy = max(results.median("stream copy", "GB/s", file) or 0 for file in results.context) * 1e9
    print(f"\nmeasured on {name}; copy of the memory {copy * 1e-12:.3f} TB/s, "
          f"{copy / CARDS[card]:.2f} of the bandwidth of an {card}\n")
    print(f"| case | ps a spin | model, {card} | measured over model | share of the copy |")
    print("|---|---|---|---|---|")
    moved = {}
    for kernel in kernels:
        key = kernel.precision, METHODS[kernel.method]
        moved[key] = moved.get(key, 0) + kernel.memory_bytes / kernel.steps
    for (precision, method), bytes_moved in moved.items():
        for edge in (64, 128, 256):
            case = f"{precision}/{method}/{edge}"
            if (time := results.median(case, "ns/spin")) is None:
                continue
            time *= 1e-9
            model = steps(kernels, CARDS[card], edge)[precision, method][0]
            print(f"| {case} | {time * 1e12:.1f} | {model * 1e12:.1f} "
                  f"| {time / model:.2f} | {bytes_moved / copy / time:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--edge", type=int, default=256, help="sites along an edge of the cube")
    parser.add_argument("--measured", type=pathlib.Path, metavar="DIR")
    arguments = parser.parse_args()
    kernels = read_kernels()
    print_kernels(kernels, arguments.edge)
    print_steps(kernels, arguments.edge)
    print_replicas(kernels)
    print_film(read_all_kernels())
    if arguments.measured:
        print_measured(kernels, arguments.measured)


if __name__ == "__main__":
    main()
