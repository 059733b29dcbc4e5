# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Views of the spins, initial spins and fields as arrays, and energies of terms."""

import gc
import unittest

import cayspin
import numpy as np
from package_test import ON_DEVICE, TABLES, PackageTest, random_spins, scene, stepped

EPSILON = {"double": 2.0**-52, "single": 2.0**-23}


def address(array):
    return array.__array_interface__["data"][0]


class Views(PackageTest):
    def test_shape_and_no_copy(self):
        for precision, size in (("double", 8), ("single", 4)):
            sim = cayspin.Simulation(scene(), precision)
            view, again = sim.spins, sim.spins
            self.assertEqual(view.shape, (2, 3, 7, 3))
            self.assertEqual(view.itemsize, size)
            if ON_DEVICE:  # copies, packed
                self.assertEqual(view.strides, (3 * 3 * 7 * size, 3 * 7 * size, 3 * size, size))
            else:
                self.assertEqual(address(view), address(again))
                self.assertEqual(view.strides[2], size)
                self.assertGreaterEqual(view.strides[3], 2 * 3 * 7 * size)
            self.assertFalse(view.flags.writeable)
            with self.assertRaises(ValueError):
                view[0, 0, 0, 0] = 1

    def test_a_view_never_changes(self):
        for keys in ({}, {"method": "euler"}, {"method": "ab2"}, {"method": "red_black2",
                     "compensated": None}, {"method": "tsit5", "tolerance": 1e-4}):
            with self.subTest(keys):
                of = scene(lattice={"shape": [6, 4, 2]}, field={"slab_demag": None},
                           integrator=keys)
                sim = cayspin.Simulation(of)
                views, copies = [], []
                for _ in range(5):
                    views.append(sim.spins)
                    copies.append(views[-1].copy())
                    sim.step(3)
                for view, copy in zip(views, copies):
                    np.testing.assert_array_equal(view, copy)
                self.assertFalse(np.array_equal(views[-1], sim.spins))
                np.testing.assert_array_equal(sim.spins, stepped(of, 15))

    @unittest.skipIf(ON_DEVICE, "spins on a device are copied at each look")
    def test_memory_stays_where_nobody_looks(self):
        sim = cayspin.Simulation(scene())
        first = address(sim.spins)
        sim.step(2)
        at_two = address(sim.spins)
        view = sim.spins
        sim.step(2)
        self.assertEqual(first, at_two)
        self.assertNotEqual(address(sim.spins), address(view))

    def test_a_view_outlives_its_simulation(self):
        sim = cayspin.Simulation(scene())
        view = sim.spins
        expected = view.copy()
        del sim
        gc.collect()
        filler = [np.full((2, 3, 7, 3), 9.0) for _ in range(50)]
        np.testing.assert_array_equal(view, expected)
        self.assertEqual(len(filler), 50)


