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

/// m <- exp(v) m. With a probability of 2/5 v is 0, otherwise sqrt(5) s times one of the twelve
/// corners of the icosahedron. These have the moments of normal numbers of deviation s up to the
/// fifth, which is all that a step of weak order 2 knows of them (Kloeden and Platen 1992,
/// Sec. 14.2): the corners are a spherical design of strength 5 (Delsarte, Goethals and Seidel
/// 1977).
template <class Real>
struct TurnAtRandom {
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;
  std::uint64_t seed, draw;
  bool after, before;                     // which halves
  std::int64_t first_y, first_z, ny, nz;  // of the part in the whole lattice, and that
  std::uint64_t blocks;                   // of 32 sites in a row
  // The quaternion of exp(v) is cosine + w, with +-small, +-large and 0 for the components of w.
  Real cosine, small, large;

  // A counter has a word for each of four sites, eight counters those of a block.
  static constexpr std::uint32_t counters = 8, block = 4 * counters;

  /// s^2: the variance of each component.
  void set_variance(double variance) {
    double const half_angle = std::sqrt(5 * variance) / 2, golden = (1 + std::sqrt(5.0)) / 2;
    double const radius = std::hypot(1, golden);
    cosine = static_cast<Real>(std::cos(half_angle));
    small = static_cast<Real>(std::sin(half_angle) / radius);
    large = static_cast<Real>(std::sin(half_angle) * golden / radius);
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    std::int64_t const y = wrapped(first_y + site.y(), ny), z = wrapped(first_z + site.z(), nz);
    auto const x = static_cast<std::uint32_t>(site.x());
    auto const of_block = (static_cast<std::uint64_t>(z * ny + y) * blocks + x / block) * counters;
    auto const random = Turns<lanes_of<Value>>(words<lanes_of<Value>>(of_block, x % block));
    Vec3<Value> m = site.load(spins);
    if (after) {
      // The quaternion's own round-off is the same in each step: left alone, lengths would drift.
      m = turned(random, 0, m);
      m = (Value(Real(1.5)) - Value(Real(0.5)) * dot(m, m)) * m;
    }
    if (before) m = turned(random, 1, m);
    site.store(m, output);
  }

 private:
  // Ghosts are less than a lattice away.
  KOKKOS_FORCEINLINE_FUNCTION static std::int64_t wrapped(std::int64_t at, std::int64_t extent) {
    return at < 0 ? at + extent : at < extent ? at : at - extent;
  }

  using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;

  /// Random numbers of sites side by side. 28 bits of a word are two digits to the base 5, which
  /// say what is 0; the others are signs.
  template <int Lanes>
  struct Turns {
    using Numbers = typename LanesOf<Bits, Lanes>::type;
    Numbers signs[2], zero[2];

    KOKKOS_FORCEINLINE_FUNCTION explicit Turns(Numbers const& words) : signs{words, words >> 2} {
      constexpr Bits fraction = (Bits{1} << 28) - 1;
      Numbers const number = words >> 4, first = number + (number << 2);
      Numbers const rest = first & fraction, second = rest + (rest << 2);
      zero[0] = first >> 28;
      zero[1] = second >> 28;
    }
  };

  /// The words of site `x` of a block and those beside it.
  template <int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION auto words(std::uint64_t of_block, std::uint32_t x) const {
    if constexpr (Lanes == 1) {
      Philox<1> random(of_block + x % counters, draw);
      random.encrypt(seed);
      // By constant indices: an array on the stack of a device is slow.
      auto const& word = random.word;
      auto const even = x < 2 * counters ? word[0] : word[2];
      auto const odd = x < 2 * counters ? word[1] : word[3];
      return static_cast<Bits>(x / counters % 2 == 0 ? even : odd);
    } else {
      if (block_drawn != of_block) draw_block(of_block);
      typename LanesOf<std::uint32_t, Lanes>::type found;
      std::memcpy(&found, drawn + x, sizeof found);
      return __builtin_convertvector(found, typename LanesOf<Bits, Lanes>::type);
    }
  }
  KOKKOS_FORCEINLINE_FUNCTION void draw_block(std::uint64_t of_block) const {
    Philox<counters> random(of_block, draw);
    random.encrypt(seed);
    for (std::uint32_t k = 0; k < 4; ++k) {
      auto const narrow =
          __builtin_convertvector(random.word[k], typename LanesOf<std::uint32_t, counters>::type);
      std::memcpy(drawn + k * counters, &narrow, sizeof narrow);
    }
    block_drawn = of_block;
  }

  template <class Value, int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> turned(Turns<Lanes> const& random, int half,
                                                 Vec3<Value> const& m) const {
    constexpr int top = 8 * sizeof(Bits) - 1;
    constexpr Bits sign = Bits{1} << top;
    auto const of_small = Kokkos::bit_cast<Bits>(small) | (random.signs[half] << top);
    auto const of_large =
        Kokkos::bit_cast<Bits>(large) | ((random.signs[half] << (top - 1)) & sign);
    auto const& zero = random.zero[half];
    auto const x_zero = mask(zero == 0), y_zero = mask(zero == 1), z_zero = mask(zero == 2);
    Vec3<Value> const w{value<Value>((y_zero & of_large) | (z_zero & of_small)),
                        value<Value>((z_zero & of_large) | (x_zero & of_small)),
                        value<Value>((x_zero & of_large) | (y_zero & of_small))};
    Vec3<Value> const c = cross(w, m);
    return multiply_add(Value(2), multiply_add(Value(cosine), c, cross(w, c)), m);
  }

  // All bits where a condition holds.
  KOKKOS_FORCEINLINE_FUNCTION static Bits mask(bool condition) {
    return condition ? ~Bits{0} : Bits{0};
  }
  template <class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static auto mask(Numbers const& conditions) {
    return conditions;
  }
  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static Value value(Numbers const& bits) {
    Real numbers[std::size_t{lanes_of<Value>}];
    std::memcpy(numbers, &bits, sizeof numbers);
    return load<Value>(numbers);
  }

  // Of the block drawn last: packs of a row follow one another. Not used on devices.
  mutable std::uint64_t block_drawn = ~std::uint64_t{0};
  mutable std::uint32_t drawn[block] = {};
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

  /// The noise after step number `step` and before the next one, in one pass: the bits of two calls
  /// of turn. Throws as turn does.
  template <class Exec>
  void turn_between_steps(Exec const& exec, std::int64_t step, double dt,
                          Spins const& spins) const {
    turn_between(exec, step, true, true, dt, spins);
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
    kernel.blocks = (static_cast<std::uint64_t>(all.shape[0]) + kernel.block - 1) / kernel.block;
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
