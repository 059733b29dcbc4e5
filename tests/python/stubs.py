# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""The stubs of _cayspin name what the module has, and every public name has a docstring."""

import ast
import inspect
import pathlib
import unittest

import cayspin
from cayspin import _cayspin


def public(names):
    return {name for name in names if not name.startswith("_")}


class Stubs(unittest.TestCase):
    def test_names(self):
        folder = pathlib.Path(cayspin.__file__).parent
        self.assertTrue((folder / "py.typed").is_file())
        tree = ast.parse((folder / "_cayspin.pyi").read_text(encoding="utf-8"))
        stubs = {}
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                stubs[node.name] = public(part.name for part in node.body
                                          if isinstance(part, ast.FunctionDef))
            elif isinstance(node, ast.AnnAssign):
                stubs[node.target.id] = None
        module = {}
        for name in public(vars(_cayspin)):
            thing = getattr(_cayspin, name)
            own = isinstance(thing, type) and not issubclass(thing, Exception)
            module[name] = public(vars(thing)) if own else (
                set() if isinstance(thing, type) else None)
        self.assertEqual(stubs, module)

    def test_docstrings(self):
        for name in cayspin.__all__:
            thing = getattr(cayspin, name)
            if name == "__version__" or issubclass(type(thing), type) and issubclass(
                    thing, Exception):
                continue
            self.assertTrue(thing.__doc__, name)
            if inspect.isclass(thing):
                for key in public(vars(thing)):
                    member = getattr(thing, key)
                    if callable(member) or isinstance(member, property):
                        self.assertTrue(member.__doc__, f"{name}.{key}")


if __name__ == "__main__":
    unittest.main()
