// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/random_bits.hpp>
#include <cayspin/integrate.hpp>
#include <cayspin/part.hpp>
#include <cayspin/rotation/random_turn.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_1 {

namespace detail {

/// One turn for all sites.
template <class Real, bool OnHost>
struct OneTurn {
  RandomTurn<Real, OnHost> turn;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION RandomTurn<Real, OnHost> const& at(Site const&) const {
    return turn;
  }
  template <class Site, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector kept(Site const&, Vector const&, Vector const& after) const {
    return after;
  }
};

/// One for each site of a crystal's cell, and none where a spin does not move.
template <class Real, bool OnHost>
struct TurnOfCellSite {
  RandomTurn<Real, OnHost> const* turns;
  std::int32_t cell_sites;
  SiteArray<Real, 1> moves;  // without data: all do

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION RandomTurn<Real, OnHost> const& at(Site const& site) const {
    return turns[site.z() % cell_sites];
  }
  template <class Site, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector kept(Site const& site, Vector const& before,
                                          Vector const& after) const {
    using Value = typename Site::value_type;
    if (!moves.data) return after;
    return select<Value>(site.load(moves) == Value(0), before, after);
  }
};

/// The turns of a cell's sites, made for the length of step that was asked for last. A copy has its
/// own.
template <class Real, class MemorySpace>
class CellTurns {
  static constexpr bool on_host = is_host_execution<typename MemorySpace::execution_space>;

 public:
  using Turn = RandomTurn<Real, on_host>;

  CellTurns() = default;
  explicit CellTurns(std::size_t count) : turns_("cayspin::ThermalNoise::cell_sites", count) {}
  CellTurns(CellTurns const& other) : CellTurns(other.turns_.size()) {}
  CellTurns(CellTurns&&) noexcept = default;
  CellTurns& operator=(CellTurns other) noexcept {
    std::swap(turns_, other.turns_);
    std::swap(made_for_, other.made_for_);
    return *this;
  }
  ~CellTurns() = default;

  /// turn_of(site) of each site of a cell, unless they were made for `u` before; then waits.
  template <class Exec, class TurnOf>
  TurnOfCellSite<Real, on_host> get(Exec const& exec, double u, TurnOf const& turn_of) {
    if (u != made_for_) {
      auto const turns = Kokkos::create_mirror_view(turns_);
      for (std::size_t site = 0; site < turns.size(); ++site) turns(site) = turn_of(site);
      exec.fence("cayspin::ThermalNoise: the turns before are done");
      Kokkos::deep_copy(exec, turns_, turns);
      exec.fence("cayspin::ThermalNoise: turns of a cell's sites");
      made_for_ = u;
    }
    return {turns_.data(), static_cast<std::int32_t>(turns_.size()), {}};
  }

 private:
  Kokkos::View<Turn*, MemorySpace> turns_;
  double made_for_ = -1;
};

/// Both halves of the noise between two steps, or one of them.
template <class Real, bool OnHost, class Turns = OneTurn<Real, OnHost>>
struct TurnAtRandom {
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;
  RandomBits<OnHost> random;
  Turns turns;
  bool after, before;                     // which halves
  std::int64_t first_y, first_z, ny, nz;  // of the part in the whole lattice, and that
  std::uint64_t places;                   // for random bits, in a row

  static std::uint64_t places_of_row(std::int64_t nx) {
    constexpr auto lanes = RandomBits<OnHost>::most_lanes;
    return (static_cast<std::uint64_t>(nx) + lanes - 1) / lanes * lanes;
  }

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    using Bits = typename RandomTurn<Real, OnHost>::Bits;
    std::int64_t const y = wrapped(first_y + site.y(), ny), z = wrapped(first_z + site.z(), nz);
    auto const row = static_cast<std::uint64_t>(z * ny + y) * places;
    auto const bits =
        random.template get<Bits, lanes_of<Value>>(row + static_cast<std::uint64_t>(site.x()));
    auto const& turn = turns.at(site);
    Vec3<Value> const found = site.load(spins);
    Vec3<Value> m = found;
    if (after) {
      // The turn's own round-off is the same in each step: left alone, lengths would drift.
      m = turn.template turned<0>(bits, m);
      m = multiply_add(Value(Real(-0.5)), dot(m, m), Value(Real(1.5))) * m;
    }
    if (before) m = turn.template turned<5>(bits, m);
    site.store(turns.kept(site, found, m), output);
  }

 private:
  // Ghosts are less than a lattice away.
  KOKKOS_FORCEINLINE_FUNCTION static std::int64_t wrapped(std::int64_t at, std::int64_t extent) {
    return at < 0 ? at + extent : at < extent ? at : at - extent;
  }
};

}  // namespace detail

