#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The pages of pictures: every scene passes `cayspin check`, pictures are small, and some are drawn
again.

Usage: gallery_test.py PROGRAM
"""
import pathlib
import re
import shlex
import sys
import tempfile
import unittest

import h5py  # noqa: F401  the pictures need it
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

import gallery  # noqa: E402  python/gallery.py

QUICK = ("skyrmion", "spin_flop", "crystal_and_bonds")


class Gallery(unittest.TestCase):
    def setUp(self):
        page = gallery.PAGES[0]
        self.sections = gallery.SECTION.findall(page.read_text(encoding="utf-8"))
        self.gallery = gallery.scenes(page)
        self.scenes = self.gallery | gallery.scenes(gallery.PAGES[1])

    def test_has_twelve_scenes_with_their_time(self):
        self.assertEqual(len(self.gallery), 12)
        for section in self.sections:
            self.assertRegex(section.partition("```")[0], r"\b[\d.]+ s\.\n$")

    def test_scenes_pass_the_check(self):
        for name, (scene, commands) in self.scenes.items():
            checked = 0
            with gallery.workspace(self.program) as (folder, environment):
                if scene:
                    (folder / f"{name}.toml").write_text(scene, encoding="utf-8")
                for command in commands[:-1]:
                    # Only `check` is run, so files that earlier commands would write are missing.
                    words = [word for word in shlex.split(command) if "--output" != word]
                    words = [word for word in words if not word.endswith(".h5")]
                    while "--set" in words and "file" in words[words.index("--set") + 1]:
                        del words[words.index("--set"):words.index("--set") + 2]
                    self.assertIn(words[1], ("run", "relax"), command)
                    gallery.run(shlex.join(["cayspin", "check", *words[2:]]), folder, environment)
                    checked += 1
            self.assertGreaterEqual(checked, 1, name)

    def test_commands_are_those_of_the_page_and_its_scenes(self):
        for section, (name, (_, commands)) in zip(self.sections, self.gallery.items()):
            scene = re.search(r"\]\(\.\./(scenes/\w+\.toml)\)", section).group(1)
            self.assertIn(scene, commands[-2], name)
            self.assertRegex(commands[-1], r"^(cayspin plot|python3 python/plot_trajectory\.py) ")

    def test_pictures_are_small(self):
        for name in self.scenes:
            picture = ROOT / f"docs/images/gallery_{name}.png"
            self.assertLessEqual(picture.stat().st_size, gallery.BYTES, name)
            with Image.open(picture) as image:
                self.assertEqual(image.width, gallery.WIDTH, name)

    def test_quick_scenes_are_drawn(self):
        with tempfile.TemporaryDirectory() as name:
            for scene in QUICK:
                gallery.draw(scene, *self.scenes[scene], self.program, pathlib.Path(name))
                with Image.open(f"{name}/gallery_{scene}.png") as image:
                    self.assertGreater(len(image.convert("RGB").getcolors(1 << 20)), 100)


if __name__ == "__main__":
    Gallery.program = pathlib.Path(sys.argv.pop(1))
    unittest.main()
