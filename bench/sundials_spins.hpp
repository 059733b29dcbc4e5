// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.hpp>

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

// Spins as vectors of SUNDIALS.
namespace by_sundials {

using Spins = cayspin::SpinField<double, Kokkos::HostSpace>;
using Exec = Kokkos::DefaultHostExecutionSpace;
using SiteArray = cayspin::SiteArray<double, 3>;
using OutputArray = cayspin::OutputArray<double, 3>;

inline void require(bool fine, char const* what) {
  if (!fine) throw std::runtime_error(std::string("SUNDIALS: ") + what + " failed");
}

struct FreeVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
using Vector = std::unique_ptr<_generic_N_Vector, FreeVector>;

/// Makes serial vectors of SUNDIALS that have the memory layout of a spin field, margins included,
/// so that kernels read and write them in place. If the padding would be an eighth of the spins or
/// more, vectors hold only the spins and are copied for kernels, because SUNDIALS' operations on
/// the longer vectors would cost more. The padding of rates is zero.
class SpinVectors {
 public:
  explicit SpinVectors(cayspin::Lattice const& lattice)
      : spins_("bench::spins", lattice), rates_("bench::rates", lattice) {
    auto const sites = static_cast<std::size_t>(3 * spins_.sites());
    in_place_ = spins_.layout().allocation(3) * 8 < sites * 9;
    length_ = static_cast<sunindextype>(in_place_ ? spins_.layout().allocation(3) : sites);
  }

  Vector make(SUNContext context) const { return Vector(N_VNew_Serial(length_, context)); }
  cayspin::Lattice const& lattice() const { return spins_.lattice(); }
  cayspin::RowLayout const& layout() const { return spins_.layout(); }

  void write(Spins const& from, N_Vector to) const {
    if (in_place_)
      std::copy_n(from.allocation().data(), length_, N_VGetArrayPointer(to));
    else
      pack(from.array(), to);
  }
  void read(N_Vector from, Spins const& to) const {
    if (in_place_)
      std::copy_n(N_VGetArrayPointer(from), length_, to.allocation().data());
    else
      unpack(from, to.array());
  }

  /// Returns the array from which kernels read the vector `v`. If vectors are not used in place,
  /// copies `v` into that array first.
  SiteArray input(N_Vector v) const {
    if (in_place_) return of_vector(v);
    unpack(v, spins_.array());
    return spins_.array();
  }
  /// Returns the array to which kernels write the vector `v`. Call finish(v) after the kernels.
  OutputArray output(N_Vector v) const {
    return {in_place_ ? of_vector(v) : rates_.array(), false};
  }
  void finish(N_Vector v) const {
    if (!in_place_) return pack(rates_.array(), v);
    auto const& at = layout();
    double* const data = N_VGetArrayPointer(v);
    std::fill_n(data, at.origin, 0.0);
    std::fill_n(data + length_ - at.origin, at.origin, 0.0);
    for (int c = 0; c < 3; ++c) {
      double* const component = data + at.origin + c * at.component_stride;
      for (std::int64_t z = 0; z < at.nz; ++z) {
        for (std::int64_t y = 0; y < at.ny; ++y)
          std::fill_n(component + at.row_offset(y, z) + at.nx, at.pitch - at.nx, 0.0);
        std::fill_n(component + at.row_offset(0, z) + at.ny * at.pitch, at.plane - at.ny * at.pitch,
                    0.0);
      }
      std::fill_n(component + at.nz * at.plane, at.component_stride - at.nz * at.plane, 0.0);
    }
  }

 private:
  SiteArray of_vector(N_Vector v) const {
    return {N_VGetArrayPointer(v) + layout().origin, layout().component_stride};
  }
  template <class Copy>
  void for_each_row(Copy const& copy_row) const {
    auto const& at = layout();
    std::ptrdiff_t packed = 0;
    for (int c = 0; c < 3; ++c)
      for (std::int64_t row = 0; row < at.rows(); ++row, packed += at.nx)
        copy_row(packed, c * spins_.array().stride + at.row_offset(row));
  }
  void pack(SiteArray const& from, N_Vector to) const {
    double* const data = N_VGetArrayPointer(to);
    for_each_row(
        [&](auto packed, auto at) { std::copy_n(from.data + at, layout().nx, data + packed); });
  }
  void unpack(N_Vector from, SiteArray const& to) const {
    double const* const data = N_VGetArrayPointer(from);
    for_each_row(
        [&](auto packed, auto at) { std::copy_n(data + packed, layout().nx, to.data + at); });
  }

  Spins spins_, rates_;
  bool in_place_ = false;
  sunindextype length_ = 0;
};

/// Functor that computes A x m at every site.
template <class Generator>
struct RateOfSites {
  Generator generator;
  SiteArray spins;
  OutputArray rate;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    cayspin::Stencil<Site, double> const stencil(site, spins);
    site.store(cross(cayspin::detail::evaluate(generator, stencil), stencil.center()), rate);
  }
};

/// Evaluates the right-hand side of m' = A x m by the generator's own kernel. If the field is
/// non-local, the spins are first copied to the field whole_, from which the generator is prepared.
template <class Generator>
class RightSide {
 public:
  RightSide(cayspin::Lattice const& lattice, Generator generator, bool is_nonlocal = false)
      : vectors(lattice),
        generator_(std::move(generator)),
        whole_("bench::whole", lattice),
        is_nonlocal_(is_nonlocal) {}

  void operator()(double t, N_Vector y, N_Vector rate) {
    if (is_nonlocal_) vectors.read(y, whole_);
    auto prepared = cayspin::detail::prepare_term(generator_, exec_, whole_, t);
    cayspin::detail::for_each_site<double>(
        exec_, label_, vectors.layout(),
        RateOfSites<decltype(prepared)>{std::move(prepared), vectors.input(y),
                                        vectors.output(rate)});
    vectors.finish(rate);
    ++evaluations;
  }
  Generator const& generator() const { return generator_; }

  SpinVectors vectors;
  std::int64_t evaluations = 0, most = INT64_MAX;

 private:
  std::string label_ = "cayspin::bench::rate";
  Exec exec_;
  Generator generator_;
  Spins whole_;
  bool is_nonlocal_;
};

}  // namespace by_sundials
