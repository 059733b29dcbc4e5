# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Simulation of a scene that has an [ensemble] table."""

from __future__ import annotations

import dataclasses
import os
import warnings

import numpy as np

from cayspin import _cayspin, arguments, sites
from cayspin.equilibrium import Minimum
from cayspin.scene import Scene


class EnsembleSimulation:
    """The replicas of a `scene` with [ensemble], which run together. Each replica is bit-identical
    to a run of the scene with the values and seeds of that replica. On several threads, small
    replicas run at the same time.

        sim = cayspin.EnsembleSimulation(scene)
        sim.run()
        sim.spins  # (replica, nz, ny, nx, 3)

    `precision` is "double" or "single", `space` an execution space that was compiled in (default:
    that of Kokkos), `threads` the number of threads of the space; the first simulation of a process
    sets it for all later ones. `restart` names the file of an ensemble, from whose last frame or
    checkpoint the simulation continues. The file is refused if the method needs more than the spins
    to continue exactly, and there is no checkpoint.

    Ctrl-C stops the simulation between two steps with KeyboardInterrupt; some replicas may then be
    further than others. Lengths, times, fields and energies are in the units of the scene: reduced
    ones, or with units = "SI" m, s, T and J.

    Raises SceneError for a scene that cannot run here, CayspinError for other arguments, for a
    scene without [ensemble] and for a `restart` that does not fit.
    """

    def __init__(self, scene: Scene, precision: str = "double", space: str | None = None,
                 threads: int | None = None, restart: str | os.PathLike | None = None):
        if not isinstance(scene, Scene):
            raise _cayspin.CayspinError(
                f"EnsembleSimulation: a {type(scene).__name__}; accepted: a Scene")
        self._run = _cayspin.EnsembleRun(
            scene._scene, arguments.word(precision, "precision"),
            None if space is None else arguments.word(space, "space"),
            None if threads is None else arguments.whole(threads, "threads", 32))
        if restart is not None:
            file = arguments.file_name(restart, "restart")
            try:
                warning = self._run.continue_from(file)
            except RuntimeError as error:  # for a file that cannot be opened
                raise _cayspin.CayspinError(str(error)) from None
            if warning:
                warnings.warn(warning, stacklevel=2)
        self._scene = scene
        self._dt_is_checked = False

    def step(self, n: int = 1) -> None:
        """Takes `n` steps of dt in every replica. Replicas that run() has ended early go on, too,
        and catch up with the others. The first step warns if dt is too large for one of the
        replicas. After Ctrl-C some replicas may be further than `steps`; they wait for the others.

        Raises NumbersFailed when spins of a replica are not finite, leave the sphere or gain energy
        without a source, SceneError for a dt that integrator.refuse_unstable refuses, CayspinError
        without an integrator or beyond the last possible step.
        """
        n = arguments.whole(n, "step")
        self._require_integrator("step")
        self._advance(n, False)

    def run(self, until: float | None = None) -> None:
        """Steps to time `until`, in s in SI, or to the scene's end. A replica ends early when its
        torque falls below the scene's until_torque.

        Raises NumbersFailed and SceneError as step() does. Raises CayspinError for a time that has
        passed or is not a whole number of steps, and for a scene without end or integrator.
        """
        self._require_integrator("run")
        if until is None and self._scene.steps == 0:
            raise _cayspin.CayspinError("run: the scene has no end; accepted: run(until=t), or "
                                        "integrator.end in the scene")
        if until is not None:
            until = arguments.real(until, "run: until")
        end = self._run.last_step if until is None else self._run.step_at(until)
        if end < self.steps:
            passed = end * self._scene.dt if until is None else until
            raise _cayspin.CayspinError(f"run: until: t = {passed:g} has passed, the time is "
                                        f"{self.time:g}; accepted: a later time")
        self._advance(end - self.steps, True)

    def relax(self, torque: float = 1e-6, evaluations: int = 100000,
              keep_saddles: bool = False) -> list[Minimum]:
        """Moves each replica to a minimum of the energy, as Simulation.relax() does, and returns
        the result of each search. A search ends where max |m x H| is below `torque`, in the unit of
        H, T in SI, or after about `evaluations` evaluations of the field. With `keep_saddles` it
        may end at a saddle.

        Raises NumbersFailed for a field that is not finite, SceneError for rigid bodies,
        temperatures and torques of currents, CayspinError for other arguments.
        """
        found = self._run.relax(arguments.real(torque, "relax: torque"),
                                arguments.whole(evaluations, "relax: evaluations"),
                                arguments.flag(keep_saddles, "relax: keep_saddles"))
        return [Minimum(*(getattr(one, field.name) for field in dataclasses.fields(Minimum)))
                for one in found]

    def _require_integrator(self, name):
        if not self._scene._scene.has_integrator:
            raise _cayspin.CayspinError(f"{name}: the scene has no integrator; accepted: relax()")

    def _advance(self, count, until_torque):
        self._run.require_reachable(count)
        if not self._dt_is_checked:
            warning = self._run.warning()
            self._dt_is_checked = True
            if warning:
                warnings.warn(arguments.without_line(warning), stacklevel=3)
        self._run.advance(count, until_torque)

    @property
    def spins(self) -> np.ndarray:
        """A copy of the present spins, (replica, nz, ny, nx, 3), or for a crystal with several
        sites in a cell (replica, site, nz, ny, nx, 3)."""
        spins, cell_sites = self._run.spins(), self._scene._scene.cell_sites
        if cell_sites == 1:
            return np.array(spins)
        return np.stack([sites.by_site(replica, cell_sites) for replica in spins])

    def energy(self) -> np.ndarray:
        """The energy of each replica, (replica,), summed over its sites, in the scene's unit, J in
        SI."""
        return np.array(self._run.sample()[0])

    def magnetization(self) -> np.ndarray:
        """The mean spin of each replica, (replica, 3), weighted by the moments of the sites."""
        return np.array(self._run.sample()[2]).reshape(-1, 3)

    def norm_defect(self) -> np.ndarray:
        """The largest | |m| - 1 | of each replica, (replica,), dimensionless."""
        return np.array(self._run.sample()[1])

    @property
    def replicas(self) -> int:
        """The number of replicas."""
        return self._run.replicas

    @property
    def time(self) -> float:
        """The time that the replicas have reached, in the scene's unit, s in SI."""
        return self._run.time

    @property
    def steps(self) -> int:
        """Steps of dt since the time 0 that all replicas have taken. Those that ended early do not
        count, unless all have: then this is the largest number of steps."""
        return self._run.steps

    @property
    def evaluations(self) -> int:
        """Evaluations so far of the field of all sites of a replica, summed over the replicas."""
        return self._run.evaluations

    @property
    def step_seconds(self) -> float:
        """Seconds of stepping so far. For replicas that run at the same time on several threads,
        the sum of their times."""
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
        """The execution space, such as "openmp"."""
        return self._run.space

    @property
    def threads(self) -> int:
        """The number of threads of the space, which is 1 for a device."""
        return self._run.threads

    def __repr__(self):
        return (f"<cayspin.EnsembleSimulation of {self.replicas}, step {self.steps}, "
                f"t = {self.time:g}, {self.precision}, {self.space}>")
