// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/philox.hpp>
#include <cayspin/integrate.hpp>
#include <cayspin/part.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace cayspin {

namespace detail {

/// m <- exp(v) m. The components of v are sqrt(3) s, 0 or -sqrt(3) s with the probabilities 1/6,
/// 2/3 and 1/6: the moments of normal numbers of deviation s up to the fifth, which is all that a
/// step of weak order 2 knows of them (Kloeden and Platen 1992, Sec. 14.2). So |v| has four values.
template <class Real>
struct TurnAtRandom {
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;
  std::uint64_t seed, draw;
  bool after, before;                         // which halves
  std::int64_t first_y, first_z, nx, ny, nz;  // of the part in the whole lattice, and that
  // The quaternion of exp(v) is cosine[n] + sine[n] e, with e = v / (sqrt(3) s) and n = e.e.
  Real cosine[4], sine[4];

  /// s^2: the variance of each component.
  void set_variance(double variance) {
    for (int n = 0; n < 4; ++n) {
      double const half_angle = std::sqrt(3 * variance * n) / 2;
      cosine[n] = static_cast<Real>(std::cos(half_angle));
      sine[n] = static_cast<Real>(n == 0 ? 0 : std::sin(half_angle) / std::sqrt(n));
    }
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    std::int64_t const y = (first_y + site.y() + ny) % ny, z = (first_z + site.z() + nz) % nz;
    auto const number = static_cast<std::uint64_t>((z * ny + y) * nx + site.x());
    constexpr int lanes = lanes_of<Value>;
    Real signs[2][3][std::size_t{lanes}];
    for (int lane = 0; lane < lanes; lane += group<lanes>)
      draw_signs<group<lanes>>(number + static_cast<std::uint64_t>(lane), lane, signs);
    Vec3<Value> m = site.load(spins);
    if (after) m = turned(signs[0], m);
    if (before) m = turned(signs[1], m);
    site.store(m, output);
  }

 private:
  // As many counters as fit a register of the processors that there are.
  template <int Lanes>
  static constexpr int group = Lanes < 8 ? Lanes : 8;

  /// -1, 0 or 1 for each half, component and lane: two digits to the base 6 of each random word.
  template <int Count, std::size_t Lanes>
  KOKKOS_FORCEINLINE_FUNCTION void draw_signs(std::uint64_t number, int first,
                                              Real (&signs)[2][3][Lanes]) const {
    constexpr std::uint64_t low_half = 0xFFFFFFFF;
    Philox<Count> random(number, draw);
    random.encrypt(seed);
    for (int c = 0; c < 3; ++c) {
      auto const digit = random.word[c] * 6, next = (digit & low_half) * 6;
      keep_signs<Count>(digit >> 32, signs[0][c] + first);
      keep_signs<Count>(next >> 32, signs[1][c] + first);
    }
  }
  template <int Count, class Words>
  KOKKOS_FORCEINLINE_FUNCTION static void keep_signs(Words const& digits, Real* signs) {
    if constexpr (Count == 1) {
      *signs = digits == 0 ? Real(-1) : digits == 5 ? Real(1) : Real(0);
    } else {
      using Doubles = typename LanesOf<double, Count>::type;
      Doubles const none{}, up = none + 1.0;
      Doubles const found = digits == 0 ? -up : (digits == 5 ? up : none);
      auto const rounded = __builtin_convertvector(found, typename LanesOf<Real, Count>::type);
      std::memcpy(signs, &rounded, sizeof rounded);
    }
  }

  template <class Value, std::size_t Lanes>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> turned(Real const (&signs)[3][Lanes],
                                                 Vec3<Value> const& m) const {
    Vec3<Value> const e{load<Value>(signs[0]), load<Value>(signs[1]), load<Value>(signs[2])};
    Value const n = dot(e, e);
    Vec3<Value> const w = of_four(sine, n) * e, c = cross(w, m);
    return multiply_add(Value(2), multiply_add(of_four(cosine, n), c, cross(w, c)), m);
  }

  /// The entry of a table for n = 0, 1, 2 or 3.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value of_four(Real const (&table)[4], Value const& n) {
    Value const low = select<Value>(n < Value(Real(0.5)), Value(table[0]), Value(table[1]));
    Value const high = select<Value>(n < Value(Real(2.5)), Value(table[2]), Value(table[3]));
    return select<Value>(n < Value(Real(1.5)), low, high);
  }
};

}  // namespace detail

/// Options of ThermalNoise.
struct ThermalNoiseOptions {
  double temperature = 0;  ///< in units of moment times field: kB T over the energy of a site
  std::uint64_t seed = 0;
};

