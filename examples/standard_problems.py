#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Solves the five standard problems of muMAG with the shipped scenes. Prints what they ask for
beside published values, with the evaluations of the field and the processor time in seconds.

Usage: standard_problems.py [PROBLEM]... [--picture PNG] [--quick]
"""

import argparse
import pathlib
import time

import cayspin
import numpy as np

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"


def scene(name, **tables):
    return cayspin.Scene.from_file(SCENES / f"standard_problem_{name}.toml", **tables)


class Clock:
    """Processor seconds of this process."""

    def __init__(self):
        self.begin = time.process_time()

    def __str__(self):
        return f"{time.process_time() - self.begin:.2f}"


class Loop:
    """Equilibria in fields along a direction, each relaxed from the previous one."""

    def __init__(self, of, direction):
        self.sim = cayspin.Simulation(of)
        self.direction = np.array(direction) / np.linalg.norm(direction)
        self.fields, self.along, self.counts, self.clock = [], [], [], Clock()

    def to(self, h):
        found = self.sim.relax(applied=h * self.direction)
        if not found.converged:
            raise SystemExit(f"not at rest in a field of {h}: {found}")
        m = np.array(self.sim.magnetization())
        self.fields.append(h)
        self.along.append(m @ self.direction)
        self.counts.append(found.evaluations)
        return m

    def coercivity(self):
        """Returns the coercivity: minus the field at which the magnetization along the direction
        crosses zero, interpolated between the states before and after."""
        i = int(np.argmax(np.array(self.along) < 0))
        (a, b), (h, k) = self.along[i - 1:i + 1], self.fields[i - 1:i + 1]
        return -(h - a * (k - h) / (b - a))

    def cost(self):
        return (f"{len(self.counts):8}{np.median(self.counts):13.0f}{max(self.counts):9}"
                f"{str(self.clock):>9}")


def problem_1(quick):
    """Half hysteresis loops of a film of permalloy, 2 um x 1 um x 20 nm, along both axes."""
    loops = []
    print("axis     cells, nm   Hc, mT   <m> at H = 0       states  evaluations: median, most   s")
    # The problem asks for a field 1 degree off the axis.
    for cells in [[50, 25, 1]] if quick else [[100, 50, 1], [200, 100, 1]]:
        size = {"shape": cells, "spacing": [2e-6 / cells[0], 1e-6 / cells[1], 20e-9]}
        for axis, degrees in (("long", 1), ("short", 91)):
            direction = [np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0]
            of = scene(1, lattice=size, field={"applied": [0, 0, 0]},
                       initial={"uniform": direction})
            loop = Loop(of, direction)
            for millitesla in (50, 40, 30, 20, 15, 10, 5):
                loop.to(1e-3 * millitesla)
            m = loop.to(0)
            for step in range(1, 31):
                loop.to(-0.5e-3 * step)
            for millitesla in (-20, -30, -40, -50):
                loop.to(1e-3 * millitesla)
            print(f"{axis:9}{2000 / cells[0]:9g}{1e3 * loop.coercivity():9.2f}   "
                  f"({m[0]:6.3f}, {m[1]:.3f})  {loop.cost()}", flush=True)
            loops.append((axis, cells, loop))
    print("long            20     5.43   ( 0.873, 0.155)  OOMMF 2.1a0 on the same cells")
    print("short           20     2.92   (-0.873, 0.155)  OOMMF 2.1a0 on the same cells")
    return loops


# Donahue et al., J. Appl. Phys. 87, 5520 (2000), and muMAG's page on the problem: d, Hc, <m_x> and
# <m_y> at zero field. The first row is their limit for small particles.
DONAHUE = ((0.1, .05707, 1, 0), (2, .05694, 1, 0), (5, .05612, .9999, 0), (8, .05515, .9995, 0),
           (10, .05454, .9989, 0), (12, .05389, .9886, .0631), (15, .05258, .9784, .0795),
           (20, .04991, .9701, .0819), (25, .04779, .9657, .0790), (30, .04594, .9627, .0756))


def problem_2(quick):
    """Half hysteresis loops along (1, 1, 1) of particles of 5d x d x d/10."""
    loops = []
    print("d, l_ex  cells           Hc, Ms   <m> at H = 0       states  evaluations: median, most"
          "   s")
    for d, n, layers in ((0.1, 10, 1), (5, 10, 1), (10, 10, 1)) if quick else (
            (0.1, 10, 1), (5, 20, 1), (10, 25, 1), (20, 50, 1), (30, 50, 1),
            (5, 10, 1), (5, 20, 2), (5, 40, 4), (10, 10, 1), (10, 20, 2), (10, 40, 4),
            (20, 20, 2), (20, 40, 4), (30, 20, 2), (30, 40, 4)):
        loop = Loop(scene(2, lattice={"shape": [5 * n, n, layers],
                                      "spacing": [d / n, d / n, 0.1 * d / layers]},
                          field={"applied": [0, 0, 0]}), [1, 1, 1])
        for h in (0.5, 0.2, 0.1, 0.05, 0.02):
            loop.to(h)
        remanence = loop.to(0)
        step, fields = 0.005, 0.0
        while step > 1e-5:  # towards the coercivity, in ever shorter steps
            while loop.along[-1] > 0:
                before = loop.sim.spins.copy()
                fields -= step
                loop.to(fields)
            if step > 1e-4:
                loop.sim.spins = before
                loop.along.pop(), loop.fields.pop()
                fields += step
            step /= 10
        print(f"{d:<9g}{f'{5 * n} x {n} x {layers}':14}{loop.coercivity():9.5f}   "
              f"({remanence[0]:.4f}, {abs(remanence[1]):.4f}) {loop.cost()}", flush=True)
        loops.append((d, layers, loop))
    for d, *theirs in DONAHUE:
        if any(d == of for of, *_ in loops):
            print("{:<9g}Donahue et al.{:9.5f}   ({:.4f}, {:.4f})".format(d, *theirs))
    return loops


def energies(sim, cells):
    """Returns the mean energy densities of exchange, demagnetising field and anisotropy, in units
    of Km; the energy of the anisotropy is 0 for spins along its axis."""
    found = sim.energies()
    sites = cells**3
    return np.array([2 * found["exchange"] / sites, 2 * found["demag"] / sites,
                     2 * found["anisotropy"] / sites + 0.1])


def problem_3(quick):
    """Finds the edge of the cube in which a flower and a vortex have the same energy."""
    starts = {"flower": ({"uniform": [0, 0, 1]}, True),
              "twisted flower": ({"uniform": [0, 0, 1]}, False),
              "vortex": ({"expression": ["0.3", "0.5 - z", "y - 0.5"]}, False)}

    def at_rest(state, edge, cells):
        start, keeps = starts[state]
        sim = cayspin.Simulation(scene(3, lattice={"shape": [cells] * 3, "spacing": edge / cells},
                                       initial=start))
        return sim, sim.relax(keep_saddles=keeps).evaluations

    def energy(state, edge, cells):
        return energies(at_rest(state, edge, cells)[0], cells).sum()

    def crossing(flower, cells):
        edges, apart = [8.45, 8.5], []
        while len(edges) < 6 and abs(edges[-1] - edges[-2]) > 1e-4:
            apart += [energy(flower, edge, cells) - energy("vortex", edge, cells)
                      for edge in edges[len(apart):]]
            edges.append(edges[-1] - apart[-1] * (edges[-1] - edges[-2]) / (apart[-1] - apart[-2]))
        return edges[-1]

    print("cells  L, l_ex  state              E, Km  exchange   demag  anisotropy  |<m>|"
          "   evaluations   s")
    for cells in (10,) if quick else (10, 20, 40):
        for flower in ("flower", "twisted flower"):
            edge = crossing(flower, cells)
            for state in (flower, "vortex"):
                clock = Clock()
                sim, evaluations = at_rest(state, edge, cells)
                parts = energies(sim, cells)
                print(f"{cells}^3{edge:10.4f}  {state:16}{parts.sum():8.4f}{parts[0]:10.4f}"
                      f"{parts[1]:8.4f}{parts[2]:12.4f}{np.linalg.norm(sim.magnetization()):7.3f}"
                      f"{evaluations:14}{str(clock):>8}", flush=True)
    print("""70^3    8.4673  flower            0.3025    0.0177  0.2792      0.0056  Martins et al.
                vortex            0.3025    0.1724  0.0780      0.0521
        8.47    flower, vortex    0.3027  Rave, Fabian, Hubert (1998)
        8.477   flower, vortex            +- 0.007, Bjork et al. (2021)
        8.52    flower            0.3049  Hertel, Kronmueller (2002), finite elements
        8.57    twisted flower    0.3032""")
    edges = np.linspace(8, 8.8, 5 if quick else 17)
    return edges, {state: [energy(state, edge, 16) for edge in edges] for state in starts}


def curve(of, end, looks, evaluations_of_multirate=None):
    """Returns <m> at `looks` equally spaced times, and a text with the cost."""
    sim, clock, m = cayspin.Simulation(of), Clock(), []
    for look in range(looks):
        sim.run(until=(look + 1) * end / looks, output=False)
        m.append(sim.magnetization())
    multirate = evaluations_of_multirate or sim.evaluations
    return np.array(m), f"{multirate:17}{str(clock):>10}"


def problem_4(quick):
    """Two reversals of a film of permalloy, and the cost of an error of 1e-3 in <m>."""
    size = {"shape": [100, 25, 1], "spacing": [5e-9, 5e-9, 3e-9]} if quick else {}
    sim = cayspin.Simulation(scene(4, lattice=size, field={"applied": [0, 0, 0]}))
    clock, found = Clock(), sim.relax(torque=1e-8)
    start = sim.spins.copy()
    print(f"at rest: <m> = ({', '.join(f'{x:.6f}' for x in start.mean(axis=(0, 1, 2)))}), "
          f"{found.evaluations} evaluations, {clock} s")
    end, curves = 1e-9, []
    each_stage = {"method": "rkmk4", "substeps": 1}
    adaptive = {"dt": 1e-11, "tolerance": 0.05, "substeps": 1}
    for number, applied in ((1, [-24.6e-3, 4.3e-3, 0]), (2, [-35.5e-3, -6.3e-3, 0])):
        def of(integrator, multirate, applied=applied):
            return scene(4, lattice=size, field={"applied": applied, "demag": {"multirate": multirate}},
                         initial=start, integrator={"end": end, **integrator})

        exact, cost = curve(of({**each_stage, "dt": 2.5e-13}, False), end, 100)
        m = np.concatenate([start.mean(axis=(0, 1, 2))[None], exact])
        i = int(np.argmax(m[:, 0] < 0))
        crossing = (i - m[i, 0] / (m[i, 0] - m[i - 1, 0])) * end / 100
        print(f"field {number}: <m_x> is first zero at {1e9 * crossing:.4f} ns; at 1 ns <m> = "
              f"({', '.join(f'{x:.6f}' for x in exact[-1])})")
        print(f"    method              error  evaluations         s\n    rkmk4, 4000 steps       "
              f"-{cost[2:]}")
        curves.append(m)
        for name, integrator, multirate, count in (
                ("the scene", {}, True, 800 + 13),
                ("rkmk4, 2700 steps", {**each_stage, "dt": end / 2700}, False, None),
                ("bs3", {"method": "bs3", **adaptive}, False, None),
                ("dp5", {"method": "dp5", **adaptive}, False, None))[:1 if quick else 4]:
            m, cost = curve(of(integrator, multirate), end, 100, count)
            print(f"    {name:18}{np.abs(m - exact).max():8.1e}{cost[4:]}", flush=True)
    print("""OOMMF (std4/oommf.txt of fidimag), 200 x 50 cells: field 1
    zero at 0.13850 ns, at 1 ns (-0.984505, 0.127447, 0.043153)
