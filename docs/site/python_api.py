#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Prints docs/reference/python_api.md, the reference of the Python package, from its sources.

Usage: python3 docs/site/python_api.py > docs/reference/python_api.md
It needs neither the compiled package nor NumPy.
"""

import ast
import dataclasses
import inspect
import pathlib
import re
import textwrap
from typing import Dict, List, Optional

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python/cayspin"
WIDTH = 100

GROUPS = {
    "Scenes and simulations": ["Scene", "Simulation", "Minimum", "Modes", "Bands", "Averages", "path",
                               "MinimumEnergyPath", "EnsembleSimulation", "sweep"],
    "Choosing a method": ["advise", "Advice", "trade", "Trade"],
    "Files and pictures": ["open", "Trajectory", "Ensemble", "read_modes", "texture.draw", "view", "View"],
    "Numbers from spins": ["topological_charge", "dispersion", "Dispersion", "structure_factor",
                           "linear_structure_factor", "StructureFactor", "average", "Average"],
    "Input": ["occupied_of_mesh", "read_uppasd", "read_spirit_pairs"],
    "Errors and version": ["CayspinError", "SceneError", "NumbersFailed", "__version__"],
}
CONSTRUCTED = ("Scene", "Simulation", "EnsembleSimulation")  # instances of others are only received

HEAD = """# Python API

Every public name of the package `cayspin`; the [guide](../guide/python.md) has examples. Arrays are
NumPy's and spins (nz, ny, nx, 3), of a crystal with several sites in a cell (site, nz, ny, nx, 3).
Numbers are in the [units](../guide/units.md) of the scene. A wrong call raises `CayspinError`,
whose message is one line; entries name other errors.

`python3 docs/site/python_api.py` makes this page from the docstrings.
"""


@dataclasses.dataclass
class Member:
    """A function, method, property or field."""

    name: str
    kind: str
    doc: str
    type: str  # of a field or property; of a function or method, what it returns
    arguments: Optional[ast.arguments] = None
    parameters: Optional[List[str]] = None  # as written in the source
    raises: bool = False


@dataclasses.dataclass
class Thing(Member):
    """A public name of the package."""

    members: List[Member] = dataclasses.field(default_factory=list)
    base: str = ""


class Module:
    """A Python source file and its top-level functions, classes and annotated names."""

    def __init__(self, path):
        self.source = path.read_text(encoding="utf-8")
        self.lines = self.source.splitlines()
        self.tree = ast.parse(self.source)
        self.definitions = {}
        for node in self.tree.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                self.definitions[node.name] = node
            elif isinstance(node, ast.AnnAssign):
                self.definitions[node.target.id] = node

    def text(self, node):
        return " ".join(ast.get_source_segment(self.source, node).split()) if node else ""

    def comment(self, node):
        """Returns the text of the `#: ..` behind a field; if there is none, of those above it."""
        behind = self.lines[node.end_lineno - 1].partition("#:")[2].strip()
        above = []
        for line in reversed(self.lines[:node.lineno - 1]):
            if not line.lstrip().startswith("#:"):
                break
            above.insert(0, line.partition("#:")[2].strip())
        return behind or " ".join(above)

    def parameters(self, arguments):
        """Returns the parameters as they are written, without self and cls."""
        def one(argument, default, stars=""):
            text = stars + argument.arg
            if argument.annotation:
                text += f": {self.text(argument.annotation)}"
            if default:
                text += (" = " if argument.annotation else "=") + self.text(default)
            return text

        places = arguments.posonlyargs + arguments.args
        defaults = [None] * (len(places) - len(arguments.defaults)) + arguments.defaults
        found = [one(*pair) for pair in zip(places, defaults)
                 if pair[0].arg not in ("self", "cls")]
        if arguments.vararg:
            found.append(one(arguments.vararg, None, "*"))
        elif arguments.kwonlyargs:
            found.append("*")
        found += [one(*pair) for pair in zip(arguments.kwonlyargs, arguments.kw_defaults)]
        if arguments.kwarg:
            found.append(one(arguments.kwarg, None, "**"))
        return found

    def function(self, node, kind):
        raises = any(isinstance(part, ast.Raise) for part in ast.walk(node))
        return Member(node.name, kind, ast.get_docstring(node) or "", self.text(node.returns),
                      node.args, self.parameters(node.args), raises)

    def members(self, node):
        for part in node.body:
            if isinstance(part, ast.AnnAssign) and not part.target.id.startswith("_"):
                yield Member(part.target.id, "field", self.comment(part),
                             self.text(part.annotation))
            if not isinstance(part, ast.FunctionDef):
                continue
            decorators = [self.text(one) for one in part.decorator_list]
            if part.name == "__init__":
                for inner in ast.walk(part):
                    target = getattr(inner, "target", None)
                    if isinstance(inner, ast.AnnAssign) and not target.attr.startswith("_"):
                        yield Member(target.attr, "field", self.comment(inner),
                                     self.text(inner.annotation))
            elif part.name == "__len__":
                yield self.function(part, "length")
            elif not part.name.startswith("_") and not any(
                    one.endswith(".setter") for one in decorators):
                yield self.function(part, "property" if "property" in decorators else "method")

    def thing(self, name, public_name):
        node = self.definitions[name]
        if isinstance(node, ast.FunctionDef):
            return Thing(**{**vars(self.function(node, "function")), "name": public_name})
        if isinstance(node, ast.AnnAssign):
            return Thing(public_name, "value", self.comment(node), self.text(node.annotation))
        made = Thing(public_name, "class", ast.get_docstring(node) or "", "",
                     members=list(self.members(node)),
                     base=self.text(node.bases[0]) if node.bases else "")
        for part in node.body:
            if isinstance(part, ast.FunctionDef) and part.name == "__init__" \
                    and public_name in CONSTRUCTED:
                made.arguments, made.parameters = part.args, self.parameters(part.args)
                made.raises = True
        return made


def imports(path):
    """Returns {public name: (file of the module, name there)} of an __init__.py."""
    found = {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.module != "__future__":
            *_, last = node.module.split(".")
            file = next(file for file in (path.parent / f"{last}.py", path.parent / f"{last}.pyi",
                                          path.parent / last / "__init__.py") if file.exists())
            found.update({one.asname or one.name: (file, one.name) for one in node.names})
    return found


def public_names():
    """Returns the names in cayspin.__all__."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    return next(ast.literal_eval(node.value) for node in tree.body
                if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")


