// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "landau_lifshitz.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Common code of most tests, compiled in compiled_once.cpp instead of in each test: fields, the
// memory of common steppers, runs of the slab, and messages of GoogleTest. Compilers for devices
// must compile kernels where these are used, so nothing is precompiled for them.
#if !defined(KOKKOS_ENABLE_CUDA) && !defined(KOKKOS_ENABLE_HIP) && !defined(KOKKOS_ENABLE_SYCL)
#ifndef CAYSPIN_TEST_COMPILES
#define CAYSPIN_TEST_COMPILES extern
#endif

#define CAYSPIN_TEST_METHOD(Real, Tableau, Update)                                              \
  CAYSPIN_TEST_COMPILES template struct detail::StageMemory<SpinField<Real, Kokkos::HostSpace>, \
                                                            tableau::Tableau, update::Update>;  \
  CAYSPIN_TEST_COMPILES template class detail::StagedStepper<                                   \
      SpinField<Real, Kokkos::HostSpace>, tableau::Tableau, update::Update, isotropy::Zero,     \
      detail::StageMemory<SpinField<Real, Kokkos::HostSpace>, tableau::Tableau, update::Update>>;

#define CAYSPIN_TEST_PRECISION(Real)                                                            \
  CAYSPIN_TEST_COMPILES template class SiteField<Real, 3, Kokkos::HostSpace>;                   \
  CAYSPIN_TEST_COMPILES template class SiteField<Real, 1, Kokkos::HostSpace>;                   \
  CAYSPIN_TEST_COMPILES template class SpinField<Real, Kokkos::HostSpace>;                      \
  CAYSPIN_TEST_COMPILES template class detail::StepperBase<SpinField<Real, Kokkos::HostSpace>>; \
  CAYSPIN_TEST_COMPILES template class detail::SweepBuffers<Real, Kokkos::HostSpace>;           \
  CAYSPIN_TEST_COMPILES template std::vector<Real> copy_to_host(                                \
      SiteField<Real, 3, Kokkos::HostSpace> const&);                                            \
  CAYSPIN_TEST_COMPILES template void copy_from_host(                                           \
      std::vector<double> const&, SiteField<Real, 3, Kokkos::HostSpace> const&);                \
  CAYSPIN_TEST_METHOD(Real, Euler, Lie<Cayley>)                                                 \
  CAYSPIN_TEST_METHOD(Real, Heun, LieUncorrected<Cayley>)                                       \
  CAYSPIN_TEST_METHOD(Real, Classical4, Lie<Cayley>)

namespace cayspin::inline v0_2 {

CAYSPIN_TEST_PRECISION(double)
CAYSPIN_TEST_PRECISION(float)

}  // namespace cayspin::inline v0_2

namespace cayspin::test {

using NaturalSlab = decltype(Slab{}.natural());
using OrthogonalSlab = decltype(Slab{}.orthogonal());

#define CAYSPIN_TEST_RUN(Stepper, Generator)                                                       \
  CAYSPIN_TEST_COMPILES template void advance(Stepper<Spins>&, Generator const&, Spins&, double,   \
                                              std::int64_t, std::int64_t);                         \
  CAYSPIN_TEST_COMPILES template Spins run<Stepper<Spins>>(Generator const&, Spins const&, double, \
                                                           std::int64_t);
CAYSPIN_TEST_RUN(Rkmk4, NaturalSlab)
CAYSPIN_TEST_RUN(Rkmk4, OrthogonalSlab)
CAYSPIN_TEST_RUN(LieHeun, NaturalSlab)
CAYSPIN_TEST_RUN(LieHeun, OrthogonalSlab)
CAYSPIN_TEST_RUN(LieEuler, NaturalSlab)
CAYSPIN_TEST_RUN(LieEuler, OrthogonalSlab)
CAYSPIN_TEST_COMPILES template Spins random_spins<Spins>(Lattice const&, unsigned);
CAYSPIN_TEST_COMPILES template double largest_distance(Spins const&, Spins const&);

}  // namespace cayspin::test

namespace testing {

CAYSPIN_TEST_COMPILES template std::string PrintToString(int const&);
CAYSPIN_TEST_COMPILES template std::string PrintToString(std::int64_t const&);
CAYSPIN_TEST_COMPILES template std::string PrintToString(std::size_t const&);
CAYSPIN_TEST_COMPILES template std::string PrintToString(double const&);
CAYSPIN_TEST_COMPILES template std::string PrintToString(std::string const&);
CAYSPIN_TEST_COMPILES template std::string PrintToString(std::vector<double> const&);

}  // namespace testing
#endif
