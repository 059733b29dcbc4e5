// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/field/coefficient.hpp>
#include <cayspin/integrate.hpp>
#include <cayspin/observer/turns_at_random.hpp>
#include <cayspin/part.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

/// Options of ThermalNoise.
struct ThermalNoiseOptions {
  double temperature = 0;  ///< in units of moment times field: kB * T / (energy unit of a site)
  std::uint64_t seed = 0;  ///< replica r of the lattice uses seed + r
  /// Gyromagnetic ratio divided by the moment, for each site of a crystal's cell; 0 where there is
  /// no spin. Empty: all 1.
  std::vector<double> cell_sites = {};
  /// Factor that multiplies damping * temperature in each replica of the lattice. Empty: all 1.
  std::vector<double> replicas = {};
  /// If true, the columns (sites with equal x) are independent lattices whose first axis is y.
  /// Column x gets the random numbers of such a lattice with seed + x, and `replicas` has a factor
  /// for each column.
  bool columns_are_replicas = false;
};

/// Thermal noise for LandauLifshitz with damping and any one-step method: half of it is applied
/// before each step and half after. A half turns each spin by a random rotation vector, whose
/// components have the variance u - u^2 / 12 with u = damping * temperature * dt. Spins without a
/// field then diffuse with an error of third order in u. Together with the step this is a splitting
/// of second order, which samples Boltzmann's distribution exp(-E / temperature).
///   ThermalNoise const noise(spins, damping, {.temperature = 0.5, .seed = 1});
///   integrate(exec, stepper, generator, spins, times, noise.after_steps(times), observers...,
///             noise.before_steps());
/// Without observers in between, noise.between_steps(times) applies both halves at once. Random
/// numbers come from Philox, keyed by seed, site and step: results are bitwise independent of
/// threads, host spaces and ranks, and of where a run is interrupted, and each replica moves as it
/// would as a separate lattice. Costs two passes per step (one with between_steps), and no memory
/// per site. Does not compile with an AdaptiveStepper. Multistep methods lose their order.
template <class Spins>
class ThermalNoise {
  using Real = typename Spins::value_type;

 public:
  enum class Half { before, after };

  /// Throws std::invalid_argument for spins that have no sites, for a temperature, damping or
  /// factor that is negative or not finite, and if options.cell_sites or options.replicas is
  /// neither empty nor of the right size. With options.columns_are_replicas, also throws on a
  /// lattice with replicas, on a part of a lattice, and if options.cell_sites is not empty.
  ThermalNoise(Spins const& like, double damping, ThermalNoiseOptions const& options)
      : lattice_(detail::validated(like.lattice())), damping_(damping), options_(options) {
    if (!(damping >= 0) || !std::isfinite(damping))
      throw std::invalid_argument("cayspin::ThermalNoise: the damping must be finite and >= 0");
    if (!(options.temperature >= 0) || !std::isfinite(options.temperature))
      throw std::invalid_argument("cayspin::ThermalNoise: the temperature must be finite and >= 0");
    check(options.cell_sites, like.lattice().cell_sites, "site of a cell");
    check(options.replicas,
          options.columns_are_replicas ? lattice_.shape[0] : like.lattice().replicas, "replica");
    if (options.columns_are_replicas && (lattice_.replicas > 1 || lattice_.part != nullptr))
      throw std::invalid_argument(
          "cayspin::ThermalNoise: columns of a part of a lattice, or of a lattice with replicas, "
          "cannot be replicas");
    if (options.columns_are_replicas && !options.cell_sites.empty())
      throw std::invalid_argument(
          "cayspin::ThermalNoise: columns of crystals cannot be replicas; accepted: no numbers of "
          "a cell's sites");
    make_room_for_turns();
  }
  /// Multiplies damping * temperature at each site by a factor, which may contain the damping, the
  /// temperature, or 1 / moment; 0 where a spin does not move. If there are factors other than 0
  /// and 1, options.cell_sites and options.replicas must be empty. Throws std::invalid_argument if
  /// that rule is broken, if columns are to be replicas, for factors on another lattice, for a
  /// negative or non-finite factor, and like the other constructor.
  ThermalNoise(Spins const& like, double damping, ThermalNoiseOptions const& options,
               ScalarField<Real, typename Spins::memory_space> const& factors)
      : ThermalNoise(like, damping, options) {
    require_lattice("cayspin::ThermalNoise's factors", factors.lattice(), lattice_);
    if (options.columns_are_replicas)
      throw std::invalid_argument(
          "cayspin::ThermalNoise: columns with factors of sites cannot be replicas");
    auto const signs = detail::signs_of(factors, "cayspin::ThermalNoise: the factors");
    if (signs.negative)
      throw std::invalid_argument("cayspin::ThermalNoise: the factors must be >= 0 on every site");
    factors_ = factors;
    if (!signs.zero_or_one) {
      if (!options.cell_sites.empty() || !options.replicas.empty())
        throw std::invalid_argument(
            "cayspin::ThermalNoise: factors of sites beside numbers of a cell's sites or of "
            "replicas: one of the two");
      typename Spins::memory_space::execution_space const exec;
      largest_factor_ = detail::reduce_sites<detail::Maximum, 1>(
          exec, "cayspin::ThermalNoise::largest_factor", factors.layout(),
          detail::LargestNumber<Real>{factors.array()})[0];
    } else if (options_.cell_sites.empty()) {
      options_.cell_sites.assign(static_cast<std::size_t>(lattice_.cell_sites), 1);
      make_room_for_turns();
    }
  }

