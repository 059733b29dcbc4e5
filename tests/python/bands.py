# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Spin waves and curvatures from Python, and files of modes read back."""

import os
import signal
import threading
import unittest

import cayspin
import h5py
import numpy as np
from package_test import PackageTest
from spectra_test import ANISOTROPY, DAMPING, EXCHANGE, chain

WAVES = np.linspace([0, 0, 0], [0.5, 0, 0], 9)
SHORT = {"lattice": {"shape": [6], "boundary": "periodic"}}


def simulation(**tables):
    return cayspin.Simulation(chain(**{**SHORT, **tables}))


class OfWaves(PackageTest):
    def test_a_chain(self):
        for precision, bound in (("double", 1e-12), ("single", 1e-5)):
            sim = cayspin.Simulation(chain(**SHORT), precision)
            before = sim.evaluations
            bands = sim.bands(WAVES)
            exact = ANISOTROPY + 2 * EXCHANGE * (1 - np.cos(2 * np.pi * WAVES[:, :1]))
            np.testing.assert_array_equal(bands.wave_vector, WAVES)
            np.testing.assert_allclose(bands.frequency, exact, rtol=bound)
            np.testing.assert_allclose(bands.decay, DAMPING * exact, rtol=bound)
            self.assertEqual(sim.evaluations - before, bands.evaluations)
            self.assertIsNone(bands.spins)
            self.assertEqual(sim.bands([[0, 0, 0], [1 / 3, 0, 0]]).frequency.shape, (2, 1))

    # The field of the present time counts.
    def test_a_field_in_time(self):
        sim = simulation(field={"applied": [0, 0, "0.5 + t"]})
        sim.step(4)
        np.testing.assert_allclose(sim.bands([[0, 0, 0]]).frequency, [[0.5 + sim.time]], rtol=1e-12)

    def test_the_bands_of_the_program(self):
        made = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1},
            lattice={"shape": [4, 3], "crystal": "honeycomb", "boundary": "periodic"},
            field={"couplings": {"shells": [-1.0]}, "applied": [0, 0, 0.1],
                   "anisotropy": {"constant": 0.2, "axis": [0, 0, 1]}},
            initial={"expression": ["0", "0", "1 - 2*s"]})
        file = self.run_program(made, "--at-rest", "--wave-vector", "0,0,0", "--wave-vector",
                                "0.4,0.2,0", "--points", "4", command="modes")
        found = cayspin.Simulation(made).bands(file["wave_vector"])
        np.testing.assert_array_equal(found.frequency, file["frequency"])
        np.testing.assert_array_equal(found.decay, file["decay"])
        self.assertEqual(found.frequency.shape, (5, 2))
        read = cayspin.read_modes(file.filename)
        self.assertIsInstance(read, cayspin.Bands)
        for name in ("wave_vector", "frequency", "decay"):
            np.testing.assert_array_equal(getattr(read, name), getattr(found, name))
        np.testing.assert_array_equal(read.spins, cayspin.Simulation(made).spins)
        self.assertEqual(read.evaluations, file.attrs["evaluations"])

    def test_refusals(self):
        error, sim = cayspin.CayspinError, simulation()
        accepted = "; accepted: finite numbers (wave, 3)"
        self.assert_all_refused(error, {
            "bands: wave_vectors of shape (3,)" + accepted: lambda: sim.bands([0, 0, 0]),
            "bands: wave_vectors of shape (1, 2)" + accepted: lambda: sim.bands([[0, 0]]),
            "bands: wave_vectors of shape (0, 3)" + accepted: lambda: sim.bands(np.empty((0, 3))),
            "bands: wave_vectors of shape (2, 3)" + accepted:
                lambda: sim.bands([[0, 0, 0], [np.nan, 0, 0]]),
            "bands: wave_vectors: an array of": lambda: sim.bands([["a", "b", "c"]]),
            "bands: wave_vectors: 0.1 along x, and the field of dipoles reaches around the "
            "lattice; accepted: multiples of 1/6 there":
                lambda: simulation(field={"dipoles": True}).bands([[0.1, 0, 0]]),
            "bands: wave_vectors: it has a component along y, which is open; accepted: 0 there":
                lambda: simulation(lattice={"shape": [6, 6], "boundary": ["periodic", "open"]})
                .bands([[0, 0.1, 0]])})
        frozen = simulation(lattice={**SHORT["lattice"], "frozen": "i < 1"})
        self.assert_refused(error, "bands: wave_vectors: the cells differ", frozen.bands, WAVES)
        self.assert_all_refused(cayspin.SceneError, {
            "lattice.boundary": lambda: simulation(lattice={"shape": [6]}).bands(WAVES),
            "torque": lambda: simulation(torque={"slonczewski": {
                "damping_like": 0.1, "polarization": [0, 0, 1]}}).bands(WAVES),
            "has 1600 sites in a cell, which extends over the open axes; accepted for bands: at":
                lambda: simulation(lattice={"shape": [3, 40, 40], "boundary": [
                    "periodic", "open", "open"]}).bands(WAVES)})

    def test_an_interrupt(self):
        sim = simulation(lattice={"shape": [3, 30], "boundary": ["periodic", "open"]})
        threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                sim.bands(np.zeros((1000, 3)))


