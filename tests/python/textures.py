# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Pictures of spins: colours, keys, arrows, planes, charges, and refusals."""

import unittest

import cayspin
import matplotlib
import numpy as np
from cayspin import texture
from cayspin.texture.colors import hue_colors, wheel_colors
from cayspin.texture.charge import half_solid_angles
from package_test import PackageTest, random_spins, scene

matplotlib.use("Agg")

import matplotlib.pyplot  # noqa: E402  the backend has to be chosen before

NAMED = {(1, 0, 0): (1, 0, 0), (-1, 0, 0): (0, 1, 1), (0, 1, 0): (0.5, 1, 0),
         (0, -1, 0): (0.5, 0, 1), (0, 0, 1): (0.9,) * 3, (0, 0, -1): (0.1,) * 3,
         (0, 0, 0): (1, 1, 1)}


def skyrmion(sites=40, radius=8.0):
    """Returns a core down among spins up, (1, sites, sites, 3); all spins at the rim are equal."""
    x, y = np.meshgrid(*(np.arange(sites) - (sites - 1) / 2,) * 2)
    r = np.hypot(x, y)
    angle = np.where(r < 2 * radius, np.pi * (1 - r / (2 * radius)), 0)
    return np.stack((np.sin(angle) * x / r, np.sin(angle) * y / r, np.cos(angle)), -1)[None]


def drawn(axes):
    return np.asarray(axes.images[0].get_array())


