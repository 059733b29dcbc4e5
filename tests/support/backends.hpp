// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/spin_field.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace cayspin::test {

/// A precision and an execution space, for typed tests.
template <class RealType, class ExecType>
struct Backend {
  using Real = RealType;
  using Exec = ExecType;
  using MemorySpace = typename Exec::memory_space;
  using Spins = SpinField<Real, MemorySpace>;
};

template <class First, class... Spaces>
struct BothPrecisions {
  using type = ::testing::Types<Backend<float, Spaces>..., Backend<double, Spaces>...>;
};

/// Both precisions on the default host space and on the space of a device, if there is one. With
/// CAYSPIN_BUILD_ALL_TESTS on every compiled space; with an emulated device only on that one.
#if defined(CAYSPIN_HOST_DEVICE)
using Backends = typename BothPrecisions<void, HostDevice>::type;
#else
using Backends = typename BothPrecisions<void
#if !defined(CAYSPIN_TEST_ALL_SPACES)
                                         ,
                                         Kokkos::DefaultHostExecutionSpace
#else
#if defined(KOKKOS_ENABLE_SERIAL)
                                         ,
                                         Kokkos::Serial
#endif
#if defined(KOKKOS_ENABLE_OPENMP)
                                         ,
                                         Kokkos::OpenMP
#endif
#if defined(KOKKOS_ENABLE_THREADS)
                                         ,
                                         Kokkos::Threads
#endif
#endif
#if defined(KOKKOS_ENABLE_CUDA)
                                         ,
                                         Kokkos::Cuda
#endif
#if defined(KOKKOS_ENABLE_HIP)
                                         ,
                                         Kokkos::HIP
#endif
#if defined(KOKKOS_ENABLE_SYCL)
                                         ,
                                         Kokkos::SYCL
#endif
                                         >::type;
#endif

struct BackendName {
  template <class Type>
  static std::string GetName(int) {
    return std::string(sizeof(typename Type::Real) == sizeof(double) ? "double" : "float") + "_" +
           Type::Exec::name();
  }
};

/// Fixture of typed tests on a backend.
template <class Backend>
struct OnBackend : ::testing::Test {
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;
};

using Precisions = ::testing::Types<float, double>;

struct PrecisionName {
  template <class Real>
  static std::string GetName(int) {
    return sizeof(Real) == sizeof(double) ? "double" : "float";
  }
};

template <class Real>
inline constexpr double epsilon = std::numeric_limits<Real>::epsilon();

/// Returns `count` unit vectors, which depend only on the seed, not on the platform.
inline std::vector<double> random_directions(std::int64_t count, unsigned seed) {
  std::mt19937 engine(seed);
  auto const uniform = [&] { return engine() * 0x1p-31 - 1; };
  std::vector<double> numbers;
  while (static_cast<std::int64_t>(numbers.size()) < 3 * count) {
    double const x = uniform(), y = uniform(), z = uniform(), length = std::hypot(x, y, z);
    if (length < 0.1 || length > 1) continue;
    for (double const c : {x, y, z}) numbers.push_back(c / length);
  }
  return numbers;
}

/// Returns a field with these numbers, (sites, 3), rounded to Real.
template <class Spins>
Spins spins_of(Lattice const& lattice, std::vector<double> const& numbers) {
  Spins spins("spins", lattice);
  copy_from_host(numbers, spins);
  return spins;
}

/// Returns the values of a field, (sites, 3), in double.
template <class Field>
std::vector<double> numbers_of(Field const& field) {
  auto const numbers = copy_to_host(field);
  return {numbers.begin(), numbers.end()};
}

inline Vec3<double> at(std::vector<double> const& numbers, std::int64_t site) {
  return {numbers[3 * site], numbers[3 * site + 1], numbers[3 * site + 2]};
}

inline void expect_near(Vec3<double> const& found, Vec3<double> const& expected, double bound) {
  EXPECT_NEAR(found.x, expected.x, bound);
  EXPECT_NEAR(found.y, expected.y, bound);
  EXPECT_NEAR(found.z, expected.z, bound);
}

}  // namespace cayspin::test
