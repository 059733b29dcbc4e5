// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "plan.hpp"

#include "applied_field.hpp"
#include "dear_method.hpp"
#include "demagnetization.hpp"
#include "failure.hpp"
#include "files/available_memory.hpp"
#include "ranks.hpp"
#include "run_files.hpp"
#include "text.hpp"
#include "thermal.hpp"

#include <cayspin/detail/exact_sum.hpp>
#include <cayspin/detail/row_layout.hpp>
#include <cayspin/field/bonds_of_sites.hpp>
#include <cayspin/io/ovf.hpp>
#include <cayspin/io/trajectory.hpp>
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

// The largest length of a vector at 1001 equal times of the run. A pulse that they miss is among
// the features.
double largest(AppliedField const& vector, std::string_view key, io::Scene const& scene,
               Times const& times, TimeFeatures const& features) {
  if (!vector.present()) return 0;
  int const samples = vector.depends_on_time() ? 1000 : 0;
  double const end = times.at(times.steps);
  double largest = 0;
  for (int i = 0; i <= samples; ++i) {
    double const t = samples == 0 ? 0 : end * i / samples;
    try {
      auto const h = vector(t);
      largest = std::max(largest, std::hypot(h.x, h.y, h.z));
    } catch (NumbersFailed const& error) {
      if (!scene.units.si) throw io::scene_error(scene, key, error.what());
      throw io::scene_error(scene, key, "is not finite at t = " + time_text(scene.units, t));
    }
  }
  for (auto const& [of, length] : features.largest)
    if (of == key && length > 1.001 * largest) largest = length;
  return largest;
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), largest = -least;

  double magnitude() const { return std::max(-least, largest); }
};

// Of all sites, by some planes at once: a rank has no room for more than its part.
Range range_of_sites(io::Scene const& scene, io::SiteNumbers const& numbers, std::string_view key) {
  auto const& shape = scene.lattice.shape;
  auto const at_once = io::planes_to_read(shape, sizeof(double));
  Range range;
  for (std::int64_t first = 0; first < shape[2]; first += at_once) {
    auto const planes = std::min(at_once, shape[2] - first);
    for (double const value :
         io::numbers_of_sites(scene, numbers, key, {{0, 0, first}, {shape[0], shape[1], planes}}))
      range = {std::min(range.least, value), std::max(range.largest, value)};
  }
  return range;
}

double largest_of_sites(io::Scene const& scene, io::SiteNumbers const& numbers,
                        std::string_view key) {
  return range_of_sites(scene, numbers, key).magnitude();
}

double largest_damping(io::Scene const& scene) {
  auto const& system = scene.system;
  if (!system.dampings.there()) return system.damping;
  auto const range = range_of_sites(scene, system.dampings, "system.damping");
  if (range.least < 0)
    throw io::scene_error(scene, system.dampings.key_or("system.damping"),
                          "is negative at a site; accepted: numbers >= 0");
  return range.largest;
}

double largest_exchange(io::Scene const& scene) {
  constexpr auto key = "field.exchange";
  auto const range = range_of_sites(scene, scene.field.exchange_factors, key);
  if (range.least < 0 && range.largest > 0)
    throw io::scene_error(scene, scene.field.exchange_factors.key_or(key),
                          "the constants must have one sign, as the harmonic mean of a positive "
                          "and a negative one is no bond");
  return range.magnitude();
}

// Of terms whose constants differ from site to site.
double bound_of_numbers(io::Scene const& scene, Lattice const& lattice) {
  auto const& field = scene.field;
  double bound = 0;
  if (field.exchange_factors.there())
    bound += field.exchange->field_bound(lattice) * largest_exchange(scene);
  if (field.dmi_factors.there())
    for (int axis = 0; axis < 3; ++axis)
      if (lattice.has_neighbors(axis))
        bound +=
            2 * largest_of_sites(scene, field.dmi_factors, "field.dmi") / lattice.spacing[axis];
  for (auto const& term : field.anisotropies)
    if (term.factors.there()) bound += largest_of_sites(scene, term.factors, "field.anisotropy");
  return bound;
}

// Of the terms that have sites of their own: the largest of the sites of a cell.
double bound_of_sites(io::Scene const& scene, Lattice const& lattice, double of_all) {
  auto const field = io::without_numbers_of_sites(scene.field);
  of_all += bound_of_numbers(scene, lattice);
  cayspin::detail::BondLists const bonds(lattice, io::couplings(scene));
  if (field.bulk_dmi)
    for (int axis = 0; axis < 3; ++axis)
      if (lattice.has_neighbors(axis))
        of_all += 2 * std::abs(field.bulk_dmi->constant) / lattice.spacing[axis];
  double largest = 0;
  for (std::size_t site = 0; site < bonds.field_bounds.size(); ++site) {
    double bound = of_all + bonds.field_bounds[site];
    auto const add = [&](int of, double constant) {
      if (of < 0 || of == static_cast<int>(site)) bound += std::abs(constant);
    };
    for (auto const& term : field.anisotropies) add(term.site, term.constant);
    for (auto const& term : field.cubic_anisotropies) add(term.site, 2 * term.constant);
    auto const of_site = [&](std::vector<double> const& numbers) {
      return numbers.empty() ? 1 : numbers[site];
    };
    bound *= of_site(scene.lattice.gyromagnetic) / of_site(scene.lattice.moments);
    largest = std::max(largest, bound);
  }
  return largest;
}