class TextureTest(PackageTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(matplotlib.pyplot.close, "all")


class Colors(TextureTest):
    def test_known_directions(self):
        m = np.array(list(NAMED), float)
        for length in (1, 0.2, 7):  # rigid bodies have any length
            axes = texture.draw(texture.Texture(length * np.stack((m, m))[None]))
            np.testing.assert_allclose(drawn(axes), [list(NAMED.values())] * 2, atol=1e-6)

    def test_bright_along_the_normal_alone(self):
        m = random_spins((1000,), 1)
        colors = hue_colors(m)
        middle = (colors.max(-1) + colors.min(-1)) / 2
        np.testing.assert_allclose(middle, 0.5 + 0.4 * m[:, 2], atol=1e-6)

    def test_the_wheel_agrees_with_the_picture(self):
        m = random_spins((1, 12, 12), 2)
        axes = texture.draw(texture.Texture(m))
        key, = (one for one in axes.figure.axes if one is not axes)
        wheel, extent = drawn(key), key.images[0].get_extent()
        self.assertEqual((wheel.shape, list(extent)), ((256, 256, 4), [-1, 1, -1, 1]))
        self.assertEqual(key.images[0].origin, "lower")
        out = np.arccos(m[0, ..., 2]) / np.pi
        angle = np.arctan2(m[0, ..., 1], m[0, ..., 0])
        column, row = ((1 + out * turned(angle)) / 2 * 256 for turned in (np.cos, np.sin))
        there = out < 0.99
        near = wheel[row.astype(int), column.astype(int), :3]
        self.assertLess(np.abs(near - drawn(axes))[there].max(), 0.06)
        self.assertEqual([text.get_text() for text in key.texts],
                         ["+x", "\u2212x", "+y", "\u2212y", "middle: +z, rim: \u2212z"])
        self.assertEqual(wheel_colors(64)[0, 0, 3], 0)  # nothing beyond the rim

    def test_safe(self):
        m = random_spins((1, 5, 6), 3)
        m[0, 2, 3] = 0
        axes = texture.draw(texture.Texture(m), colors="safe")
        values, scale = axes.images[0].get_array(), axes.images[0]
        np.testing.assert_allclose(values.filled(9)[m[0].any(-1)], m[0, m[0].any(-1), 2])
        self.assertTrue(values.mask[2, 3])
        self.assertEqual(scale.to_rgba(values)[2, 3].tolist(), [1, 1, 1, 1])
        self.assertEqual((scale.norm.vmin, scale.norm.vmax), (-1, 1))
        self.assertEqual(axes.figure.axes[-1].get_ylabel(), "$m_z$")


class Films(TextureTest):
    def test_planes_of_a_box(self):
        m = random_spins((3, 4, 5), 4)
        box = texture.Texture(m, spacing=(1.0, 0.5, 2.0))
        for plane, spins, order, names, size in (
                ("z=2", m[2], [0, 1, 2], "xy", (5, 2)), ("y=1", m[:, 1], [0, 2, 1], "xz", (5, 6)),
                ("x=4", m[:, :, 4], [1, 2, 0], "yz", (2, 6)), (None, m[1], [0, 1, 2], "xy", (5, 2))):
            axes = texture.draw(box, plane=plane)
            np.testing.assert_array_equal(drawn(axes), hue_colors(spins[..., order]))
            self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), tuple(names))
            self.assertEqual(axes.images[0].get_extent(), (0, size[0], 0, size[1]))
            self.assertEqual((axes.images[0].origin, axes.get_aspect()), ("lower", 1))
            self.assertEqual((axes.get_xlim(), axes.get_ylim()), ((0, size[0]), (0, size[1])))
        self.assertEqual(axes.get_title("left"), "plane z=1 of 3")

    def test_arrows_point_along_spins(self):
        for shape, seed in (((1, 9, 7), 5), ((1, 100, 201), 6)):
            m = random_spins(shape, seed)
            m[0, 4, 3] = 0
            axes = texture.draw(texture.Texture(m, spacing=(2.0, 3.0, 1.0)))
            arrows, = axes.collections
            column, row = (arrows.XY / [2, 3] - 0.5).T
            self.assertLess(np.abs(np.rint(column) - column).max(), 1e-9)
            there = m[0, np.rint(row).astype(int), np.rint(column).astype(int)]
            np.testing.assert_allclose(np.stack((arrows.U, arrows.V), -1), there[:, :2])
            self.assertEqual((arrows.angles, arrows.pivot), ("xy", "middle"))
            across = len(set(np.rint(row))), len(set(np.rint(column)))
            if shape[2] == 7:
                self.assertEqual(across, (9, 7))
            else:
                self.assertTrue(12 <= max(across) <= 40, across)

    def test_no_arrows_in_a_small_corner(self):
        figure = matplotlib.pyplot.figure(figsize=(4, 4), dpi=100)
        small = texture.draw(texture.Texture(random_spins((1, 60, 60), 7)),
                             figure.add_axes((0, 0, 0.25, 0.25)))
        self.assertLess(len(small.collections[0].U), 50)
        self.assertEqual(figure.axes, [small])  # no key beside axes that were given

    def test_difference(self):
        m, before = random_spins((1, 5, 6), 8), random_spins((1, 5, 6), 9)
        m[0, 0, 0] = 0
        axes = texture.draw(texture.Texture(m), before=before)
        values = axes.images[0].get_array()
        there = m[0].any(-1)
        np.testing.assert_allclose(values[there], np.linalg.norm(m - before, axis=-1)[0, there])
        self.assertTrue(values.mask[0, 0])
        self.assertEqual(len(axes.collections), 0)
        self.assertAlmostEqual(axes.images[0].norm.vmax, values.max())
        self.assertEqual(axes.images[0].norm.vmin, 0)
        axes = texture.draw(texture.Texture(m), before=before, limit=2)
        self.assertEqual(axes.images[0].norm.vmax, 2)

    def test_lengths_in_si(self):
        for spacing, unit, end in ((2e-9, "nm", 12), (5e-6, "\u00b5m", 30), (1e-2, "mm", 60)):
            film = texture.Texture(random_spins((1, 5, 6), 1), (spacing,) * 3, si=True)
            axes = texture.draw(film)
            self.assertEqual(axes.get_xlabel(), f"x ({unit})")
            self.assertAlmostEqual(axes.get_xlim()[1], end)

    def test_size_of_the_figure(self):
        for shape, inches in (((1, 20, 20), (8.1, 6.6)), ((1, 20, 40), (8.1, 3.85))):
            axes = texture.draw(texture.Texture(random_spins(shape, 1)))
            self.assertEqual(tuple(np.round(axes.figure.get_size_inches(), 6)), inches)
            box = axes.get_window_extent()
            self.assertAlmostEqual(box.width / box.height, shape[2] / shape[1])


