# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A scene that runs."""

from __future__ import annotations

import dataclasses
import os
import warnings
from typing import Any, Callable, Sequence

import numpy as np

from cayspin import _cayspin, arguments, sites, texture, toml_text
from cayspin.averages import Averages
from cayspin.scene import Scene

_GUARD_PERIOD = 100  # steps between two looks at energy and lengths in step()


@dataclasses.dataclass(frozen=True)
class Minimum:
    """Result of relax(), in the units of the scene."""

    end: str  #: "converged", "stagnated" (by round-off) or "evaluation limit"
    torque: float  #: max |m x H|
    energy: float
    iterations: int
    evaluations: int  #: of the field of all sites
    saddles: int  #: that were left on the way
    curvature: float  #: an upper bound of the least one of the energy, of a converged state

    @property
    def converged(self) -> bool:
        """Is the torque below its bound, and was no direction found that leads down?"""
        return self.end == "converged"


@dataclasses.dataclass(frozen=True)
class Modes:
    """Result of modes(), slowest first."""

    frequency: np.ndarray  #: angular; in Hz in SI
    decay: np.ndarray  #: in 1/s in SI; negative where the motion grows
    residual: np.ndarray  #: errors of the shapes, relative
    shape: np.ndarray  #: complex dm, (mode, nz, ny, nx, 3); the longest has length 1
    converged: bool
    evaluations: int  #: of the field of all sites


