// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_run.hpp"

#include "host_vectors.hpp"
#include "io/checkpoint.hpp"
#include "io/notes.hpp"
#include "io/relax.hpp"
#include "io/stages.hpp"
#include "restart.hpp"
#include "run_files.hpp"
#include "scene_run_in_space.hpp"
#include "single_terms.hpp"
#include "turn.hpp"

#include <cayspin/minimize.hpp>
#include <cayspin/spin_field.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace cayspin::simulation {
namespace {

void start_kokkos(std::string const& space, std::optional<int> threads) {
  if (Kokkos::is_initialized()) return;
  static KokkosSession* session = nullptr;
  session = new KokkosSession(space, threads, {});
  std::atexit([] { delete session; });
}

std::string space_of(std::optional<std::string> const& asked) {
  try {
    return chosen_space(asked);
  } catch (UsageError const& error) {
    throw UsageError(std::string(error.what()).substr(2));  // without the dashes of the option
  }
}

Plan plan_of(io::Scene const& scene, Precision precision) {
  if (scene.integrator.method->automatic)
    throw io::scene_error(scene, "integrator.method",
                          "\"auto\" is chosen by the program; accepted: the method and dt or "
                          "tolerance that `cayspin advise` names");
  auto plan = make_plan(scene, precision);
  // The features in time of a program's nonlocal field cannot be known in advance, nor those of any
  // field if steps = 0, which is a run without an end. Adaptive steps are then at most dt.
  auto& steps = plan.options.steps;
  bool const is_endless = scene.integrator.steps == 0;
  if (is_endless) steps.end = std::numeric_limits<double>::infinity();
  if (scene.field.own.nonlocal || (is_endless && io::depends_on_time(scene.field)))
    steps.max_dt = std::max(steps.min_dt, std::min(steps.max_dt, scene.integrator.dt));
  require_memory(scene, plan);
  return plan;
}

// Converts the program's own fields from the units of the scene to reduced units.
io::Scene with_reduced_own_field(io::Scene scene) {
  auto const units = scene.units;
  auto& own = scene.field.own;
  // If the sites of the cell have moments, kernels divide the nonlocal field by these, as they
  // divide -dE/dm. So the field is multiplied by the moments first.
  if (auto const& moments = scene.lattice.moments;
      own.nonlocal && !moments.empty() && !io::has_moments_of_sites(scene))
    own.nonlocal = [given = own.nonlocal, moments](io::HostVectors const& spins,
                                                   io::HostVectors const& field, double t) {
      given(spins, field, t);
      scale_by_site(field, moments);
    };
  if (!units.si) return scene;
  if (own.uniform)
    own.uniform = [given = own.uniform, units](double t) {
      auto field = given(t * units.time);
      for (double& component : field) component /= units.field;
      return field;
    };
  if (own.nonlocal)
    own.nonlocal = [given = own.nonlocal, units](io::HostVectors const& spins,
                                                 io::HostVectors const& field, double t) {
      given(spins, field, t * units.time);
      scale(field, 1 / units.field);
    };
  return scene;
}

// Returns the start of a scene. Errors in vectors passed by a program name the argument `name`,
// because these vectors have no key.
template <class Error>
std::vector<double> normalised(io::Scene const& scene, std::string const& name) {
  constexpr std::string_view key = "initial.given: ";
  try {
    return io::initial_spins(scene);
  } catch (io::SceneError const& error) {
    std::string_view const line = error.what();
    auto const at = line.find(key);
    if (at == line.npos) throw;
    throw Error(fmt::format("{}: {}", name, line.substr(at + key.size())));
  }
}

}  // namespace

SceneRun::SceneRun(io::Scene const& scene, Plan const& plan, Precision precision, std::string space)
    : scene_(scene), held_plan_(plan), precision_(precision), space_(std::move(space)) {}

std::unique_ptr<SceneRun> SceneRun::open(io::Scene const& typed, RunSettings const& settings) {
  Turn const turn;
  io::require_no_stages(typed, "a Simulation");
  io::require_no_ensemble(typed, "a Simulation");
  auto const scene = io::with_shape_of_start(typed);
  io::check_files(scene);
  auto const space = space_of(settings.space);
  if (settings.threads && *settings.threads < 1)
    throw UsageError(fmt::format("{} threads; accepted: a whole number >= 1", *settings.threads));
  start_kokkos(space, settings.threads);
  auto own = with_reduced_own_field(scene);
  std::optional<EarlierRun> left;
  if (settings.restart) own.begin = left.emplace(*settings.restart).enter({{{}, {}, own}});
  auto const plan = plan_of(own, settings.precision);
  std::optional<Restart> restart;
  if (left)
    restart.emplace(std::move(*left), own, plan, settings.precision,
                    std::numeric_limits<std::int64_t>::max());
  auto run = in_space(
      space, settings.precision, [&]<class Real, class Space>() -> std::unique_ptr<SceneRun> {
        return std::make_unique<SceneRunInSpace<Real, Space>>(
            own, plan, settings.precision, space,
            restart ? restart->spins(own) : normalised<io::SceneError>(own, "initial"));
      });
  if (run->threads() > 1 || !is_on_host(space)) Turn::end_at_fork();
  run->typed_own_ = scene.field.own;
  if (!restart) return run;
  run->number_ = restart->step();
  run->restart_warning_ = restart->warning();
  run->go_on_from(restart->shift());
  if (restart->memory()) run->exchange(*restart->memory());
  return run;
}

