# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""cayspin for Spack 1.0 and newer. Put this file into your own Spack repository, as
packages/cayspin/package.py, and run:  spack dev-build --source-path CLONE cayspin@main
To test the installed package:  spack test run cayspin"""

import os
import pathlib

from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Cayspin(CMakePackage):
    """Lie-group time integration of spin fields on Kokkos."""

    license("Apache-2.0 WITH LLVM-exception")

    # cayspin has no public address yet: `dev-build` builds the clone, and `install` builds an
    # archive in the current folder.
    url = f"file://{os.getcwd()}/cayspin-0.2.0.tar.gz"
    manual_download = True
    download_instr = (
        "cayspin has no public address yet. In a clone, make an archive and install it there: "
        "git archive --prefix=cayspin-0.2.0/ -o cayspin-0.2.0.tar.gz HEAD, "
        "spack install --no-checksum cayspin@0.2.0"
    )

    version("main")
    version("0.2.0")

    variant("program", default=True, description="The program, scenes, files and the C interface")
    variant("examples", default=False, description="Build the examples")
    variant("fftw", default=False, description="The demagnetising field; FFTW is under the GPL")
    variant("png", default=True, when="+program", description="Images in scenes, by libpng")
    variant("shared", default=False, when="+program", description="Programs share one library")

    depends_on("c", type="build", when="+program")
    depends_on("cxx", type="build")
    depends_on("fortran", type="build", when="+program+examples")
    depends_on("cmake@3.25:", type="build")
    # The Kokkos package sets backends and architecture, as in: cayspin ^kokkos+cuda cuda_arch=90
    depends_on("kokkos@4.5:5")
    depends_on("kokkos+pic", when="+shared")
    depends_on("fftw@3 precision=float,double", when="+fftw")
    depends_on("fftw-api@3", when="+examples")
    with when("+program"):
        depends_on("hdf5@1.10:~mpi")
        depends_on("fmt@9:")
        depends_on("muparser@2.3.3:")
        depends_on("tomlplusplus")
        depends_on("eigen@3.4:", type="build")
        depends_on("libpng@1.6:", when="+png")
        depends_on("cli11", type="build")
        depends_on("nlohmann-json", type="build")

    conflicts("%gcc@:11", msg="cayspin needs C++20: g++ 12 or newer")

    def cmake_args(self):
        arguments = [
            self.define_from_variant("CAYSPIN_BUILD_APP", "program"),
            self.define_from_variant("CAYSPIN_BUILD_PROGRAM", "program"),
            self.define_from_variant("CAYSPIN_BUILD_EXAMPLES", "examples"),
            self.define_from_variant("CAYSPIN_FFTW", "fftw"),
            self.define_from_variant("CAYSPIN_PNG", "png"),
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define("CAYSPIN_BUILD_TESTS", False),
            self.define("CAYSPIN_BUILD_BENCH", False),
            self.define("CAYSPIN_INSTALL", True),
        ]
        return arguments + self.compiler_of_kokkos()

    def compiler_of_kokkos(self):
        if self.spec.satisfies("^kokkos+wrapper"):
            compiler = self["kokkos-nvcc-wrapper"].kokkos_cxx
        elif self.spec.satisfies("^kokkos+rocm"):
            compiler = self.spec["hip"].hipcc
        else:
            return []
        return [self.define("CMAKE_CXX_COMPILER", compiler)]

    # Users read the compiler from these files; Spack's compiler wrapper works only in Spack's
    # builds.
    filter_compiler_wrappers("*.pc", relative_root=os.path.join("lib", "pkgconfig"))

    test_requires_compiler = True

    @run_after("install")
    def keep_sources_of_tests(self):
        cache_extra_test_sources(self, ["examples", "scenes"])

    def test_examples(self):
        """The examples compile against the installed package and pass their ctest"""
        sources = pathlib.Path(self.test_suite.current_test_cache_dir.examples)
        arguments = [
            self.define("CMAKE_BUILD_TYPE", "Release"),
            self.define("CMAKE_CXX_COMPILER", self["cxx"].cxx),
            self.define("cayspin_ROOT", self.prefix),
        ]
        targets = [f"example_{source.stem}" for source in sources.glob("*.cpp")]
        cmake = Executable(self.spec["cmake"].prefix.bin.cmake)
        ctest = Executable(self.spec["cmake"].prefix.bin.ctest)
        cmake("-S", str(sources), "-B", "examples", *arguments, *self.compiler_of_kokkos())
        cmake("--build", "examples", "--target", *targets)
        ctest("--test-dir", "examples", "--output-on-failure", "-R", "^example_[0-9]")

    def test_program(self):
        """The installed program runs a scene and describes its file"""
        if self.spec.satisfies("~program"):
            raise SkipTest("the package was installed without its program")
        scenes = pathlib.Path(self.test_suite.current_test_cache_dir.scenes)
        cayspin = Executable(self.prefix.bin.cayspin)
        cayspin("run", str(scenes / "macrospin.toml"))
        check_outputs("rkmk4", cayspin("info", "macrospin.h5", output=str))
