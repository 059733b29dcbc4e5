# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A program's own field adds to the terms of a scene, and can replace any of them."""

import unittest

import cayspin
import h5py
import numpy as np
from package_test import PackageTest

SHAPE = (2, 4, 6)
NORMAL = np.array([0.0, 0.6, 0.8])
TABLES = {
    "system": {"kind": "llg", "damping": 0.1},
    "lattice": {"shape": [6, 4, 2], "spacing": [1.0, 0.8, 1.2], "regions": "i < 3 ? 0 : 1"},
    "initial": {"random": {"seed": 3}},
    "integrator": {"method": "rkmk4", "dt": 0.02, "steps": 40},
}
CRYSTAL = {"shape": [6, 4, 2], "crystal": "honeycomb", "boundary": ["periodic", "periodic", "open"]}
MOMENTS = {**TABLES["lattice"], "moments": "i == 2 ? 0 : 1 + 0.2*j"}


def scene(field, **tables):
    return cayspin.Scene(**{**TABLES, **tables}, field=field)


def slab(spins, t):
    return -0.7 * (spins @ NORMAL)[..., None] * NORMAL


def term_of(field):
    """Returns a term that is linear in the spins, as a function that multiplies by its matrix."""
    sim = cayspin.Simulation(scene(field))
    numbers = 3 * np.prod(SHAPE)
    matrix = np.empty((numbers, numbers))
    for column in range(numbers):
        ahead, back = np.zeros((2, *SHAPE, 3)) + [0.6, 0, 0.8]
        ahead.reshape(-1, 3)[column // 3] = np.eye(3)[column % 3]
        back.reshape(-1, 3)[column // 3] = -np.eye(3)[column % 3]
        sim.spins = ahead
        matrix[:, column] = sim.field().ravel() / 2
        sim.spins = back
        matrix[:, column] -= sim.field().ravel() / 2
    return lambda spins, t: (matrix @ spins.ravel()).reshape(spins.shape)


TERMS = {
    "exchange": {"exchange": 0.6},
    "interlayers": {"exchange": {"regions": [0.6, 0.4]},
                    "interlayer": [{"between": [0, 1], "J": -0.05, "biquadratic": 0.02}]},
    "dmi": {"dmi": {"interfacial": 0.3, "normal": [0, 0, 1]}},
    "free boundaries": {"exchange": 0.5, "dmi": {"bulk": 0.3, "free_boundary": True}},
    "anisotropies": {"anisotropy": [{"constant": 0.3, "constant2": 0.1, "axis": [1, 0, 0]},
                                    {"cubic": 0.2, "axes": [[1, 0, 0], [0, 1, 0]]}]},
    "couplings": {"couplings": [{"between": [0, 0], "offset": [1, 1, 0], "J": 0.2,
                                 "D": [0, 0, 0.1]}]},
    "applied": {"applied": ["0.1*cos(t)", 0, 0.2]},
    "an own uniform field": {"applied": lambda t: (0.1, 0, t)},
    "sources": {"sources": [{"profile": ["x", 0, "y"], "time": "1 + t"}]},
    "constants in time": {"exchange": 0.5, "in_time": {"exchange": "1 + t"}},
    "slab": {"slab_demag": {"normal": [1, 0, 0]}},
    "slab on the host": {"slab_demag": {"normal": [1, 0, 0], "strength": 1.5, "where": "host"}},
    "slab, once a step": {"slab_demag": {"normal": [1, 0, 0], "where": "host", "multirate": True}},
    "demag": {"demag": {"strength": 1.3}, "mu0": 1.2},
    "dipoles": {"dipoles": True},
}


class OwnFields(PackageTest):
    def test_add_to_each_term(self):
        doubled = {**TABLES["lattice"], "moments": 2.0}
        lattices = [TABLES["lattice"], MOMENTS, doubled]
        cases = [(name, field, lattice) for name, field in TERMS.items() for lattice in lattices]
        cases += [("dipoles of a crystal", {"dipoles": True}, CRYSTAL)]
        for name, field, lattice in cases:
            for precision, limit in (("double", 2e-14), ("single", 2e-5)):
                with self.subTest(name, lattice=lattice, precision=precision):
                    without = cayspin.Simulation(scene(field, lattice=lattice), precision)
                    both = cayspin.Simulation(scene({**field, "nonlocal": slab}, lattice=lattice),
                                              precision)
                    spins, own = both.spins, slab(both.spins, 0)
                    there = (spins**2).sum(-1, keepdims=True) > 0
                    np.testing.assert_allclose(both.field() * there,
                                               (without.field() + own) * there, atol=limit, rtol=0)
                    moments = lattice.get("moments") if lattice is doubled else 1.0
                    if lattice is MOMENTS:
                        moments = 1 + 0.2 * np.arange(4.0)[:, None]
                    of_own = -0.5 * (moments * (spins * own).sum(-1)).sum()
                    energies, before = both.energies(), without.energies()
                    self.assertAlmostEqual(energies.pop("nonlocal"), of_own, delta=100 * limit)
                    self.assertEqual(energies, before)
                    self.assertAlmostEqual(both.energy(), without.energy() + of_own,
                                           delta=200 * limit)

    def test_add_to_dipoles_of_unequal_moments_in_si(self):
        si = {"units": "SI", "lattice": {**CRYSTAL, "spacing": 3e-10},
              "material": {"mu_s": {"bohr_magnetons": [2.0, 3.0]}, "alpha": 0.1,
                           "damping_form": "gilbert"}, "system": {"kind": "llg"},
              "integrator": {"method": "rkmk4", "dt": 1e-15, "steps": 1}}
        for precision, limit in (("double", 1e-12), ("single", 1e-4)):
            sim = cayspin.Simulation(scene({"dipoles": True, "nonlocal": slab}, **si), precision)
            terms = sim.energies()
            magnitude = max(map(abs, terms.values()))
            self.assertEqual(set(terms), {"dipoles", "nonlocal"})
            self.assertGreater(min(map(abs, terms.values())), 0)
            self.assertAlmostEqual(sum(terms.values()), sim.energy(), delta=limit * magnitude)

    def test_may_depend_on_time(self):
        one = {"lattice": {"shape": [1]}, "system": {"kind": "llg", "damping": 0.01},
               "initial": {"uniform": [0.6, 0, 0.8]},
               "integrator": {"method": "rkmk4", "dt": 0.01, "steps": 100}}
        rising = cayspin.Simulation(scene({"nonlocal": lambda m, t: -t * m * [0, 0, 1]}, **one))
        rising.run()  # the energy t m_z^2 / 2 rises
        same = cayspin.Simulation(scene({"anisotropy": {"constant": -1.0, "axis": [0, 0, 1]},
                                         "in_time": {"anisotropy": "t"}}, **one))
        same.run()
        np.testing.assert_allclose(rising.spins, same.spins, atol=1e-13, rtol=0)

        matrix = np.array([[0, 0, 5], [0, 0, 0], [5, 0, 0.0]])
        ends = []
        for integrator in ({"method": "tsit5", "tolerance": 1e-7, "end": 100},
                           {"method": "rkmk4", "dt": 0.005, "end": 100}):
            tables = {**one, "initial": {"uniform": [0, 0, 1]}, "integrator": integrator}
            sim = cayspin.Simulation(scene(
                {"applied": [0, 0, 1], "nonlocal": lambda m, t: (m @ matrix) * (60 < t < 61)},
                **tables))
            sim.run()
            ends.append(sim.spins)
        np.testing.assert_allclose(*ends, atol=3e-3)
        self.assertLess(ends[1][..., 2].max(), 0.9)

    # Yields a simulation with the field `whole` in the scene and a slab as own field, and one with
    # the two exchanged.
    def exchanged(self, whole, lattice, precision="double", **tables):
        more = {"exchange": 0.5, "applied": [0.1, 0, 0.2]}
        strength = {"normal": NORMAL.tolist(), "strength": 0.7}
        for own in ({whole: True, "nonlocal": slab},
                    {"slab_demag": strength, "nonlocal": term_of({whole: True})}):
            yield cayspin.Simulation(scene({**more, **own}, lattice=lattice, **tables), precision)

    def test_steps_beside_demag(self):
        for whole, lattice, integrator in (
                ("demag", TABLES["lattice"], TABLES["integrator"]),
                ("dipoles", TABLES["lattice"], {"method": "dp5", "tolerance": 1e-6, "end": 0.8}),
                ("demag", {**TABLES["lattice"], "occupied": "i + j != 3"}, TABLES["integrator"])):
            for precision, limit in (("double", 1e-13), ("single", 1e-5)):
                if precision == "single" and "tolerance" in integrator:
                    continue  # the steps would differ
                one, other = self.exchanged(whole, lattice, precision, integrator=integrator)
                for sim in (one, other):
                    sim.run()
                    sim.set({"field.applied": [0, 0.3, 0], "integrator": TABLES["integrator"]})
                    sim.run()
                np.testing.assert_allclose(one.spins, other.spins, atol=limit, rtol=0)
                self.assertGreater(one.steps, 40)

    def test_relax_beside_demag(self):
        one, other = self.exchanged("demag", TABLES["lattice"])
        for sim in (one, other):
            self.assertTrue(sim.relax().converged)
        self.assertAlmostEqual(one.energy(), other.energy(), delta=1e-10)
        np.testing.assert_allclose(one.spins, other.spins, atol=1e-5)

    def test_each_kind_of_method(self):
        steps = {"dt": 0.02, "steps": 40}
        undamped = {"kind": "llg", "damping": 0.0}
        cases = [{"method": method, **steps} for method in (
            "heun", "ab2", "rkmk8", "projected_rk4", "series4", "implicit_midpoint", "stiff2")]
        cases += [{"method": "rkmk4", **steps, key: value} for key, value in (
            ("generator", "tangent"), ("compensated", True), ("energy_control", True))]
        cases += [{"method": "euler", **steps, "isotropy": isotropy}
                  for isotropy in ("analytic", "finite_difference")]
        cases += [{"method": "rkmk4", "dt": 0.05, "steps": 5000, "until_torque": 1e-3}]
        for integrator in cases:
            with self.subTest(integrator):
                tables = {"system": undamped} if "energy_control" in integrator else {}
                ends = []
                for own in ({"slab_demag": {"normal": NORMAL.tolist(), "strength": 0.7}},
                            {"nonlocal": slab}):
                    sim = cayspin.Simulation(scene({"exchange": 0.5, "applied": [0.1, 0, 0.2], **own},
                                                   integrator=integrator, **tables))
                    sim.run()
                    ends.append(sim.spins)
                np.testing.assert_allclose(*ends, atol=1e-12, rtol=0)

    def test_modes_beside_demag(self):
        found = []
        for sim in self.exchanged("demag", TABLES["lattice"]):
            sim.relax(torque=1e-9)
            found.append(sim.modes(3).frequency)
        np.testing.assert_allclose(*found, rtol=1e-6)

    def test_noise_beside_demag(self):
        one, other = self.exchanged(
            "demag", TABLES["lattice"], thermal={"temperature": 0.2, "seed": 4},
            integrator={"method": "heun", "dt": 0.02, "steps": 40})
        for sim in (one, other):
            sim.run()
        np.testing.assert_allclose(one.spins, other.spins, atol=1e-12, rtol=0)

    def test_are_called_before_each_stage_or_once_a_step(self):
        for more, multirate, calls_per_step in (({}, None, 4), ({}, True, 1), ({"substeps": 2}, None, 1)):
            times = []

            def own(spins, t, times=times):
                times.append(t)
                return slab(spins, t)

            demag = True if multirate is None else {"multirate": multirate}
            sim = cayspin.Simulation(scene({"exchange": 0.5, "demag": demag, "nonlocal": own},
                                           integrator={**TABLES["integrator"], **more}))
            sim.step(3)
            before = len(times)
            sim.step(10)
            self.assertEqual(len(times) - before, 10 * calls_per_step)
        self.assert_refused(
            cayspin.SceneError, "field.demag.multirate: false does not go with substeps and a ",
            lambda: cayspin.Simulation(scene({"demag": {"multirate": False}, "nonlocal": slab},
                                             integrator={**TABLES["integrator"], "substeps": 2})))


class FieldsOfFiles(PackageTest):
    def test_a_function_replaces_the_applied_field_of_a_file(self):
        name, mask = "only-one.h5", np.arange(48).reshape(SHAPE) != 5
        with h5py.File(self.folder / name, "w") as file:
            file["spins"] = np.broadcast_to([0.0, 0.6, 0.8], (*SHAPE, 3))
        given = scene({"exchange": 0.6, "applied": [0.3, 0, 0]}, initial={"file": name},
                      output={"file": "a \"b\".h5", "every": 7})
        file = self.written(given)

        def applied(t):
            return 0.1, 0.2, t

        for override in ({"field": {"applied": applied}}, {"field.applied": applied}):
            made = cayspin.Scene.from_file(file, integrator={"dt": 0.01},
                                           lattice={"occupied": mask}, **override)
            sim = cayspin.Simulation(made)
            self.assertEqual((made.dt, made.steps, made._scene.output.name), (0.01, 40, 'a "b".h5'))
            expected = np.where(mask[..., None], [0, 0.6, 0.8], 0)
            np.testing.assert_allclose(sim.spins, expected, atol=1e-15)
            sim.step(10)
            self.assertAlmostEqual(sim.energies()["applied"],
                                   -(sim.spins @ [0.1, 0.2, 0.1]).sum(), 12)


class ConstantFields(PackageTest):
    def test_are_sources_of_arrays(self):
        _, j, i = np.indices(SHAPE)
        array = np.stack([(i + 0.5) / 6, np.zeros(SHAPE), 0.3 * (j + 0.5) / 4], -1)
        typed = scene({"sources": [{"profile": ["x", 0, "0.3*y"], "time": "cos(t)"}]})
        given = scene({"sources": [{"profile": array, "time": "cos(t)"}]})
        sims = [cayspin.Simulation(one) for one in (typed, given)]
        self.assertAlmostEqual(sims[1].energy(), -(sims[1].spins * array).sum(), delta=1e-13)
        for sim in sims:
            sim.step(40)
        np.testing.assert_array_equal(sims[0].spins, sims[1].spins)
        sims[1].set("field.sources", [{"profile": 2 * array}])
        np.testing.assert_allclose(sims[1].field(), 2 * array, rtol=1e-15)

    def test_an_array_may_be_the_applied_field(self):
        array = np.random.default_rng(1).normal(size=(*SHAPE, 3))
        others = {"exchange": 0.4, "mu0": 0.5}
        sim = cayspin.Simulation(scene({**others, "applied": array}, lattice=MOMENTS))
        _, j, i = np.indices(SHAPE)
        moments = np.where(i == 2, 0, 1 + 0.2 * j)[..., None]
        expected = -0.5 * (moments * sim.spins * array).sum()
        self.assertAlmostEqual(sim.energies()["sources"], expected, delta=1e-13)
        # A field that the function of a linear field returns has half this energy.
        half = cayspin.Simulation(scene({"nonlocal": lambda m, t: 0.5 * array}, lattice=MOMENTS))
        self.assertAlmostEqual(half.energy(), expected / 2, delta=1e-13)
        both = cayspin.Simulation(scene({**others, "sources": [{"profile": [0, 0, "x"]},
                                                               {"profile": array}]}))
        same = cayspin.Simulation(scene({**others, "sources": [{"profile": [0, 0, "x"]}],
                                         "applied": array}))
        for one in (both, same):
            one.step(20)
        np.testing.assert_array_equal(both.spins, same.spins)
        crystal = np.random.default_rng(2).normal(size=(2, *SHAPE, 3))
        sim = cayspin.Simulation(scene({"applied": crystal}, lattice=CRYSTAL))
        np.testing.assert_allclose(sim.field(), crystal, rtol=1e-15)
        sim.set("field.applied", [0, 0, 2])
        np.testing.assert_allclose(sim.field(), crystal + [0, 0, 2], rtol=1e-14)
        sim.relax(applied=[0, 0, 100], torque=1e-9)
        total = crystal + [0, 0, 100]
        np.testing.assert_allclose(
            sim.spins, total / np.linalg.norm(total, axis=-1, keepdims=True), atol=1e-9)

    def test_an_applied_array_that_is_wrong_is_refused_in_one_line(self):
        array = np.ones((*SHAPE, 3))
        self.assert_refused(
            cayspin.SceneError, "field.applied: an array of shape (2, 4, 5, 3); accepted: "
            "(2, 4, 6, 3), or three numbers or expressions", scene, {"applied": array[:, :, :5]})
        for wrong in (array[0], array[..., :2], array[..., 0], np.ones((1, 2, *SHAPE, 3))):
            self.assert_refused(
                cayspin.SceneError, f"field.applied: an array of shape {wrong.shape}; accepted: "
                "(nz, ny, nx, 3), of a crystal (site, nz, ny, nx, 3), or three numbers or "
                "expressions", scene, {"applied": wrong})
        broken = array.copy()
        broken[1, 2, 3, 0] = np.nan
        self.assert_refused(cayspin.SceneError, "field.applied: a number of the array is not finite; "
                            "accepted: finite numbers", scene, {"applied": broken})
        self.assert_refused(cayspin.SceneError, "field.applied: an array of complex128; accepted: "
                            "one of real numbers", scene, {"applied": 1j * array})
        for sources in ({"profile": [0, 0, 1]}, 3.0, array, None):
            self.assert_refused(cayspin.SceneError, "field.sources: ", scene,
                                {"applied": array, "sources": sources})
        sim = cayspin.Simulation(scene({"exchange": 1.0}))
        file = self.written(scene({"exchange": 1.0}))
        for call in (lambda: sim.set("field.applied", array),
                     lambda: sim.set("field.applied", array[0]),
                     lambda: sim.set({"field": {"applied": array}}),
                     lambda: cayspin.Scene.from_file(file, field={"applied": array})):
            self.assert_refused(cayspin.SceneError, "field.applied: an array of vectors, which only ",
                                call)

    def test_axes_are_arrays_too(self):
        axis = np.broadcast_to([0.0, 0.6, 0.8], (*SHAPE, 3)).copy()
        axis[:, :, 3:] = [1, 0, 0]
        regions = {"regions": [[0, 0.6, 0.8], [1, 0, 0]]}
        fields = [cayspin.Simulation(scene({"anisotropy": {"constant": 0.3, "axis": one}})).field()
                  for one in (axis, regions)]
        np.testing.assert_allclose(fields[0], fields[1], atol=1e-15)
        self.assert_refused(cayspin.SceneError, "field.anisotropy.axis[0]: an array of shape",
                            scene, {"anisotropy": {"constant": 0.3, "axis": axis[:, :, :4]}})


if __name__ == "__main__":
    unittest.main()