void SceneRun::save(std::filesystem::path const& checkpoint) {
  Turn const turn;
  io::CheckpointWriter file(checkpoint, checkpoint_header(scene_, precision_, number_, time()));
  exchange(file);
  file.commit();
}

void SceneRun::exchange_with(Checkpoint& checkpoint) {
  Turn const turn;
  exchange(checkpoint);
}

bool SceneRun::remembers() const { return simulation::remembers(scene_, plan()); }

std::optional<std::string> SceneRun::warning() const { return dt_warning_of_run(scene_, plan()); }

std::int64_t SceneRun::step_at(double t) const {
  if (!std::isfinite(t)) throw UsageError(fmt::format("t = {}; accepted: a finite time >= 0", t));
  double const dt = plan().times.dt * scene_.units.time;
  double const begin = plan().times.begin * scene_.units.time;
  double const steps = (t - begin) / dt, whole = std::round(steps);
  auto const origin = static_cast<double>(plan().times.origin);
  // `begin` is a sum over all changes of the scene, and each addition has a rounding error.
  double const round_off = std::min(1e-3, 1e-12 * (origin + std::max(0.0, whole)));
  if (!(std::abs(steps - whole) <= std::max(1e-9, round_off)) || !(whole >= 0) ||
      !(origin + whole <= 0x1p53))
    throw UsageError(
        fmt::format("t = {} is {:.12g} steps of dt = {}{}; accepted: a whole number of "
                    "steps, such as t = {:.12g}",
                    t, steps, dt, begin > 0 ? fmt::format(" after t = {:.12g}", begin) : "",
                    begin + std::max(0.0, whole) * dt));
  return plan().times.origin + static_cast<std::int64_t>(whole);
}

void SceneRun::require_reachable(std::int64_t count, std::int64_t step) const {
  if (!io::has_integrator(scene_))
    throw UsageError("the scene has no table [integrator]; accepted: relax()");
  if (count < 0) throw UsageError(fmt::format("{} steps; accepted: a whole number >= 0", count));
  constexpr std::int64_t last = std::int64_t{1} << 53U;  // times beyond it are not exact
  if (count > last - step)
    throw UsageError(
        fmt::format("{} steps after step {}; accepted: up to step {}", count, step, last));
  std::int64_t const target = step + count;
  if (std::isfinite(plan().options.steps.end) && plan().variant.method->adaptive &&
      target > last_step())
    throw UsageError(fmt::format(
        "step {} lies beyond step {}, t = {:.9g}, where the scene ends and its adaptive method "
        "stops; accepted: a later integrator.end, or integrator.steps = 0 for a run without end",
        target, last_step(), plan().times.at(last_step()) * scene_.units.time));
}

Advanced SceneRun::advance(std::int64_t count, Looks const& looks) {
  Turn const turn;
  require_reachable(count);
  return advance_to(number_ + count, looks);
}

io::Scene SceneRun::typed_scene() const {
  auto scene = scene_;
  scene.field.own = typed_own_;
  scene.begin = {};
  return scene;
}

void SceneRun::change(std::vector<std::string> const& overrides, io::Given const& given) {
  Turn const turn;
  auto typed = io::changed_on_the_way(scene_, overrides, given);
  auto own = typed_own_;
  if (typed.field.applied) own.uniform = nullptr;
  typed.field.own = own;
  require_same_terms(scene_, typed);
  if (io::has_integrator(typed)) io::check_combination(typed);
  io::check_files(typed);
  auto reduced = with_reduced_own_field(typed);
  auto const begin = io::begin_after(scene_, number_, reduced);
  reduced.begin = {0, begin.step, begin.time};
  auto const plan = plan_of(reduced, precision_);
  rebuild(reduced, plan);
  scene_ = std::move(reduced);
  held_plan_.emplace(plan);
  typed_own_ = std::move(own);
}

Minimum SceneRun::relax(RelaxSettings const& settings) {
  Turn const turn;
  return relaxed(settings);
}

void SceneRun::require_relaxable(RelaxSettings const& settings) const {
  double const least = Minimizer<SpinField<double>>::least_bound * scene_.units.field;
  if (!(settings.torque >= least) || !std::isfinite(settings.torque))
    throw UsageError(
        fmt::format("torque {}; accepted: a number of at least {}", settings.torque, least));
  if (settings.evaluations < 1)
    throw UsageError(
        fmt::format("{} evaluations; accepted: a whole number >= 1", settings.evaluations));
  require_rest(scene_);
}