class Charge(TextureTest):
    def test_a_skyrmion(self):
        m = skyrmion()
        axes = texture.draw(texture.Texture(m), quantity="charge")
        values = drawn(axes)
        self.assertEqual(values.shape, (39, 39))
        self.assertAlmostEqual(values.sum(), -1, delta=1e-12)
        self.assertAlmostEqual(values.sum(), cayspin.topological_charge(m)[0], delta=1e-13)
        self.assertEqual(axes.get_title("left"), "Q = -1.0000")
        self.assertEqual(axes.images[0].get_extent(), (0.5, 39.5, 0.5, 39.5))
        self.assertLess(values.max(), 1e-12)

    def test_every_plane(self):
        m = skyrmion()[0]  # rotated so that x -> y -> z -> x, once and twice
        about_x = m[..., [2, 0, 1]][:, :, None]
        about_y = m[..., [1, 2, 0]].swapaxes(0, 1)[:, None]
        for spins, plane in ((about_x, "x=0"), (about_y, "y=0")):
            values = drawn(texture.draw(texture.Texture(spins), plane=plane, quantity="charge"))
            self.assertAlmostEqual(values.sum(), -1, delta=1e-12)

    def test_boundaries(self):
        m = random_spins((2, 5, 7), 2)
        for boundary in (("open", "periodic"), ("periodic", "open"), ("periodic", "periodic")):
            charge = cayspin.topological_charge(m, boundary)
            box = texture.Texture(m, boundary=(*boundary, "open"))
            values = drawn(texture.draw(box, plane="z=1", quantity="charge"))
            self.assertAlmostEqual(values.sum(), charge[1], delta=1e-13)
            np.testing.assert_allclose(values, half_solid_angles(m, boundary)[1] / (2 * np.pi),
                                       atol=1e-15)


class Chains(TextureTest):
    def test_components_and_colours(self):
        for axis, name in enumerate("xyz"):
            shape = [1, 1, 1]
            shape[2 - axis] = 30
            m = random_spins(shape, axis)
            axes = texture.draw(texture.Texture(m, spacing=(0.5,) * 3))
            self.assertEqual([line.get_label() for line in axes.lines],
                             ["$m_x$", "$m_y$", "$m_z$"])
            for component, line in enumerate(axes.lines):
                x, y = line.get_data()
                np.testing.assert_array_equal(y, m.reshape(30, 3)[:, component])
                np.testing.assert_allclose(x, (np.arange(30) + 0.5) / 2)
            self.assertEqual((axes.get_xlabel(), axes.get_xlim()), (name, (0, 15)))
            strip, = axes.child_axes
            self.assertEqual(drawn(strip).shape, (1, 30, 3))
            self.assertEqual(strip.get_xlim(), (0, 15))

    def test_a_line_of_a_film(self):
        m = random_spins((1, 6, 8), 3)
        axes = texture.draw(texture.Texture(m), plane="y=2")
        np.testing.assert_array_equal(axes.lines[1].get_ydata(), m[0, 2, :, 1])

    def test_difference(self):
        m, before = random_spins((1, 1, 9), 8), random_spins((1, 1, 9), 9)
        axes = texture.draw(texture.Texture(m), before=before)
        line, = axes.lines
        np.testing.assert_allclose(line.get_ydata(), np.linalg.norm(m - before, axis=-1)[0, 0])