mumax3's tests, 128 x 32 cells, at 1 ns: field 1 (-0.984612, 0.126041, 0.043271)
    field 2 (-0.969233, -0.120395, -0.005308)""")
    return curves


def problem_5(quick):
    """A vortex of permalloy in a current."""
    curves = []
    meshes = {"mumax3's": ({"shape": [32, 32, 4], "spacing": [3.125e-9, 3.125e-9, 2.5e-9]},
                           [-72.17, 0, 0], 1.7595e11, 1),
              "the scene's": ({}, [-72.35, 0, 0], 2.211e5 / (4e-7 * np.pi), 8)}
    for name, (size, velocity, gamma, nanoseconds) in list(meshes.items())[:1 if quick else 2]:
        sim = cayspin.Simulation(scene("5_start", lattice=size))
        found = sim.relax()
        of = scene(5, lattice=size, initial=sim.spins.copy(), material={"gamma": gamma},
                   torque={"zhang_li": {"velocity": velocity, "nonadiabaticity": 0.05}})
        looks = 100 * nanoseconds
        m, cost = curve(of, 1e-9 * nanoseconds, looks, 800 * nanoseconds + 21)
        multirate, seconds = cost.split()
        print(f"{name} cells: at rest <m_z> = {sim.spins[..., 2].mean():.6f}, {found.evaluations} "
              f"evaluations; then {multirate}, {seconds} s", flush=True)
        for t in (1, 2, 5, 8):
            if 100 * t <= looks:
                x, y, z = m[100 * t - 1]
                print(f"    {t} ns: <m> = ({x:.6f}, {y:.6f}, {z:.6f})")
        curves.append(m)
    print("""mumax3's test standardproblem5.mx3, 1 ns: (-0.234798, -0.094536, 0.022964)