/// The noise of a temperature around the steps of any one-step method for LandauLifshitz with
/// damping: half of it before each step and half after. A half turns each spin by a random angle
/// about a random axis, of which the variance per component is s^2 = u - u^2/12 with
/// u = damping temperature dt. Spins without a field then diffuse with an error of the third order
/// in u. The whole is a splitting of second order. It tends to Boltzmann's distribution of
/// E / temperature.
///   ThermalNoise const noise(spins, damping, {.temperature = 0.5, .seed = 1});
///   integrate(exec, stepper, generator, spins, times, noise.after_steps(times), observers...,
///             noise.before_steps());
/// Without observers in between, noise.between_steps(times) does both at once. The random numbers
/// are those of Philox by seed, site and step: the bits do not depend on threads, host spaces or
/// ranks, nor on where a run is cut. Costs no memory and two passes a step. Refused when compiled
/// with an AdaptiveStepper. Methods that remember steps lose their order.
template <class Spins>
class ThermalNoise {
  using Real = typename Spins::value_type;

 public:
  enum class Half { before, after };

  /// Throws std::invalid_argument for a temperature or damping that is negative or not finite.
  ThermalNoise(Spins const& like, double damping, ThermalNoiseOptions const& options)
      : lattice_(like.lattice()), damping_(damping), options_(options) {
    if (!(damping >= 0) || !std::isfinite(damping))
      throw std::invalid_argument("cayspin::ThermalNoise: the damping must be finite and >= 0");
    if (!(options.temperature >= 0) || !std::isfinite(options.temperature))
      throw std::invalid_argument("cayspin::ThermalNoise: the temperature must be finite and >= 0");
  }

  /// The noise before or after step number `step`, of length dt, also of ghosts.
  /// Throws std::invalid_argument where half of a step would turn spins by more than a radian, and
  /// for spins on another lattice.
  template <class Exec>
  void turn(Exec const& exec, std::int64_t step, Half half, double dt, Spins const& spins) const {
    bool const after = half == Half::after;
    turn_between(exec, after ? step : step - 1, after, !after, dt, spins);
  }

  /// An observer: the second half of each step. The first among the observers, so that the others
  /// see the spins as they are after it.
  auto after_steps(Times const& times) const {
    return BetweenSteps{*this, true, false, times.first};
  }
  /// An observer: the first half of the step that follows. The last among the observers.
  auto before_steps() const { return BetweenSteps{*this, false, true}; }
  /// Both in one pass, where no observer is between them.
  auto between_steps(Times const& times) const {
    return BetweenSteps{*this, true, true, times.first};
  }

 private:
  /// Between a step and the next one: the half after that step, the one before the next, or both.
  template <class Exec>
  void turn_between(Exec const& exec, std::int64_t step, bool after, bool before, double dt,
                    Spins const& spins) const {
    detail::check_access<Exec, typename Spins::memory_space>();
    require_lattice("cayspin::ThermalNoise", lattice_, spins.lattice());
    double const u = damping_ * options_.temperature * std::abs(dt);
    if (!(u <= 1))
      throw std::invalid_argument(
          "cayspin::ThermalNoise: damping temperature dt must be at most 1: a smaller dt");
    if (u == 0) return;
    auto const& all = whole(lattice_);
    auto const begin = lattice_.part ? lattice_.part->begin() : std::array<std::int64_t, 3>{};
    detail::TurnAtRandom<Real> kernel{};
    kernel.spins = spins.array();
    kernel.output = spins.output(false);
    kernel.seed = options_.seed;
    kernel.draw = static_cast<std::uint64_t>(step);
    kernel.after = after;
    kernel.before = before;
    kernel.first_y = begin[1];
    kernel.first_z = begin[2];
    kernel.nx = all.shape[0];
    kernel.ny = all.shape[1];
    kernel.nz = all.shape[2];
    kernel.set_variance(u - u * u / 12);
    detail::for_each_site<Real>(exec, "cayspin::ThermalNoise", spins.layout(), kernel);
  }

  /// Of the two halves between steps, those that are wanted.
  struct BetweenSteps {
    static constexpr bool changes_spins = true;
    ThermalNoise noise;
    bool after, before;
    std::int64_t first = 0;  // no step ends there

    template <class Exec>
    void operator()(Exec const& exec, Step const& step, Spins const& spins) const {
      bool const ends = after && step.number > first, begins = before && !step.last;
      if (ends || begins) noise.turn_between(exec, step.number, ends, begins, step.dt, spins);
    }
  };

  Lattice lattice_;
  double damping_;
  ThermalNoiseOptions options_;
};

}  // namespace cayspin
