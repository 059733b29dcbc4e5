# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Checks includes against the layers: check_layers.py ROOT, or check_layers.py --self-test."""

import pathlib
import re
import sys
import tempfile

# Lowest layer first. A header may include headers of its own layer and of the layers listed before
# it. Patterns are relative to include/cayspin, and "folder/" matches all files below it. The first
# matching pattern decides.
LIBRARY = [
    ("numbers", ["vec3.hpp", "units.hpp", "detail/backend.hpp", "detail/pack.hpp", "detail/unrolled.hpp"]),
    ("lattice", ["lattice.hpp", "lattice/", "part.hpp", "row_layout.hpp", "crystal.hpp", "coupling.hpp", "shells.hpp"]),
    ("loops over sites", ["detail/"]),
    ("spins", ["replicas.hpp", "spin_field.hpp", "stencil.hpp"]),
    ("contracts", ["concepts.hpp", "checkpoint.hpp", "optional_members.hpp", "step.hpp", "field/parts.hpp"]),
    ("field terms", ["field/"]),
    ("demagnetization", ["demagnetization/"]),
    ("generators", ["generator/"]),
    ("rotations", ["rotation/"]),
    ("isotropies", ["isotropy/", "isotropy.hpp"]),
    ("reductions", ["scalars.hpp", "evaluate.hpp"]),
    ("solvers", ["solver/"]),
    ("stages", ["stage/"]),
    ("stability", ["stability.hpp"]),
    ("steppers", ["stepper/"]),
    ("time", ["integrate.hpp", "serialize.hpp"]),
    ("observers", ["observer/"]),
    ("minimisers", ["minimizer/", "minimize.hpp", "path/", "minimum_energy_path.hpp",
                    "lowest_escape.hpp"]),
    ("modes", ["modes/", "modes.hpp"]),
    ("everything", ["cayspin.hpp"]),
    ("ranks", ["mpi/"]),
]

# Layers of the code built on the library. Patterns are relative to the repository.
PROGRAMS = [
    ("list of methods", ["src/io/method.hpp", "src/io/words.hpp", "src/simulation/method_list.hpp"]),  # data that all others read
    ("the paper's steppers", ["paper/include/"]),  # headers that need only the library
    ("reader and writer", ["src/scene/", "src/trajectory/", "src/hdf5/", "src/ovf/", "src/files/",
                           "src/io/"]),
    ("simulation", ["src/simulation/"]),
    ("C interface", ["src/c_interface/"]),
    ("program", ["src/program/"]),
    ("paper", ["paper/"]),
]

# No header in detail/ is named after physics.
PHYSICS = ("anisotropy damping demag energy exchange field flow generator isotropy newton observer "
           "rotation sigma spin stability stepper tableau zeeman").split()

# Macros of compilers, processors and devices, and the headers that may test them.
BACKEND_MACRO = re.compile(r"\bKOKKOS_(?:ENABLE|ARCH)_\w+|"
                           r"\b__(?:CUDA|HIP|SYCL|NVCC|GNUC|clang|x86|FMA|AVX|SSE|ARM|aarch)\w*")
BACKEND_HEADERS = ("/detail/backend.hpp", "/detail/execution.hpp",
                   "/demagnetization/device_transforms.hpp")

# Folders in which a file included in quotes may lie, in addition to the folder of the including
# file; and files that the build writes.
INCLUDE_FOLDERS = ["src", "src/io", "src/simulation", "paper", "tests"]
GENERATED = {"cayspin_git_commit.hpp", "cayspin/version.hpp"}
PUBLIC_FOLDERS = {"cayspin/": "include", "cayspin_paper/": "paper/include"}

SOURCE_FOLDERS = ["include", "src", "paper", "tests", "bench", "examples", "demo"]
VERSION = re.compile(r"^project\(cayspin VERSION (\d+)\.(\d+)", re.M)
NAMESPACE = re.compile(r"^namespace (cayspin(?:::inline \w+)?)", re.M)
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<(cayspin[a-z_]*/[^>]+)>|"([^"]+)")', re.MULTILINE)