magnum.np's demos/sp5/ref/m.dat, 1 ns: (-0.230158, -0.095326, 0.023511)
    2 ns: (-0.267249, 0.032937, 0.022825); 5 ns: (-0.214015, 0.010350, 0.024255)""")
    return curves


def draw(file, results):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, ((loops, small, cube), (fields, circle, _)) = plt.subplots(
        2, 3, figsize=(12, 7), constrained_layout=True)
    _.remove()
    for axis, cells, loop in results[1][-2:]:
        h, m = 1e3 * np.array(loop.fields), np.array(loop.along)
        line, = loops.plot(h, m, label=f"{axis} axis")
        loops.plot(-h, -m, color=line.get_color())
    loops.set(title="Problem 1", xlabel="field, mT", ylabel="<m> along the field")
    loops.legend()
    small.plot(*list(zip(*DONAHUE))[:2], "o", mfc="none", label="Donahue et al.")
    for layers, marker in ((1, "x"), (4, "+")):
        of = [(d, loop.coercivity()) for d, count, loop in results[2] if count == layers]
        if of:
            small.plot(*zip(*of), marker, label=f"cayspin, cells in z: {layers}")
    small.set(title="Problem 2", xlabel="d, l_ex", ylabel="Hc, Ms")
    small.legend()
    for state, energies_of_state in results[3][1].items():
        cube.plot(results[3][0], energies_of_state, label=state)
    cube.set(title="Problem 3, 16^3 cells", xlabel="L, l_ex", ylabel="E, Km")
    cube.legend()
    for number, m in enumerate(results[4], 1):
        fields.plot(np.linspace(0, 1, len(m)), m[:, 1], label=f"field {number}")
    fields.set(title="Problem 4", xlabel="t, ns", ylabel="<m_y>")
    fields.legend()
    circle.plot(results[5][-1][:, 0], results[5][-1][:, 1])
    circle.set(title="Problem 5", xlabel="<m_x>", ylabel="<m_y>", aspect="equal")
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problems", type=int, nargs="*", metavar="PROBLEM", help="1 to 5")
    parser.add_argument("--picture", metavar="PNG", help="where all five are drawn")
    parser.add_argument("--quick", action="store_true", help="coarse cells, fewer runs")
    arguments = parser.parse_args()
    if arguments.picture and arguments.problems:
        parser.error("--picture draws all five problems; accepted: no PROBLEM beside it")
    results = {}
    for number in arguments.problems or range(1, 6):
        problem = globals()[f"problem_{number}"]
        print(f"\nProblem {number}. {problem.__doc__}", flush=True)
        results[number] = problem(arguments.quick)
    if arguments.picture:
        draw(arguments.picture, results)


if __name__ == "__main__":
    main()
