# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs of a scene with all combinations of the values of some keys, here or on the workers of a
client."""

from __future__ import annotations

import contextlib
import itertools
import math
import numbers
import os
import re
from typing import Any, Iterable, Mapping

import numpy as np

from cayspin import _cayspin, arguments, toml_text
from cayspin.scene import Scene
from cayspin.simulation import Simulation

_MOST_RUNS = 100000  # as in src/program/sweep/grid.cpp
_RESULTS = [("step", np.int64), ("time", np.float64), ("energy", np.float64),
            ("norm_defect", np.float64), ("magnetization", np.float64, (3,)),
            ("evaluations", np.int64), ("step_seconds", np.float64)]
_NO_RESULTS = (0, math.nan, math.nan, math.nan, (math.nan,) * 3, 0, math.nan)
_DONE, _WRONG_SCENE, _NUMBERS_FAILED = 0, 2, 3  # exit statuses of the program


def _message(error, path, overrides):
    """Returns a message without the place of the error, in a text that the caller has not seen."""
    message = re.sub(rf"^{re.escape(path)}:(\d+:)? *", "", str(error))
    for one in overrides:
        message = message.removeprefix(f"--set {one}: ")
    return message


def _run(text, path, overrides, precision, space, threads):
    """Runs one combination; clients call this in their workers. Returns its status, its message and
    the values of _RESULTS."""
    try:
        scene = Scene.__new__(Scene)
        scene._finish(_cayspin.Scene.parse(text, path, overrides, None, {}), {}, None, None, {})
        sim = Simulation(scene, precision, space, threads)
        # Asked for here, because warnings of a worker would not reach the caller.
        warning, sim._dt_is_checked = sim._run.warning(), True
        sim.run(output=False)
    except _cayspin.NumbersFailed as error:
        return _NUMBERS_FAILED, _message(error, path, overrides), _NO_RESULTS
    except _cayspin.SceneError as error:
        return _WRONG_SCENE, _message(error, path, overrides), _NO_RESULTS
    energy, norm_defect, magnetization = sim._run.sample()
    return _DONE, _message(warning or "", path, overrides), (
        sim.steps, sim.time, energy, norm_defect, tuple(magnetization), sim.evaluations,
        sim.step_seconds)


def _values_by_key(over):
    """Returns the keys with lists of their values."""
    if not isinstance(over, Mapping) or not over:
        raise _cayspin.CayspinError(f"sweep: over {arguments.shown(over)}; accepted: a dict of keys "
                                    "and lists of their values")
    found = {}
    for key, values in over.items():
        if not re.fullmatch(r"[^=\s]+", arguments.word(key, "sweep: over")):
            raise _cayspin.CayspinError(f"sweep: over {key!r}; accepted: the name of a key")
        for other in found:
            if f"{key}.".startswith(f"{other}.") or f"{other}.".startswith(f"{key}."):
                raise _cayspin.CayspinError(f"sweep: over has both {other} and {key}; accepted: one "
                                            "of them")
        found[key] = arguments.entries(values, f"sweep: over {key}", "a list of values")
        if not found[key]:
            raise _cayspin.CayspinError(f"sweep: over {key}: an empty list; accepted: at least one "
                                        "value")
    runs = math.prod(map(len, found.values()))
    if runs > _MOST_RUNS:
        raise _cayspin.CayspinError(f"sweep: {runs} runs; accepted: at most {_MOST_RUNS}")
    return found


def _require_text(scene):
    if not isinstance(scene, Scene):
        raise _cayspin.CayspinError(f"sweep: a {type(scene).__name__}; accepted: a Scene")
    for key, kind in scene._only_here.items():
        raise _cayspin.CayspinError(f"sweep: the scene has {kind} as {key}, which cannot be passed "
                                    "to other processes; accepted: a scene that is only text")


def _require_runnable(text, path, overrides):
    """Raises the error of a combination that cannot run, before the first run starts."""
    try:
        scene = _cayspin.Scene.parse(text, path, overrides, None, {})
    except _cayspin.SceneError as error:
        message = _message(error, str(path), overrides)
        raise _cayspin.SceneError(f"sweep: with {' '.join(overrides)}: {message}") from None
    if re.search(r"^\s*(\[\s*ensemble\b|ensemble\s*[.=])", scene.text, re.MULTILINE):
        raise _cayspin.SceneError("sweep: ensemble: each run is one Simulation, which takes no "
                                  "ensemble; accepted: a scene without [ensemble]")
    if not scene.has_integrator or scene.steps == 0:
        raise _cayspin.CayspinError("sweep: the scene has no end; accepted: integrator.end or "
                                    "integrator.steps in the scene")


def _on(client, calls):
    """Returns what the calls of _run() return, in their order. If one raises, those that have not
    begun are cancelled."""
    if client is None:
        return [_run(*call) for call in calls]
    futures = []
    try:
        for call in calls:
            futures.append(client.submit(_run, *call))
        return [future.result() for future in futures]
    except BaseException:
        for future in futures:
            with contextlib.suppress(Exception):  # would hide the first one
                future.cancel()
        raise


def _column(values):
    """Returns the values of a key as an array: of float64 if all are numbers, else of objects."""
    if all(isinstance(one, numbers.Real) and not isinstance(one, (bool, np.bool_))
           for one in values):
        return np.array(values, np.float64)
    column = np.empty(len(values), object)
    for n, value in enumerate(values):
        column[n] = value
    return column


def _table(keys, combinations, results):
    columns = dict(zip(keys, map(_column, zip(*combinations))))
    columns["status"] = np.array([status for status, _, _ in results], np.int64)
    columns["message"] = np.array([message for _, message, _ in results], np.str_)
    table = np.empty(len(results), [(key, column.dtype) for key, column in columns.items()] +
                     _RESULTS)
    for key, column in columns.items():
        table[key] = column
    for n, (name, *_) in enumerate(_RESULTS):
        table[name] = [numbers_of_run[n] for _, _, numbers_of_run in results]
    return table


def sweep(scene: Scene, over: Mapping[str, Iterable[Any]], client: Any = None,
          precision: str = "double", space: str | None = None,
          threads: int | None = None) -> np.ndarray:
    """Runs the `scene` to its end with every combination of the values of some keys, each as
    Simulation.run() does, with the same bits. Writes no files; `cayspin sweep` does.

        table = cayspin.sweep(scene, over={"system.damping": [0.05, 0.1, 0.2],
                                           "field.applied": [[2, 0, 0], [5, 0, 0]]})
        table["magnetization"][table["status"] == 0]

    `over` has lists of values by dotted keys, in the units of the scene. With a `client`, each
    combination is a call of client.submit(function, *arguments), whose result() is waited for: a
    dask.distributed.Client, an Executor of concurrent.futures, or another object with these
    methods. Its workers need this package, the input files of the scene under the same absolute
    names, and processes that are not forked from one with runs on several threads. Without a client
    the runs take place here, one after another. `precision`, `space` and `threads` are those of
    Simulation; where workers share the cores of a machine, choose `threads` accordingly.

    Returns a structured array (run,), in which the last key changes fastest. Its fields are the
    keys (float64 if all values of a key are numbers, otherwise objects), and

    - `status`: 0 for a complete run, 3 where the numbers failed, 2 where the scene cannot run
    - `message`: the warning or the error of the run, or ""
    - `step`, `time`, `energy`, `norm_defect` and `magnetization`, (3,), at the end of the run, in
      the units of the scene
    - `evaluations` of the field of all sites, and `step_seconds`, the seconds of stepping

    A run that fails has the step 0, no evaluations and otherwise NaN, and the others go on. All
    scenes are checked before the first run. If the client or a call of it raises an exception, and
    after Ctrl-C, the calls that have not begun are cancelled, and the exception reaches you.

    Raises SceneError for wrong values of keys and scenes with [ensemble], CayspinError for scenes
    with functions or arrays, scenes without end and other wrong arguments.
    """
    _require_text(scene)
    by_key = _values_by_key(over)
    if client is not None and not callable(getattr(client, "submit", None)):
        raise _cayspin.CayspinError(f"sweep: client {arguments.shown(client)}; accepted: an object "
                                    "with submit(), such as an Executor, or None")
    how = (arguments.word(precision, "precision"),
           None if space is None else arguments.word(space, "space"),
           None if threads is None else arguments.whole(threads, "threads", 32))
    combinations = list(itertools.product(*by_key.values()))
    overrides = [[f"{key}={toml_text.value(value, key)}" for key, value in zip(by_key, values)]
                 for values in combinations]
    for one in overrides:
        _require_runnable(scene.text, scene._scene.path, one)
    # Workers may be in other folders, and the scene's input files are beside its own.
    path = os.path.abspath(scene._scene.path)
    results = _on(client, [(scene.text, path, one, *how) for one in overrides])
    return _table(by_key, combinations, results)