class Files(TextureTest):
    def test_trajectory_and_simulation(self):
        file = self.folder / "run.h5"
        sim = cayspin.Simulation(scene(output={"every": 20}))
        sim.run(output=file)
        now = sim.plot(plane="z=0")
        with cayspin.open(file) as run:
            last = run.plot(plane="z=0")
            np.testing.assert_array_equal(drawn(last), drawn(now))
            self.assertEqual(last.images[0].get_extent(), now.images[0].get_extent())
            np.testing.assert_allclose(last.images[0].get_extent(), [0, 7, 0, 2.7])
            self.assertEqual(last.get_title("left"), "frame 2, t = 2, plane z=0 of 2")
            np.testing.assert_array_equal(drawn(run.plot(0, plane="y=1")),
                                          hue_colors(run.spins[0][:, 1][..., [0, 2, 1]]))
            change = run.plot(2, difference_to=0, plane="z=1")
            np.testing.assert_allclose(
                drawn(change), np.linalg.norm(run.spins[2] - run.spins[0], axis=-1)[1])
            charge = run.plot(quantity="charge", plane="z=1")
            self.assertAlmostEqual(drawn(charge).sum(), run.topological_charge()[-1, 1],
                                   delta=1e-13)
            given = matplotlib.pyplot.figure().add_subplot()
            self.assertIs(run.plot(axes=given), given)
            for part, options in (("frame 3; accepted: -3 to 2", {"frame": 3}),
                                  ("frame -4", {"frame": -4}),
                                  ("frame 7", {"difference_to": 7}),
                                  ("frame: 'last'", {"frame": "last"}),
                                  ("plane 'z=2'; accepted: z=0 to z=1", {"plane": "z=2"}),
                                  ("plane 'w=0'", {"plane": "w=0"}), ("plane 3", {"plane": 3}),
                                  ("colors 'grey'", {"colors": "grey"}),
                                  ("quantity 'energy'", {"quantity": "energy"}),
                                  ("a difference", {"quantity": "charge", "difference_to": 0})):
                self.assert_refused(cayspin.CayspinError, part, run.plot, **options)
        self.assert_refused(cayspin.CayspinError, "accepted: (2, 3, 7, 3)", sim.plot,
                            before=np.ones((2, 2)))
        self.assert_refused(cayspin.CayspinError, "plane 'x=7'", sim.plot, plane="x=7")
        self.assert_refused(cayspin.CayspinError, "axes: 3; accepted: matplotlib axes", sim.plot, 3)
        self.assert_refused(cayspin.CayspinError, "key: 'no'; accepted: True", sim.plot, key="no")
        chain = texture.Texture(random_spins((1, 1, 9), 1))
        self.assert_refused(ValueError, "of a crystal, a chain or a single spin", texture.draw, chain,
                            quantity="charge")

    def test_vacancies(self):
        axes = cayspin.Simulation(scene(lattice={"occupied": "x > 0.3"})).plot()
        self.assertTrue((drawn(axes)[:, :2] == 1).all())
        self.assertFalse((drawn(axes)[:, 3:] == 1).all(-1).any())

    def test_a_crystal(self):
        file = self.folder / "crystal.h5"
        crystal = cayspin.Scene(
            system={"kind": "llg", "damping": 0.1},
            lattice={"shape": [5, 4], "crystal": "honeycomb", "spacing": 2.0},
            field={"couplings": {"shells": [1.0]}}, initial={"random": {"seed": 2}},
            integrator={"method": "rkmk4", "dt": 0.05, "steps": 20}, output={"every": 20})
        sim = cayspin.Simulation(crystal)
        sim.run(output=file)
        with cayspin.open(file) as run:
            for axes in (run.plot(), sim.plot()):
                sites, arrows = axes.collections
                np.testing.assert_allclose(sites.get_offsets(),
                                           run.positions[:].reshape(-1, 3)[:, :2])
                np.testing.assert_allclose(sites.get_facecolors()[:, :3],
                                           hue_colors(run.spins[-1].reshape(-1, 3)))
                self.assertLessEqual(len(arrows.U), 40)
            self.assert_refused(cayspin.CayspinError, "of a crystal, a chain or a single spin", run.plot,
                                quantity="charge")


if __name__ == "__main__":
    unittest.main()
