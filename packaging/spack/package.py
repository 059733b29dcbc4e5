# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""cayspin for Spack 1.0 and newer. In a clone, with this file in a repository of yours as
packages/cayspin/package.py:  spack dev-build --source-path CLONE cayspin@main"""

from spack_repo.builtin.build_systems.cmake import CMakePackage
from spack.package import *


class Cayspin(CMakePackage):
    """Lie-group time integration of spin fields on Kokkos."""

    license("Apache-2.0 WITH LLVM-exception")

    # No public address yet: dev-build takes the clone.
    version("main")
    version("0.1.0")

    variant("program", default=True, description="The program, scenes, files and the C interface")
    variant("examples", default=False, description="Build the examples")
    variant("shared", default=False, when="+program", description="A shared C interface")

    depends_on("c", type="build", when="+program")
    depends_on("cxx", type="build")
    depends_on("fortran", type="build", when="+program+examples")
    depends_on("cmake@3.25:", type="build")
    # Backends and architecture are those of Kokkos: cayspin ^kokkos+openmp, ^kokkos+cuda cuda_arch=90
    depends_on("kokkos@4.5:5")
    depends_on("kokkos+pic", when="+shared")
    depends_on("fftw-api@3", when="+examples")
    with when("+program"):
        depends_on("hdf5~mpi")
        depends_on("fmt@9:")
        depends_on("muparser")
        depends_on("tomlplusplus")
        depends_on("eigen@3.4:", type="build")
        depends_on("cli11", type="build")
        depends_on("nlohmann-json", type="build")

    conflicts("%gcc@:11", msg="cayspin needs C++20: g++ 12 or newer")

    def cmake_args(self):
        arguments = [
            self.define_from_variant("CAYSPIN_BUILD_APP", "program"),
            self.define_from_variant("CAYSPIN_BUILD_PROGRAM", "program"),
            self.define_from_variant("CAYSPIN_BUILD_EXAMPLES", "examples"),
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define("CAYSPIN_BUILD_TESTS", False),
            self.define("CAYSPIN_BUILD_BENCH", False),
            self.define("CAYSPIN_INSTALL", True),
        ]
        if self.spec.satisfies("^kokkos+wrapper"):
            wrapper = self["kokkos-nvcc-wrapper"].kokkos_cxx
            arguments.append(self.define("CMAKE_CXX_COMPILER", wrapper))
        elif self.spec.satisfies("^kokkos+rocm"):
            arguments.append(self.define("CMAKE_CXX_COMPILER", self.spec["hip"].hipcc))
        return arguments
