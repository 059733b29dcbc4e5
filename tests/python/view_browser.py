# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The page of `cayspin view` in a browser: its pictures, its controls and its console."""

import sys
import time
import unittest

import h5py
import numpy as np
from browser_test import Browser, has_browser
from script_test import write
from view_test import LONG_SCENE

import cayspin_plots  # noqa: F401  puts `texture` on the path
from texture import checksum
from texture.colors import hue_colors, map_colors

UP, LEFT, HOME = "\ue013", "\ue012", "\ue011"  # keys of WebDriver
RENDERER = """const gl = document.createElement("canvas").getContext("webgl2");
return gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info").UNMASKED_RENDERER_WEBGL);"""
# A script that returns how many frames per second appear while the slider is dragged for a number
# of milliseconds.
RATE = """const [milliseconds, done] = arguments, frame = document.getElementById("frame");
let count = -1;
const next = () => {
  ++count;
  frame.value = (Number(frame.value) + 1) % (Number(frame.max) + 1);
  frame.dispatchEvent(new Event("input"));
};
const observer = new MutationObserver(next);
observer.observe(document.body, {attributeFilter: ["data-shown"]});
setTimeout(() => { observer.disconnect(); done(count / milliseconds * 1000); }, milliseconds);
next();"""
# A script that hides the page for a second, beginning with the page's second query of
# document.hidden.
HIDDEN = """let looks = 0, hidden = false;
Object.defineProperty(document, "hidden", {get: () => {
  if (++looks === 2) {
    hidden = true;
    setTimeout(() => { hidden = false; }, 1000);
  }
  return hidden;
}});"""
ASKED = """return performance.getEntriesByType("resource").filter(
  one => new URL(one.name).pathname === "/news").length;"""
NAMELESS = """return [...document.querySelectorAll("input, button, select, canvas")].filter(
  one => !one.hidden && !(one.ariaLabel || one.labels?.length || one.textContent.trim())
  ).map(one => one.id);"""


def random_spins(*shape):
    spins = np.random.default_rng(1).normal(size=(*shape, 3))
    return spins / np.linalg.norm(spins, axis=-1, keepdims=True)