def things() -> Dict[str, List[Thing]]:
    """Returns the public names of each group."""
    modules, packages = {}, {"": imports(PACKAGE / "__init__.py"),
                             "texture": imports(PACKAGE / "texture/__init__.py")}
    found = {}
    for group, names in GROUPS.items():
        found[group] = []
        for name in names:
            package, _, last = name.rpartition(".")
            file, there = packages[package][last]
            modules.setdefault(file, Module(file))
            found[group].append(modules[file].thing(there, name))
    return found


def markdown(doc):
    """Returns a docstring as Markdown: indented blocks as code, named pages as links."""
    doc = re.sub(r"docs/reference/(\w+\.md)", r"[\1](\1)", doc)
    lines, block = [], []
    for line in [*inspect.cleandoc(doc).split("\n"), "end"]:
        if line.startswith("    ") or (block and not line):
            block.append(line[4:])
            continue
        if block:
            code = "\n".join(block).rstrip()
            lines += ["```python", *code.split("\n"), "```", ""]
            block = []
        lines.append(line)
    return "\n".join(lines[:-1]).rstrip()


def signature(name, parameters, returns):
    end = f") -> {returns}" if returns else ")"
    line = f"{name}({', '.join(parameters)}{end}"
    if len(line) > WIDTH:
        rows = textwrap.wrap(", ".join(one.replace(" ", "\0") for one in parameters), WIDTH - 4,
                             break_long_words=False, break_on_hyphens=False)
        inner = "\n".join("    " + row for row in rows).replace("\0", " ")
        line = f"{name}(\n{inner}{end}"
    return f"```python\n{line}\n```"


def bullet(member, owner):
    name = f"len({owner.lower()})" if member.kind == "length" else member.name
    type_ = f" (`{member.type}`)" if member.type else ""
    paragraphs = inspect.cleandoc(member.doc).split("\n\n")
    text = [f"`{name}`{type_}: {paragraphs[0]}", *paragraphs[1:]]
    return "\n\n".join(
        textwrap.fill(" ".join(one.split()), WIDTH, initial_indent="- " if n == 0 else "  ",
                      subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
        for n, one in enumerate(text))


def entry(thing):
    """Returns the section of a public name, as a list of its parts."""
    if thing.kind == "value":
        return [f"### `{thing.name}`", f"`{thing.type}`: {thing.doc}"]
    if thing.kind == "function":
        return [f"### `{thing.name}()`",
                signature(f"cayspin.{thing.name}", thing.parameters, thing.type),
                markdown(thing.doc)]
    parts = [f"### class `{thing.name}`"]
    if thing.arguments:
        parts.append(signature(f"cayspin.{thing.name}", thing.parameters, ""))
    elif thing.base:
        parts.append(f"```python\nclass cayspin.{thing.name}({thing.base})\n```")
    parts.append(markdown(thing.doc))
    values = [member for member in thing.members if member.kind != "method"]
    parts.append("\n".join(bullet(member, thing.name) for member in values))
    for member in thing.members:
        if member.kind == "method":
            name = f"{thing.name}.{member.name}"
            parts += [f"#### `{name}()`", signature(name, member.parameters, member.type),
                      markdown(member.doc)]
    return [part for part in parts if part]


def slug(thing):
    return "-".join(re.findall(r"\w+", f"class {thing.name}" if thing.kind == "class"
                               else thing.name.replace(".", ""))).lower()


def page():
    parts = [HEAD.rstrip()]
    groups = things()
    for group, names in groups.items():
        links = ", ".join(f"[`{thing.name}`](#{slug(thing)})" for thing in names)
        parts.append(textwrap.fill(f"- {group}: {links}", WIDTH, subsequent_indent="  ",
                                   break_long_words=False, break_on_hyphens=False))
    text = parts[0] + "\n\n" + "\n".join(parts[1:]) + "\n\n"
    sections = []
    for group, names in groups.items():
        sections.append(f"## {group}")
        for thing in names:
            sections += entry(thing)
    return text + "\n\n".join(sections) + "\n"


if __name__ == "__main__":
    print(page(), end="")
