// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Linear modes with an expensive field: their linewidths, and that none grows.
#include "../support/larger.hpp"
#include "long_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

using namespace cayspin;
using namespace cayspin::test;

namespace {

/// Fields along x that grow from spin to spin in a row. The spins are not coupled.
struct RowOfFields {
  static constexpr int degree = 1;
  double first = 0, step = 0;

  double at(std::int64_t i) const { return first + step * static_cast<double>(i); }
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const number = detail::lane_numbers<Value>() + Value(double(stencil.site().x()));
    return Vec3<Value>{Value(first) + Value(step) * number, Value(0.0), Value(0.0)};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(Value(0.0) - dot(stencil.center(), field(stencil)));
  }
};

/// H = -(0, y * m_y, z * m_z), evaluated on the host: the demagnetising field of a mode.
struct Elliptical {
  static constexpr int degree = 2;
  double y = 0, z = 0;

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    using Real = typename HostSpins::value_type;
    for (std::int64_t i = 0; i < spins.sites(); ++i) {
      auto const m = spins.get(i);
      field.set(
          i, {Real(0), static_cast<Real>(-y * double(m.y)), static_cast<Real>(-z * double(m.z))});
    }
  }
};

template <class Spins>
Spins almost_along_x(Lattice const& lattice, double angle) {
  return make_spins<Spins>(lattice, [&](auto i, auto, auto) {
    double const phase = 2.4 * static_cast<double>(i);
    return Vector{1, angle * std::cos(phase), angle * std::sin(phase)};
  });
}

/// A mode of small deviations from x: u' = M * u for u = (m_y, m_z), with
/// M = [-damping * a, -b; a, -damping * b]. Its energy (a * m_y^2 + b * m_z^2) / 2 is known in
/// closed form at any later time.
struct Mode {
  double along, y, z, damping;

  double a() const { return along + y; }
  double b() const { return along + z; }
  double energy(Vector const& m) const { return 0.5 * (a() * m.y * m.y + b() * m.z * m.z); }
  double energy_after(Vector const& m, double t) const {
    double const mean = -0.5 * damping * (a() + b()), half = 0.5 * damping * (b() - a());
    double const w = std::sqrt(a() * b() - half * half), decay = std::exp(mean * t);
    double const c = std::cos(w * t), s = std::sin(w * t) / w;
    return energy({0, decay * ((c + half * s) * m.y - b() * s * m.z),
                   decay * (a() * s * m.y + (c - half * s) * m.z)});
  }
};

/// Returns the largest relative error of a linewidth among modes like those of a film of permalloy,
/// with fields in units of Ms. The standard problem of ferromagnetic resonance is run with dt =
/// 0.22.
template <int Order, class Field>
double error_of_linewidths(double damping, double dt) {
  double worst = 0;
  for (auto const& [along, y, z] :
       {std::array{0.025, 0.08, 0.8}, {0.1, 0.05, 0.75}, {0.18, 0.15, 0.63}}) {
    Lattice const one{{1, 1, 1}};
    auto spins = almost_along_x<Field>(one, std::is_same_v<Field, Spins> ? 1e-3 : 1e-2);
    Mode const mode{along, y, z, damping};
    HostField<Field, Elliptical> const demag(spins, Elliptical{y, z});
    SlowField const slow(spins, demag);
    LandauLifshitz const generator{EffectiveField{Zeeman{Vector{along, 0, 0}}, slow}, damping};
    Multirate<Rkmk4<Field>, std::remove_const_t<decltype(slow)>, Order> stepper(
        spins, Rkmk4<Field>(spins), slow, {.substeps = 2});
    double const lifetime = 2 / (damping * (mode.a() + mode.b()));
    auto const steps = static_cast<std::int64_t>(0.7 * lifetime / dt);
    Vector const start = spin(spins, 0);
    for (std::int64_t n = 0; n < steps; ++n)
      stepper.step(Space{}, generator, spins, static_cast<double>(n) * dt, dt);
    double const t = static_cast<double>(steps) * dt;
    double const exact = mode.energy_after(start, t), found = mode.energy(spin(spins, 0));
    worst = larger(worst, std::abs(std::log(found / exact)) / (2 * t / lifetime));
  }
  return worst;
}

