# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Error against time: the commands `trade` and `advise` of the program."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
from typing import Any

from cayspin import arguments, toml_text
from cayspin._cayspin import CayspinError, NumbersFailed
from cayspin.processes import environment
from cayspin.scene import Scene
from cayspin.texture import toml


def program() -> str:
    """Returns the program that CAYSPIN_PROGRAM names, that of this package, or the one on the
    PATH."""
    packaged = pathlib.Path(__file__).resolve().parent / "bin" / "cayspin"
    found = None if packaged.exists() else shutil.which("cayspin")
    return os.environ.get("CAYSPIN_PROGRAM") or found or str(packaged)


LONGEST = 7 * 24 * 3600  # seconds: trials of large scenes take hours


def _input_files(command: str, scene: Scene) -> list[str]:
    """Overrides that give the scene's input files with absolute paths."""
    folder = pathlib.Path(scene._scene.path).parent.absolute()

    def found(thing, key):
        if isinstance(thing, list):
            return [one for n, entry in enumerate(thing) for one in found(entry, f"{key}.{n}")]
        if not isinstance(thing, dict):
            return []
        return [one for name, entry in thing.items() for one in (
            [f"{key}.{name}={toml_text.value(folder / entry, name)}"]
            if name in ("file", "image") and isinstance(entry, str)
            else found(entry, f"{key}.{name}"))]

    if "file" not in scene.text and "image" not in scene.text:
        return []
    try:
        tables = toml.loads(scene.text)
    except ImportError as error:
        raise CayspinError(f"{command}: finding the input files of the scene requires "
                           f"{error}; accepted: a scene without such files") from None
    return [one for name, table in tables.items() if name != "output" for one in found(table, name)]


def _as_of_a_call(command: str, message: str, file: str, written: bool,
                  changed: list[str]) -> str:
    """Returns a message of the program, rewritten for the caller of trade() or advise(): without
    options of the command line, and without the file that was written for the call."""
    if written:
        message = re.sub(rf"^{re.escape(file)}:(\d+: )?", "", message).strip()
    for one in changed:
        message = message.removeprefix(f"--set {one}: ")
    message = re.sub(r" \(see cayspin help \w+\)$", "", message)
    return re.sub(r"^cayspin: --(\w+):? ", rf"{command}: \1 ", message)


def _ask(command: str, scene: Scene, *options: str) -> dict:
    if not isinstance(scene, Scene):
        raise CayspinError(f"{command}: a {type(scene).__name__}; accepted: a Scene")
    for key, kind in scene._only_here.items():
        raise CayspinError(f"{command}: the scene has {kind} as {key}, which the program cannot "
                           "run; accepted: a scene that is only text")
    with tempfile.TemporaryDirectory() as folder:
        if scene._overrides is None:
            file = pathlib.Path(folder, "scene.toml")
            file.write_text(scene.text, encoding="utf-8")
            changed = _input_files(command, scene)
        else:
            file = scene._scene.path
            changed = scene._overrides
        settings = [part for one in changed for part in ("--set", one)]
        try:
            done = subprocess.run([program(), command, str(file), *settings, *options, "--json"],
                                  capture_output=True, text=True, timeout=LONGEST,
                                  env=environment())
        except subprocess.TimeoutExpired:
            raise CayspinError(f"{command}: the program has not ended after {LONGEST} s") from None
        except OSError as error:
            raise CayspinError(f"{command}: the program {program()} does not run: {error.strerror}"
                               ) from None
    if done.returncode:
        message = _as_of_a_call(command, done.stderr.strip(), str(file),
                                scene._overrides is None, changed)
        message = message or f"{command}: the program ended with status {done.returncode}"
        raise (NumbersFailed if done.returncode == 3 else CayspinError)(message)
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        raise CayspinError(f"{command}: the program {program()} printed no result; accepted: the "
                           "program cayspin") from None
    if scene._overrides is None and answer.get("warning"):
        answer["warning"] = re.sub(rf"^{re.escape(str(file))}:(\d+: )?", "",
                                   answer["warning"]).strip()
    return answer


def _options(precision, space, threads):
    options = []
    for name, value, read in (("precision", precision, arguments.word),
                              ("space", space, arguments.word),
                              ("threads", threads, arguments.whole)):
        if value is not None:
            options += [f"--{name}", str(read(value, name))]
    return options