double torque_bound(io::Scene const& scene, Lattice const& lattice, Times const& times,
                    TimeFeatures const& features) {
  auto const& torque = scene.field.torque;
  double bound = 0;
  if (auto const& of = torque.zhang_li) {
    constexpr auto key = "torque.zhang_li.velocity";
    double const velocity = largest(AppliedField(of->velocity, key), key, scene, times, features);
    for (int axis = 0; axis < 3; ++axis)
      if (lattice.has_neighbors(axis)) bound += velocity / lattice.spacing[axis];
    bound *= std::hypot(1, of->nonadiabaticity);
  }
  if (auto const& of = torque.slonczewski) {
    constexpr auto key = "torque.slonczewski";
    bound += largest(AppliedField({of->damping_like, of->field_like, 0.0}, key), key, scene, times,
                     features);
  }
  return bound;
}

double field_bound(io::Scene const& scene, Lattice const& lattice, Times const& times,
                   TimeFeatures const& features) {
  auto const field = io::without_numbers_of_sites(scene.field);
  double bound = 0;
  io::for_each_lattice_term(field, [&](auto const& term) {
    if (term) bound += term->field_bound(lattice);
  });
  if (field.slab_demag) bound += std::abs(field.mu0 * field.slab_demag->strength);
  if (field.demag) bound += std::abs(field.mu0 * field.demag->strength);
  double const applied = largest(AppliedField(field), "field.applied", scene, times, features);
  if (!io::needs_pass(scene)) {
    for (auto const& term : field.anisotropies) bound += std::abs(term.constant);
    return bound + applied;
  }
  auto const fastest = [](std::vector<double> const& numbers) {
    return numbers.empty() ? 1 : std::ranges::max(numbers);
  };
  return bound_of_sites(scene, lattice, bound) + fastest(scene.lattice.gyromagnetic) * applied +
         torque_bound(scene, lattice, times, features);
}

// At most |A|: of rigid bodies the largest row sum of I^-1, where it is in the scene.
double largest_rate(io::Scene const& scene, Lattice const& lattice, Times const& times,
                    TimeFeatures const& features) {
  auto const& system = scene.system;
  if (system.kind == io::SystemKind::llg)
    return field_bound(scene, lattice, times, features) *
           std::hypot(largest_damping(scene), system.precession);
  double largest = 0;
  if (std::holds_alternative<io::InertiaFile>(system.inertia)) return largest;
  for (auto const& [xx, yy, zz, xy, xz, yz] : io::inverse_inertia(scene))
    largest = std::max({largest, std::abs(xx) + std::abs(xy) + std::abs(xz),
                        std::abs(xy) + std::abs(yy) + std::abs(yz),
                        std::abs(xz) + std::abs(yz) + std::abs(zz)});
  return largest;
}

template <class Real>
std::int64_t field_bytes(Lattice const& lattice, int components) {
  return static_cast<std::int64_t>(
      cayspin::detail::RowLayout::of<Real>(lattice).allocation(components) * sizeof(Real));
}

template <class Real>
Memory memory_of(io::Scene const& scene, Lattice const& lattice, Variant const& variant,
                 Precision precision, std::int64_t planes_at_once) {
  Memory memory;
  memory.spins = field_bytes<Real>(lattice, 3);
  memory.work = variant.work_bytes(lattice, !io::is_nonlocal(scene.field) && !io::needs_pass(scene),
                                   precision);
  if (scene.field.own.nonlocal) memory.field += memory.spins;
  if (io::needs_pass(scene)) memory.field += memory.spins + 3 * field_bytes<Real>(lattice, 1);
  if (auto const& slab = scene.field.slab_demag) {
    if (slab->on_host || slab->dear) memory.field += memory.spins;
    // Means, and of parts that share layers their exact sums.
    std::int64_t const words = lattice.part == nullptr ? 1 : 1 + cayspin::detail::ExactSum::words;
    if (slab->average_layer) memory.field += 8 * words * std::ranges::max(whole(lattice).shape);
  }
  if (scene.field.demag)
    memory.field += memory.spins + demagnetization_bytes<Real>(*scene.field.demag, lattice);
  if (has_dear_field(scene)) {
    memory.work += work_fields_of_dear(scene, variant) * memory.spins;
    memory.field += memory.spins;
  }
  // Of the search for a direction down, where the torque is small.
  if (scene.integrator.until_torque && lattice.part == nullptr)
    memory.work += (1 + Minimizer<SpinField<double>>::work_fields) * memory.spins;
  // A rank reads its sites by some planes at once, but OVF whole. The first one writes.
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
  // Two frames or pieces of them on their way, and the copies of a chunk that HDF5 makes.
  auto const pieces = io::frame_pieces(all.shape, sizeof(Real), storage_of(scene), planes_at_once,
                                       std::ssize(scene.lattice.basis));
  std::int64_t const positions = writes && has_positions(scene.lattice) ? 8 * numbers_of_all : 0;
  std::int64_t const frames =
      (writes ? static_cast<std::int64_t>(2 * pieces.bytes + pieces.copied) : 0) + positions +
      (is_part ? static_cast<std::int64_t>(sizeof(Real)) * numbers : 0);
  // A field on its way into a checkpoint, in double.
  bool const stores = !scene.output.checkpoint_every.is_never();
  std::int64_t const of_number = sizeof(Real) == sizeof(double) ? 8 : 12;
  std::int64_t const of_planes =
      is_part && writes ? 8 * 3 * all.shape[0] * all.shape[1] * planes_at_once : 0;
  std::int64_t const checkpoint = stores ? of_number * numbers + of_planes : 0;
  memory.files = std::max(start - memory.work, frames + checkpoint);
  return memory;
}

