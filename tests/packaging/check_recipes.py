# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Compares packaging/spack and packaging/conda with the CMake files: check_recipes.py ROOT.

The recipe for Spack is loaded with stubs of Spack's directives, that of conda is rendered with
jinja2. Neither is built: names, versions, options and the files of their tests are compared.
"""

import contextlib
import pathlib
import re
import sys
import types

import jinja2
import yaml

# What CMake finds, and how Spack and conda-forge call it.
PACKAGES = {
    "Kokkos": ("kokkos", "kokkos"),
    "HDF5": ("hdf5", "hdf5"),
    "tomlplusplus": ("tomlplusplus", "tomlplusplus"),
    "fmt": ("fmt", "fmt"),
    "muparser": ("muparser", "muparser"),
    "Eigen3": ("eigen", "eigen"),
    "nlohmann_json": ("nlohmann-json", "nlohmann_json"),
    "CLI11": ("cli11", "cli11"),
}
OF_CMAKE_ITSELF = {"BUILD_SHARED_LIBS", "CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER"}


class BuildFiles:
    """What the CMake files say: version, options and required packages."""

    def __init__(self, root):
        top = (root / "CMakeLists.txt").read_text(encoding="utf-8")
        source = (root / "src/CMakeLists.txt").read_text(encoding="utf-8")
        kokkos = (root / "cmake/FindOrBuildKokkos.cmake").read_text(encoding="utf-8")
        self.version = re.search(r"project\(cayspin VERSION (\S+)", top)[1]
        self.cmake = re.search(r"cmake_minimum_required\(VERSION (\S+)\)", top)[1]
        self.kokkos = re.search(r"CAYSPIN_KOKKOS_MINIMUM (\S+)\)", kokkos)[1]
        self.beyond_kokkos = int(re.search(r"CAYSPIN_KOKKOS_BEYOND (\d+)\)", kokkos)[1])
        self.options = set(re.findall(r"option\((CAYSPIN_\w+)", top))
        self.packages = set(re.findall(r"find_package\((\w+) REQUIRED", source)) | {"Kokkos"}


class SpackRecipe:
    """What the directives of a package.py declare."""

    def __init__(self, text):
        self.versions, self.variants, self.dependencies, self.files_of_tests = [], {}, {}, []
        conditions = []

        def variant(name, default, description, when=None):
            self.variants[name] = default

        def depends_on(spec, type=None, when=None):
            name = re.match(r"[\w-]+", spec)[0]
            self.dependencies.setdefault(name, []).append((spec, [*conditions, when]))

        @contextlib.contextmanager
        def when(condition):
            conditions.append(condition)
            yield
            conditions.pop()

        directives = {"license": lambda name: None, "version": self.versions.append,
                      "variant": variant, "depends_on": depends_on, "when": when,
                      "conflicts": lambda spec, msg: None,
                      "filter_compiler_wrappers": lambda files, relative_root: None,
                      "run_after": lambda phase: lambda method: method,
                      "cache_extra_test_sources":
                          lambda package, names: self.files_of_tests.extend(names)}
        spack, build_system = types.ModuleType("spack.package"), types.ModuleType("cmake")
        vars(spack).update(directives)
        build_system.CMakePackage = type("CMakePackage", (), {})
        modules = {"spack": types.ModuleType("spack"), "spack.package": spack}
        name = "spack_repo.builtin.build_systems.cmake".split(".")
        for end in range(1, len(name)):
            modules[".".join(name[:end])] = types.ModuleType(name[end - 1])
        modules[".".join(name)] = build_system
        sys.modules.update(modules)
        namespace = {}
        exec(compile(text, "package.py", "exec"), namespace)
        self.package = namespace["Cayspin"]
        self.package().keep_sources_of_tests()
        self.files_of_tests += [f"scenes/{name}" for name in re.findall(r"[\w-]+\.toml", text)]

    def cmake_options(self, spec_of_kokkos):
        """Names of the options that cmake_args defines; `spec_of_kokkos` such as +wrapper."""
        recipe, names = self, set()

        class Spec:
            def satisfies(self, condition):
                return condition == f"^kokkos{spec_of_kokkos}"

            def __getitem__(self, name):
                return types.SimpleNamespace(hipcc="hipcc", kokkos_cxx="nvcc_wrapper")

        class Package(self.package):
            spec = Spec()

            def define(self, name, value):
                names.add(name)

            def define_from_variant(self, name, variant):
                if variant not in recipe.variants:
                    raise KeyError(f"there is no variant {variant}")
                names.add(name)

            def __getitem__(self, name):
                return self.spec[name]

        Package().cmake_args()
        return names


class CondaRecipe:
    """A rendered meta.yaml."""

    def __init__(self, text):
        environment = jinja2.Environment(undefined=jinja2.StrictUndefined)
        rendered = environment.from_string(text).render(
            compiler=lambda language: f"{language}_compiler", stdlib=lambda of: f"{of}_stdlib")
        self.fields = yaml.safe_load(rendered)
        self.script = " ".join(self.fields["build"]["script"])
        self.files_of_tests = [*self.fields["test"]["source_files"],
                               *re.findall(r"scenes/[\w-]+\.toml", text)]
        self.host = {line.split()[0]: line for line in self.fields["requirements"]["host"]}


def missing_files(names, root):
    return [f"its tests need {name}, which does not exist" for name in names
            if not (root / name).exists()]


def wrong_options(names, build_files):
    return [f"there is no CMake option {name}"
            for name in sorted(names - build_files.options - OF_CMAKE_ITSELF)]


def problems_of_spack(text, root, build_files):
    recipe = SpackRecipe(text)
    problems = missing_files(recipe.files_of_tests, root)
    if build_files.version not in recipe.versions:
        problems.append(f"no version {build_files.version}")
    for name, (spack, _) in PACKAGES.items():
        if spack not in recipe.dependencies:
            problems.append(f"{name} is required and {spack} is no dependency")
    for spack, versions in (("kokkos", f"{build_files.kokkos}:{build_files.beyond_kokkos - 1}"),
                            ("cmake", f"{build_files.cmake}:")):
        if all(spec != f"{spack}@{versions}" for spec, _ in recipe.dependencies.get(spack, [])):
            problems.append(f"{spack} has to be @{versions}")
    for uses in recipe.dependencies.values():
        for spec, conditions in uses:
            for variant in re.findall(r"[+~](\w+)", " ".join(filter(None, conditions))):
                if variant not in recipe.variants:
                    problems.append(f"{spec} depends on {variant}, which is no variant")
    for spec_of_kokkos in ("", "+wrapper", "+rocm"):
        problems += wrong_options(recipe.cmake_options(spec_of_kokkos), build_files)
    return problems


def problems_of_conda(text, variants, root, build_files):
    recipe = CondaRecipe(text)
    problems = missing_files(recipe.files_of_tests, root)
    if "stdlib(" in text and "c_stdlib" not in (yaml.safe_load(variants) or {}):
        problems.append("conda_build_config.yaml does not say what stdlib is")
    if str(recipe.fields["package"]["version"]) != build_files.version:
        problems.append(f"the version is not {build_files.version}")
    for section in ("source", "build", "requirements", "test", "about"):
        if section not in recipe.fields:
            problems.append(f"no section {section}")
    for name, (_, conda) in PACKAGES.items():
        if conda not in recipe.host:
            problems.append(f"{name} is required and {conda} is no host requirement")
    versions = f">={build_files.kokkos},<{build_files.beyond_kokkos}"
    if recipe.host.get("kokkos") != f"kokkos {versions}":
        problems.append(f"kokkos has to be {versions}")
    if f"cmake >={build_files.cmake}" not in recipe.fields["requirements"]["build"]:
        problems.append(f"cmake has to be >={build_files.cmake}")
    return problems + wrong_options(set(re.findall(r"-D(\w+)=", recipe.script)), build_files)


def problems_of(root, spack, conda, variants):
    build_files = BuildFiles(root)
    unknown = build_files.packages - PACKAGES.keys()
    return ([f"CMake requires {name}: tell check_recipes.py its names" for name in unknown] +
            [f"spack: {line}" for line in problems_of_spack(spack, root, build_files)] +
            [f"conda: {line}" for line in problems_of_conda(conda, variants, root, build_files)])


def recipes_of(root):
    names = ("spack/package.py", "conda/meta.yaml", "conda/conda_build_config.yaml")
    return tuple((root / "packaging" / name).read_text(encoding="utf-8") for name in names)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check_recipes.py ROOT")
    root = pathlib.Path(sys.argv[1])
    problems = problems_of(root, *recipes_of(root))
    print("\n".join(problems) or "the recipes agree with the CMake files")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