TEST(MultirateModes, KeepTheirLinewidths) {
  constexpr double dt = 0.22;
  for (double const damping : {0.002, 0.004, 0.008, 0.01}) {
    double const now = error_of_linewidths<4, Spins>(damping, dt);
    expect_below("order 4, damping " + std::to_string(damping), now, 0.0005);
  }
  // Order 3 changes a damping of 0.008 by more than 1 %.
  EXPECT_GT((error_of_linewidths<3, Spins>(0.008, dt)), 0.01);
  using Floats = SpinField<float, Space::memory_space>;
  expect_below("order 4, floats", error_of_linewidths<4, Floats>(0.008, dt), 5e-3);
  expect_below("order 4, half the step", error_of_linewidths<4, Spins>(0.008, dt / 2), 5e-5);
}

/// Returns the largest factor by which the angle of a spin grows during the second half of the
/// steps, among spins whose frequency * dt is 0.05 to 12. During the first half, transients decay.
template <int Order>
double growth(double damping, double dt_times_d, Elliptical const& shape, int steps) {
  constexpr std::int64_t count = 241;
  Lattice const row{{count, 1, 1}};
  RowOfFields const fields{0.05, 0.05};
  Spins spins = almost_along_x<Spins>(row, 1e-7);
  HostField<Spins, Elliptical> const demag(spins,
                                           Elliptical{shape.y * dt_times_d, shape.z * dt_times_d});
  SlowField const slow(spins, demag);
  LandauLifshitz const generator{EffectiveField{fields, slow}, damping};
  Multirate<Rkmk4<Spins>, std::remove_const_t<decltype(slow)>, Order> stepper(
      spins, Rkmk4<Spins>(spins), slow, {.substeps = 16});
  auto const angles_now = [&] {
    std::vector<double> angles;
    for (std::int64_t i = 0; i < count; ++i) {
      auto const m = spin(spins, i);
      angles.push_back(std::hypot(m.y, m.z));
    }
    return angles;
  };
  std::vector<double> half;
  for (int n = 0; n < steps; ++n) {
    stepper.step(Space{}, generator, spins, n, 1);
    if (n == steps / 2) half = angles_now();
  }
  std::vector<double> const end = angles_now();
  double worst = 0;
  for (std::size_t i = 0; i < half.size(); ++i) {
    // The angle of an elliptical mode oscillates by up to this factor.
    double const w = fields.at(static_cast<std::int64_t>(i));
    double const ellipse = std::sqrt((w + dt_times_d) / w);
    worst = larger(worst, end[i] / (half[i] * ellipse));
  }
  return worst;
}

// For its damping, a Case gives values of dt * (largest eigenvalue of the expensive field) at which
// no mode grows: `stable` for order 4, and `of_order_3` for order 3.
TEST(MultirateModes, DoNotGrow) {
  struct Case {
    double damping, stable, of_order_3;
  };
  for (auto const& [damping, stable, of_order_3] :
       {Case{0.002, 0.05, 0.02}, {0.008, 0.24, 0.08}, {0.02, 0.35, 0.14}, {0.1, 0.5, 0.4}})
    for (Elliptical const& shape : {Elliptical{0, 1}, {0.5, 0.5}, {0.25, 0.75}}) {
      EXPECT_LT(growth<4>(damping, stable, shape, 400), 1) << damping << " " << shape.z;
      EXPECT_LT(growth<3>(damping, of_order_3, shape, 400), 1) << damping << " " << shape.z;
    }
  // At somewhat larger values, some modes grow.
  EXPECT_GT((growth<4>(0.008, 0.35, {0, 1}, 400)), 10);
  EXPECT_GT((growth<3>(0.008, 0.22, {0, 1}, 400)), 10);
}

}  // namespace
