// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "plan.hpp"

#include "files/available_memory.hpp"
#include "io/ovf.hpp"
#include "io/trajectory.hpp"
#include "largest_field.hpp"
#include "limits_of_terms.hpp"
#include "memory_of_terms.hpp"
#include "multirate_method.hpp"
#include "ranks.hpp"
#include "run_files.hpp"
#include "single_terms.hpp"
#include "text.hpp"
#include "thermal.hpp"

#include <cayspin/minimize.hpp>
#include <cayspin/stability.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace cayspin::simulation {
namespace {

Lattice make_lattice(io::Scene const& scene) {
  Lattice lattice;
  lattice.shape = scene.lattice.shape;
  lattice.spacing = scene.lattice.spacing;
  lattice.cell_sites = static_cast<std::int64_t>(scene.lattice.basis.size());
  for (int axis = 0; axis < 3; ++axis)
    lattice.boundary[axis] = scene.lattice.boundary[axis] == io::BoundaryKind::periodic
                                 ? Boundary::periodic
                                 : Boundary::open;
  try {
    lattice.validate();
  } catch (std::invalid_argument const& error) {
    std::string_view const message = error.what();
    throw io::scene_error(scene, "lattice.shape", message.substr(message.find(": ") + 2));
  }
  return lattice;
}

template <class Real>
Memory memory_of(io::Scene const& scene, Lattice const& lattice, Variant const& variant,
                 Precision precision, std::int64_t planes_at_once) {
  Memory memory;
  memory.spins = field_bytes<Real>(lattice, 3);
  bool const is_far = !io::couplings(scene).empty() || io::reach_of_interlayers(scene) > 0;
  memory.work = variant.work_bytes(lattice, !io::is_nonlocal(scene.field) && !is_far, precision);
  memory.field = memory_of_terms<Real>(scene, lattice);
  if (scene.output.terms && scene.system.kind == io::SystemKind::llg)
    for (auto const& term : single_terms(scene))
      memory.field += memory_of_terms<Real>(term.second, lattice);
  if (is_thermal(scene) && io::has_noise_of_sites(scene) && !scene.columns)
    memory.field += field_bytes<Real>(lattice, 1);
  if (scene.output.regions) memory.field += 2 * field_bytes<Real>(lattice, 1);
  if (scene.lattice.follow) memory.field += memory.spins + field_bytes<Real>(lattice, 1);
  if (has_slow_field(scene)) {
    memory.work += work_fields_of_multirate(scene, variant) * memory.spins;
    memory.field += memory.spins;
  }
  if (scene.integrator.energy_control) memory.work += memory.spins;
  // Memory of the search for a descent direction, which runs when the torque is small.
  if (scene.integrator.until_torque && lattice.part == nullptr)
    memory.work += (1 + Minimizer<SpinField<Real>>::work_fields) * memory.spins;
  // A rank reads its part of a start a few planes at a time, but an OVF file as a whole. The first
  // rank writes the files.
  auto const& all = whole(lattice);
  std::int64_t const numbers = 3 * lattice.sites(), numbers_of_all = 3 * all.sites();
  bool const is_part = lattice.part != nullptr;
  bool const writes = !is_part || own_sites(lattice).begin == std::array<std::int64_t, 3>{};
  std::int64_t start = 8 * numbers;
  if (auto const* const file = std::get_if<io::FileStart>(&scene.initial)) {
    constexpr std::int64_t of_planes = 512 << 20;
    start += io::is_ovf(file->path) ? 8 * numbers_of_all
                                    : 8 * numbers + std::min(8 * numbers_of_all, of_planes);
  }
  if (std::holds_alternative<io::InertiaFile>(scene.system.inertia) &&
      scene.system.kind == io::SystemKind::rigid_body) {
    memory.field += field_bytes<Real>(lattice, 6);
    start += 8 * (9 + 6 + 6) * all.sites();
  }
  // Memory for output: two queued frames or pieces of frames, HDF5's copies of a chunk, the
  // positions, and a copy of a rank's own spins.
  auto const pieces = io::frame_pieces(all.shape, sizeof(Real), storage_of(scene), planes_at_once,
                                       std::ssize(scene.lattice.basis));
  std::int64_t const positions = writes && has_positions(scene.lattice) ? 8 * numbers_of_all : 0;
  std::int64_t const frames =
      (writes ? static_cast<std::int64_t>(2 * pieces.bytes + pieces.copied) : 0) + positions +
      (is_part ? static_cast<std::int64_t>(sizeof(Real)) * numbers : 0);
  // Memory for a checkpoint: the field being written, in double, and planes of the whole lattice on
  // the first rank.
  bool const stores = !scene.output.checkpoint_every.is_never();
  std::int64_t const of_number = sizeof(Real) == sizeof(double) ? 8 : 12;
  std::int64_t const of_planes =
      is_part && writes ? 8 * 3 * all.shape[0] * all.shape[1] * planes_at_once : 0;
  std::int64_t const checkpoint = stores ? of_number * numbers + of_planes : 0;
  memory.files = std::max(start - memory.work, frames + checkpoint);
  return memory;
}

// Returns the largest value of damping * temperature * gyromagnetic ratio / moment at any site and
// at 1001 equally spaced times of the run.
double largest_heat(io::Scene const& scene, Times const& times) {
  TemperatureInTime const temperature(*scene.thermal, scene.units);
  double const begin = times.at(times.first), end = times.at(times.steps);
  double largest = 0;
  constexpr int samples = 1000;
  for (int i = 0; i <= (temperature.depends_on_time() ? samples : 0); ++i) {
    double const t = begin + (end - begin) * i / samples;
    try {
      largest = std::max(largest, temperature(t));
    } catch (NumbersFailed const&) {
      throw io::scene_error(
          scene, "thermal.temperature",
          fmt::format("is negative, or not finite, at t = {}; accepted: numbers >= 0 for all of "
                      "the run",
                      time_text(scene.units, t)));
    }
  }
  if (scene.columns && !scene.columns->temperatures.empty())
    largest *= std::ranges::max(scene.columns->heats());
  bool const has_damping =
      scene.system.dampings.there() || (scene.columns && !scene.columns->dampings.empty());
  double const damping = has_damping ? 1 : scene.system.damping;
  return io::largest_noise(scene) * damping * largest;
}

// Passes the features of the field to an adaptive method, so that its steps do not miss them.
void put_features(io::Scene const& scene, TimeFeatures const& features, StepOptions& steps) {
  auto const& integrator = scene.integrator;
  if (features.unresolved && !std::isfinite(integrator.max_dt))
    throw io::scene_error(scene, *features.unresolved,
                          "changes too often to be looked at before the run; accepted: "
                          "integrator.max_dt, or an earlier integrator.end");
  if (auto const& shortest = features.shortest; shortest && shortest->length < integrator.min_dt)
    throw io::scene_error(
        scene, "integrator.min_dt",
        fmt::format("{} is longer than a feature of {} at t = {}; accepted: at most {}",
                    time_text(scene.units, integrator.min_dt, 6), shortest->key,
                    time_text(scene.units, shortest->time, 6),
                    time_text(scene.units, shortest->length, 3)));
  steps.bounds = features.bounds;
}

}  // namespace

