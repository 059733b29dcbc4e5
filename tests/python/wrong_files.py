# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Wrong and damaged files, and wrong options of pictures: each raises CayspinError with one line."""

import fcntl
import importlib.util
import math
import os
import pathlib
import subprocess
import sys
import unittest
import unittest.mock

import cayspin
import h5py
import matplotlib
import matplotlib.pyplot
import numpy as np
from package_test import PackageTest, scene

matplotlib.use("Agg")

FILM = {"lattice": {"shape": [4, 3], "spacing": None, "boundary": None},
        "field": {"slab_demag": None}, "output": {"every": 10}}
FRAME = (1, 3, 4, 3)


class FilesTest(PackageTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(matplotlib.pyplot.close, "all")

    def run_of(self, name="run.h5"):
        file = self.folder / name
        cayspin.Simulation(scene(**FILM)).run(output=file)
        return file

    def ensemble(self):
        file = self.run_program(scene(**FILM, ensemble={"replicas": 2}))
        self.addCleanup(file.close)
        return cayspin.open(file.filename)


class WrongFiles(FilesTest):
    def damaged(self, file, dataset):
        """Returns a copy of a file with a flipped bit in the header of a dataset."""
        with h5py.File(file) as open_file:
            place = h5py.h5o.get_info(open_file[dataset].id).addr
        content = bytearray(file.read_bytes())
        self.assertEqual(content[place:place + 4], b"OHDR")
        content[place + 12] ^= 4
        copy = file.with_name(f"damaged_{file.name}")
        copy.write_bytes(content)
        return copy

    def test_headers_with_a_flipped_bit(self):
        file = self.run_of()
        with cayspin.open(file) as run:
            self.assertEqual(len(run), 5)
        for dataset in ("spins", "time", "scalars/energy"):
            self.assert_refused(cayspin.CayspinError, "cannot be read: ", cayspin.open,
                                self.damaged(file, dataset))
        with self.ensemble() as ensemble:
            self.assertEqual(len(ensemble), 5)
        self.assert_refused(cayspin.CayspinError, "cannot be read: ", cayspin.open,
                            self.damaged(type(file)(ensemble.path), "energy"))

    def test_spins_with_another_checksum(self):
        file = self.run_of()
        with h5py.File(file, "r+") as changed:
            changed["spins"][3, 0, 1, 2] = [0, 0, 1]
        with cayspin.open(file) as run:
            self.assertEqual(run.spins.shape, (5, *FRAME))
            path = [[0, 0, 0], [0.5, 0, 0]]
            for call in (run.topological_charge, lambda: run.dispersion(path),
                         run.structure_factor, lambda: run.plot(3)):
                self.assert_refused(cayspin.CayspinError, "frame 3 is damaged", call)
            run.plot(2)

    def test_files_without_what_a_run_writes(self):
        def written(name, **attributes):
            file = h5py.File(self.folder / name, "w")
            self.addCleanup(file.close)
            file.attrs.update(attributes)
            return file

        with written("attribute.h5", ensemble_format=1) as file:
            pass
        self.assert_refused(cayspin.CayspinError, "not an ensemble: it has no spins", cayspin.open,
                            self.folder / "attribute.h5")
        names = ("spins", "time", "step", "energy", "norm_defect", "magnetization")
        for part, add in {
                "not a trajectory: it has no spins": lambda file, name: file.create_group(name),
                "not a trajectory: it has no scalars":
                    lambda file, name: file.create_dataset(name, (3, 1, 3, 4, 3)),
        }.items():
            with written("others.h5") as file:
                for name in names:
                    add(file, name)
            self.assert_refused(cayspin.CayspinError, part, cayspin.open, self.folder / "others.h5")

    def test_a_file_without_frames(self):
        file = self.run_of()
        with h5py.File(file, "r+") as changed:
            for name in ("spins", "time", "step", "energy", "norm_defect", "magnetization"):
                changed[name].resize(0, axis=0)
        with cayspin.open(file) as run:
            self.assertEqual(run.topological_charge().shape, (0, 1))
            self.assert_refused(cayspin.CayspinError, "a file that holds frames", run.plot)

    def test_a_frame_that_a_kill_left_unfinished_does_not_count(self):
        for name in ("energy", "magnetization", "checksum"):
            file = self.run_of(f"{name}.h5")
            with h5py.File(file, "r+") as killed:
                killed[name].resize(4, axis=0)
            with cayspin.open(file) as run:
                self.assertEqual(len(run), 4)
                self.assertEqual(run.plot().get_title(loc="left"), "frame 3, t = 1.5")
                self.assert_refused(cayspin.CayspinError, "frame 4; accepted: -4 to 3", run.plot, 4)
        script = pathlib.Path(__file__).resolve().parents[2] / "python/plot_texture.py"
        plot = subprocess.run([sys.executable, "-B", script, self.folder / "energy.h5"], text=True,
                              capture_output=True)
        self.assertEqual((plot.returncode, plot.stderr), (0, ""))

    def test_closed_files(self):
        file = self.run_of()
        run, ensemble = cayspin.open(file), self.ensemble()
        run.close()
        ensemble.close()
        to_xarray = [run.to_xarray] if importlib.util.find_spec("xarray") else []
        for call in (run.plot, run.topological_charge, run.structure_factor, lambda: run.spins,
                     lambda: len(run), lambda: run.scene, ensemble.plot, lambda: ensemble.spins,
                     ensemble.structure_factor, lambda: ensemble.complete, *to_xarray):
            self.assert_refused(cayspin.CayspinError, "the file is closed", call)
        self.assertEqual(repr(run), f"<cayspin.Trajectory {file}: closed>")

    def test_an_open_file_is_not_replaced(self):
        file = self.run_of()
        sim = cayspin.Simulation(scene(**FILM))
        with cayspin.open(file) as run:
            self.assert_refused(cayspin.CayspinError, "this program or another one has it open; "
                                "accepted: a closed file", sim.run, output=file, overwrite=True)
            self.assertEqual((sim.steps, len(run.spins[:])), (0, len(run)))
        sim.run(output=file, overwrite=True)

    def test_a_file_that_is_being_written(self):
        ensemble = self.run_program(scene(**FILM, ensemble={"replicas": 2}))
        of_ensemble = ensemble.filename
        ensemble.close()
        for file in (self.run_of(), of_ensemble):
            with open(file, "rb") as written:
                fcntl.flock(written, fcntl.LOCK_EX | fcntl.LOCK_NB)
                self.assert_refused(cayspin.CayspinError, f"{file}: a program is writing it; "
                                    "accepted: the file of a run that has ended", cayspin.open, file)
            cayspin.open(file).close()

    def test_restarts_of_ensembles(self):
        of = scene(**FILM, ensemble={"replicas": 2})
        text = self.folder / "text.h5"
        text.write_text("no run", encoding="utf-8")
        for wrong in (self.folder / "none.h5", text, self.folder):
            self.assert_refused(cayspin.CayspinError, f"{wrong}: cannot open the file",
                                cayspin.EnsembleSimulation, of, restart=wrong)

    def test_spins_of_ensembles_are_copies(self):
        crystal = {"crystal": "honeycomb", "shape": [4, 3]}
        for lattice in (FILM["lattice"], {**FILM["lattice"], **crystal}):
            sim = cayspin.EnsembleSimulation(scene(
                field={"slab_demag": None, "exchange": None}, lattice=lattice,
                ensemble={"replicas": 2}))
            spins = sim.spins
            before = spins.copy()
            spins[...] = 0
            np.testing.assert_array_equal(sim.spins, before)

    def test_frames_that_are_no_slice(self):
        with cayspin.open(self.run_of()) as run:
            for call in (run.structure_factor, lambda frames: run.dispersion(
                    [[0, 0, 0], [0.5, 0, 0]], frames)):
                self.assert_refused(cayspin.CayspinError, "accepted: a slice", call,
                                    np.zeros((3, 3)))

    def test_empty_names(self):
        sim, spins = cayspin.Simulation(scene(**FILM)), np.ones(FRAME)
        self.assert_all_refused(cayspin.CayspinError, {
            "path: start: an empty name": lambda: cayspin.path(scene(**FILM), "", spins),
            "path: end: an empty name": lambda: cayspin.path(scene(**FILM), spins, ""),
            "run: output: an empty name": lambda: sim.run(output=""),
            "save: an empty name": lambda: sim.save(""),
            "restart: an empty name": lambda: cayspin.Simulation(scene(**FILM), restart=""),
            "from_file: an empty name": lambda: cayspin.Scene.from_file(""),
            "open: an empty name": lambda: cayspin.open("")})
        self.assertEqual(sim.steps, 0)


class WrongOptions(FilesTest):
    def test_of_pictures(self):
        sim, run, ensemble = cayspin.Simulation(scene(**FILM)), cayspin.open(self.run_of()), self.ensemble()
        self.addCleanup(run.close)
        self.addCleanup(ensemble.close)
        for of in (sim, run, ensemble):
            self.assert_refused(cayspin.CayspinError, "plot: no option foo; accepted: ", of.plot,
                                foo=1)
            for limit in ({}, 1j, math.inf, np.complex64(1)):
                self.assert_refused(cayspin.CayspinError, f"limit {limit!r}; accepted: a finite",
                                    of.plot, quantity="charge", limit=limit)
        for of in (sim, ensemble):
            self.assert_refused(cayspin.CayspinError, "before: rows of different lengths; accepted",
                                of.plot, before=[[1], [1, 2]])
        self.assert_refused(cayspin.CayspinError, "no option before; accepted: difference_to, ",
                            run.plot, before=np.zeros(FRAME))

    def test_an_ensemble_draws_the_difference_to_other_spins(self):
        with self.ensemble() as ensemble:
            axes = ensemble.plot(1, 2, before=ensemble.spins[0, 1])
            expected = np.linalg.norm(ensemble.spins[2, 1] - ensemble.spins[0, 1], axis=-1)[0]
        np.testing.assert_allclose(axes.images[0].get_array(), expected, rtol=1e-12)


class WrongPrograms(PackageTest):
    def test_another_program(self):
        with unittest.mock.patch.dict(os.environ, {"CAYSPIN_PROGRAM": "/bin/true"}):
            for call in (cayspin.advise, cayspin.trade):
                self.assert_refused(cayspin.CayspinError, "/bin/true printed no result", call,
                                    scene(**FILM), 0.1)

    def test_the_command_of_the_package_without_a_program(self):
        missing = str(self.folder / "none")
        done = subprocess.run([sys.executable, "-m", "cayspin", "methods"], text=True, check=False,
                              env={**os.environ, "CAYSPIN_PROGRAM": missing}, capture_output=True)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertEqual(done.stderr, f"cayspin: the program {missing} does not run: No such file "
                         "or directory; accepted: one on the PATH, or its file in "
                         "CAYSPIN_PROGRAM\n")


if __name__ == "__main__":
    unittest.main()