class Simulation:
    """A scene in memory.

    `precision` is "double" or "single", `space` one of the execution spaces compiled in (default:
    that of Kokkos), `threads` their number: the first simulation of a process decides that.

    `restart` names a file of save(), or the trajectory of a run: the simulation goes on from there
    with the bits of one without a break. Its lattice has to be the scene's; a warning names what
    else differs.

    While it steps, other Python threads run. Ctrl-C stops it between two steps with
    KeyboardInterrupt, and it can go on from there. N calls of step() give the bits of one step(N),
    and those of `cayspin run`.

    Raises SceneError, CayspinError, and NumbersFailed when the numbers of a run fail. The first step
    warns of a dt that is too large, as `cayspin run` does; refuse_unstable makes that a SceneError.
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
        """Takes n steps of dt, or fewer when an observer returns True."""
        n = arguments.whole(n, "step")
        if not self._scene._scene.has_integrator:
            raise _cayspin.CayspinError("step: the scene has no integrator; accepted: relax()")
        self._run.require_reachable(n)
        self._check_dt()
        if n > 0 and self._observers:
            self._advance(self._run.steps + n, _GUARD_PERIOD, False, None)
        else:
            self._run.advance(n, _GUARD_PERIOD, False)

    def run(self, until: float | None = None, output: str | os.PathLike | bool | None = None,
            overwrite: bool = False) -> None:
        """Steps to time `until`, or to the scene's end, as `cayspin run` does.

        Frames go into the HDF5 file `output`, or into the scene's output.file; output=False writes
        none. The run ends early where the scene's until_torque or an observer says so.
        """
        overwrite = arguments.flag(overwrite, "run: overwrite")
        if not self._scene._scene.has_integrator:
            raise _cayspin.CayspinError("run: the scene has no integrator; accepted: relax()")
        if until is None and self._scene.steps == 0:
            raise _cayspin.CayspinError("run: the scene has no end; accepted: run(until=t), or "
                                        "integrator.end in the scene")
        end = self._run.last_step if until is None else self._run.step_at(
            arguments.real(until, "run: until"))
        if end < self.steps:
            until = end * self._scene.dt if until is None else until
            raise _cayspin.CayspinError(f"run: until t = {until:g}, and the time is "
                                        f"{self.time:g}; accepted: a later time")
        self._run.require_reachable(end - self.steps)
        self._check_dt()
        if output is None:
            output = self._scene._scene.output
        if output is None or arguments.is_false(output):
            self._advance(end, self._scene._scene.guard_period, True, None)
            return
        file = arguments.file_name(output, "run: output")
        recorder = _cayspin.Recorder(self._run, end, file, overwrite)
        try:
            recorder.look(False)
            self._advance(end, self._scene._scene.guard_period, True, recorder)
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
        """Moves the spins to a state of least energy, without steps in time, as `cayspin relax`
        does: until max |m x H| is below `torque`, or for so many evaluations of the field.

        `applied`, three numbers, takes the place of the scene's field.applied. A hysteresis is
        [sim.relax(applied=h) and sim.magnetization() for h in fields]: each search begins at the
        state before. Otherwise H is that at the time now. Time and steps stay as they are.
        With `keep_saddles` a state without torque is enough, a saddle too.

        The scene needs no integrator. Raises NumbersFailed for a field that is not finite,
        SceneError for rigid bodies and temperatures. Ctrl-C leaves the spins on their way.
        """
        if applied is not None:
            applied = arguments.numbers(applied, "relax: applied")
            if applied.shape != (3,):
                raise _cayspin.CayspinError(f"relax: applied of shape {applied.shape}; accepted: "
                                            "three numbers")
            applied = tuple(float(component) for component in applied)
        found = self._run.relax(arguments.real(torque, "relax: torque"),
                                arguments.whole(evaluations, "relax: evaluations"), applied,
                                arguments.flag(keep_saddles, "relax: keep_saddles"))
        return Minimum(*(getattr(found, field.name) for field in dataclasses.fields(Minimum)))

    def modes(self, count: int = 8, tolerance: float = 1e-9,
              evaluations: int = 100000) -> Modes:
        """The slowest normal modes about the spins, which have to be at rest: call relax() before.
        The spins move by the real part of shape e^((i frequency - decay) t), with frequency in
        radians. `tolerance` is the error of the shapes; frequencies are more accurate.
        """
        *numbers, shapes, converged, cost = self._run.modes(
            arguments.whole(count, "modes: count"), arguments.real(tolerance, "modes: tolerance"),
            arguments.whole(evaluations, "modes: evaluations"))
        parts = np.array(shapes).reshape((len(shapes), *self._run.spins().shape, 2))
        return Modes(*(np.array(each) for each in numbers), parts[..., 0] + 1j * parts[..., 1],
                     converged, cost)

    def set(self, keys: str | dict[str, Any], value: Any = None) -> None:
        """Goes on with other keys of the scene, from the spins, time and steps now:
        set("field.applied", [0.1, 0, 0]), set({"system.damping": 0.02, "integrator.dt": 0.01}),
        set({"integrator": {"method": "tsit5", "tolerance": 1e-6, "end": 50}}).

        They are changed as by a table [[stage]] of a scene, with the same rules: integrator.method
        begins a new [integrator], and its end or steps are counted from now. Where no integrator is
        among the keys, run() goes on for as long again as the scene did. Methods that remember
        earlier steps begin again. Numbers of sites may be arrays. Raises SceneError for keys that
        stay as they are, such as those of lattice, and for what cannot be; nothing is changed then.
        """
        changes = {arguments.word(keys, "set"): value} if isinstance(keys, str) else keys
        if not isinstance(changes, dict):
            raise _cayspin.CayspinError(f"set: a {type(changes).__name__}; accepted: a key and its "
                                        "value, or a dict of them")
        changes, arrays = self._scene._changes(changes)
        try:
            self._run.change(toml_text.overrides(changes), arrays)
        except _cayspin.SceneError as error:
            raise _cayspin.SceneError(str(error).removeprefix("--set ")) from None
        self._scene = self._scene._changed(self._run.scene, arrays)
        self._dt_is_checked = False

    def save(self, checkpoint: str | os.PathLike) -> None:
        """Stores all that Simulation(scene, restart=checkpoint) needs to go on with the same bits.
        A file of that name is replaced as a whole."""
        self._run.save(arguments.file_name(checkpoint, "save"))

    def _check_dt(self):
        if not self._dt_is_checked:
            warning = self._run.warning()
            self._dt_is_checked = True
            if warning:
                warnings.warn(warning, stacklevel=3)

    def _advance(self, end, guard_period, until_torque, recorder):
        run = self._run
        while run.steps < end:
            due = min([(run.steps // every + 1) * every for every, _ in self._observers] + [end])
            if recorder:
                due = min(due, recorder.next)
            at_rest = run.advance(due - run.steps, guard_period, until_torque)
            if recorder:
                recorder.look(at_rest)
            stop = [arguments.wants_stop(f(self)) for every, f in self._observers
                    if run.steps % every == 0]
            if at_rest or any(stop):
                return

    def observe(self, every: int, f: Callable[[Simulation], Any]) -> None:
        """Calls f(simulation) after each step whose number is a multiple of `every`. Where it
        returns True, the current step(n) or run() ends."""
        every = arguments.whole(every, "observe: every")
        if not callable(f):
            raise _cayspin.CayspinError(f"observe: a {type(f).__name__}; accepted: a function")
        if every < 1:
            raise _cayspin.CayspinError(f"observe: every {every} steps; accepted: at least 1")
        self._observers.append((every, f))

    def averages(self, every: int, window: int | None = None) -> Averages:
        """Running means of magnetizations and energies with their errors: looks after each step
        whose number is a multiple of `every`, from now on. With `window` they are over that many
        latest looks, otherwise over all since the last restart() of what is returned."""
        if window is not None:
            window = arguments.whole(window, "averages: window")
            if window < 1:
                raise _cayspin.CayspinError(f"averages: window {window}; accepted: at least 1")
        means = Averages(window)
        self.observe(every, means._look)
        return means

    @property
    def spins(self) -> np.ndarray:
        """The spins now, (nz, ny, nx, 3), of a crystal with several sites in a cell
        (site, nz, ny, nx, 3): a read-only view of the library's memory, no copy.

        A view never changes. When the simulation goes on while someone holds one, it moves to
        other memory. Assigning to `spins` sets them: any array that broadcasts to the shape,
        normalised. Methods that remember earlier steps begin again.
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
        """Draws the spins now into matplotlib axes, which it returns. Options are those of
        cayspin.texture.draw: plane="z=0", quantity="charge", colors="safe", before=other_spins.
        Raises CayspinError for other planes and words."""
        try:
            return texture.draw(self._texture(), axes, **options)
        except ValueError as error:
            raise _cayspin.CayspinError(f"plot: {error}") from None

    def _texture(self):
        scene, spins = self._scene, self.spins
        _, boundary, si = texture.lattice_of(scene.text)
        cell, places = scene.cell, None
        if spins.ndim == 5 or np.count_nonzero(cell - np.diag(np.diag(cell))):
            numbers = np.stack(np.meshgrid(*map(np.arange, spins.shape[-4:-1]), indexing="ij"), -1)
            places = np.stack([(numbers[..., ::-1] + site) @ cell for site in scene.basis])
            places = places.reshape(spins.shape)
        return texture.Texture(spins, np.diag(cell), boundary, places, si,
                               texture.time_text(self.time, si))

    def field(self) -> np.ndarray:
        """The effective field H of every site now, in the shape of the spins, read-only."""
        return sites.by_site(self._run.field(), self._scene._scene.cell_sites)

    def energy(self) -> float:
        """The energy, summed over sites; of rigid bodies that of their rotation."""
        return self._run.sample()[0]

    def energies(self) -> dict[str, float]:
        """The energy of each term of the scene: exchange, dmi, anisotropy, applied, slab_demag,
        demag, dipoles, nonlocal; of rigid bodies: rotation."""
        return self._run.energies()

    def magnetization(self) -> np.ndarray:
        """The mean spin, (3,)."""
        return np.array(self._run.sample()[2])

    def sublattice_magnetization(self) -> np.ndarray:
        """The mean spin of each site of the cell, (site, 3), where there are spins."""
        spins = self.spins
        spins = spins.reshape(-1, *spins.shape[-4:])
        count = spins.any(-1).sum((1, 2, 3))
        return spins.sum((1, 2, 3), np.float64) / np.maximum(count, 1)[:, None]

    def norm_defect(self) -> float:
        """The largest | |m| - 1 | of all sites."""
        return self._run.sample()[1]

    @property
    def time(self) -> float:
        """The time now: steps times dt."""
        return self._run.time

    @property
    def steps(self) -> int:
        """Steps taken."""
        return self._run.steps

    @property
    def evaluations(self) -> int:
        """Evaluations of the field of all sites so far."""
        return self._run.evaluations

    @property
    def step_seconds(self) -> float:
        """Seconds spent on stepping so far."""
        return self._run.step_seconds

    @property
    def scene(self) -> Scene:
        """The scene that runs."""
        return self._scene

    @property
    def precision(self) -> str:
        """"double" or "single"."""
        return self._run.precision

    @property
    def space(self) -> str:
        """The execution space."""
        return self._run.space

    @property
    def threads(self) -> int:
        """Threads of the space; 1 for a device."""
        return self._run.threads

    def __repr__(self):
        return (f"<cayspin.Simulation step {self.steps}, t = {self.time:g}, {self.precision}, "
                f"{self.space}>")