class Trade(list):
    """Result of trade(): a list of dicts, one for each run. pandas.DataFrame(trade) takes it.

    - `method`, and `baseline`: whether the method is a baseline
    - `dt`, in the scene's unit, or `tolerance`, in radians
    - `error`: the largest distance of any spin from a reference solution, dimensionless
    - `seconds` of stepping, and `evaluations` of the field of all sites
    - `front`: whether no other run is faster and at least as accurate
    """

    def __init__(self, answer: dict):
        super().__init__({"method": method["method"], "baseline": method["baseline"], **rung}
                         for method in answer["methods"] for rung in method["rungs"])
        #: the time up to which the errors were measured, in the scene's unit
        self.horizon: float = answer["horizon"]

    def plot(self, axes: Any = None, cost: str = "seconds") -> Any:
        """Draws error over `cost` ("seconds" or "evaluations") into matplotlib `axes` (default: new
        ones), which it returns. Methods on the Pareto front have names. Raises CayspinError for
        another `cost`.
        """
        if cost not in ("seconds", "evaluations"):
            raise CayspinError(f'plot: cost {cost!r}; accepted: "seconds" or "evaluations"')
        axes = arguments.axes(axes)
        for name in dict.fromkeys(run["method"] for run in self):
            runs = [run for run in self if run["method"] == name and run["error"] > 0]
            if not runs:
                continue
            points = [run[cost] for run in runs], [run["error"] for run in runs]
            if any(run["front"] for run in runs):
                axes.loglog(*points, "o-", markersize=3, label=name)
            else:
                axes.loglog(*points, color="0.75", linewidth=0.7, zorder=1)
        axes.set_xlabel("seconds of stepping" if cost == "seconds" else "evaluations of the field")
        axes.set_ylabel("largest distance of any spin")
        axes.legend(fontsize="small")
        return axes


@dataclasses.dataclass
class Advice:
    """Result of advise(): the cheapest method for an error, and its steps."""

    method: str  #: its name, as in "rkmk4 tangent, single"
    error: float  #: predicted largest distance of any spin, dimensionless
    seconds: float  #: predicted seconds of the whole run
    memory: int  #: predicted for the run, in bytes
    precision: str  #: "double" or "single"
    dt: float  #: the step, in the scene's unit
    steps: int  #: of the whole run
    tolerance: float | None  #: in radians; None for methods with constant steps
    warning: str | None  #: the warning of `cayspin run` if dt is too large, otherwise None
    horizon: float  #: the time up to which the error is predicted, in the scene's unit
    units: str  #: of dt and horizon, the scene's: "reduced" or "SI"
    space: str  #: the execution space in which `seconds` holds
    threads: int  #: the number of threads of the space
    scene: Scene  #: with the method and its steps: Simulation(advice.scene, advice.precision)
    others: list[dict]  #: method and seconds of the other methods, cheapest first


def trade(scene: Scene, seconds: float = 10, precision: str | None = None,
          space: str | None = None, threads: int | None = None) -> Trade:
    """Tries the methods that can run the `scene`, except a few that exist only to show a formula,
    with finer and finer steps, as `cayspin trade` does. After a run that takes longer than
    `seconds`, its method is not tried with finer steps. This takes minutes. `precision`, `space`
    and `threads` are those of Simulation; by default both precisions and the program's space and
    threads.

    Raises CayspinError for a scene that the program cannot run, such as one with functions or
    arrays.
    """
    return Trade(_ask("trade", scene, "--seconds", repr(arguments.real(seconds, "seconds")),
                      *_options(precision, space, threads)))


def advise(scene: Scene, error: float, precision: str | None = None, space: str | None = None,
           threads: int | None = None) -> Advice:
    """Finds the cheapest method that runs the `scene` to within `error`, as `cayspin advise` does.
    `error`, 1e-13 to 1, is the largest distance of any spin from the solution, at a dozen times
    from the first step on. `precision`, `space` and `threads` are those of trade().

    Raises NumbersFailed if no method reaches the error, CayspinError for a scene that the program
    cannot run, such as one with functions or arrays.
    """
    answer = _ask("advise", scene, "--error", repr(arguments.real(error, "error")),
                  *_options(precision, space, threads))
    return Advice(scene=scene._with(answer.pop("overrides")), **answer)
