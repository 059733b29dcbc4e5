// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_path.hpp"

#include "failure.hpp"
#include "kokkos_settings.hpp"
#include "ranks.hpp"
#include "run_files.hpp"
#include "scene_field.hpp"
#include "scene_minimizer.hpp"
#include "scene_modes.hpp"
#include "simulate.hpp"
#include "transition_rates.hpp"

#include <cayspin/lowest_escape.hpp>
#include <cayspin/observer/normalize.hpp>
#include <cayspin/path/image_energy.hpp>
#include <cayspin/path/probed_field.hpp>
#include <cayspin/path/saddle.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::simulation {
namespace {

constexpr std::int64_t most_zero_modes = 4;  // of a state with more, fewer modes are climbed
// Curvatures of zero modes are below this fraction of the field without exchange.
constexpr double zero_mode = 1e-4;
// If a state's energy changes by more than this fraction of the lower barrier when the state is
// found again in double precision, another state was found, or the path's state was far from rest.
constexpr double largest_energy_change = 1e-2;

struct Interrupted {};

/// Returns unit spins in double precision: a copy of spins in single precision.
template <class Space, class Given>
auto in_double(Space const& exec, Given const& given) {
  SpinField<double, typename Space::memory_space> const spins("path::in_double", given.lattice());
  copy_from_host(copy_to_host(given), spins);
  normalize(exec, spins);
  return spins;
}

/// Throws NumbersFailed if the energy of a state changed when it was found again in double
/// precision. The energies are those of the start, the saddle and the end.
void require_same_states(std::array<double, 3> const& given, std::array<double, 3> const& found) {
  double const barrier = given[1] - std::max(given[0], given[2]);
  constexpr std::array names{"the start", "the saddle", "the end"};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!(std::abs(found[i] - given[i]) <= largest_energy_change * barrier))
      throw NumbersFailed(
          fmt::format("rates: in double precision, the search leads from {} to a state of another "
                      "energy; accepted: a smaller bound on the torque, or a path in double "
                      "precision",
                      names[i]));
}

/// Returns the rates for a path in single precision. Its Hessians would have errors above the
/// smallest curvatures, so its ends and its saddle are found again in double precision. Throws like
/// rates_of, and NumbersFailed if a search fails or leads to another state.
template <class Space, class Given>
io::RatesOfPath rates_in_double(Space const& exec, io::Scene const& scene, Given const& from,
                                Given const& saddle, Given const& to,
                                std::function<void()> const& poll) {
  using Spins = SpinField<double, typename Space::memory_space>;
  auto const& lattice = saddle.lattice();
  auto const field = field_of<Spins>(scene, lattice, false).made_for(FieldFor::energy);
  auto ends = std::array{in_double(exec, from), in_double(exec, to)};
  auto const top = in_double(exec, saddle);
  cayspin::detail::ProbedField<Spins> const probed(exec, field, top, 0, true);
  double const torque =
      std::max(1e-9 * probed.strongest, Minimizer<SpinField<double>>::least_bound);
  auto const not_found = [](char const* what) {
    return NumbersFailed(
        fmt::format("rates: {} in double precision; accepted: a path in double precision", what));
  };
  auto const proceed = [&](auto const&...) {
    poll();
    return Next::proceed;
  };
  Spins const gradient("path::gradient", lattice);
  auto const energy_of = [&](Spins const& spins) {
    return cayspin::detail::look_at_image(exec, field, 0, spins, gradient).energy.value;
  };
  std::array const given{energy_of(ends[0]), energy_of(top), energy_of(ends[1])};
  SceneMinimizer<double, Space> minimizer(top);
  MinimizeOptions const options{.torque = torque, .observer = proceed};
  for (auto& end : ends)
    if (minimizer.minimize(exec, scene, field, end, options).end != MinimizeEnd::converged)
      throw not_found("an end of the path was not found again");

  auto const lowest = find_curvatures<double, Space>(
      exec, scene, field, top, {.count = 1, .tolerance = 1e-3, .poll = proceed});
  if (lowest.vectors.empty()) throw not_found("no curvature was found at the saddle");
  cayspin::detail::SaddleSearch<Spins> search(lattice);
  Kokkos::deep_copy(exec, search.spins().allocation(), top.allocation());
  copy_from_host(lowest.vectors.front(), search.vector());
  auto preconditioner = probed.preconditioner;
  constexpr std::int64_t most_evaluations = 1000000;
  auto const found = search.find(exec, field, probed.is_mobile, preconditioner,
                                 probed.climb(0, torque, most_evaluations),
                                 [&](auto const& now) { return proceed(now) == Next::proceed; });
  if (!found.is_saddle) throw not_found("the saddle was not found again");
  require_same_states(given, {energy_of(ends[0]), found.energy.value, energy_of(ends[1])});
  return rates_of(scene, exec, field, ends[0], search.spins(), ends[1], found.curvature, poll);
}

