# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compares the recipes for Spack and conda with the CMake files, and every file that states the
version with CMakeLists.txt: check_recipes.py ROOT.

No recipe is built. Versions, dependencies, options and the scenes of their tests are compared as
text.
"""

import ast
import pathlib
import re
import sys

# Packages that CMake finds: their names in Spack and in conda-forge.
PACKAGES = {
    "HDF5": ("hdf5", "hdf5"),
    "tomlplusplus": ("tomlplusplus", "tomlplusplus"),
    "fmt": ("fmt", "fmt"),
    "muparser": ("muparser", "muparser"),
    "Eigen3": ("eigen", "eigen"),
    "nlohmann_json": ("nlohmann-json", "nlohmann_json"),
    "CLI11": ("cli11", "cli11"),
    "PNG": ("libpng", "libpng"),
}
# Text that each of these files has to contain; V stands for the version.
STATEMENTS = {
    "pyproject.toml": '\nversion = "V"\n',
    "CITATION.cff": "\nversion: V\n",
    "CHANGELOG.md": "\n## [V] - ",
    "docs/guide/linking.md": " cayspin@V ",
}
SEARCHED = ("README.md", "docs/**/*.md", "examples/**/CMakeLists.txt", "tests/install/**/CMakeLists.txt")


def other_versions(root, version):
    """Yields the files that do not state `version`, and those that ask CMake for anything but its
    first two numbers."""
    minor = version.rpartition(".")[0]
    for name, statement in STATEMENTS.items():
        expected = statement.replace("V", version)
        if expected not in (root / name).read_text(encoding="utf-8"):
            yield f"{name}: has no {expected.strip()!r}"
    for path in sorted(path for pattern in SEARCHED for path in root.glob(pattern)):
        for asked in re.findall(r"find_package\(cayspin (\d[\d.]*)", path.read_text(encoding="utf-8")):
            if asked != minor:
                yield f"{path.relative_to(root)}: asks for cayspin {asked}, and this is {minor}"


def problems_of(root):
    def read(path):
        return (root / path).read_text(encoding="utf-8")

    spack, conda = read("packaging/spack/package.py"), read("packaging/conda/meta.yaml")
    top, kokkos = read("CMakeLists.txt"), read("cmake/FindOrBuildKokkos.cmake")
    [version] = re.findall(r"project\(cayspin VERSION (\S+)", top)
    [cmake] = re.findall(r"cmake_minimum_required\(VERSION (\S+)\)", top)
    [lowest] = re.findall(r"CAYSPIN_KOKKOS_MINIMUM (\S+)\)", kokkos)
    [beyond] = re.findall(r"CAYSPIN_KOKKOS_BEYOND (\d+)\)", kokkos)
    options = re.findall(r"option\((CAYSPIN_\w+)", top)
    required = re.findall(r"find_package\((\w+)(?: ([\d.]+))? REQUIRED", read("src/CMakeLists.txt"))
    required += re.findall(r"find_package\((\w+)(?: ([\d.]+))? QUIET\)", top)

    in_spack = [f'version("{version}")', f'"kokkos@{lowest}:{int(beyond) - 1}"', f'"cmake@{cmake}:"']
    in_conda = [f'version = "{version}"', f"- kokkos >={lowest},<{beyond}\n", f"- cmake >={cmake}\n"]
    for package, least in required:
        if package not in PACKAGES:
            yield f"CMake requires {package}: tell check_recipes.py its names"
            continue
        for_spack, for_conda = PACKAGES[package]
        in_spack.append(f'depends_on("{for_spack}@{least}:' if least else f'depends_on("{for_spack}')
        in_conda.append(f"- {for_conda} >={least}" if least else f"- {for_conda}")

    ast.parse(spack)
    for name, text, expected in (("spack", spack, in_spack), ("conda", conda, in_conda)):
        for part in expected:
            if part not in text:
                yield f"{name}: has no {part.strip()}"
        for option in sorted({*re.findall(r"CAYSPIN_\w+", text)} - {*options}):
            yield f"{name}: there is no CMake option {option}"
        for scene in re.findall(r"[\w-]+\.toml", text):
            if not (root / "scenes" / scene).exists():
                yield f"{name}: its tests need scenes/{scene}, which does not exist"
        for other in {*re.findall(r"cayspin[-@](\d+(?:\.\d+)+)", text)} - {version}:
            yield f"{name}: names version {other}, and this is {version}"
    yield from other_versions(root, version)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check_recipes.py ROOT")
    problems = list(problems_of(pathlib.Path(sys.argv[1])))
    print("\n".join(problems) or "the recipes and all versions agree with the CMake files")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