Plan make_plan(io::Scene const& scene, Precision precision,
               std::shared_ptr<TimeFeatures const> features) {
  io::require_no_ensemble(scene, "this command");
  require_demagnetization(scene);
  io::require_alike_where_followed(scene);
  auto const lattice = make_lattice(scene);
  io::require_directions(scene);
  require_limits_of_terms(scene, lattice);
  auto const& integrator = scene.integrator;
  auto const& begin = scene.begin;
  Plan plan{
      lattice,
      find_variant(scene),
      {integrator.rotation, integrator.sigma, integrator.isotropy_cap, {}},
      {begin.time, integrator.dt, begin.step + integrator.steps, begin.step, false, begin.step},
      std::numeric_limits<double>::infinity(),
      0,
      {},
      0,
      0,
      features ? std::move(features) : features_of(scene, integrator.tolerance)};
  if (is_thermal(scene)) {
    if (plan.variant.remembers)
      throw io::scene_error(scene, "integrator.method",
                            "remembers steps, between which the noise of a temperature turns the "
                            "spins; accepted: a one-step method, such as \"heun\", \"rkmk4\", "
                            "\"red_black2\"");
    double const heat = largest_heat(scene, plan.times);
    io::require_moderate_noise(scene, heat);
    // In half a step, each component of the noise has the variance heat * dt. A step has two
    // halves, and two of the three components move the spin: the sum is four times that.
    plan.noise_turn = 2 * std::sqrt(heat * integrator.dt);
  }
  if (integrator.tolerance) {
    plan.options.steps = {*integrator.tolerance, 0, integrator.min_dt, integrator.max_dt,
                          plan.times.at(plan.times.steps)};
    double const least = precision == Precision::double_precision
                             ? StepOptions::least_tolerance<double>()
                             : StepOptions::least_tolerance<float>();
    if (*integrator.tolerance < least)
      throw io::scene_error(scene, "integrator.tolerance",
                            fmt::format("{:.3g} is beyond {} precision; accepted: at least {:.3g}",
                                        *integrator.tolerance, to_string(precision), least));
    put_features(scene, *plan.features, plan.options.steps);
  }
  require_slow_field_fits(scene, plan.variant);
  auto const substeps = static_cast<double>(integrator.substeps);
  if (scene.system.kind == io::SystemKind::llg) {
    double const bound = field_bound(scene, lattice, plan.times, *plan.features);
    if (!std::isfinite(bound))
      throw io::scene_error(scene, "field",
                            "its largest value is not finite; accepted: smaller constants, or a "
                            "larger lattice.spacing");
    plan.stable_dt = substeps * plan.variant.stable_step(bound, largest_damping(scene),
                                                         scene.system.precession, plan.options);
  }
  bool const in_double = precision == Precision::double_precision;
  plan.memory = in_double ? memory_of<double>(scene, lattice, plan.variant, precision, 0)
                          : memory_of<float>(scene, lattice, plan.variant, precision, 0);
  plan.frames = frames_of(integrator.steps, scene.output.every);
  constexpr double frame_bytes = 8 * 7;
  double const sample_bytes = frame_bytes + 8 * static_cast<double>(more_scalars(scene).count());
  auto const frames = static_cast<double>(plan.frames);
  auto const samples = static_cast<double>(frames_of(integrator.steps, scene.output.scalars_every));
  auto const numbers = 3 * static_cast<double>(lattice.sites());
  plan.file_bytes = frames * (numbers * (in_double ? 8 : 4) + frame_bytes) + samples * sample_bytes;
  if (has_positions(scene.lattice))
    plan.file_bytes += static_cast<double>(position_bytes(scene.lattice)) +
                       24 * frames * static_cast<double>(scene.lattice.basis.size());
  // The scene with only the terms whose motion a step must resolve. Exchange and couplings have the
  // fastest modes; if there is a stable dt, or the method is stiff, steps need not resolve these.
  io::Scene followed = scene;
  if (plan.variant.method->stiff || std::isfinite(plan.stable_dt)) {
    keep_numbers_of_free_sides(scene, followed.field.anisotropies);
    followed.field.exchange.reset();
    followed.field.exchange_factors = {};
    followed.field.couplings.clear();
    followed.field.couplings_file.clear();
  }
  plan.turn =
      integrator.dt / substeps * largest_rate(followed, lattice, plan.times, *plan.features);
  plan.substep = integrator.dt / substeps;
  return plan;
}