template <class Real, class Space>
class PathOfScene {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  PathOfScene(io::Scene const& scene, Lattice const& lattice, ScenePathOptions const& options)
      : scene_(scene),
        options_(options),
        saddle_("path::highest_saddle", lattice),
        field_(field_of<Spins>(scene, lattice, false).made_for(FieldFor::energy)),
        moment_(range_of_moments(io::all_moments(scene, own_sites(lattice))).least) {
    for (std::int64_t k = 0; k < options.images; ++k) images_.emplace_back("path::image", lattice);
  }

  ScenePath find(std::vector<double> const& from, std::vector<double> const& to) {
    copy_from_host(from, images_.front());
    if (!options_.modes) copy_from_host(to, images_.back());
    auto const found = search();
    ScenePath result{
        .end = found.end, .path = in_scene_units(found), .needs_images = found.needs_images};
    if (options_.rates && found.end == PathEnd::converged) add_rates(found, result);
    result.path.header.threads = threads_of(exec_);
    return result;
  }

 private:
  void add_rates(MinimumEnergyPath const& found, ScenePath& result) const {
    auto const poll = [&] {
      if (options_.observer && options_.observer({found.evaluations}) == Next::stop)
        throw Interrupted();
    };
    try {
      if constexpr (std::is_same_v<Real, double>)
        result.path.rates = rates_of(scene_, exec_, field_, images_.front(), saddle_,
                                     images_.back(), found.saddle().curvature, poll);
      else
        result.path.rates =
            rates_in_double(exec_, scene_, images_.front(), saddle_, images_.back(), poll);
    } catch (Interrupted const&) {
      result.end = PathEnd::interrupted;
    } catch (NumbersFailed const& error) {
      result.rates_failed = error.what();
    }
  }

  MinimumEnergyPath search() {
    PathOptions const options{.torque = std::max(moment_ * options_.torque / scene_.units.field,
                                                 Minimizer<SpinField<double>>::least_bound),
                              .evaluations = options_.evaluations,
                              .observer = options_.observer};
    try {
      return options_.modes ? escape(options)
                            : minimum_energy_path(exec_, field_, images_, saddle_, options);
    } catch (FieldNotFinite const&) {
      throw NumbersFailed(fmt::format("{}: the field of an end, or its energy, is not finite",
                                      scene_.path.string()));
    }
  }

  // Relaxes the only known end, and climbs from it along its modes of lowest curvature.
  MinimumEnergyPath escape(PathOptions const& options) {
    auto& state = images_.front();
    MinimumEnergyPath unfinished;
    auto const rest = cayspin::detail::relax_end(exec_, field_, state, options, unfinished);
    if (rest.end != MinimizeEnd::converged) return unfinished;
    // Exchange says nothing about modes in which all spins turn together.
    cayspin::detail::ProbedField<Spins> const probed(exec_, field_, state, options.time,
                                                     options.preconditioned);
    unfinished.evaluations += probed.evaluations;
    auto const before = unfinished.evaluations;
    auto const modes = find_curvatures<Real, Space>(
        exec_, scene_, field_, state,
        {.count = static_cast<std::size_t>(*options_.modes + most_zero_modes),
         .tolerance = 1e-4,
         .evaluations = std::max<std::int64_t>(1, options.evaluations - before),
         .poll = [&] { return options_.observer ? options_.observer({before}) : Next::proceed; }});
    unfinished.evaluations += modes.evaluations;
    unfinished.end = PathEnd::interrupted;
    if (modes.end == ModesEnd::interrupted) return unfinished;
    double const scale = probed.preconditioner.first_shift() * scene_.units.energy;
    std::vector<Spins> directions;
    for (std::size_t i = 0; i < modes.values.size(); ++i) {
      bool const is_zero = modes.values[i] < zero_mode * std::min(scale, modes.values.back());
      if (is_zero || std::ssize(directions) == *options_.modes) continue;
      copy_from_host(modes.vectors[i], directions.emplace_back("path::mode", state.lattice()));
    }
    return cayspin::detail::escape_from_rest(exec_, field_, rest.energy, directions, images_,
                                             saddle_, options, probed, unfinished);
  }

  io::Path in_scene_units(MinimumEnergyPath const& found) const {
    auto const& units = scene_.units;
    io::Path path;
    path.end = found.needs_images ? "the path needs more images" : to_string(found.end);
    path.converged = found.end == PathEnd::converged;
    path.evaluations = found.evaluations;
    path.across = found.across * units.field / moment_;
    path.distance = found.distance;
    for (double const energy : found.energy) path.energy.push_back(energy * units.energy);
    for (auto const& saddle : found.saddles) {
      path.saddles.push_back({saddle.energy * units.energy, saddle.curvature * units.energy,
                              saddle.next_curvature * units.energy,
                              static_cast<std::int64_t>(saddle.image)});
      path.torque = std::max(path.torque, saddle.torque * units.field / moment_);
    }
    for (auto const& image : images_) {
      auto const numbers = copy_to_host(image);
      path.spins.insert(path.spins.end(), numbers.begin(), numbers.end());
    }
    auto const numbers = copy_to_host(saddle_);
    path.saddle.assign(numbers.begin(), numbers.end());
    return path;
  }

