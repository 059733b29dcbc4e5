# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""cayspin.view: the page of a file in a notebook."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import unittest
import urllib.request
from unittest import mock

import cayspin
from package_test import PackageTest, scene


def answer(address):
    return urllib.request.urlopen(address, timeout=20)


class Views(PackageTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "run.h5"
        cayspin.Simulation(scene(output={"every": 20})).run(output=self.file)

    def test_a_file(self):
        view = cayspin.view(self.file)
        self.addCleanup(view.close)
        self.assertIn(f'<iframe src="{view.address}"', view._repr_html_())
        with answer(view.address) as page:
            self.assertIn(b"<canvas", page.read())
            self.assertIn("frame-ancestors http://127.0.0.1:* http://localhost:*",
                          page.headers["Content-Security-Policy"])
        sim = cayspin.Simulation(scene())  # may run while the page is open
        sim.run(output=self.folder / "other.h5")
        view.close()
        view.close()
        self.assertRaises(OSError, answer, view.address)

    def test_other_files(self):
        self.assert_refused(cayspin.CayspinError, "none.h5: there is no such file", cayspin.view,
                            self.folder / "none.h5")
        self.assert_refused(cayspin.CayspinError, "the name of a file", cayspin.view, 3)
        text = self.folder / "-text.h5"
        text.write_text("text\n")
        self.assert_refused(cayspin.CayspinError, "cannot be read", cayspin.view, text)

    def test_a_scene_and_a_kernel_that_is_killed(self):
        output = self.folder / "long.h5"
        endless = scene(integrator={"steps": 1000000000}, output={"every": 1000,
                                                                  "file": str(output)})
        file = self.written(endless)
        kernel = subprocess.run(
            [sys.executable, "-B", "-c", "import cayspin, os, sys\n"
             "print(cayspin.view(sys.argv[1]).address, flush=True)\nos.kill(os.getpid(), 9)", file],
            capture_output=True, text=True)
        self.assertTrue(kernel.stdout.startswith("http://127.0.0.1:"), kernel.stderr)
        end = time.monotonic() + 20
        while True:
            try:
                with cayspin.open(output) as run:  # no run writes it any more
                    self.assertFalse(run.complete)
                    break
            except cayspin.CayspinError as error:
                self.assertLess(time.monotonic(), end, error)
                time.sleep(0.1)
        self.assertRaises(OSError, answer, kernel.stdout.strip())

    def test_an_interrupt_before_the_page_starts_ends_the_run(self):
        started, program = self.folder / "started", self.folder / "program"
        program.write_text(f"#!/bin/sh\necho $$ > '{started}.new'\nmv '{started}.new' '{started}'\n"
                           "exec sleep 60\n")
        program.chmod(0o755)

        def interrupt():
            while not started.exists():
                time.sleep(0.05)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=interrupt, daemon=True).start()
        file = self.written(scene(output={"file": str(self.folder / "never.h5")}))
        with mock.patch.dict(os.environ, CAYSPIN_PROGRAM=str(program)):
            self.assertRaises(KeyboardInterrupt, cayspin.view, file)
        self.assertRaises(ProcessLookupError, os.kill, int(started.read_text()), 0)

    def test_the_package_has_the_page(self):
        folder = pathlib.Path(cayspin.__file__).parent / "view" / "page"
        self.assertEqual({file.name for file in folder.iterdir()},
                         {"index.html", "page.js", "spins.js", "lines.js", "page.css", "icon.svg"})


if __name__ == "__main__":
    unittest.main()
