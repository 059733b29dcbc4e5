// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/scene_run.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::python {

namespace nb = nanobind;

/// An array with four axes in host memory, with any strides. vectors_of() checks its type.
using NumbersIn = nb::ndarray<nb::ro, nb::ndim<4>, nb::device::cpu>;
/// One number for each site. The index along x varies fastest.
using SiteNumbersIn = nb::ndarray<nb::ro, double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using SiteNumbersOut = nb::ndarray<nb::numpy, double, nb::ndim<3>>;
using NumbersOut = nb::ndarray<nb::numpy, nb::ro>;

/// Returns the memory of an array (nz, ny, nx, 3), without a copy. Throws UsageError for another
/// shape or type.
io::HostVectors vectors_of(NumbersIn const& array);

/// Returns a read-only array that uses lent memory and keeps it alive.
NumbersOut array_of(simulation::LentVectors const& lent);

/// Returns an array of this shape that owns the numbers.
SiteNumbersOut array_of(std::vector<double> numbers, std::array<std::int64_t, 3> const& shape);

using ArraysIn = std::map<std::string, SiteNumbersIn>;  // by key

/// Returns copies of an array of spins and of values per site, for a scene.
io::Given given(std::optional<NumbersIn> const& spins, ArraysIn const& numbers);

/// Makes a program's own field from callables or None. uniform(t) returns three numbers;
/// nonlocal(spins, t) gets a copy of the spins and returns an array (nz, ny, nx, 3).
io::OwnField own_field(nb::object uniform, nb::object nonlocal);

}  // namespace cayspin::python