  io::Scene const& scene_;
  ScenePathOptions const& options_;
  Space exec_;
  std::vector<Spins> images_;
  Spins saddle_;
  SceneField<Spins> field_;
  // Torques of the search are |m x dE/dm|, and those of a scene are |m x H|, where H is -dE/dm
  // divided by the moment. So the former, divided by the least moment, are upper bounds on the
  // latter.
  double moment_;
};

void require_same_frozen_spins(io::Scene const& scene, std::vector<double> const& from,
                               std::vector<double> const& to) {
  auto const frozen = io::frozen(scene, {{0, 0, 0}, scene.lattice.shape});
  for (std::size_t i = 0; i < from.size() && !frozen.empty(); ++i)
    if (frozen[i / 3] && std::abs(from[i] - to[i]) > 1e-6)
      throw io::scene_error(scene, "lattice.frozen",
                            "the frozen spins of the two ends differ; accepted: the same spins in "
                            "both");
}

}  // namespace

void require_path(io::Scene const& scene, ScenePathOptions const& options) {
  require_rest(scene);
  if (io::depends_on_time(scene.field))
    throw io::scene_error(scene, io::key_in_time(scene.field),
                          "depends on t, and a path does not; accepted: numbers");
  if (!scene.field.applied_in_turn.empty())
    throw io::scene_error(scene, "field.applied",
                          "a list of fields is for cayspin relax; accepted: three numbers");
  constexpr std::int64_t most_images = 1000;
  if (options.images < 3 || options.images > most_images)
    throw UsageError(fmt::format("images {}; accepted: a whole number from 3 to {}", options.images,
                                 most_images));
  constexpr double least = Minimizer<SpinField<double>>::least_bound;
  if (!(options.torque / scene.units.field >= least) || !std::isfinite(options.torque))
    throw UsageError(fmt::format("torque {}; accepted: a number of at least {}", options.torque,
                                 least * scene.units.field));
  constexpr std::int64_t most_modes = 100;
  if (options.modes && (*options.modes < 1 || *options.modes > most_modes))
    throw UsageError(
        fmt::format("modes {}; accepted: a whole number from 1 to {}", *options.modes, most_modes));
  if (options.evaluations < 1)
    throw UsageError(
        fmt::format("evaluations {}; accepted: a whole number >= 1", options.evaluations));
  if (options.rates && io::sites(scene) > most_sites_for_rates)
    throw io::scene_error(scene, "lattice.shape",
                          fmt::format("has {} sites; accepted with rates: at most {}",
                                      io::sites(scene), most_sites_for_rates));
}

Plan make_plan_of_path(io::Scene const& scene, Precision precision,
                       ScenePathOptions const& options) {
  auto plan = make_plan_to_relax(scene, precision);
  auto const images = static_cast<std::size_t>(options.images);
  plan.memory.work = plan.memory.spins * (path_work_fields(images) + options.images - 1);
  if (options.modes) {
    // The modes are searched before the path, and their vectors are kept.
    auto const modes = most_zero_modes + *options.modes;
    auto const of_search = plan.memory.spins * (6 * modes + 100 + options.images);
    plan.memory.work =
        std::max(plan.memory.work + plan.memory.spins * escape_work_fields, of_search);
    plan.memory.work += plan.memory.spins * modes;
  }
  if (options.rates) {
    constexpr std::int64_t matrices = 8;  // with two rows for each site
    auto const rows = 2 * io::sites(scene);
    plan.memory.work += matrices * rows * rows * static_cast<std::int64_t>(sizeof(double));
  }
  plan.memory.files = 2 * (options.images + 1) * 3 * 8 * io::sites(scene);
  plan.file_bytes = static_cast<double>(plan.memory.files) / 2;
  return plan;
}

ScenePath find_scene_path(io::Scene const& scene, std::vector<double> const& from,
                          std::vector<double> const& to, std::string const& space,
                          Precision precision, ScenePathOptions const& options,
                          std::string const& git_commit) {
  auto const plan = make_plan_of_path(scene, precision, options);
  if (!options.modes) require_same_frozen_spins(scene, from, to);
  Kokkos::Timer const clock;
  auto found = in_space(space, precision, [&]<class Real, class Space>() {
    return PathOfScene<Real, Space>(scene, plan.lattice, options).find(from, to);
  });
  auto const threads = found.path.header.threads;
  found.path.header = run_header(scene, precision, space, threads, git_commit);
  found.path.wall_seconds = clock.seconds();
  return found;
}

}  // namespace cayspin::simulation