class Pictures(Browser):
    def test_a_film(self):
        file, spins = self.film()
        spins[9:, 0, :7] = random_spins(11, 7, 10)
        with h5py.File(file, "r+") as data:
            data["spins"][:] = spins
            data.attrs["scene"] = "[lattice]\nshape = [10, 8]\nspacing = [1, 1.5]\n"
        self.open(file)
        self.assertEqual(self.shown(), 19)
        self.assert_colors(hue_colors(spins[19, 0]))
        size = self.element("spins").size
        self.assertAlmostEqual(size["width"] / size["height"], 10 / 12, delta=0.01)
        for frame in (0, 3, 12):
            self.go_to(frame)
            self.assert_colors(hue_colors(spins[frame, 0]))
        self.assertIn("12 of 0 to 19, t = 1.2", self.element("time").text)
        self.select("colors", "safe")
        normal = np.where(spins[12, 0].any(-1), spins[12, 0, ..., 2], np.nan)
        self.wait(lambda: "safe" in self.shown_text())
        self.assert_colors(map_colors(normal, "safe", -1, 1)[0], 6)

    def test_the_key(self):
        self.open(self.film()[0])
        key = self.pixels("key")
        middle = np.array(key.shape[:2]) // 2
        for right, up in ((0.5, 0), (0, 0.5), (-0.35, 0.35), (0.3, 0), (0, -0.7)):
            radius = np.hypot(right, up)
            part = np.sin(np.pi * radius) / radius
            expected = 255 * hue_colors([right * part, up * part, np.cos(np.pi * radius)])
            found = key[tuple((middle + middle * (-up, right)).astype(int))]
            self.assertLess(abs(found - expected).max(), 16, (right, up))

    def test_planes_of_a_box(self):
        spins = random_spins(20, 3, 4, 5)
        file = write(self.folder / "box.h5")
        self.replace_spins(file, spins)
        self.open(file)
        self.assert_colors(hue_colors(spins[19, 1]))
        self.pull("plane", 2)
        self.wait(lambda: self.element("number").text == "z=2 of 3")
        self.wait(lambda: "z=2" in self.shown_text())
        self.assert_colors(hue_colors(spins[19, 2]))
        self.select("normal", "1")
        self.wait(lambda: "y=2" in self.shown_text())
        self.assert_colors(hue_colors(spins[19, :, 2][..., [0, 2, 1]]))
        self.assertIn("up: +z", self.element("directions").text)
        self.click_cell(3, 1, 5, 3)
        m = ", ".join(f"{part:.3f}" for part in spins[19, 1, 2, 3])
        self.wait(lambda: f"m = ({m})" in self.element("spin").text)

    def test_a_chain_is_a_strip(self):
        file = write(self.folder / "chain.h5")
        with h5py.File(file) as data:
            spins = data["spins"][19]
        self.open(file)
        self.assert_colors(hue_colors(spins[0]))

    def test_a_crystal(self):
        places = np.array([[0, 0], [1.2, 0], [6, 0.5], [3, 1], [0.5, 2], [4, 2.2]])
        spins, positions = random_spins(20, 2, 1, 1, 3), np.zeros((2, 1, 1, 3, 3))
        positions[..., :2] = places.reshape(2, 1, 1, 3, 2)
        spins[:, 1, 0, 0, 0] = 0
        file = write(self.folder / "crystal.h5", cell_sites=2)
        self.replace_spins(file, spins, positions=positions)
        self.open(file)
        pixels = self.pixels()
        low, high = places.min(0), places.max(0)
        edge = 0.7 * 1.2  # the margin around a chain of cells
        part = (places - low + edge) / (high - low + 2 * edge)
        colors = 255 * hue_colors(spins[19].reshape(-1, 3))
        for (right, up), color in zip(part, colors):
            found = pixels[int(pixels.shape[0] * (1 - up)), int(pixels.shape[1] * right)]
            self.assertLessEqual(abs(found - color).max(), 4)
        self.assertEqual(list(pixels[3, 3]), [255, 255, 255])


