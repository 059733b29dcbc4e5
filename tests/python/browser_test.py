# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""A browser that shows pages of `cayspin view` to tests."""

import io
import shutil
import time

import matplotlib.image
import numpy as np
from script_test import ScriptTest
from view_test import Page

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.support.ui import Select
except ImportError:
    webdriver = None

FLAGS = ("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--window-size=1200,900",
         "--force-device-scale-factor=1")


def has_browser():
    return webdriver and shutil.which("chromium") and shutil.which("chromedriver")


class Browser(ScriptTest):
    @classmethod
    def setUpClass(cls):
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for flag in FLAGS:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        service = webdriver.chrome.service.Service(shutil.which("chromedriver"))
        cls.driver = webdriver.Chrome(service=service, options=options)
        cls.addClassCleanup(cls.driver.quit)
        cls.driver.set_script_timeout(60)

    def open(self, *arguments):
        page = Page(self, *arguments)
        self.driver.get(page.address)
        self.wait(lambda: self.shown() is not None)
        return page

    def tearDown(self):
        errors = [entry["message"] for entry in self.driver.get_log("browser")]
        self.driver.get("about:blank")
        for command, options in (("clearDeviceMetricsOverride", {}),
                                 ("setEmulatedMedia", {"features": []})):
            self.driver.execute_cdp_cmd(f"Emulation.{command}", options)
        self.assertEqual(errors, [])

    def wait(self, what, seconds=20):
        end = time.monotonic() + seconds
        while not what():
            self.assertLess(time.monotonic(), end, self.element("message").text)
            time.sleep(0.02)

    def element(self, name):
        return self.driver.find_element("id", name)

    def shown_text(self):
        return self.driver.execute_script("return document.body.dataset.shown") or ""

    def shown(self):
        """Returns the number of the frame that is drawn."""
        return int(self.shown_text().split()[0]) if self.shown_text() else None

    def pull(self, slider, value):
        self.driver.execute_script(
            "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))",
            self.element(slider), value)

    def select(self, name, value):
        Select(self.element(name)).select_by_value(value)

    def go_to(self, frame):
        self.pull("frame", frame)
        self.wait(lambda: self.shown() == frame)

    def pixels(self, canvas="spins"):
        png = matplotlib.image.imread(io.BytesIO(self.element(canvas).screenshot_as_png))
        return np.round(255 * png[..., :3]).astype(int)

    def assert_colors(self, expected, tolerance=4):
        """Compares the colours in the middle of cells; `expected` has rows from the bottom up."""
        pixels, (rows, columns) = self.pixels(), expected.shape[:2]
        up, right = ((np.arange(count) + 0.5) / count for count in (rows, columns))
        found = pixels[np.ix_((pixels.shape[0] * (1 - up)).astype(int),
                              (pixels.shape[1] * right).astype(int))]
        off = abs(found - 255 * expected).max()
        self.assertLessEqual(off, tolerance, f"off by {off} of 255")

    def click_cell(self, column, row, columns, rows):
        canvas = self.element("spins")
        width, height = canvas.size["width"], canvas.size["height"]
        ActionChains(self.driver).move_to_element_with_offset(
            canvas, round((column + 0.5) / columns * width - width / 2),
            round(height / 2 - (row + 0.5) / rows * height)).click().perform()
