#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs two builds of cayspin on the same short scenes and compares their trajectories bit for bit.
Scenes of `relax` have no steps and are left out.

Every combination that `REFERENCE methods` lists is run in both precisions on every scene. All other
combinations of the same words are run once for spins and once for rigid bodies. Most of them are
refused, and both builds have to do so with the same sentence. Exit status 1 if anything differs.
"""

import argparse
import collections
import concurrent.futures
import dataclasses
import itertools
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATASETS = ("spins", "time", "energy")
GENERATORS = ("default", "orthogonal", "tangent")
ROTATIONS = ("cayley", "exponential")
ISOTROPIES = ("zero", "constant", "energy", "analytic", "finite_difference",
              "finite_difference_backward")
NONE = (None,)
MOST_SITES = 1000
REFUSING_SCENES = ("macrospin", "rigid_body_ensemble")


@dataclasses.dataclass(frozen=True)
class Combination:
    method: str
    adaptive: bool
    compensated: bool
    isotropy: str | None
    generator: str | None
    rotation: str | None

    def __str__(self):
        words = [self.method, self.isotropy, self.generator, self.rotation]
        return " ".join(filter(None, words)) + (" compensated" if self.compensated else "")


@dataclasses.dataclass(frozen=True)
class Case:
    scene: str
    precision: str
    combination: Combination

    def __str__(self):
        return f"{self.scene} {self.precision}: {self.combination}"


def words(cell):
    """Returns the words in a cell of the table, without remarks in brackets; "-" means no word."""
    found = [re.sub(r" *\(.*\)", "", word).strip() for word in cell.split(",")]
    return NONE if found == ["-"] else found


def listed_combinations(program):
    """Returns all combinations that the rows of `cayspin methods` stand for."""
    lines = subprocess.run([program, "methods"], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    titles = ("isotropy", "generator", "rotation", "order", "evaluations")
    columns = [0, *(lines[0].index(title) for title in titles)]
    found = []
    for line in lines[1:]:
        if not line.strip():
            break
        name, isotropies, generators, rotations, _ = (
            line[a:b].strip() for a, b in itertools.pairwise(columns))
        method, *compensated = name.split()
        for choice in itertools.product(words(isotropies), words(generators), words(rotations)):
            found.append(Combination(method, "adaptive" in line, bool(compensated), *choice))
    if not found:
        sys.exit(f"{program} lists no methods")
    return list(dict.fromkeys(found))


def other_combinations(listed):
    """Yields all other combinations of the same words. Most of them are refused."""
    adaptive = {combination.method: combination.adaptive for combination in listed}
    known = set(listed)
    for method, compensated, *choice in itertools.product(
            adaptive, (False, True), ISOTROPIES, GENERATORS, ROTATIONS):
        combination = Combination(method, adaptive[method], compensated, *choice)
        if combination not in known:
            yield combination


def toml_value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(v)}" for key, v in value.items()) + " }"
    return repr(value)


def scene_text(scene, combination, steps):
    """Returns a scene's text with another method, fewer steps and, if large, a smaller lattice."""
    in_si = scene.get("units") == "SI"
    top = {key: value for key, value in scene.items() if not isinstance(value, dict)}
    scene = {section: dict(keys) for section, keys in scene.items() if isinstance(keys, dict)}
    integrator = scene["integrator"]
    for key in ("isotropy", "generator", "rotation", "compensated", "end", "steps"):
        integrator.pop(key, None)
    integrator |= {"method": combination.method, "steps": steps}
    if combination.adaptive:
        integrator.setdefault("tolerance", 1e-5)
    elif integrator.pop("tolerance", None):
        integrator["dt"] /= 20  # the adaptive method of the scene may take much shorter steps
    if combination.isotropy == "constant":
        integrator["isotropy"] = {"constant": 5e10 if in_si else 0.3}
    elif combination.isotropy:
        integrator["isotropy"] = combination.isotropy
    if combination.generator:
        integrator["generator"] = combination.generator
    if combination.rotation:
        integrator["rotation"] = combination.rotation
    if combination.compensated:
        integrator["compensated"] = True
    scene["output"] = scene.get("output", {}) | {"every": max(1, steps // 4)}
    shape = scene["lattice"]["shape"]
    most = round(MOST_SITES ** (1 / len(shape)))
    scene["lattice"]["shape"] = [min(n, most) for n in shape]
    above = "".join(f"{key} = {toml_value(value)}\n" for key, value in top.items())
    return above + "\n".join(f"[{section}]\n" + "\n".join(f"{key} = {toml_value(value)}"
                                                          for key, value in keys.items())
                             for section, keys in scene.items()) + "\n"


def contents(path):
    with h5py.File(path) as file:
        return {name: (file[name].dtype, file[name].shape, file[name][()].tobytes())
                for name in DATASETS}


def run(program, scene, output, case, options):
    """Runs a scene; returns exit status, messages, and the contents of the file, or None."""
    command = [program, "run", scene, "--output", output, "--precision", case.precision, "--quiet",
               *options]
    environment = {**os.environ, "OMP_PROC_BIND": "false", "OMP_WAIT_POLICY": "passive"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    said = (done.stdout + done.stderr).replace(str(output), "OUTPUT").strip()
    return done.returncode, said, contents(output) if output.exists() else None


def compare(case, scene, arguments):
    """Returns the outcome, which is one of OUTCOMES, and a remark."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        path = folder / "scene.toml"
        path.write_text(scene_text(scene, case.combination, arguments.steps), encoding="utf-8")
        programs = ((arguments.reference, ["--threads", str(arguments.threads)]),
                    (arguments.other, ["--threads", str(arguments.threads), *arguments.other_set]))
        (status, said, file), (other_status, other_said, other_file) = (
            run(program, path, folder / f"{index}.h5", case, options)
            for index, (program, options) in enumerate(programs))
        said, other_said = (text.replace(str(path), "SCENE") for text in (said, other_said))
    if status != other_status:
        return "different", f"exit {status} {said!r}, exit {other_status} {other_said!r}"
    if (file is None) != (other_file is None):
        return "different", "only one of them writes a file"
    if file is not None:
        names = [name for name in DATASETS if file[name] != other_file[name]]
        if names:
            return "different", "/" + ", /".join(names)
    if status == 0:
        return "equal", ""
    outcome = "refused" if file is None else "stopped"
    if said != other_said:
        return f"{outcome}, reworded", f"{said!r}, {other_said!r}"
    return f"{outcome} alike", ""


OUTCOMES = ("equal", "refused alike", "stopped alike", "refused, reworded", "stopped, reworded",
            "different")


def cases_of(arguments, scenes):
    listed = listed_combinations(arguments.reference)
    if arguments.method:
        listed = [c for c in listed if c.method in arguments.method]
    for name, precision, combination in itertools.product(scenes, ("double", "single"), listed):
        yield Case(name, precision, combination)
    if not arguments.listed_only:
        for name, combination in itertools.product(REFUSING_SCENES, other_combinations(listed)):
            if name in scenes:
                yield Case(name, "double", combination)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reference", type=pathlib.Path, help="a program cayspin")
    parser.add_argument("other", type=pathlib.Path, help="the one that is compared with it")
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT / "scenes", metavar="FOLDER")
    parser.add_argument("--scene", action="append", help="only this one, several times")
    parser.add_argument("--method", action="append", help="only this one, several times")
    parser.add_argument("--steps", type=int, default=20, help="of each run (default: 20)")
    parser.add_argument("--threads", type=int, default=1, help="of each run (default: 1)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (default: 2)")
    parser.add_argument("--listed-only", action="store_true",
                        help="no combinations that `methods` does not list")
    parser.add_argument("--reworded", action="store_true",
                        help="accept that a message has another wording")
    parser.add_argument("--other-set", action="append", default=[], metavar="KEY=VALUE",
                        help="override a key in the other build, to see a difference found")
    arguments = parser.parse_args()
    arguments.other_set = [word for value in arguments.other_set for word in ("--set", value)]
    return arguments


def print_table(rows):
    width = max(map(len, rows))
    print(f"{'scene':{width}} " + " ".join(f"{outcome:>17}" for outcome in OUTCOMES))
    for name, counts in rows.items():
        print(f"{name:{width}} " + " ".join(f"{counts[outcome]:17}" for outcome in OUTCOMES))


def main():
    arguments = parse_arguments()
    scenes = {path.stem: tomllib.loads(path.read_text(encoding="utf-8"))
              for path in sorted(arguments.scenes.glob("*.toml"))
              if not arguments.scene or path.stem in arguments.scene}
    scenes = {name: scene for name, scene in scenes.items() if "integrator" in scene}
    cases = list(cases_of(arguments, scenes))
    rows = {name: collections.Counter() for name in [*scenes, "all"]}
    bad = {"different"} if arguments.reworded else {"different", *OUTCOMES[3:5]}
    failures = []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        outcomes = pool.map(lambda case: compare(case, scenes[case.scene], arguments), cases)
        for case, (outcome, remark) in zip(cases, outcomes):
            rows[case.scene][outcome] += 1
            rows["all"][outcome] += 1
            if outcome in bad:
                failures.append(f"{outcome}: {case}: {remark}")
    for failure in failures:
        print(failure)
    print_table(rows)
    print(f"{len(cases)} combinations run, {len(failures)} not as they were")
    sys.exit(1 if failures or not rows["all"]["equal"] else 0)


if __name__ == "__main__":
    main()