// What steps of a tolerance have to know of the field beforehand.
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
  require_demagnetization(scene);
  auto const lattice = make_lattice(scene);
  auto const& integrator = scene.integrator;
  Plan plan{lattice,
            find_variant(scene),
            {integrator.rotation, integrator.sigma, integrator.isotropy_cap, {}},
            {0, integrator.dt, integrator.steps},
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
    // Of each component in half a step; two of three move the spin.
    double const variance = io::largest_noise(scene) * scene.system.damping *
                            scene.thermal->temperature * integrator.dt;
    plan.noise_turn = 2 * std::sqrt(variance);
  }
  if (integrator.tolerance) {
    plan.options.steps = {*integrator.tolerance, 0, integrator.min_dt, integrator.max_dt,
                          plan.times.at(integrator.steps)};
    double const least = precision == Precision::double_precision
                             ? StepOptions::least_tolerance<double>()
                             : StepOptions::least_tolerance<float>();
    if (*integrator.tolerance < least)
      throw io::scene_error(scene, "integrator.tolerance",
                            fmt::format("{:.3g} is beyond {} precision; accepted: at least {:.3g}",
                                        *integrator.tolerance, to_string(precision), least));
    put_features(scene, *plan.features, plan.options.steps);
  }
  require_dear_field_fits(scene, plan.variant);
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
  auto const count = [&](std::int64_t every) { return (integrator.steps + every - 1) / every + 1; };
  plan.frames = count(scene.output.every);
  constexpr double sample_bytes = 8 * 7;
  auto const frames = static_cast<double>(plan.frames);
  auto const samples = static_cast<double>(count(scene.output.scalars_every));
  auto const numbers = 3 * static_cast<double>(lattice.sites());
  plan.file_bytes =
      frames * (numbers * (in_double ? 8 : 4) + sample_bytes) + samples * sample_bytes;
  if (has_positions(scene.lattice))
    plan.file_bytes += static_cast<double>(position_bytes(scene.lattice)) +
                       24 * frames * static_cast<double>(scene.lattice.basis.size());
  // What a step has to follow. Its fastest modes are those of exchange: a stable dt guards them.
  io::Scene followed = scene;
  if (plan.variant.method->stiff || std::isfinite(plan.stable_dt)) {
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
  if (plan.times.steps == 0 || plan.variant.method->adaptive) return std::nullopt;
  if (dt > plan.stable_dt && plan.stable_dt > 0)
    return fmt::format("{} is above the stable {}", text, time_text(units, plan.stable_dt, 6));
  if (dt > plan.stable_dt)
    return fmt::format("{} is not stable: at this damping the method amplifies at every dt", text);
  // Order 8 is stable where it no longer follows.
  double const most = std::isfinite(plan.stable_dt) ? 3 : 2;
  if (!(plan.turn <= most))
    return fmt::format("{} turns spins by up to {:.3g} radians a step, too many to follow", text,
                       plan.turn);
  if (auto const& shortest = plan.features->shortest; shortest && plan.substep > shortest->length)
    return fmt::format("{} is longer than {}, a feature of {} at t = {}, which steps may miss",
                       text, time_text(units, shortest->length, 3), shortest->key,
                       time_text(units, shortest->time, 6));
  if (plan.noise_turn > Plan::most_noise)
    return fmt::format("{} lets noise turn spins by {:.3g} radians a step, too many to follow",
                       text, plan.noise_turn);
  return std::nullopt;
}

std::optional<std::string> dt_warning(io::Scene const& scene, Plan const& plan) {
  auto const reason = dt_warning(plan, scene.units);
  if (!reason) return std::nullopt;
  auto const error = io::scene_error(scene, "integrator.dt", *reason);
  if (scene.integrator.refuse_unstable) throw error;
  return error.what();
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
    throw io::scene_error(scene, "lattice.shape",
                          fmt::format("the run needs {} of memory, {} are available",
                                      bytes_text(plan.memory.total()), bytes_text(available)));
}

}  // namespace cayspin::simulation
