// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "arrays.hpp"

#include "simulation/failure.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace cayspin::python {
namespace {

using simulation::UsageError;

// Wraps a Python object so that any thread may release it, with or without the GIL.
std::shared_ptr<nb::object> kept(nb::object object) {
  return {new nb::object(std::move(object)), [](nb::object* held) {
            if (!nb::is_alive()) return;
            nb::gil_scoped_acquire const gil;
            delete held;
          }};
}

// Returns false for a complex number (of which NumPy would take the real part) and for an array
// with axes (even if NumPy would convert its one element). The caller's cast to double refuses what
// is no number.
bool is_real_number(nb::object const& number) {
  if (PyFloat_CheckExact(number.ptr())) return true;
  if (PyComplex_Check(number.ptr())) return false;
  if (!nb::hasattr(number, "dtype")) return true;
  auto const kind = nb::cast<std::string>(number.attr("dtype").attr("kind"));
  return nb::cast<int>(number.attr("ndim")) == 0 &&
         std::string_view("biuf").find(kind) != std::string_view::npos;
}

template <class To, class From>
void copy_vectors(io::HostVectors const& from, io::HostVectors const& to) {
  auto const* source = static_cast<From const*>(from.data);
  auto* target = static_cast<To*>(to.data);
  auto const at = [](std::array<std::int64_t, 4> const& s, std::int64_t k, std::int64_t j,
                     std::int64_t i,
                     std::int64_t c) { return k * s[0] + j * s[1] + i * s[2] + c * s[3]; };
  for (std::int64_t k = 0; k < to.shape[0]; ++k)
    for (std::int64_t j = 0; j < to.shape[1]; ++j)
      for (std::int64_t i = 0; i < to.shape[2]; ++i)
        for (std::int64_t c = 0; c < 3; ++c)
          target[at(to.strides, k, j, i, c)] =
              static_cast<To>(source[at(from.strides, k, j, i, c)]);
}

template <class To>
void copy_vectors(io::HostVectors const& from, io::HostVectors const& to) {
  from.is_double ? copy_vectors<To, double>(from, to) : copy_vectors<To, float>(from, to);
}

template <class Real>
NumbersOut copy_of(io::HostVectors const& vectors) {
  auto numbers = std::make_shared<std::vector<Real>>(simulation::packed<Real>(vectors));
  auto const& [nz, ny, nx] = vectors.shape;
  return array_of(
      {{numbers->data(), vectors.is_double, vectors.shape, {3 * nx * ny, 3 * nx, 3, 1}}, numbers});
}

}  // namespace

io::HostVectors vectors_of(NumbersIn const& array) {
  bool const is_double = array.dtype() == nb::dtype<double>();
  if (!is_double && array.dtype() != nb::dtype<float>())
    throw UsageError("an array of another type; accepted: float64 or float32");
  if (array.shape(3) != 3)
    throw UsageError("an array whose last extent is not 3; accepted: an array (nz, ny, nx, 3)");
  io::HostVectors vectors{const_cast<void*>(array.data()), is_double, {}, {}};
  for (std::size_t axis = 0; axis < 4; ++axis) {
    if (axis < 3) vectors.shape[axis] = static_cast<std::int64_t>(array.shape(axis));
    vectors.strides[axis] = array.stride(axis);
  }
  return vectors;
}

SiteNumbersOut array_of(std::vector<double> numbers, std::array<std::int64_t, 3> const& shape) {
  auto kept = std::make_unique<std::vector<double>>(std::move(numbers));
  nb::capsule const owner(
      kept.get(), [](void* held) noexcept { delete static_cast<std::vector<double>*>(held); });
  auto* const data = kept.release()->data();
  auto const extent = [&](std::size_t axis) { return static_cast<std::size_t>(shape[axis]); };
  return {data, {extent(0), extent(1), extent(2)}, owner};
}

NumbersOut array_of(simulation::LentVectors const& lent) {
  using Owner = std::shared_ptr<void const>;
  auto const& vectors = lent.vectors;
  nb::capsule const owner(new Owner(lent.owner), [](void* held) noexcept {
    nb::gil_scoped_release const released;
    delete static_cast<Owner*>(held);
  });
  std::size_t shape[4] = {0, 0, 0, 3};
  std::copy_n(vectors.shape.begin(), 3, shape);
  return NumbersOut(vectors.data, 4, shape, owner, vectors.strides.data(),
                    vectors.is_double ? nb::dtype<double>() : nb::dtype<float>());
}

io::Given given(std::optional<NumbersIn> const& spins, ArraysIn const& numbers) {
  io::Given given;
  if (spins)
    given.spins =
        std::make_shared<std::vector<double> const>(simulation::packed<double>(vectors_of(*spins)));
  for (auto const& [key, array] : numbers)
    given.numbers[key] =
        std::make_shared<std::vector<double> const>(array.data(), array.data() + array.size());
  return given;
}

io::OwnField own_field(nb::object uniform, nb::object nonlocal) {
  io::OwnField own;
  if (!uniform.is_none())
    own.uniform = [function = kept(std::move(uniform))](double t) {
      nb::gil_scoped_acquire const gil;
      auto const result = (*function)(t);
      bool const is_bytes = PyBytes_Check(result.ptr()) || PyByteArray_Check(result.ptr());
      if (is_bytes || !PySequence_Check(result.ptr()) || PyObject_Length(result.ptr()) < 0) {
        PyErr_Clear();  // an array without axes has no length
        throw UsageError(
            "field.applied: the function returned no sequence; accepted: three numbers");
      }
      if (nb::len(result) != 3)
        throw UsageError(
            "field.applied: the function returned another number of components; "
            "accepted: three numbers; for a field per site use an array or field.sources");
      std::array<double, 3> field{};
      for (std::size_t c = 0; c < 3; ++c)
        if (nb::object const component = result[c];
            !is_real_number(component) || !nb::try_cast(component, field[c]))
          throw UsageError("field.applied: the function returned no numbers; accepted: three");
      return field;
    };
  if (!nonlocal.is_none())
    own.nonlocal = [function = kept(std::move(nonlocal))](io::HostVectors const& spins,
                                                          io::HostVectors const& field, double t) {
      nb::gil_scoped_acquire const gil;
      auto const result = (*function)(
          nb::cast(spins.is_double ? copy_of<double>(spins) : copy_of<float>(spins)), t);
      NumbersIn array;
      if (!nb::try_cast(result, array))
        throw UsageError(
            "field.nonlocal: the function returned no array; accepted: float64 or "
            "float32 of shape (nz, ny, nx, 3)");
      auto const vectors = [&] {
        try {
          return vectors_of(array);
        } catch (UsageError const& error) {
          throw UsageError(std::string("field.nonlocal: the function returned ") + error.what());
        }
      }();
      if (vectors.shape != field.shape)
        throw UsageError(
            "field.nonlocal: the function returned an array of another shape; "
            "accepted: (nz, ny, nx, 3)");
      field.is_double ? copy_vectors<double>(vectors, field) : copy_vectors<float>(vectors, field);
    };
  return own;
}

}  // namespace cayspin::python