class Setting(PackageTest):
    def test_any_layout_is_a_start(self):
        random = 2 * random_spins((2, 3, 7), 1)
        padded = np.zeros((4, 3, 14, 6))
        padded[::2, :, ::-2, :3] = random
        for array in (random, np.asfortranarray(random), padded[::2, :, ::-2, :3],
                      random.astype(np.float32).astype(np.float64)):
            with self.subTest(array.strides):
                tolerance = 1e-6 if array.dtype != float or array is not random else 4 * 2.0**-52
                started = cayspin.Simulation(scene(initial=array))
                np.testing.assert_allclose(started.spins, random / 2, rtol=0, atol=tolerance)
                sim = cayspin.Simulation(scene())
                sim.step(3)
                sim.spins = array
                np.testing.assert_array_equal(sim.spins, started.spins)

    def test_setting_is_a_new_start(self):
        for method in ("rkmk4", "ab2"):
            of = scene(integrator={"method": method})
            sim, fresh = cayspin.Simulation(of), cayspin.Simulation(of)
            start = fresh.spins.copy()
            sim.step(7)
            sim.spins = start
            fresh.spins = start
            sim.step(5)
            fresh.step(5)
            np.testing.assert_array_equal(sim.spins, fresh.spins)

    def test_broadcast_and_refusals(self):
        sim = cayspin.Simulation(scene())
        sim.spins = [0, 0, 2]
        self.assertTrue((sim.spins == [0, 0, 1]).all())
        self.assert_refused(cayspin.CayspinError, "broadcasts to (2, 3, 7, 3)",
                            setattr, sim, "spins", np.ones((4, 3)))
        wrong = np.ones((2, 3, 7, 3))
        wrong[1, 2, 4] = 0
        part = "the spin of site (4, 2, 1) is (0, 0, 0)"
        self.assert_refused(cayspin.CayspinError, f"spins: {part}", setattr, sim, "spins", wrong)
        self.assert_refused(cayspin.SceneError, f"initial: {part}", cayspin.Simulation,
                            scene(initial=wrong))
        self.assertTrue((sim.spins == [0, 0, 1]).all())
        self.assert_refused(cayspin.SceneError, "accepted: (nz, ny, nx, 3)",
                            scene, initial=np.ones((7, 3)))
        self.assert_refused(cayspin.SceneError, "accepted: (2, 3, 7, 3)",
                            scene, initial=np.ones((1, 1, 1, 3)))


def by_hand(m):
    """Returns H and the energy of each term of TABLES, by NumPy in double precision."""
    m = m.astype(float)
    field = TABLES["field"]
    laplacian = np.zeros_like(m)
    for axis, spacing, periodic in ((2, 1.0, True), (1, 0.9, False), (0, 1.1, False)):
        for shift in (1, -1):
            difference = np.roll(m, shift, axis) - m
            if not periodic:
                index = [slice(None)] * 4
                index[axis] = 0 if shift == 1 else -1
                difference[tuple(index)] = 0
            laplacian += difference / spacing**2
    h = {"exchange": field["exchange"] * laplacian}
    axis = np.array([0, 1, 2]) / np.sqrt(5)
    h["anisotropy"] = 0.4 * (m @ axis)[..., None] * axis
    h["applied"] = np.broadcast_to(1.5 * np.array(field["applied"]), m.shape)
    h["slab_demag"] = -1.5 * 0.8 * m * [0, 0, 1]
    energies = {name: -(m * one).sum() * (1 if name == "applied" else 0.5)
                for name, one in h.items()}
    return sum(h.values()), energies


class Observables(PackageTest):
    def test_field_and_energies(self):
        for precision in ("double", "single"):
            with self.subTest(precision):
                sim = cayspin.Simulation(scene(), precision)
                sim.step(5)
                h, energies = by_hand(sim.spins)
                tolerance = 64 * EPSILON[precision]
                np.testing.assert_allclose(sim.field(), h, rtol=0, atol=tolerance * abs(h).max())
                self.assertEqual(list(sim.energies()), list(energies))
                for name, energy in sim.energies().items():
                    self.assertAlmostEqual(energy, energies[name], delta=42 * tolerance, msg=name)
                self.assertAlmostEqual(sim.energy(), sum(energies.values()), delta=42 * tolerance)
                np.testing.assert_allclose(
                    sim.magnetization(), sim.spins.astype(float).mean(axis=(0, 1, 2)),
                    rtol=0, atol=tolerance)
                length = np.linalg.norm(sim.spins.astype(float), axis=-1)
                self.assertAlmostEqual(sim.norm_defect(), abs(length - 1).max(), delta=tolerance)

    def test_rigid_bodies(self):
        bodies = cayspin.Scene(system={"kind": "rigid_body", "inertia": [1, 2, 4]},
                               lattice={"shape": [5]}, initial={"uniform": [0, 0, 1]},
                               integrator={"method": "rkmk4", "dt": 0.1})
        sim = cayspin.Simulation(bodies)
        self.assertEqual(sim.energies(), {"rotation": 5 / 8})
        self.assert_refused(cayspin.CayspinError, "rigid bodies have no field", sim.field)


if __name__ == "__main__":
    unittest.main()