Minimum SceneRun::relaxed(RelaxSettings const& settings) {
  require_relaxable(settings);
  auto field = scene_.field;
  if (auto const& applied = settings.applied) {
    field.own.uniform = nullptr;
    field.applied.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
      if (!std::isfinite((*applied)[i]))
        throw UsageError("applied: not finite; accepted: three finite numbers");
      (*field.applied)[i] = (*applied)[i] / scene_.units.field;
    }
  }
  InterruptPoll poll(settings.interrupted);
  auto found = find_rest(
      field, {.torque = settings.torque / scene_.units.field,
              .evaluations = settings.evaluations,
              .time = reduced_time(),
              .keep_saddles = settings.keep_saddles,
              .observer = [&](Minimum const&) { return poll() ? Next::stop : Next::proceed; }});
  evaluations_ += found.evaluations;
  found.torque *= scene_.units.field;
  found.curvature *= scene_.units.energy;
  found.energy.value *= scene_.units.energy;
  found.energy.magnitude *= scene_.units.energy;
  return found;
}

namespace {

void require_valid(ModesOptions const& options) {
  if (options.count < 1 || options.count > ModesOptions::most)
    throw UsageError(fmt::format("{} modes; accepted: 1 to {}", options.count, ModesOptions::most));
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw UsageError(
        fmt::format("tolerance {}; accepted: a number between 0 and 1", options.tolerance));
  if (options.evaluations < 1)
    throw UsageError(
        fmt::format("{} evaluations; accepted: a whole number >= 1", options.evaluations));
}

}  // namespace

FoundModes SceneRun::modes(ModesOptions const& options) {
  require_valid(options);
  Turn const turn;
  require_rest(without_torque(scene_));
  auto now = options;
  now.time = reduced_time();
  auto found = modes_of_field(now);
  evaluations_ += found.evaluations;
  return found;
}

FoundCurvatures SceneRun::curvatures(ModesOptions const& options) {
  require_valid(options);
  Turn const turn;
  require_rest(scene_);
  auto now = options;
  now.time = reduced_time();
  auto found = curvatures_of_field(now);
  evaluations_ += found.evaluations;
  return found;
}

FoundBands SceneRun::bands(std::vector<std::array<double, 3>> const& wave_vectors,
                           std::function<Next()> const& poll) {
  Turn const turn;
  require_rest(scene_);
  require_bands(scene_, wave_vectors);
  auto found = bands_of_field(wave_vectors, poll);
  evaluations_ += found.evaluations;
  return found;
}

LentVectors SceneRun::spins() {
  Turn const turn;
  return lend_spins();
}

void SceneRun::set_spins(io::HostVectors const& from) {
  Turn const turn;
  auto const& [nx, ny, nz] = scene_.lattice.shape;
  if (from.shape != std::array{nz, ny, nx})
    throw UsageError(fmt::format("spins of shape ({}, {}, {}, 3); accepted: ({}, {}, {}, 3)",
                                 from.shape[0], from.shape[1], from.shape[2], nz, ny, nx));
  auto as_start = scene_;
  as_start.initial =
      io::GivenStart{std::make_shared<std::vector<double> const>(packed<double>(from))};
  replace_spins(normalised<UsageError>(as_start, "spins"));
}

void SceneRun::continue_from(std::int64_t step, std::vector<double> const& spins) {
  Turn const turn;
  number_ = step;
  replace_spins(spins);
}

void SceneRun::continue_from_column(SceneRun const& columns, std::int64_t column) {
  Turn const turn;
  take_column(columns, column);
  evaluations_ = columns.evaluations();
}

Sample SceneRun::sample() {
  Turn const turn;
  return sampled();
}

Sample SceneRun::judged_sample() {
  Turn const turn;
  return sampled(true);
}

Sample SceneRun::sampled(bool judges) {
  Sample now = look();
  if (auto const failure = judges ? failure_of(now) : std::nullopt)
    throw NumbersFailed(scene_.path.string() + ": " + *failure);
  now.time *= scene_.units.time;
  now.energy.value *= scene_.units.energy;
  now.energy.magnitude *= scene_.units.energy;
  return now;
}

std::vector<double> SceneRun::more_of_sample() {
  Turn const turn;
  return more();
}

std::vector<std::pair<std::string, double>> SceneRun::energies() {
  Turn const turn;
  auto energies = term_energies();
  for (auto& [name, energy] : energies) energy *= scene_.units.energy;
  return energies;
}

LentVectors SceneRun::field() {
  Turn const turn;
  if (scene_.system.kind != io::SystemKind::llg)
    throw UsageError("rigid bodies have no field; accepted: a scene with system.kind = \"llg\"");
  auto const field = evaluated_field();
  scale(field.vectors, scene_.units.field);
  return field;
}

}  // namespace cayspin::simulation