def layer_of(layers, name):
    """Returns the index and the name of the layer, or None."""
    for index, (layer, patterns) in enumerate(layers):
        if any(name == p or (p.endswith("/") and name.startswith(p)) for p in patterns):
            return index, layer
    return None


class Tree:
    """The sources below a folder and what each of them includes."""

    def __init__(self, root):
        self.root = root
        self.problems = []
        self.includes = {}
        files = [path for folder in SOURCE_FOLDERS for path in (root / folder).rglob("*")
                 if path.suffix in (".hpp", ".cpp")]
        for path in sorted(files):
            found = INCLUDE.findall(path.read_text(encoding="utf-8"))
            self.includes[self.name(path)] = [self.resolve(path, *pair) for pair in found]

    def name(self, path):
        return path.relative_to(self.root).as_posix()

    def resolve(self, path, public, quoted):
        """Returns the name of the included file; None if the build writes it or it is missing."""
        if (public or quoted) in GENERATED:
            return None
        if public:
            folder = PUBLIC_FOLDERS.get(public.split("/")[0] + "/", "include")
            candidates = [self.root / folder / public]
        else:
            candidates = [path.parent / quoted]
            candidates += [self.root / folder / quoted for folder in INCLUDE_FOLDERS]
        for candidate in candidates:
            if candidate.is_file():
                return self.name(candidate.resolve())
        self.problems.append(f"{self.name(path)}: there is no {public or quoted}")
        return None

    def check_layers(self, layers, prefix=""):
        """Checks that no file includes a higher layer, and that each below `prefix` has a layer."""
        for name, included in self.includes.items():
            if not name.startswith(prefix):
                continue
            here = layer_of(layers, name.removeprefix(prefix))
            if here is None:
                if prefix:
                    self.problems.append(f"{name}: in no layer of the table")
                continue
            for other in filter(None, included):
                there = layer_of(layers, other.removeprefix(prefix))
                if other.startswith(prefix) and there and there[0] > here[0]:
                    self.problems.append(f"{name} ({here[1]}) includes {other} ({there[1]})")

    def check_library_stands_alone(self):
        for name, included in self.includes.items():
            for other in filter(None, included):
                if name.startswith("include/") and not other.startswith("include/"):
                    self.problems.append(f"{name} includes {other}, which is not of the library")

    def check_cycles(self):
        state = {}

        def visit(name, path):
            state[name] = "open"
            for other in filter(None, self.includes[name]):
                if state.get(other) == "open":
                    cycle = [*path[path.index(other):], other]
                    self.problems.append("cycle: " + " -> ".join(cycle))
                elif other in self.includes and other not in state:
                    visit(other, [*path, other])
            state[name] = "done"

        for name in self.includes:
            if name not in state:
                visit(name, [name])

    def check_names_in_detail(self):
        for path in sorted((self.root / "include/cayspin/detail").glob("*.hpp")):
            for word in PHYSICS:
                if word in path.stem.split("_"):
                    self.problems.append(f"{self.name(path)}: {word} is physics, not of detail/")

    def check_versioned_namespace(self):
        """Checks that headers are in the versioned namespace, which keeps two versions of the
        library in one program apart."""
        version = VERSION.search((self.root / "CMakeLists.txt").read_text(encoding="utf-8"))
        expected = f"cayspin::inline v{version[1]}_{version[2]}"
        for name in self.includes:
            text = (self.root / name).read_text(encoding="utf-8")
            if name.startswith("include/") and set(NAMESPACE.findall(text)) - {expected}:
                self.problems.append(f"{name}: not all of it is in {expected}")

    def check_members_without_address(self):
        """Checks that no file writes [[no_unique_address]], which may change the size of a struct
        in device code: see detail/backend.hpp."""
        for name in self.includes:
            text = (self.root / name).read_text(encoding="utf-8")
            if "[[no_unique_address]]" in text and not name.endswith("/detail/backend.hpp"):
                self.problems.append(f"{name}: write CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS, for nvcc")


    def check_backends(self):
        """Checks that only BACKEND_HEADERS test macros of backends: a port edits only these."""
        for name in self.includes:
            if not name.startswith("include/") or name.endswith(BACKEND_HEADERS):
                continue
            text = (self.root / name).read_text(encoding="utf-8")
            for macro in sorted(set(BACKEND_MACRO.findall(text))):
                self.problems.append(f"{name}: {macro} is of a backend, for detail/backend.hpp")


