#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs the examples of the guide and of three pages of the reference, each page in its own folder.

Usage: page_examples.py PROGRAM, with the package cayspin on PYTHONPATH
Blocks of `cayspin` and `python3` commands are run, and a block of output after them is compared.
Blocks of Python are run as one script: `print(...)  # text` has to print the text. Scenes are
checked; keys alone are set in the scene before. Other pages name a program of examples/ that is
built and tested.
"""
import glob
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

import gallery  # noqa: E402  python/gallery.py

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PRINTED = re.compile(r"^ *print\(.*\)  # ([^;:\n]+)", re.MULTILINE)
KEY = re.compile(r"^(\w+) = (.*?)\s*(?:# .*)?$", re.MULTILINE)
TESTED = re.compile(r"examples/(?:\d\d_\w+\.cpp|c_and_fortran|ranks/main\.cpp)\)")
REFERENCE = ("conventions", "field_terms", "methods")


def pages():
    guide = glob.glob(str(ROOT / "docs/guide/*.md"))
    return sorted(map(pathlib.Path, guide)) + [
        ROOT / f"docs/reference/{name}.md" for name in REFERENCE]


def commands_of(block):
    """The commands of a block, or none where one needs more than a built program, as a browser."""
    commands = block.replace("\\\n", " ").splitlines()
    runs_here = all(command.startswith(("cayspin ", "python3 ")) and
                    not command.startswith("cayspin view ") for command in commands)
    return commands if runs_here else []


class Examples(unittest.TestCase):
    def run_scene(self, block, folder, environment):
        scene, overrides = folder / "scene.toml", ""
        if "[system]" in block:
            scene.write_text(block, encoding="utf-8")
        else:
            overrides = "".join(f" --set '{key}={value}'" for key, value in KEY.findall(block))
        return gallery.run(f"cayspin check scene.toml{overrides}", folder, environment)

    def run_python(self, blocks, folder, environment):
        script = "\n".join(blocks)
        (folder / "page.py").write_text(script, encoding="utf-8")
        printed = gallery.run("python3 page.py", folder, environment).splitlines()
        for text in PRINTED.findall(script):
            self.assertIn(text.strip(), printed)

    def examples_run(self, page, program):
        text, count, output, scripts = page.read_text(encoding="utf-8"), 0, "", []
        with gallery.workspace(program) as (folder, environment):
            for language, block in BLOCK.findall(text):
                if language == "sh":
                    commands = commands_of(block)
                    output = "".join(gallery.run(f"{command} 2>&1", folder, environment)
                                     for command in commands)
                    count += len(commands)
                elif language == "" and output:
                    for line in block.splitlines():
                        self.assertIn(line, output)
                elif language == "toml":
                    self.run_scene(block, folder, environment)
                    count += 1
                elif language == "python":
                    scripts.append(block)
            if scripts:
                self.run_python(scripts, folder, environment)
        return count + len(scripts)

    def test_every_page_has_one_that_runs(self):
        for page in pages():
            with self.subTest(page.name):
                ran = self.examples_run(page, self.program)
                tested = TESTED.findall(page.read_text(encoding="utf-8"))
                print(f"{page.name:24} {ran} run here, {len(set(tested))} tested in examples/")
                self.assertGreater(ran + len(tested), 0, "no example that a test runs")


if __name__ == "__main__":
    Examples.program = pathlib.Path(sys.argv.pop(1))
    unittest.main()
