# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Structure factors of normal modes, compared with the inverse Hessian and with linear theory."""

import dataclasses
import unittest

import cayspin
import h5py
import numpy as np
from package_test import PackageTest, scene
from spectra_test import ANISOTROPY, EXCHANGE, SITES, chain, magnons, modes_of

BOLTZMANN, MU_B, GAMMA = 1.380649e-23, 9.2740100657e-24, 1.760859e11


class OfModes(PackageTest):
    FREQUENCY = np.linspace(-12, 12, 4801)

    def ellipses(self, damping):
        """Returns the modes and the spins of a chain that is stiffer by 0.5 along x."""
        return modes_of(chain(
            system={"kind": "llg", "damping": damping},
            field={"exchange": 1.0, "anisotropy": [{"constant": 1.0, "axis": [0, 0, 1]},
                                                   {"constant": -0.5, "axis": [1, 0, 0]}]}))

    def test_inverse_of_the_hessian(self):
        modes, spins = self.ellipses(0.0)
        found = cayspin.linear_structure_factor(modes, 0.3, self.FREQUENCY, spins=spins, width=0.1,
                                                components=("xx", "yy", "zz", "total"))
        stiffness = magnons(found)
        x, y = found.integrated["xx"][0, 0], found.integrated["yy"][0, 0]
        np.testing.assert_allclose(x, 0.3 / (stiffness + 0.5), rtol=1e-8)
        np.testing.assert_allclose(y, 0.3 / stiffness, rtol=1e-8)
        self.assertLess(found.integrated["zz"].max(), 1e-12)
        np.testing.assert_allclose(found.integrated["total"][0, 0], x + y, rtol=1e-12)
        w = np.sqrt(stiffness * (stiffness + 0.5))
        u = self.FREQUENCY
        lines = [0.1 / np.pi / ((u - sign * w[:, None])**2 + 0.01) / 2 for sign in (1, -1)]
        np.testing.assert_allclose(found.intensity["yy"][0, 0], y[:, None] * sum(lines), rtol=1e-6)

    def test_damped_ellipses(self):
        modes, spins = self.ellipses(0.1)
        found = cayspin.linear_structure_factor(modes, 0.3, self.FREQUENCY, spins=spins)
        exact = 0.3 / magnons(found)
        off = np.abs(found.integrated["yy"][0, 0] / exact - 1).max()
        self.assertAlmostEqual(off, 4.2e-4, delta=0.2e-4)

    def test_directions_of_waves(self):
        # For right-handed waves exp(i (k.r - w t)), this D raises the frequency by 0.8 sin(k).
        modes, spins = modes_of(chain(
            lattice={"shape": [12], "boundary": "periodic"},
            system={"kind": "llg", "damping": 0.0},
            field={"anisotropy": {"constant": 1.0, "axis": [0, 0, 1]},
                   "couplings": [{"between": [0, 0], "offset": [1, 0, 0], "J": 1.0,
                                  "D": [0, 0, 0.4]}]}))
        found = cayspin.linear_structure_factor(modes, 0.3, self.FREQUENCY, spins=spins,
                                                width=0.02, components=("xx", "yy", "xy"))
        right = (found.intensity["xx"] + found.intensity["yy"]
                 - 2 * found.intensity["xy"].imag)[0, 0]
        k = 2 * np.pi * found.wave_vectors[0, 0, :, 0]
        expected = magnons(found) + 0.8 * np.sin(k)
        peaks = self.FREQUENCY[right.argmax(1)]
        self.assertLess(np.abs(peaks - expected).max(), 0.006)
        start = 0.01 * np.random.default_rng(1).standard_normal((1, 1, 12, 3)) + [0, 0, 1]
        sim = cayspin.Simulation(chain(
            lattice={"shape": [12], "boundary": "periodic"}, initial=start,
            system={"kind": "llg", "damping": 0.0},
            field={"anisotropy": {"constant": 1.0, "axis": [0, 0, 1]},
                   "couplings": [{"between": [0, 0], "offset": [1, 0, 0], "J": 1.0,
                                  "D": [0, 0, 0.4]}]},
            integrator={"method": "rkmk4", "dt": 0.05}))
        frames = []
        for _ in range(400):
            frames.append(sim.spins.copy())
            sim.step(5)
        run = cayspin.structure_factor(np.stack(frames), 0.25, components=("xx", "yy", "xy"))
        right = (run.intensity["xx"] + run.intensity["yy"] - 2 * run.intensity["xy"].imag)[0, 0]
        peaks = run.frequency[right.argmax(1)]
        self.assertLess(np.abs(peaks - expected).max(), run.frequency[1] - run.frequency[0])

    def test_antiferromagnet(self):
        made = chain(
            lattice={"shape": [6], "boundary": "periodic", "basis": [[0, 0, 0], [0.5, 0, 0]]},
            system={"kind": "llg", "damping": 0.0},
            field={"anisotropy": {"constant": 0.5, "axis": [0, 0, 1]},
                   "couplings": [{"between": [0, 1], "offset": [0, 0, 0], "J": -1.0},
                                 {"between": [1, 0], "offset": [1, 0, 0], "J": -1.0}]},
            initial={"expression": ["0", "0", "1 - 2*s"]})
        modes, spins = modes_of(made)
        found = cayspin.linear_structure_factor(
            modes, 0.3, self.FREQUENCY, spins=spins, width=0.02, positions=made.basis,
            zones=(2, 1, 1))
        k = np.pi * found.wave_vectors[0, 0, :, 0]
        for word in ("xx", "yy"):
            np.testing.assert_allclose(found.integrated[word][0, 0],
                                       0.3 / (2 * (1 + np.cos(k)) + 0.5), rtol=1e-8)
        peaks = np.abs(self.FREQUENCY[found.intensity["xx"][0, 0].argmax(1)])
        expected = np.sqrt(2.5**2 - 4 * np.cos(k)**2)
        self.assertLess(np.abs(peaks - expected).max(), 0.006)

    def test_moments_of_a_crystal(self):
        # The energy, and hence the integrated intensity, does not depend on the moments; the rates
        # do.
        for moments, ratios in (([1.0, 0.4], [1.0, 1.0]), ([1.0, 0.4], [1.0, 1.7])):
            made = chain(
                lattice={"shape": [6], "boundary": "periodic", "moments": moments,
                         "gyromagnetic": ratios, "basis": [[0, 0, 0], [0.5, 0, 0]]},
                system={"kind": "llg", "damping": 0.0},
                field={"anisotropy": {"constant": 1.0, "axis": [0, 0, 1]},
                       "couplings": [
                           {"between": [0, 1], "offset": [0, 0, 0], "J": 1.0},
                           {"between": [1, 0], "offset": [1, 0, 0], "J": 1.0}]})
            modes, spins = modes_of(made)
            weights = np.divide(moments, ratios)[:, None, None, None]
            np.testing.assert_allclose(modes.moments, np.broadcast_to(weights, (2, 1, 1, 6)),
                                       rtol=1e-14)
            file = self.run_program(made, "--count", "12", command="modes").filename
            for given in (None, weights):
                found = cayspin.linear_structure_factor(
                    modes, 0.3, self.FREQUENCY, spins=spins, width=0.1, moments=given,
                    positions=made.basis, zones=(2, 1, 1))
                k = np.pi * found.wave_vectors[0, 0, :, 0]
                np.testing.assert_allclose(found.integrated["xx"][0, 0],
                                           0.3 / (2 * (1 - np.cos(k)) + 1), rtol=1e-8)
                read = cayspin.linear_structure_factor(
                    file, 0.3, self.FREQUENCY, width=0.1, moments=given, zones=(2, 1, 1))
                np.testing.assert_allclose(read.integrated["xx"], found.integrated["xx"],
                                           rtol=1e-8)

    def test_moments_of_a_crystal_in_si(self):
        joule, kelvin, w = 1e-21, 5.0, np.linspace(-9e14, 9e14, 3)
        typed = np.array([2.0, 0.8])[:, None, None, None] * MU_B
        stored = self.folder / "moments.h5"
        with h5py.File(stored, "w") as file:
            file["values"] = np.broadcast_to(typed, (2, 1, 1, 6))
        options = {"width": 1e12, "zones": (2, 1, 1)}
        for mu_s in ({"bohr_magnetons": [2.0, 0.8]}, {"regions": [2 * MU_B, 0.8 * MU_B]},
                     f"{MU_B!r}*(2 - 1.2*s)", {"file": str(stored)}):
            with self.subTest(mu_s=mu_s):
                made = cayspin.Scene(
                    units="SI", system={"kind": "llg"},
                    material={"mu_s": mu_s, "alpha": 0, "K": 0.3 * joule, "axis": [0, 0, 1]},
                    lattice={"shape": [6], "spacing": 3e-10, "boundary": "periodic",
                             "basis": [[0, 0, 0], [0.5, 0, 0]], "regions": "s"},
                    field={"couplings": [
                        {"between": [0, 1], "offset": [0, 0, 0], "J": joule},
                        {"between": [1, 0], "offset": [1, 0, 0], "J": joule}]},
                    initial={"uniform": [0, 0, 1]})
                modes, spins = modes_of(made)
                np.testing.assert_allclose(
                    modes.moments, np.broadcast_to(typed / GAMMA, (2, 1, 1, 6)), rtol=1e-12)
                file = self.run_program(made, "--count", "12", command="modes").filename
                for given in (None, typed / GAMMA):
                    for found in (
                            cayspin.linear_structure_factor(
                                modes, kelvin, w, spins=spins, moments=given, cell=made.cell,
                                positions=made.basis, **options),
                            cayspin.linear_structure_factor(
                                file, kelvin, w, moments=given, **options)):
                        k = np.pi * found.wave_vectors[0, 0, :, 0]
                        stiffness = 2 * joule * (1 - np.cos(k)) + 0.6 * joule
                        np.testing.assert_allclose(found.integrated["xx"][0, 0],
                                                   BOLTZMANN * kelvin / stiffness, rtol=1e-8)
        stored.unlink()
        self.assert_refused(cayspin.CayspinError, "material.mu_s of its scene cannot be read",
                            cayspin.linear_structure_factor, file, kelvin, w)

    def test_wrong_calls(self):
        modes, spins = modes_of(chain())
        call = cayspin.linear_structure_factor
        w = self.FREQUENCY
        tipped = cayspin.Simulation(chain(
            system={"kind": "llg", "damping": 0.0},
            field={"exchange": 0.01, "applied": [0, 0, -0.3]}))
        over = cayspin.Simulation(chain(system={"kind": "llg", "damping": 0.1,
                                                "precession": False}))
        saddle, still = tipped.modes(2), over.modes(2)
        bands = self.run_program(chain(), "--wave-vector", "0,0,0", "--wave-vector", "0.5,0,0",
                                 command="modes").filename
        closed = self.run_program(chain(), "--count", "2", command="modes")
        turned = closed.filename
        closed.close()
        with h5py.File(turned, "r+") as file:
            file.attrs["scene"] += "\n[torque]\nslonczewski = {}\n"
        closed = self.run_program(chain(), "--count", "2", command="modes")
        early = closed.filename
        closed.close()
        with h5py.File(early, "r+") as file:
            file.attrs["converged"] = 0
        under_current = cayspin.Simulation(chain(lattice={"shape": [4]}, torque={
            "slonczewski": {"damping_like": 0.01, "polarization": [0, 0, 1]}}))
        pushed, rest = under_current.modes(4), under_current.spins
        short = dataclasses.replace(modes, converged=False)
        run = self.run_program(scene(output={"every": 20})).filename
        text = self.folder / "text.h5"
        text.write_text("no HDF5")
        for part, arguments, options in (
                ("temperature -1", (modes, -1, w), {}),
                ("width nan", (modes, 1, w), {"width": np.nan}),
                ("rising numbers", (modes, 1, w[::-1]), {}),
                ("Modes without spins", (modes, 1, w), {"spins": None}),
                ("a list; accepted: Modes", ([1], 1, w), {}),
                ("and modes of shape", (modes, 1, w), {"spins": spins[:, :, 1:]}),
                ("moments of shape (3,)", (modes, 1, w), {"moments": np.ones(3)}),
                ("component 'w'", (modes, 1, w), {"components": "w"}),
                ("mode 0 lowers the energy", (saddle, 1, w), {}),
                ("mode 0 does not oscillate", (still, 1, w), {}),
                ("bands have no shapes", (bands, 1, w), {"spins": None}),
                ("has a torque", (turned, 1, w), {"spins": None}),
                ("has a torque", (pushed, 1, w), {"spins": rest}),
                ("did not converge", (early, 1, w), {"spins": None}),
                ("did not converge", (short, 1, w), {}),
                ("no modes; accepted", (run, 1, w), {"spins": None}),
                ("cannot be opened", (text, 1, w), {"spins": None}),
                ("beside a file", (bands, 1, w), {})):
            self.assert_refused(cayspin.CayspinError, part, call, *arguments,
                                **{"spins": spins, **options})
        undamped, spins = modes_of(chain(system={"kind": "llg", "damping": 0.0}))
        self.assert_refused(cayspin.CayspinError, "without width", call, undamped, 1, w,
                            spins=spins)

    def test_modes_in_reduced_units_and_in_si(self):
        w = np.linspace(-6, 6, 121)
        modes, spins = modes_of(chain())
        file = self.run_program(chain(), "--count", str(SITES), command="modes").filename
        found = cayspin.linear_structure_factor(file, 0.3, w)
        expected = cayspin.linear_structure_factor(modes, 0.3, w, spins=spins)
        np.testing.assert_allclose(found.intensity["xx"], expected.intensity["xx"], rtol=1e-7)

        heavy = chain(lattice={"shape": [SITES], "boundary": "periodic", "moments": 0.5,
                               "gyromagnetic": 1.7},
                      field={"anisotropy": {"constant": ANISOTROPY, "axis": [0, 0, 1]},
                             "couplings": {"shells": [EXCHANGE]}})
        file = self.run_program(heavy, "--count", str(SITES), command="modes").filename
        found = cayspin.linear_structure_factor(file, 0.3, w)
        np.testing.assert_allclose(found.integrated["xx"][0, 0], 0.3 / magnons(found), rtol=1e-8)

        joule, kelvin = 1e-21, 5.0
        si = cayspin.Scene(
            units="SI", system={"kind": "llg"},
            material={"mu_s": {"bohr_magnetons": 2.0}, "alpha": 0.05, "damping_form": "gilbert",
                      "K": 0.3 * joule, "axis": [0, 0, 1]},
            lattice={"shape": [8], "spacing": 3e-10, "boundary": "periodic"},
            field={"couplings": {"shells": [joule]}}, initial={"uniform": [0, 0, 1]})
        file = self.run_program(si, "--count", "8", command="modes")
        seconds = np.linspace(-9e14, 9e14, 90001)
        found = cayspin.linear_structure_factor(file.filename, kelvin, seconds)
        sim = cayspin.Simulation(si)
        other = cayspin.linear_structure_factor(sim.modes(8), kelvin, seconds, spins=sim.spins,
                                                cell=si.cell)
        np.testing.assert_allclose(other.intensity["xx"], found.intensity["xx"], rtol=1e-7)
        k = 2 * np.pi * found.wave_vectors[0, 0, :, 0]
        stiffness = 2 * joule * (1 - np.cos(k)) + 0.6 * joule
        np.testing.assert_allclose(found.integrated["yy"][0, 0], 1.380649e-23 * kelvin / stiffness,
                                   rtol=1e-8)
        area = found.intensity["yy"].sum(-1) * (seconds[1] - seconds[0])
        np.testing.assert_allclose(area, found.integrated["yy"], rtol=0.02)
        peaks = np.abs(seconds[found.intensity["yy"][0, 0].argmax(1)])
        np.testing.assert_allclose(np.sort(peaks), np.sort(2 * np.pi * file["frequency"][:]),
                                   rtol=0.01)

    def test_damping_of_sites_in_si(self):
        # The fluctuations at equilibrium do not depend on the damping. Frequencies of Gilbert's
        # form have a factor 1 / (1 + alpha^2).
        joule, kelvin, seconds = 1e-21, 5.0, np.linspace(-9e14, 9e14, 3)
        call = cayspin.linear_structure_factor
        for form, factor in (("gilbert", 1.25), ("landau_lifshitz", 1.0)):
            integrated = []
            for alpha in (0.5, "0.5 + 0*x"):
                si = cayspin.Scene(
                    units="SI", system={"kind": "llg"},
                    material={"mu_s": {"bohr_magnetons": 2.0}, "alpha": alpha,
                              "damping_form": form, "K": 0.3 * joule, "axis": [0, 0, 1]},
                    lattice={"shape": [8], "spacing": 3e-10, "boundary": "periodic"},
                    field={"couplings": {"shells": [joule]}}, initial={"uniform": [0, 0, 1]})
                file = self.run_program(si, "--count", "8", command="modes").filename
                modes, spins = modes_of(si)
                for given in (None, factor * 2 * MU_B / GAMMA):
                    for found in (call(file, kelvin, seconds, moments=given),
                                  call(modes, kelvin, seconds, spins=spins, moments=given)):
                        integrated.append(found.integrated["yy"][0, 0])
            k = 2 * np.pi * found.wave_vectors[0, 0, :, 0]
            stiffness = 2 * joule * (1 - np.cos(k)) + 0.6 * joule
            for one in integrated:
                np.testing.assert_allclose(one, 1.380649e-23 * kelvin / stiffness, rtol=1e-8)


if __name__ == "__main__":
    unittest.main()