class Controls(Browser):
    def test_one_spin_by_mouse_and_keys(self):
        file, spins = self.film()
        self.open(file)
        self.assertFalse(self.element("sphere").is_displayed())
        self.click_cell(7, 2, 10, 8)
        self.wait(lambda: "Site 27 of z=0: m = (-1.000, 0.000, 0.000)" in
                  self.element("spin").text)
        dot = abs(self.pixels("sphere") - (0xD5, 0x5E, 0)).max(-1) < 4
        self.assertTrue(40 < dot.sum() < 200, dot.sum())
        self.element("spins").send_keys(UP, UP, LEFT)
        self.wait(lambda: "Site 46 of z=0: m = (0.000, 0.000, -1.000)" in
                  self.element("spin").text)
        self.element("frame").send_keys(HOME)
        self.wait(lambda: "m = (0.000, 1.000, 0.000)" in self.element("spin").text)

    def test_play(self):
        self.open(write(self.folder / "chain.h5"))
        self.element("play").click()
        self.wait(lambda: 0 < self.shown() < 15)
        self.assertEqual(self.element("play").get_attribute("aria-label"), "Stop playing")
        self.wait(lambda: self.shown() == 19 and
                  self.element("play").get_attribute("aria-label") == "Play")
        self.go_to(3)
        self.element("spins").send_keys(" ")
        self.wait(lambda: self.shown() > 4)
        self.element("spins").send_keys(" ")
        self.assertEqual(self.element("play").get_attribute("aria-label"), "Play")

    def test_dark_and_on_a_phone(self):
        file, _ = self.film()
        for width in (1200, 390, 320):
            for scheme, light in (("dark", False), ("light", True)):
                self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
                    "width": width, "height": 844, "deviceScaleFactor": 1, "mobile": width < 500})
                self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                    "features": [{"name": "prefers-color-scheme", "value": scheme}]})
                self.open(file)
                self.assertLessEqual(self.driver.execute_script(
                    "return document.documentElement.scrollWidth"), width)
                ground = self.driver.execute_script(
                    "return getComputedStyle(document.body).backgroundColor")
                self.assertEqual(ground == "rgb(255, 255, 255)", light)
                self.assertEqual(self.driver.execute_script(NAMELESS), [])
                self.assertTrue((self.pixels("energy").std(axis=(0, 1)) > 0).all())

    def test_hidden_while_it_reads_many_samples(self):
        file = write(self.folder / "chain.h5")
        with h5py.File(file, "r+") as data:
            for samples in data["scalars"].values():
                samples.resize(20001, axis=0)
        script = self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument",
                                             {"source": HIDDEN})
        self.addCleanup(self.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument",
                        script)
        self.open(file)
        self.wait(lambda: self.driver.execute_script(ASKED) == 2)

    def shown_at_last(self, still=3, seconds=60):
        """Waits until the shown frame has not changed for `still` seconds, and returns its
        number."""
        begin = changed = time.monotonic()
        shown = self.shown()
        while time.monotonic() < changed + still:
            self.assertLess(time.monotonic(), begin + seconds)
            if self.shown() != shown:
                shown, changed = self.shown(), time.monotonic()
            time.sleep(0.05)
        return shown

    def test_a_run_that_it_started(self):
        (self.folder / "scene.toml").write_text(LONG_SCENE)
        self.open("scene.toml")
        self.assertIn("random", self.element("scene").get_attribute("textContent"))
        self.wait(lambda: self.shown() > 2)  # the page shows new frames by itself
        self.element("pause").click()
        self.wait(lambda: self.element("state").text == "paused")
        shown = self.shown_at_last()  # the frames written so far appear
        self.assertEqual(self.element("pause").text, "Go on")
        self.element("pause").click()
        self.wait(lambda: self.shown() > shown)
        self.go_to(1)
        time.sleep(3)
        self.assertEqual(self.shown(), 1)  # the page stays at a chosen frame
        self.element("stop").click()
        self.wait(lambda: self.element("state").text == "ended early")
        self.wait(lambda: not self.element("pause").is_displayed())
        self.assertIn("interrupted", self.element("message").text)


class Large(Browser):
    def test_a_million_spins(self):
        spins = random_spins(4, 1, 1000, 1000).astype(np.float32)
        file = write(self.folder / "large.h5")
        with h5py.File(file, "r+") as data:
            rows = [[data[name][i] for name in ("time", "energy", "norm_defect")] +
                    list(data["magnetization"][i]) for i in range(4)]
            data["checksum"][:4] = [checksum.of_frame(i, rows[i], spins[i]) for i in range(4)]
            del data["spins"]
            data.create_dataset("spins", data=spins, chunks=(1, *spins.shape[1:]))
        start = time.monotonic()
        self.open(file)
        first = time.monotonic() - start
        rate = self.driver.execute_async_script(RATE, 4000)
        print(f"{self.driver.execute_script(RENDERER)}: 1e6 spins after {first:.2f} s, then "
              f"{rate:.1f} frames/s")
        self.go_to(2)
        pixels = self.pixels()
        colors = np.round(255 * hue_colors(spins[2, 0])).astype(int)[::-1]
        y, x = ((np.arange(count) + 0.5) / count * 1000 for count in pixels.shape[:2])
        away = abs(pixels - colors[np.ix_(y.astype(int), x.astype(int))]).max(-1)
        self.assertLess((away > 4).mean(), 0.1)


if __name__ == "__main__":
    if not has_browser():
        print("skipped: it takes chromium, chromium-driver and python3-selenium")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
