#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The reference page of the Python package is up to date, and docstrings say what users need."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))

import python_api  # noqa: E402  docs/site/python_api.py

SHAPE = re.compile(r"\((?:\.\.\.|\w+)(?:, \w+)*(?:, \.\.\.)?,?\)")
UNIT = re.compile(r"\bunits?\b|\bSI\b|\bseconds?\b|\bradians?\b|\brad\b|\brelative\b|\bangular\b"
                  r"|\bdimensionless\b", re.IGNORECASE)
PAGE = "docs/reference/python_api.md"


def faults_of(name, member):
    """Returns the faults of a docstring. A class's has to name the constructor's parameters."""
    doc = " ".join(member.doc.split())
    if not doc:
        return [f"{name}: no docstring"]
    found = []
    if member.arguments:
        arguments = member.arguments
        named = arguments.posonlyargs + arguments.args + arguments.kwonlyargs
        found += [f"{name}: `{one.arg}` is not described" for one in named
                  if one.arg not in ("self", "cls") and f"`{one.arg}`" not in doc]
        others = [one.arg for one in (arguments.vararg, arguments.kwarg) if one]
        found += [f"{name}: {one} are not described" for one in others if one not in doc.lower()]
    if (member.parameters or member.raises) and not re.search(r"\bRaises [A-Z]\w+", doc):
        found.append(f"{name}: no errors")
    if "np.ndarray" in member.type and not SHAPE.search(doc):
        found.append(f"{name}: no shape")
    if re.search(r"\bfloat\b", member.type) and not UNIT.search(doc):
        found.append(f"{name}: no unit")
    return found


def faults(things):
    found = []
    for thing in things:
        found += faults_of(thing.name, thing)
        for member in thing.members:
            found += faults_of(f"{thing.name}.{member.name}", member)
    return found


class PythonApi(unittest.TestCase):
    maxDiff = None

    def test_the_page_is_that_of_the_docstrings(self):
        text = (ROOT / PAGE).read_text(encoding="utf-8")
        self.assertEqual(text, python_api.page(), "write it: python3 docs/site/python_api.py > "
                         + PAGE)

    def test_every_public_name_is_there_once(self):
        listed = [name for names in python_api.GROUPS.values() for name in names]
        public = python_api.public_names()
        self.assertEqual(sorted(set(listed) - {"texture.draw"}), sorted(public))
        self.assertEqual(len(listed), len(set(listed)))

    def test_docstrings_say_parameters_shapes_units_and_errors(self):
        found = faults([thing for things in python_api.things().values() for thing in things])
        self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main()