/// Options of ThermalNoise.
struct ThermalNoiseOptions {
  double temperature = 0;  ///< in units of moment times field: kB T over the energy of a site
  std::uint64_t seed = 0;
  /// The gyromagnetic ratio over the moment of each site of a crystal's cell, and 0 without a spin.
  /// Empty: all 1.
  std::vector<double> cell_sites = {};
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
    auto const sites = static_cast<std::int64_t>(options.cell_sites.size());
    if (sites != 0 && sites != like.lattice().cell_sites)
      throw std::invalid_argument(
          "cayspin::ThermalNoise: there is not one number for each site of a cell");
    for (double const number : options.cell_sites)
      if (!(number >= 0) || !std::isfinite(number))
        throw std::invalid_argument(
            "cayspin::ThermalNoise: the numbers of a cell's sites must be finite and >= 0");
    cell_turns_ = CellTurns(options.cell_sites.size());
  }
  /// The same, without noise where `moves` is 0.
  ThermalNoise(Spins const& like, double damping, ThermalNoiseOptions const& options,
               ScalarField<Real, typename Spins::memory_space> const& moves)
      : ThermalNoise(like, damping, options) {
    require_lattice("cayspin::ThermalNoise", lattice_, moves.lattice());
    moves_ = moves;
    if (options_.cell_sites.empty()) {
      options_.cell_sites.assign(static_cast<std::size_t>(lattice_.cell_sites), 1);
      cell_turns_ = CellTurns(options_.cell_sites.size());
    }
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
    return BetweenSteps<true, false>{*this, times.first};
  }
  /// An observer: the first half of the step that follows. The last among the observers: one that
  /// may stop the run is refused after it when compiled.
  auto before_steps() const { return BetweenSteps<false, true>{*this}; }
  /// Both in one pass, where no observer is between them; refused as before_steps.
  auto between_steps(Times const& times) const {
    return BetweenSteps<true, true>{*this, times.first};
  }

 private:
  /// Between a step and the next one: the half after that step, the one before the next, or both.
  template <class Exec>
  void turn_between(Exec const& exec, std::int64_t step, bool after, bool before, double dt,
                    Spins const& spins) const {
    detail::check_access<Exec, typename Spins::memory_space>();
    require_lattice("cayspin::ThermalNoise", lattice_, spins.lattice());
    double const u = damping_ * options_.temperature * std::abs(dt);
    double const largest = options_.cell_sites.empty() ? 1 : std::ranges::max(options_.cell_sites);
    if (!(largest * u <= 1))
      throw std::invalid_argument(
          "cayspin::ThermalNoise: damping temperature dt must be at most 1: a smaller dt");
    if (u == 0) return;
    if (options_.cell_sites.empty()) {
      run(exec, step, after, before, spins, detail::OneTurn<Real, on_host<Exec>>{turn_of<Exec>(u)});
      return;
    }
    auto turns = cell_turns_.get(
        exec, u, [&](std::size_t site) { return turn_of<Exec>(u * options_.cell_sites[site]); });
    if (moves_.lattice() == lattice_) turns.moves = moves_.array();
    run(exec, step, after, before, spins, turns);
  }

  template <class Exec>
  static constexpr bool on_host = detail::is_host_execution<Exec>;
  template <class Exec>
  static detail::RandomTurn<Real, on_host<Exec>> turn_of(double u) {
    return detail::RandomTurn<Real, on_host<Exec>>(u - u * u / 12);
  }

  template <class Exec, class TurnsOfSites>
  void run(Exec const& exec, std::int64_t step, bool after, bool before, Spins const& spins,
           TurnsOfSites const& turns) const {
    auto const& all = whole(lattice_);
    auto const begin = lattice_.part ? lattice_.part->begin() : std::array<std::int64_t, 3>{};
    using Kernel = detail::TurnAtRandom<Real, on_host<Exec>, TurnsOfSites>;
    Kernel const kernel{spins.array(),
                        spins.output(false),
                        {options_.seed, static_cast<std::uint64_t>(step)},
                        turns,
                        after,
                        before,
                        begin[1],
                        begin[2],
                        all.shape[1],
                        all.shape[2],
                        Kernel::places_of_row(all.shape[0])};
    detail::for_each_site<Real>(exec, "cayspin::ThermalNoise", spins.layout(), kernel);
  }

  /// Of the two halves between steps, those that are wanted.
  template <bool After, bool Before>
  struct BetweenSteps {
    static constexpr bool changes_spins = true, begins_step = Before;
    ThermalNoise noise;
    std::int64_t first = 0;  // no step ends there

    template <class Exec>
    void operator()(Exec const& exec, Step const& step, Spins const& spins) const {
      // A run that is stopped may go on: that begins with this half.
      bool const ends = After && step.number > first, begins = Before && !step.last && !step.stops;
      if (ends || begins) noise.turn_between(exec, step.number, ends, begins, step.dt, spins);
    }
  };

  using CellTurns = detail::CellTurns<Real, typename Spins::memory_space>;

  Lattice lattice_;
  double damping_;
  ThermalNoiseOptions options_;
  ScalarField<Real, typename Spins::memory_space> moves_;
  mutable CellTurns cell_turns_;
};

}  // namespace cayspin::inline v0_1