  /// Sets the temperature for later calls of turn and turn_between_steps. Observers that were made
  /// before are copies, and keep their temperature. Throws std::invalid_argument if it is negative
  /// or not finite.
  void set_temperature(double temperature) {
    if (!(temperature >= 0) || !std::isfinite(temperature))
      throw std::invalid_argument("cayspin::ThermalNoise: the temperature must be finite and >= 0");
    options_.temperature = temperature;
  }

  /// Applies the noise before or after step number `step`, of length dt, also to ghosts. Throws
  /// std::invalid_argument if u (with the largest factor) is above 1, where a half would turn spins
  /// by about a radian, and for spins on another lattice.
  template <class Exec>
  void turn(Exec const& exec, std::int64_t step, Half half, double dt, Spins const& spins) const {
    bool const after = half == Half::after;
    turn_between(exec, after ? step : step - 1, after, !after, dt, spins);
  }

  /// Applies the noise after step number `step` and before the next one, in one pass, bitwise like
  /// two calls of turn. Throws like turn.
  template <class Exec>
  void turn_between_steps(Exec const& exec, std::int64_t step, double dt,
                          Spins const& spins) const {
    turn_between(exec, step, true, true, dt, spins);
  }

  /// Returns an observer that applies the half after each step. Put it first, so that the other
  /// observers see spins to which this half has been applied.
  auto after_steps(Times const& times) const {
    return BetweenSteps<true, false>{*this, times.first};
  }
  /// Returns an observer that applies the half before the next step. Put it last: a later observer
  /// that may stop the run does not compile.
  auto before_steps() const { return BetweenSteps<false, true>{*this}; }
  /// Returns an observer that applies both halves in one pass, for runs without observers between
  /// them. Put it last, like before_steps.
  auto between_steps(Times const& times) const {
    return BetweenSteps<true, true>{*this, times.first};
  }