def problems_of(root):
    tree = Tree(root.resolve())
    if not tree.includes:
        tree.problems.append(f"{root}: no sources")
    tree.check_layers(LIBRARY, "include/cayspin/")
    tree.check_layers(PROGRAMS)
    tree.check_library_stands_alone()
    tree.check_cycles()
    tree.check_names_in_detail()
    tree.check_versioned_namespace()
    tree.check_members_without_address()
    tree.check_backends()
    return tree.problems


# File, its text, and the problem that it causes in a correct tree.
MISTAKES = [
    ("include/cayspin/vec3.hpp", "#include <cayspin/field/a.hpp>", "(numbers) includes"),
    ("include/cayspin/vec3.hpp", "#include <cayspin/no.hpp>", "there is no cayspin/no.hpp"),
    ("include/cayspin/stepper/a.hpp", "#include <cayspin/stepper/euler.hpp>", "cycle: "),
    ("include/cayspin/stepper/b.hpp", '#include "../../../src/simulation/s.hpp"', "not of the lib"),
    ("include/cayspin/other/a.hpp", "", "in no layer"),
    ("include/cayspin/detail/damping_loop.hpp", "", "damping is physics"),
    ("include/cayspin/vec3.hpp", "namespace cayspin::detail {", "not all of it is in"),
    ("include/cayspin/vec3.hpp", "#if defined(__CUDA_ARCH__)", "is of a backend"),
    ("src/io/a.cpp", '#include "simulation/s.hpp"', "(reader and writer) includes"),
    ("src/io/a.cpp", '#include "../program/p.hpp"', "(reader and writer) includes"),
    ("src/program/p.cpp", '#include "../../paper/table.hpp"', "(program) includes"),
    ("examples/a.cpp", "#include <cayspin/old.hpp>", "there is no cayspin/old.hpp"),
]
SOUND = {
    "CMakeLists.txt": "project(cayspin VERSION 0.7.1 DESCRIPTION",
    "include/cayspin/field/a.hpp": "#include <cayspin/concepts.hpp>\n"
                                   "namespace cayspin::inline v0_7::detail {",
    "include/cayspin/concepts.hpp": "",
    "include/cayspin/vec3.hpp": "#include <cayspin/detail/pack.hpp>\n#include <cmath>",
    "include/cayspin/detail/pack.hpp": "// #include <cayspin/cayspin.hpp>",
    "include/cayspin/stepper/euler.hpp": "#include <cayspin/stepper/a.hpp>\n",
    "include/cayspin/stepper/a.hpp": "#include <cayspin/vec3.hpp>\n#include <cayspin/version.hpp>",
    "src/simulation/s.hpp": "#include <cayspin/stepper/euler.hpp>",
    "src/program/p.hpp": '#include "simulation/s.hpp"\n#include "cayspin_git_commit.hpp"',
    "paper/table.hpp": '#include "simulation/s.hpp"',
}


def problems_with(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return problems_of(pathlib.Path(folder))


def self_test():
    failures = [f"sound tree: {problem}" for problem in problems_with(SOUND)]
    for name, text, expected in MISTAKES:
        found = problems_with({**SOUND, name: text})
        if len(found) != 1 or expected not in found[0]:
            failures.append(f"{name} with {text!r}: expected one '{expected}', found {found}")
    print("\n".join(failures) or f"{len(MISTAKES)} mistakes found, none in a sound tree")
    return not failures


def main():
    if sys.argv[1:] == ["--self-test"]:
        sys.exit(0 if self_test() else 1)
    if len(sys.argv) != 2:
        sys.exit("usage: check_layers.py ROOT | --self-test")
    problems = problems_of(pathlib.Path(sys.argv[1]))
    print("\n".join(problems) or "every include is of its own layer or of a lower one")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
