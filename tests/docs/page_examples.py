#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Runs the examples of the README, the guide and three reference pages, each page in a new folder.

Usage: page_examples.py PROGRAM, with the package cayspin on PYTHONPATH
Blocks of `cayspin` and `python3` commands are run, and a block of output after them is compared.
In a block of `console`, lines that begin with `$ ` are run and may fail; they have to print the
other lines, where `...` stands for any text.
Blocks of Python are run as one script after the commands: `print(...)  # text` has to print the
text, and blocks of output after Python have to be printed, too. Scenes are checked. A
scene is saved under the name in the sentence before it, or as scene.toml; the keys of a block
without [system] are set in that scene. A page without any of these has to name a program of
examples/ that is built and tested. Each block of C++ in a tutorial has to be part of a program that
the tutorial names.
"""
import collections
import glob
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

import gallery  # noqa: E402  python/gallery.py

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
SAVED = re.compile(r"Save this as\s`(\w+\.toml)`:\s*\Z")
PRINTED = re.compile(r"^ *print\(.*\)  # ([^;:\n]+)", re.MULTILINE)
KEY = re.compile(r"^(\w+) = (.*?)\s*(?:# .*)?$", re.MULTILINE)
TESTED = re.compile(r"examples/(?:\d\d_\w+\.cpp|c_and_fortran|ranks/main\.cpp)\)")
PROGRAM = re.compile(r"examples/\d\d_\w+\.cpp")
REFERENCE = ("conventions", "field_terms", "methods")


def pages():
    """Returns the pages to run. Pages of pictures are left to gallery_test.py."""
    guide = sorted(map(pathlib.Path, glob.glob(str(ROOT / "docs/guide/*.md"))))
    return [ROOT / "README.md"] + [
        page for page in guide if page.name != "what_a_scene_can_hold.md"] + [
        ROOT / f"docs/reference/{name}.md" for name in REFERENCE]


def commands_of(block):
    """Returns a block's commands, or none if one needs more than built programs (a browser)."""
    commands = block.replace("\\\n", " ").splitlines()
    runs_here = all(command.startswith(("cayspin ", "python3 ")) and
                    not command.startswith("cayspin view ") for command in commands)
    return commands if runs_here else []


class Examples(unittest.TestCase):
    def run_scene(self, block, saved, folder, environment):
        name, overrides = saved[1] if saved else "scene.toml", ""
        if "[system]" in block:
            (folder / name).write_text(block, encoding="utf-8")
        else:
            overrides = "".join(f" --set '{key}={value}'" for key, value in KEY.findall(block))
        return gallery.run(f"cayspin check {name}{overrides}", folder, environment)

    def run_console(self, block, folder, environment):
        lines = block.splitlines()
        commands = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
        output = "".join(gallery.run(f"{{ {command}; }} 2>&1; true", folder, environment)
                         for command in commands)
        for line in lines:
            if not line.startswith("$ "):
                self.assertRegex(output, re.escape(line).replace(r"\.\.\.", ".+"))
        return len(commands)

    def run_python(self, blocks, expected, folder, environment):
        script = "\n".join(blocks)
        (folder / "page.py").write_text(script, encoding="utf-8")
        printed = map(str.strip, gallery.run("python3 page.py", folder, environment).splitlines())
        wanted = map(str.strip, [*PRINTED.findall(script), *expected])
        self.assertFalse(collections.Counter(wanted) - collections.Counter(printed))

    def examples_run(self, page, program):
        text, count, output, scripts = page.read_text(encoding="utf-8"), 0, "", []
        before, expected = "", []  # the language of the block before; what Python has to print
        with gallery.workspace(program) as (folder, environment):
            for match in BLOCK.finditer(text):
                language, block = match.groups()
                if language == "sh":
                    commands = commands_of(block)
                    output = "".join(gallery.run(f"{command} 2>&1", folder, environment)
                                     for command in commands)
                    count += len(commands)
                elif language == "console":
                    count += self.run_console(block, folder, environment)
                elif language == "" and before == "python":
                    expected += block.splitlines()
                elif language == "" and output:
                    for line in block.splitlines():
                        self.assertIn(line, output)
                elif language == "toml":
                    saved = SAVED.search(text, 0, match.start())
                    self.run_scene(block, saved, folder, environment)
                    count += 1
                elif language == "python":
                    scripts.append(block)
                before = language
            if scripts:
                self.run_python(scripts, expected, folder, environment)
        return count + len(scripts)

    def test_code_of_tutorials_is_that_of_examples(self):
        for page in ROOT.glob("docs/guide/tutorial_*.md"):
            text = page.read_text(encoding="utf-8")
            programs = [" ".join((ROOT / name).read_text(encoding="utf-8").split())
                        for name in set(PROGRAM.findall(text))]
            for language, block in BLOCK.findall(text):
                code = " ".join(block.split())
                if language == "cpp" and not any(code in program for program in programs):
                    self.fail(f"{page.name}: not in an example that it names:\n{block}")

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