 private:
  /// Applies noise between two steps: the half after the first, the half before the second, or
  /// both.
  template <class Exec>
  void turn_between(Exec const& exec, std::int64_t step, bool after, bool before, double dt,
                    Spins const& spins) const {
    detail::check_access<Exec, typename Spins::memory_space>();
    require_lattice("cayspin::ThermalNoise", lattice_, spins.lattice());
    double const u = damping_ * options_.temperature * std::abs(dt);
    auto const largest_of = [](std::vector<double> const& numbers) {
      return numbers.empty() ? 1 : std::ranges::max(numbers);
    };
    double const largest = largest_factor_
                               ? *largest_factor_
                               : largest_of(options_.cell_sites) * largest_of(options_.replicas);
    if (!(largest * u <= 1))
      throw std::invalid_argument(
          "cayspin::ThermalNoise: damping * temperature * dt must be at most 1: a smaller dt");
    if (u == 0) return;
    if (largest_factor_) {
      run(exec, step, after, before, spins,
          detail::TurnOfSite<Real>{static_cast<Real>(u), factors_.array()});
      return;
    }
    if (options_.cell_sites.empty() && options_.replicas.empty()) {
      run(exec, step, after, before, spins, detail::OneTurn<Real, on_host<Exec>>{turn_of<Exec>(u)});
      return;
    }
    if (options_.columns_are_replicas) {
      run(exec, step, after, before, spins, turns_of_columns(exec, u, dt));
      return;
    }
    auto const sites = std::max<std::size_t>(options_.cell_sites.size(), 1);
    auto const* const found = cell_turns_.get(exec, u, [&](auto const& turns) {
      for (std::size_t number = 0; number < turns.size(); ++number) {
        double const of_replica = options_.replicas.empty() ? 1 : options_.replicas[number / sites];
        double const of_site =
            options_.cell_sites.empty() ? 1 : options_.cell_sites[number % sites];
        // Multiplied in the same order as for a separate lattice at this temperature, so that
        // results are bitwise identical.
        double const temperature = options_.temperature * of_replica;
        double const of_all = damping_ * temperature * std::abs(dt) * of_site;
        turns(number) = {turn_of<Exec>(of_all), of_all == 0};
      }
    });
    detail::TurnOfCellSite<Real, on_host<Exec>> turns{
        found,
        static_cast<std::int32_t>(sites),
        options_.replicas.empty() ? 0 : spins.layout().replica_planes,
        {}};
    if (factors_.lattice() == lattice_) turns.moves = factors_.array();
    run(exec, step, after, before, spins, turns);
  }

  static void check(std::vector<double> const& numbers, std::int64_t count, char const* what) {
    if (!numbers.empty() && static_cast<std::int64_t>(numbers.size()) != count)
      throw std::invalid_argument(
          std::string("cayspin::ThermalNoise: there is not one number for each ") + what);
    for (double const number : numbers)
      if (!(number >= 0) || !std::isfinite(number))
        throw std::invalid_argument(std::string("cayspin::ThermalNoise: the number of each ") +
                                    what + " must be finite and >= 0");
  }
  void make_room_for_turns() {
    auto const replicas = options_.replicas.size(), sites = options_.cell_sites.size();
    if (replicas == 0 && sites == 0) return;
    if (options_.columns_are_replicas)
      // Packs read past the last column.
      column_numbers_ = ColumnNumbers(4 * (replicas + detail::RandomBits<true>::most_lanes));
    else
      cell_turns_ = CellTurns(std::max<std::size_t>(replicas, 1) * std::max<std::size_t>(sites, 1));
  }

  template <class Exec>
  detail::TurnOfColumn<Real> turns_of_columns(Exec const& exec, double u, double dt) const {
    std::size_t const stride = column_numbers_.size() / 4;
    auto const* const found = column_numbers_.get(exec, u, [&](auto const& numbers) {
      for (std::size_t column = 0; column < options_.replicas.size(); ++column) {
        // Multiplied in this order, so that the rounding is that of a lattice at this temperature.
        double const temperature = options_.replicas[column] * options_.temperature;
        auto const turn = turn_of<Exec>(damping_ * temperature * std::abs(dt));
        for (std::size_t i = 0; i < 4; ++i) numbers(i * stride + column) = turn.numbers()[i];
      }
    });
    return {found, static_cast<std::int64_t>(stride)};
  }