std::optional<std::string> dt_warning(Plan const& plan, io::Units const& units) {
  double const dt = plan.times.dt;
  auto const text = time_text(units, dt, 6);
  if (plan.times.steps == plan.times.first || plan.variant.method->adaptive) return std::nullopt;
  if (dt > plan.stable_dt && plan.stable_dt > 0)
    return fmt::format("{} is above the stable {}", text, time_text(units, plan.stable_dt, 6));
  if (dt > plan.stable_dt)
    return fmt::format("{} is not stable: at this damping errors grow at every dt", text);
  // A stable dt is not always short enough: methods of order 8 are stable even at steps that no
  // longer resolve the motion.
  double const most = std::isfinite(plan.stable_dt) ? 3 : 2;
  if (!(plan.turn <= most))
    return fmt::format("{} turns spins by up to {:.3g} radians a step, too far to follow", text,
                       plan.turn);
  if (auto const& shortest = plan.features->shortest; shortest && plan.substep > shortest->length)
    return fmt::format("{} is longer than {}, a feature of {} at t = {}, which steps may miss",
                       text, time_text(units, shortest->length, 3), shortest->key,
                       time_text(units, shortest->time, 6));
  if (plan.noise_turn > Plan::most_noise)
    return fmt::format("{} lets noise turn spins by {:.3g} radians a step, too far to follow", text,
                       plan.noise_turn);
  return std::nullopt;
}

std::optional<std::string> dt_warning(io::Scene const& scene, Plan const& plan) {
  auto const reason = dt_warning(plan, scene.units);
  if (!reason) return std::nullopt;
  auto const error = io::scene_error(scene, "integrator.dt", *reason);
  if (scene.integrator.refuse_unstable) throw error;
  return error.what();
}

std::optional<std::string> dt_warning_of_run(io::Scene const& scene, Plan plan) {
  if (scene.integrator.steps == 0) plan.times.steps = plan.times.first + 1;
  return dt_warning(scene, plan);
}

void keep_part(Plan& plan, io::Scene const& scene, Precision precision, Lattice const& local,
               std::int64_t planes_at_once) {
  plan.lattice = local;
  plan.memory = precision == Precision::double_precision
                    ? memory_of<double>(scene, local, plan.variant, precision, planes_at_once)
                    : memory_of<float>(scene, local, plan.variant, precision, planes_at_once);
}

bool fits(Plan const& plan) { return plan.memory.total() <= io::available_memory(); }

void require_memory(io::Scene const& scene, Plan const& plan, int ranks) {
  std::int64_t const available = io::available_memory() / ranks;
  if (plan.memory.total() > available)
    throw io::scene_error(
        scene, "lattice.shape",
        fmt::format("the run needs {} of memory, and {} is available; accepted: a smaller lattice, "
                    "single precision, or a run on more ranks",
                    bytes_text(plan.memory.total()), bytes_text(available)));
}

}  // namespace cayspin::simulation