class OfModes(PackageTest):
    # At +x, E = -(m.z)^2 / 2 - 0.2 m.x of each spin has the curvatures 0.2 - 1 and 0.2.
    def test_curvatures(self):
        field = {"exchange": 5.0, "applied": [0.2, 0, 0],
                 "anisotropy": {"constant": 1.0, "axis": [0, 0, 1]}}
        made = chain(lattice={"shape": [3]}, field=field, initial={"uniform": [1, 0, 0]})
        sim = cayspin.Simulation(made)
        self.assertIsNone(sim.modes(2).curvature)
        self.assertIsNone(sim.modes(2).negative_curvatures)
        modes = sim.modes(2, hessian=True)
        np.testing.assert_allclose(modes.curvature, [-0.8, 0.2], rtol=1e-12)
        self.assertTrue((modes.curvature_error > 0).all())
        self.assertLess(modes.curvature_error.max(), 1e-8)
        self.assertEqual(modes.negative_curvatures, 1)
        self.assertTrue(modes.converged)
        self.assertEqual(modes.curvature_vector.shape, (2, 1, 1, 3, 3))
        np.testing.assert_allclose(np.abs(modes.curvature_vector[0]),
                                   np.tile([0.0, 0, 1], (1, 1, 3, 1)), atol=1e-8)
        sim.relax()
        self.assertEqual(sim.modes(2, hessian=True).negative_curvatures, 0)
        file = self.run_program(made, "--count", "2", "--hessian", "--at-rest", command="modes")
        for name in ("curvature", "curvature_error", "curvature_residual", "curvature_vector"):
            np.testing.assert_array_equal(getattr(modes, name), file[name], name)
        pushed = simulation(torque={"slonczewski": {"damping_like": 0.1,
                                                    "polarization": [0, 0, 1]}})
        self.assert_refused(cayspin.CayspinError, "modes: hessian: under the torque of a current",
                            pushed.modes, hessian=True)
        self.assert_refused(cayspin.CayspinError, "modes: hessian: 2; accepted: True or False",
                            sim.modes, hessian=2)

    def test_files(self):
        made = chain(lattice={"shape": [4], "boundary": "periodic", "moments": [1.0, 0.4],
                              "basis": [[0, 0, 0], [0.5, 0, 0]]},
                     field={"anisotropy": {"constant": 1.0, "axis": [0, 0, 1]},
                            "couplings": [{"between": [0, 1], "offset": [0, 0, 0], "J": 1.0}]})
        options = ("--count", "3", "--hessian", "--at-rest")
        file = self.run_program(made, *options, command="modes")
        read, found = cayspin.read_modes(file.filename), cayspin.Simulation(made).modes(
            3, hessian=True)
        self.assertIsInstance(read, cayspin.Modes)
        for name in ("frequency", "decay", "residual", "shape", "moments", "curvature",
                     "curvature_error", "curvature_residual", "curvature_vector"):
            np.testing.assert_array_equal(getattr(read, name), getattr(found, name), name)
        self.assertEqual(read.spins.shape, (2, 1, 1, 4, 3))
        self.assertEqual((read.time_unit, read.energy_unit, read.under_current, read.converged),
                         (1.0, None, False, True))
        self.assertEqual(read.negative_curvatures, 0)
        for moments in (2, [[[[3.0]]], [[[4.0]]]]):
            given = cayspin.read_modes(file.filename, moments).moments
            np.testing.assert_array_equal(given, np.broadcast_to(moments, (2, 1, 1, 4)))
        self.assert_refused(cayspin.CayspinError, "read_modes: moments of shape (3,); accepted: "
                            "one that broadcasts to (2, 1, 1, 4)", cayspin.read_modes,
                            file.filename, [1, 2, 3])
        w = np.linspace(-3, 3, 31)
        of_file = cayspin.linear_structure_factor(file.filename, 0.1, w)
        of_read = cayspin.linear_structure_factor(read, 0.1, w, cell=made.cell,
                                                  positions=made.basis)
        np.testing.assert_array_equal(of_read.intensity["xx"], of_file.intensity["xx"])

    # A torque of strength 0 counts as none, as in Simulation.modes().
    def test_files_with_torques(self):
        for damping_like, expected in ((0.0, False), (1e-3, True)):
            made = chain(**SHORT, torque={"slonczewski": {"damping_like": damping_like,
                                                          "polarization": [0, 0, 1]}})
            file = self.run_program(made, "--count", "1", command="modes")
            self.assertIs(cayspin.read_modes(file.filename).under_current, expected)
            self.assertIs(cayspin.Simulation(made).modes(1).under_current, expected)

    def test_damaged_files(self):
        file = self.run_program(chain(**SHORT), "--count", "1", command="modes")
        name = file.filename
        file.close()
        with h5py.File(name, "r+") as damaged:
            del damaged["decay"]
        for call in (lambda: cayspin.read_modes(name),
                     lambda: cayspin.linear_structure_factor(name, 0.1, [0.0, 1.0])):
            self.assert_refused(cayspin.CayspinError, "cannot be read: ", call)

    # The moments of the scene are those of its six sites.
    def test_files_with_spins_of_another_shape(self):
        file = self.run_program(chain(lattice={**SHORT["lattice"], "moments": "1 + x"}), "--count",
                                "1", command="modes")
        name, spins = file.filename, file["spins"][:]
        file.close()
        with h5py.File(name, "r+") as damaged:
            del damaged["spins"]
            damaged["spins"] = spins[..., :5, :]
        for call in (lambda: cayspin.read_modes(name),
                     lambda: cayspin.linear_structure_factor(name, 0.1, [0.0, 1.0])):
            self.assert_refused(cayspin.CayspinError, "spins of shape (1, 1, 5, 3) and modes of "
                                "shape (1, 1, 1, 6, 3); accepted: ", call)
        with h5py.File(name, "r+") as damaged:
            modes = damaged["mode"][:]
            del damaged["mode"]
            damaged["mode"] = modes[..., :5, :, :]
        self.assert_refused(cayspin.CayspinError, "read_modes: moments of shape (1, 1, 6); "
                            "accepted: one that broadcasts to (1, 1, 5)", cayspin.read_modes, name)

    def test_other_files(self):
        run = self.run_program(chain(**SHORT), "--set", "integrator.steps=1")
        self.assert_refused(cayspin.CayspinError, "no modes; accepted: a file of cayspin modes",
                            cayspin.read_modes, run.filename)
        self.assert_refused(cayspin.CayspinError, "cannot be opened", cayspin.read_modes,
                            self.folder / "none.h5")
        modes = self.run_program(chain(**SHORT), "--count", "1", command="modes")
        self.assert_refused(cayspin.CayspinError, "a file of modes; accepted: the file of a run, "
                            "or read_modes() for this file", cayspin.open, modes.filename)


if __name__ == "__main__":
    unittest.main()
