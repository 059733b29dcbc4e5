# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Simulation of a scene."""

from __future__ import annotations

import dataclasses
import os
import warnings
from typing import Any, Callable, Sequence

import numpy as np

from cayspin import _cayspin, arguments, mode_search, sites, texture, toml_text
from cayspin.averages import Averages
from cayspin.equilibrium import Bands, Minimum, Modes
from cayspin.scene import Scene
from cayspin.simulation_texture import texture_of

_GUARD_PERIOD = 100  # steps between two checks of energy and lengths in step()
_LAST_STEP = 2**53


class Simulation:
    """A simulation of a `scene`: its spins, which step forward in time.

    `precision` is "double" or "single", `space` an execution space that was compiled in (default:
    that of Kokkos), `threads` the number of threads of the space; the first simulation of a process
    sets it for all later ones.

    `restart` names a file of save(), or the trajectory of a run. The simulation continues from
    there, bit-identical to an uninterrupted run. The lattice in the file has to be the scene's; a
    warning names other differences.

    While a simulation steps, other Python threads run. Ctrl-C stops the simulation between two
    steps with KeyboardInterrupt, and it can continue from there. N calls of step() give bitwise the
    same results as one step(N), and as `cayspin run`.

    Lengths, times, fields and energies are in the units of the scene: reduced ones, or with
    units = "SI" m, s, T and J.

    Raises SceneError for a scene that cannot run here, CayspinError for other arguments and a
    `restart` that does not fit.
    """

    def __init__(self, scene: Scene, precision: str = "double", space: str | None = None,
                 threads: int | None = None, restart: str | os.PathLike | None = None):
        if not isinstance(scene, Scene):
            raise _cayspin.CayspinError(f"Simulation: a {type(scene).__name__}; accepted: a Scene")
        self._run = _cayspin.Run(
            scene._scene, arguments.word(precision, "precision"),
            None if space is None else arguments.word(space, "space"),
            None if threads is None else arguments.whole(threads, "threads", 32),
            None if restart is None else arguments.file_name(restart, "restart"))
        self._scene = scene
        self._observers: list[tuple[int, Callable[[Simulation], Any]]] = []
        self._dt_is_checked = False
        warning = self._run.restart_warning()
        if warning:
            warnings.warn(warning, stacklevel=2)

    def step(self, n: int = 1) -> None:
        """Takes `n` steps of dt, or fewer if an observer returns True. The first step warns if dt
        is too large, as `cayspin run` does.

        Raises NumbersFailed when spins are not finite, leave the sphere or gain energy without a
        source, SceneError for a dt that integrator.refuse_unstable refuses, CayspinError without an
        integrator or beyond the last possible step. An exception of an observer or of your own
        field reaches you; the spins are then those of the last complete step or, if your field
        fails in a step of an adaptive method, those of up to 100 steps before.
        """
        n = arguments.whole(n, "step")
        if not self._scene._scene.has_integrator:
            raise _cayspin.CayspinError("step: the scene has no integrator; accepted: relax()")
        self._run.require_reachable(n)
        self._check_dt()
        if n > 0 and self._observers:
            self._advance(self._run.steps + n, _GUARD_PERIOD)
        else:
            self._run.advance(n, _GUARD_PERIOD, False, 0)

    def run(self, until: float | None = None, output: str | os.PathLike | bool | None = None,
            overwrite: bool = False) -> None:
        """Steps to time `until`, in s in SI, or to the scene's end, as `cayspin run` does.

        Frames go into the HDF5 file `output`, or into the scene's output.file; output=False writes
        none. `overwrite` replaces an existing file. The run ends early if the torque falls below
        the scene's until_torque, or if an observer returns True. If an observer changes dt, the run
        still ends at the same time.

        Raises NumbersFailed and SceneError as step() does. Raises CayspinError for a time that has
        passed or is not a whole number of steps, for a scene without end, and for a file that
        exists or cannot be written.
        """
        overwrite = arguments.flag(overwrite, "run: overwrite")
        if not self._scene._scene.has_integrator:
            raise _cayspin.CayspinError("run: the scene has no integrator; accepted: relax()")
        if until is None and self._scene.steps == 0:
            raise _cayspin.CayspinError("run: the scene has no end; accepted: run(until=t), or "
                                        "integrator.end in the scene")
        if until is not None:
            until = arguments.real(until, "run: until")
        end = self._run.last_step if until is None else self._run.step_at(until)
        if end < self.steps:
            passed = self.time + (end - self.steps) * self._scene.dt if until is None else until
            raise _cayspin.CayspinError(f"run: until: t = {passed:g} has passed, the time is "
                                        f"{self.time:g}; accepted: a later time")
        self._run.require_reachable(end - self.steps)
        self._check_dt()
        if until is None:
            until = self.time + (end - self.steps) * self._scene.dt
        if output is None:
            output = self._scene._scene.output
        if output is None or arguments.is_false(output):
            self._advance(end, self._scene._scene.guard_period, True, until)
            return
        file = arguments.file_name(output, "run: output")
        # An observer may move the run's end, so _advance(), not the recorder, determines it.
        try:
            recorder = _cayspin.Recorder(self._run, _LAST_STEP, file, overwrite)
        except _cayspin.CayspinError as error:
            raise type(error)(str(error).replace("with --overwrite", "with overwrite=True")) from None
        try:
            recorder.look(False)
            self._advance(end, self._scene._scene.guard_period, True, until, recorder)
            recorder.look(True)
        except KeyboardInterrupt:
            recorder.look(True)
            recorder.finish(False)
            raise
        except BaseException:
            recorder.finish(False)
            raise
        recorder.finish(True)

    def relax(self, torque: float = 1e-6, evaluations: int = 100000,
              applied: Sequence[float] | None = None,
              keep_saddles: bool = False) -> Minimum:
        """Moves the spins to a minimum of the energy, without steps in time, as `cayspin relax`
        does. The search ends where max |m x H| is below `torque`, in the unit of H, T in SI, or
        after about `evaluations` evaluations of the field of all sites.

        `applied`, three numbers in the unit of H, replaces the scene's field.applied. A hysteresis
        loop is [sim.relax(applied=h) and sim.magnetization() for h in fields]: each search starts
        from the result of the one before it. Without `applied`, H is that of the current time. Time
        and steps do not change. With `keep_saddles` the search may end at a saddle.

        The scene needs no integrator. After Ctrl-C the spins hold the last state of the search.

        Raises NumbersFailed for a field that is not finite, SceneError for rigid bodies,
        temperatures and torques of currents, CayspinError for other arguments.
        """
        if applied is not None:
            applied = arguments.three(applied, "relax: applied")
        found = self._run.relax(arguments.real(torque, "relax: torque"),
                                arguments.whole(evaluations, "relax: evaluations"), applied,
                                arguments.flag(keep_saddles, "relax: keep_saddles"))
        return Minimum(*(getattr(found, field.name) for field in dataclasses.fields(Minimum)))

    def modes(self, count: int = 8, tolerance: float = 1e-9, evaluations: int = 100000,
              hessian: bool = False) -> Modes:
        """Finds the `count` slowest normal modes, at most 128, of motion about the present spins.
        The spins have to be in equilibrium: call relax() first. In a mode, the spins move by the
        real part of shape * exp((i w - decay) * t), where w is the angular frequency: `frequency`
        in reduced units, 2 pi * `frequency` in SI.

        A scene with [torque] may have at most 1024 sites; first call run() until the spins are at
        rest under the current. A mode with a negative decay grows.

        `tolerance` is the relative error of the shapes; frequencies are more accurate. The search
        ends after about `evaluations` evaluations of the field of all sites. `hessian` adds as many
        of the lowest eigenvalues of the Hessian of the energy, not with [torque].

        Raises CayspinError for other arguments, SceneError for rigid bodies, temperatures and spins
        that neither precess nor are damped, NumbersFailed for spins that a current keeps moving.
        """
        return mode_search.modes_of(self._run, self._scene, count, tolerance, evaluations, hessian)

    def bands(self, wave_vectors: Any) -> Bands:
        """Finds the spin waves with these `wave_vectors`, (wave, 3), in cycles per cell, about the
        present spins, which have to be in equilibrium and equal in all cells along periodic axes.

            sim.bands(np.linspace([0, 0, 0], [0.5, 0, 0], 21)).frequency

        Raises CayspinError for wave vectors along open axes, or that a field which reaches around
        the lattice does not allow, and for cells that differ. Raises SceneError for [torque], for
        lattices that are too small or not periodic, and for scenes that modes() refuses.
        """
        return mode_search.bands_of(self._run, wave_vectors)

    def set(self, keys: str | dict[str, Any], value: Any = None) -> None:
        """Changes keys of the scene. Spins, time and steps are kept. `keys` is one key with its
        `value`, or a dict of keys or tables:

            sim.set("field.applied", [0.1, 0, 0])
            sim.set({"system.damping": 0.02, "integrator.dt": 0.01})
            sim.set({"integrator": {"method": "tsit5", "tolerance": 1e-6, "end": 50}})

        Values are in the units of the scene. Values per site may be arrays (nz, ny, nx).

        Keys are changed as by a table [[stage]] of a scene, with the same rules. The value of a
        key, also if it is a dict, takes the place of the old one as a whole:
        {"field.dmi": {"bulk": 0.1}} leaves no other key of the old DMI, while "field.dmi.bulk"
        changes only that key. A table such as "integrator" keeps the keys that are not given, but
        integrator.method starts a new [integrator]. A new `end` or `steps` is counted from now. If
        no key of [integrator] is given, run() runs for the scene's duration again. Methods that
        remember earlier steps start afresh.

        Raises SceneError for keys that cannot change, such as those of lattice, and for wrong
        values, CayspinError for other arguments. In both cases, nothing is changed.
        """
        changes = {arguments.word(keys, "set"): value} if isinstance(keys, str) else keys
        if not isinstance(changes, dict):
            raise _cayspin.CayspinError(f"set: a {type(changes).__name__}; accepted: a key and its "
                                        "value, or a dict of them")
        for key in changes:
            if "=" in arguments.word(key, "set") or not key:
                raise _cayspin.CayspinError(f"set: {key!r}; accepted: the name of a key")
        changes, arrays = self._scene._changes(changes)
        overrides = toml_text.overrides(changes)
        with toml_text.errors_of_overrides():
            self._run.change(overrides, arrays)
        self._scene = self._scene._changed(self._run.scene, overrides, arrays)
        self._dt_is_checked = False

    def save(self, checkpoint: str | os.PathLike) -> None:
        """Stores in the file `checkpoint` all that Simulation(scene, restart=checkpoint) needs to
        continue bit-identically. An existing file of that name is replaced as a whole.

        Raises CayspinError if the file cannot be written.
        """
        self._run.save(arguments.file_name(checkpoint, "save"))

    def _check_dt(self):
        if not self._dt_is_checked:
            warning = self._run.warning()
            self._dt_is_checked = True
            if warning:
                warnings.warn(arguments.without_line(warning), stacklevel=3)

    def _advance(self, end, guard_period, until_torque=False, until=None, recorder=None):
        run = self._run
        while run.steps < end:
            due = min([(run.steps // every + 1) * every for every, _ in self._observers] + [end])
            if recorder:
                due = min(due, recorder.next)
            at_rest = run.advance(due - run.steps, guard_period, until_torque, end)
            if recorder:
                recorder.look(at_rest or run.steps == end)
            scene = self._scene
            stop = [arguments.wants_stop(f(self)) for every, f in self._observers
                    if run.steps % every == 0]
            if at_rest or any(stop):
                return
            if until is not None and self._scene.dt != scene.dt:
                end = run.step_at(until)

    def observe(self, every: int, f: Callable[[Simulation], Any]) -> None:
        """Calls the function `f` with this simulation after each step whose number is a multiple of
        `every`. If `f` returns True, the current step(n) or run() ends.

        Raises CayspinError for an `every` below 1, and if `f` is not a function.
        """
        every = arguments.whole(every, "observe: every")
        if not callable(f):
            raise _cayspin.CayspinError(f"observe: a {type(f).__name__}; accepted: a function")
        if every < 1:
            raise _cayspin.CayspinError(f"observe: every {every} steps; accepted: at least 1")
        self._observers.append((every, f))

    def averages(self, every: int, window: int | None = None) -> Averages:
        """Starts running means of magnetizations and energies, with their errors. Samples are taken
        after each step whose number is a multiple of `every`, from now on. With `window` the means
        are over the latest `window` samples, otherwise over all samples since the last restart() of
        the result.

        Raises CayspinError for an `every` or a `window` below 1.
        """
        if window is not None:
            window = arguments.whole(window, "averages: window")
            if window < 1:
                raise _cayspin.CayspinError(f"averages: window {window}; accepted: at least 1")
        means = Averages(window)
        self.observe(every, means._look)
        return means

    @property
    def spins(self) -> np.ndarray:
        """The present spins, (nz, ny, nx, 3), or for a crystal with several sites in a cell
        (site, nz, ny, nx, 3). On a host they are a read-only view of the library's memory, on a
        device a copy.

        A view never changes: while you hold one, the next step moves the spins to other memory.
        Assigning to `spins` copies and normalises any array that broadcasts to the shape, and
        methods that remember earlier steps start afresh. Raises CayspinError for another shape, and
        for vectors that are zero or not finite.
        """
        return sites.by_site(self._run.spins(), self._scene._scene.cell_sites)

    @spins.setter
    def spins(self, values) -> None:
        values = arguments.numbers(values, "spins")
        shape = (*self._scene.shape, 3)
        try:
            values = np.broadcast_to(values, shape)
        except ValueError:
            raise _cayspin.CayspinError(f"spins: an array of shape {values.shape}; accepted: one "
                                        f"that broadcasts to {shape}") from None
        self._run.set_spins(sites.by_plane(values, self._scene._scene.cell_sites))

    def plot(self, axes: Any = None, **options: Any) -> Any:
        """Draws the present spins into matplotlib `axes` (default: new ones), which it returns.
        Options are those of texture.draw(): plane="z=0", quantity="charge", colors="safe",
        before=other_spins.

        Raises CayspinError for a plane or an option that does not exist.
        """
        arguments.options(options, texture.OPTIONS, "plot")
        try:
            return texture.draw(texture_of(self), axes, **options)
        except ValueError as error:
            raise _cayspin.CayspinError(f"plot: {error}") from None

    def field(self) -> np.ndarray:
        """The present effective field H of every site, (nz, ny, nx, 3), or for a crystal with
        several sites in a cell (site, nz, ny, nx, 3), in T in SI; read-only. H includes torques of
        currents, as the field that would turn the spins in the same way, and is 0 at frozen sites.
        At vacant sites H means nothing and need not be 0. Raises CayspinError for rigid bodies.
        """
        return sites.by_site(self._run.field(), self._scene._scene.cell_sites)

    def energy(self) -> float:
        """The energy, summed over sites, in the scene's unit, J in SI; for rigid bodies, the energy
        of their rotation."""
        return self._run.sample()[0]

    def energies(self) -> dict[str, float]:
        """The energy of each term of the scene, summed over sites, in the scene's unit, J in SI:
        exchange, dmi, anisotropy, applied, slab_demag, demag, dipoles, nonlocal and others; for
        rigid bodies, rotation."""
        return self._run.energies()

    def magnetization(self) -> np.ndarray:
        """The mean spin, (3,), weighted by the moments of the sites."""
        return np.array(self._run.sample()[2])

    def sublattice_magnetization(self) -> np.ndarray:
        """The mean spin of each site of a cell, (site, 3), over cells with a spin at this site."""
        spins = self.spins
        spins = spins.reshape(-1, *spins.shape[-4:])
        count = spins.any(-1).sum((1, 2, 3))
        return spins.sum((1, 2, 3), np.float64) / np.maximum(count, 1)[:, None]

    def norm_defect(self) -> float:
        """The largest | |m| - 1 | of all sites, dimensionless."""
        return self._run.sample()[1]

    @property
    def time(self) -> float:
        """The time now, in the scene's unit, s in SI."""
        return self._run.time

    @property
    def steps(self) -> int:
        """Steps of dt taken since the time 0."""
        return self._run.steps

    @property
    def evaluations(self) -> int:
        """Evaluations of the field of all sites so far."""
        return self._run.evaluations

    @property
    def step_seconds(self) -> float:
        """Seconds of stepping so far, without observers and files."""
        return self._run.step_seconds

    @property
    def scene(self) -> Scene:
        """The scene that runs, with the keys that set() has changed."""
        return self._scene

    @property
    def precision(self) -> str:
        """"double" or "single"."""
        return self._run.precision

    @property
    def space(self) -> str:
        """The execution space, such as "openmp"."""
        return self._run.space

    @property
    def threads(self) -> int:
        """The number of threads of the space, which is 1 for a device."""
        return self._run.threads

    def __repr__(self):
        return (f"<cayspin.Simulation step {self.steps}, t = {self.time:g}, {self.precision}, "
                f"{self.space}>")
