// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "larger.hpp"

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace cayspin::test {

// Small lattices run fastest on one thread; the host spaces agree bit for bit (tests/backends).
#if defined(KOKKOS_ENABLE_SERIAL)
using Host = Kokkos::Serial;
#else
using Host = Kokkos::DefaultHostExecutionSpace;
#endif
using Space = std::conditional_t<detail::is_host_execution<Kokkos::DefaultExecutionSpace>, Host,
                                 Kokkos::DefaultExecutionSpace>;

using Vector = Vec3<double>;
using Spins = SpinField<double, Space::memory_space>;

inline double length(Vector const& v) { return std::hypot(v.x, v.y, v.z); }

/// The Landau-Lifshitz equation with all terms of a slab; those with constant 0 have no effect.
struct Slab {
  Lattice lattice;
  double exchange = 0, anisotropy = 0;
  Vector axis{0, 0, 1};
  double demag = 0;  // normal x
  Vector applied{0, 0, 0};
  double damping = 0;
  bool precession = true;

  auto field() const {
    return EffectiveField{Exchange{lattice, exchange}, UniaxialAnisotropy{anisotropy, axis},
                          SlabDemag{Vector{1, 0, 0}, demag}, Zeeman{applied}};
  }
  auto natural() const { return LandauLifshitz{field(), damping, precession}; }
  auto orthogonal() const { return cayspin::orthogonal(natural()); }

  double field_bound() const {
    return exchange_bound(lattice, exchange) + std::abs(anisotropy) + std::abs(demag) +
           length(applied);
  }
};

/// Returns a field with `start(i, j, k)` at every site, normalised.
template <class Field = Spins, class Start>
Field make_spins(Lattice const& lattice, Start const& start) {
  std::vector<double> numbers;
  for (std::int64_t k = 0; k < lattice.shape[2]; ++k)
    for (std::int64_t j = 0; j < lattice.shape[1]; ++j)
      for (std::int64_t i = 0; i < lattice.shape[0]; ++i) {
        Vector const m = start(i, j, k);
        for (double const c : {m.x, m.y, m.z}) numbers.push_back(c / length(m));
      }
  Field field("spins", lattice);
  copy_from_host(numbers, field);
  return field;
}

template <class Field = Spins>
Field random_spins(Lattice const& lattice, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  return make_spins<Field>(lattice, [&](auto, auto, auto) {
    return Vector{normal(engine), normal(engine), normal(engine)};
  });
}

template <class Field>
Field copy_of(Field const& from) {
  Field to("copy", from.lattice());
  copy_from_host(copy_to_host(from), to);
  return to;
}

template <class Field>
Vector spin(Field const& field, std::int64_t site) {
  if constexpr (requires { field.get(site); }) {
    auto const m = field.get(site);
    return {m.x, m.y, m.z};
  } else {
    auto const numbers = copy_to_host(field);
    return {numbers[3 * site], numbers[3 * site + 1], numbers[3 * site + 2]};
  }
}

/// Returns the largest distance between the vectors of two fields at the same site.
template <class A, class B>
double largest_distance(A const& a, B const& b) {
  auto const first = copy_to_host(a);
  auto const second = copy_to_host(b);
  double largest = 0;
  for (std::size_t i = 0; i < first.size(); i += 3)
    largest = larger(largest, length({double(first[i]) - double(second[i]),
                                      double(first[i + 1]) - double(second[i + 1]),
                                      double(first[i + 2]) - double(second[i + 2])}));
  return largest;
}

template <class Stepper, class Generator, class Field>
void advance(Stepper& stepper, Generator const& generator, Field& spins, double dt,
             std::int64_t steps, std::int64_t first = 0) {
  Space const exec{};
  for (std::int64_t n = first; n < first + steps; ++n)
    stepper.step(exec, generator, spins, static_cast<double>(n) * dt, dt);
}

/// Returns a copy of `start` after `steps` steps of a new stepper.
template <class Stepper, class Generator, class Field, class... Options>
Field run(Generator const& generator, Field const& start, double dt, std::int64_t steps,
          Options const&... options) {
  Field spins = copy_of(start);
  Stepper stepper(spins, options...);
  advance(stepper, generator, spins, dt, steps);
  return spins;
}

}  // namespace cayspin::test
