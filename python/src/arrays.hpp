// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/scene_run.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cayspin::python {

namespace nb = nanobind;

/// float32 or float64 in host memory, of any strides.
using NumbersIn = nb::ndarray<nb::ro, nb::ndim<4>, nb::device::cpu>;
/// Numbers of sites, x fastest.
using SiteNumbersIn = nb::ndarray<nb::ro, double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using SiteNumbersOut = nb::ndarray<nb::numpy, double, nb::ndim<3>>;
using NumbersOut = nb::ndarray<nb::numpy, nb::ro>;

/// An array (nz, ny, nx, 3) as it lies. Throws UsageError for another shape or type.
io::HostVectors vectors_of(NumbersIn const& array);

/// A read-only array of the memory that is lent, which it keeps.
NumbersOut array_of(simulation::LentVectors const& lent);

/// An array of these numbers.
SiteNumbersOut array_of(std::vector<double> numbers, std::array<std::int64_t, 3> const& shape);

/// A field of the program, by callables or None: uniform(t) returns three numbers, and
/// nonlocal(spins, t) an array (nz, ny, nx, 3), given a copy of the spins.
io::OwnField own_field(nb::object uniform, nb::object nonlocal);

}  // namespace cayspin::python