  static constexpr char const* label = "cayspin::ThermalNoise";
  template <class Exec>
  static constexpr bool on_host = detail::is_host_execution<Exec>;
  template <class Exec>
  static detail::RandomTurn<Real, on_host<Exec>> turn_of(double u) {
    return detail::RandomTurn<Real, on_host<Exec>>(u - u * u / 12);
  }

  template <class Exec, class TurnsOfSites>
  void run(Exec const& exec, std::int64_t step, bool after, bool before, Spins const& spins,
           TurnsOfSites const& turns) const {
    if (options_.columns_are_replicas) {
      bool const shares_words = on_host<Exec> && spins.layout().rows() > 1;
      if (shares_words)
        run_of_columns<on_host<Exec>>(exec, step, after, before, spins, turns);
      else
        run_of_columns<false>(exec, step, after, before, spins, turns);
      return;
    }
    using Numbers = detail::NumbersOfSites<on_host<Exec>>;
    auto const& all = whole(lattice_);
    auto const begin = lattice_.part ? lattice_.part->begin() : std::array<std::int64_t, 3>{};
    detail::for_each_site<Real>(
        exec, label, spins.layout(),
        detail::TurnAtRandom<Real, TurnsOfSites, Numbers>{
            spins.array(),
            spins.output(false),
            {{options_.seed, static_cast<std::uint64_t>(step)},
             begin[1],
             begin[2],
             all.shape[1],
             all.shape[2],
             Numbers::places_of_row(all.shape[0]),
             spins.layout().has_replicas() ? spins.layout().replica_planes : 0},
            turns,
            after,
            before});
  }

  template <bool Keeps, class Exec, class TurnsOfColumns>
  void run_of_columns(Exec const& exec, std::int64_t step, bool after, bool before,
                      Spins const& spins, TurnsOfColumns const& turns) const {
    using Numbers = detail::NumbersOfColumns<Keeps>;
    Numbers const numbers{{options_.seed, static_cast<std::uint64_t>(step)},
                          detail::NumbersOfSites<on_host<Exec>>::places_of_row(lattice_.shape[1])};
    detail::TurnAtRandom<Real, TurnsOfColumns, Numbers> const turn{
        spins.array(), spins.output(false), numbers, turns, after, before};
    if constexpr (Keeps)
      detail::for_each_site_by_columns<Real>(exec, label, spins.layout(), turn);
    else
      detail::for_each_site<Real>(exec, label, spins.layout(), turn);
  }

  /// Observer for the selected halves between steps.
  template <bool After, bool Before>
  struct BetweenSteps {
    static constexpr bool changes_spins = true, begins_step = Before;
    ThermalNoise noise;
    std::int64_t first = 0;  // the run starts at this step number: no step ends here

    template <class Exec>
    void operator()(Exec const& exec, Step const& step, Spins const& spins) const {
      // If the run ends here, the half before the next step is left to the run that continues it.
      bool const ends = After && step.number > first, begins = Before && !step.last && !step.stops;
      if (ends || begins) noise.turn_between(exec, step.number, ends, begins, step.dt, spins);
    }
  };

  using Memory = typename Spins::memory_space;
  using CellTurns =
      detail::TableOfTurns<detail::TurnOrNone<Real, on_host<typename Memory::execution_space>>,
                           Memory>;
  using ColumnNumbers = detail::TableOfTurns<Real, Memory>;

  Lattice lattice_;
  double damping_;
  ThermalNoiseOptions options_;
  ScalarField<Real, typename Spins::memory_space> factors_;
  std::optional<double> largest_factor_;  // if any factor is not 0 or 1
  mutable CellTurns cell_turns_;
  mutable ColumnNumbers column_numbers_;
};

}  // namespace cayspin::inline v0_2
