// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "replica_columns.hpp"

#include "ensemble_plan.hpp"
#include "io/notes.hpp"
#include "kokkos_settings.hpp"
#include "plan.hpp"
#include "space.hpp"

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <span>
#include <stdexcept>
#include <utility>
#include <variant>

namespace cayspin::simulation {
namespace {

constexpr std::int64_t most_sites = 512, least_replicas = 16;

bool is_plain(io::Lattice const& lattice) {
  auto const is_one = [](double number) { return number == 1; };
  return std::min(lattice.shape[1], lattice.shape[2]) == 1 && lattice.basis.size() == 1 &&
         std::ranges::all_of(lattice.moments, is_one) &&
         std::ranges::all_of(lattice.gyromagnetic, is_one) && !lattice.moments_of_sites.there() &&
         !lattice.gyromagnetic_of_sites.there() && !lattice.occupied.there() &&
         !lattice.frozen.there() && !lattice.regions.there() && !lattice.follow;
}

bool is_local_but_for_exchange(io::Field const& field) {
  auto const& [zhang_li, slonczewski] = field.torque;
  return !field.has_dmi() && !field.exchange_factors.there() && field.exchange_between.empty() &&
         field.interlayers.empty() && field.couplings.empty() && field.couplings_file.empty() &&
         std::ranges::all_of(field.anisotropies, &io::Anisotropy::is_plain) &&
         std::ranges::all_of(field.crystal_anisotropies, &io::CrystalAnisotropy::is_plain) &&
         !zhang_li && !(slonczewski && !slonczewski->is_plain()) && field.sources.empty() &&
         !(field.slab_demag && (field.slab_demag->on_host || field.slab_demag->multirate)) &&
         !field.demag && !field.own.uniform && !field.own.nonlocal;
}

bool steps_each_site_alike(io::Integrator const& integrator) {
  auto const& method = *integrator.method;
  bool const is_constant =
      integrator.isotropy == io::Isotropy::zero || integrator.isotropy == io::Isotropy::constant;
  return method.has_equal_steps() && method.evaluations && !method.by_colour && is_constant &&
         integrator.substeps == 1 && !integrator.energy_control && !integrator.until_torque;
}

bool can_be_columns(io::Scene const& one, std::int64_t replicas) {
  return replicas >= least_replicas && io::sites(one) <= most_sites &&
         one.system.kind == io::SystemKind::llg && !one.system.dampings.there() &&
         is_plain(one.lattice) && is_local_but_for_exchange(one.field) &&
         steps_each_site_alike(one.integrator) && !(one.thermal && one.thermal->of_sites.there());
}

// Returns true if columns with these values move with the bits of separate runs. Scenes that need a
// pass add the local field to other terms in another order, and series use one local field and one
// damping for all spins.
bool can_differ(io::Scene const& one, io::Columns const& values) {
  bool const differ_in_field = !values.applied.empty() || !values.constants.empty();
  if (!differ_in_field && values.dampings.empty()) return true;
  return !one.integrator.method->differentiates_field && !(differ_in_field && io::needs_pass(one));
}

std::int64_t parts_of(std::int64_t all, std::int64_t part) { return (all + part - 1) / part; }

// Returns the first replica of each lattice of columns on a host, where each thread steps lattices
// of its own. The fields of a step fit into the cache of a core if that leaves long rows. Returns
// none if separate runs of the replicas are faster.
std::vector<std::int64_t> first_columns(std::int64_t replicas, std::int64_t sites, int threads,
                                        Precision precision) {
  std::int64_t const number = precision == Precision::double_precision ? 8 : 4;
  std::int64_t const lanes = 64 / number;  // a register has at most this many
  constexpr std::int64_t fields_of_step = 6, usual_sites = 2048, many_sites = 64;
  auto const cache = static_cast<std::int64_t>(cayspin::detail::core_cache_bytes());
  auto const packs = parts_of(replicas, lanes);
  auto const most =
      std::clamp<std::int64_t>(cache / (fields_of_step * 3 * number * sites) / lanes, 2,
                               std::max<std::int64_t>(8, usual_sites / sites / lanes));
  bool const few = packs < 2 * threads;
  if (few && threads > 1 && sites > many_sites) return {};
  auto const lattices = few ? parts_of(packs, 2) : threads * parts_of(packs, threads * most);
  std::vector<std::int64_t> first;
  for (std::int64_t lattice = 0; lattice < lattices; ++lattice)
    first.push_back(lattice * packs / lattices * lanes);
  return first;
}

// `values`: those of the columns.
io::Scene scene_of_columns(io::Scene const& one, std::int64_t first, io::Columns values,
                           std::int64_t count) {
  constexpr double far_apart = 1e200;  // its square is infinite
  auto columns = one;
  auto const& lattice = one.lattice;
  // Random numbers are drawn row by row. A row of a replica is along x in its own lattice, and
  // along y here.
  std::array<std::size_t, 2> const axes{0, lattice.shape[1] > 1 ? 1U : 2U};
  columns.lattice.shape[0] = count;
  columns.lattice.spacing[0] = far_apart;
  columns.lattice.boundary[0] = {};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    columns.lattice.shape[axis + 1] = lattice.shape[axes[axis]];
    columns.lattice.spacing[axis + 1] = lattice.spacing[axes[axis]];
    columns.lattice.boundary[axis + 1] = lattice.boundary[axes[axis]];
  }
  columns.initial = io::UniformStart{{1, 0, 0}};
  // The guard lets energies rise unless all columns are damped.
  if (!values.dampings.empty()) columns.system.damping = std::ranges::min(values.dampings);
  // A bound on the energies of all columns, to which round-off is proportional.
  for (auto const& constants : values.constants)
    for (std::size_t term = 0; term < constants.size(); ++term)
      columns.field.anisotropies[term].constant =
          std::max(columns.field.anisotropies[term].constant, std::abs(constants[term]));
  if (one.thermal) {
    columns.thermal->seed += first;
    if (auto const heats = values.heats(); !heats.empty())
      columns.thermal->temperature = std::ranges::max(heats) > 0 ? 1 : 0;
  }
  columns.columns = std::move(values);
  return columns;
}

// Copies a field of a replica, with any number of components, into one of the `count` columns of
// `columns`.
void put_column(std::span<double const> field, std::int64_t sites, std::int64_t column,
                std::int64_t count, std::vector<double>& columns) {
  if (field.size() * static_cast<std::size_t>(count) != columns.size())
    throw std::invalid_argument("the fields of replicas are of different sizes");
  auto const components = std::ssize(field) / sites;
  for (std::int64_t site = 0; site < sites; ++site)
    std::copy_n(field.begin() + components * site, components,
                columns.begin() + components * (site * count + column));
}

// Returns one of the `count` columns of a field with any number of components.
template <class Real>
std::vector<Real> of_column(std::vector<Real> const& columns, std::int64_t sites,
                            std::int64_t column, std::int64_t count) {
  auto const components = std::ssize(columns) / (sites * count);
  std::vector<Real> field(static_cast<std::size_t>(components * sites));
  for (std::int64_t site = 0; site < sites; ++site)
    std::copy_n(columns.begin() + components * (site * count + column), components,
                field.begin() + components * site);
  return field;
}

// Returns the initial spins of the replicas first .. first + count - 1 as columns.
std::vector<double> starts_of(io::Scene& one, std::int64_t first, std::int64_t count) {
  std::vector<double> columns(static_cast<std::size_t>(3 * count * io::sites(one)));
  auto* const random = std::get_if<io::RandomStart>(&one.initial);
  std::vector<double> start;
  for (std::int64_t column = 0; column < count; ++column) {
    if (random) random->seed += first + column;
    if (random || start.empty()) start = io::initial_spins(one);
    if (random) random->seed -= first + column;
    put_column(start, io::sites(one), column, count, columns);
  }
  return columns;
}

}  // namespace

std::optional<ReplicaColumns> ReplicaColumns::open(io::Scene const& scene, io::Scene const& first,
                                                   RunSettings const& settings,
                                                   ReplicaShare const& share) {
  std::optional<ReplicaColumns> opened;
  auto one = io::with_shape_of_start(first);
  auto const replicas = share.own.count, sites = io::sites(one);
  if (!can_be_columns(one, replicas)) return opened;
  auto const values = io::values_of_replicas(scene, one, share.own.first, replicas);
  if (!values || !can_differ(one, *values)) return opened;
  auto sample = SceneRun::open(one, settings);
  bool const on_host = is_on_host(sample->space());
  auto begins = on_host ? first_columns(replicas, sites, sample->threads(), settings.precision)
                        : std::vector<std::int64_t>{0};
  if (begins.empty()) return opened;
  auto const lattices = static_cast<std::int64_t>(begins.size());
  begins.push_back(replicas);
  auto const scene_from = [&](std::int64_t begin, std::int64_t count) {
    return scene_of_columns(one, begin, values->part(begin, count), count);
  };
  auto const columns = parts_of(replicas, lattices);
  auto const of_lattice = make_plan(scene_from(0, columns), settings.precision).memory.total() +
                          2 * bytes_of_open_run +  // the columns, and a replica for samples
                          columns * bytes_of_column;
  auto const on_this_machine = static_cast<double>(parts_of(share.on_this_machine, columns));
  require_memory_of_replicas(scene, on_this_machine * static_cast<double>(of_lattice),
                             share.available);
  opened.emplace();
  opened->values_ = *values;
  for (std::size_t lattice = 0; lattice + 1 < begins.size(); ++lattice) {
    auto const begin = begins[lattice], count = begins[lattice + 1] - begin;
    auto run = SceneRun::open(scene_from(begin, count), settings);
    run->continue_from(0, starts_of(one, begin, count));
    auto of_one = sample ? std::move(sample) : SceneRun::open(one, settings);
    opened->groups_.push_back({begin, count, std::move(run), std::move(of_one)});
  }
  return opened;
}

std::int64_t ReplicaColumns::evaluations() const {
  std::int64_t all = 0;
  for (auto const& group : groups_) all += group.count * group.columns->evaluations();
  return all;
}

double ReplicaColumns::step_seconds() const {
  double all = 0;
  for (auto const& group : groups_) all += group.columns->step_seconds();
  return all;
}

std::int64_t ReplicaColumns::steps() const {
  auto least = groups_.front().columns->steps();
  for (auto const& group : groups_) least = std::min(least, group.columns->steps());
  return least;
}

std::int64_t ReplicaColumns::furthest() const {
  std::int64_t most = 0;
  for (auto const& group : groups_) most = std::max(most, group.columns->steps());
  return most;
}

ReplicaColumns::Ended ReplicaColumns::advance(std::int64_t target, Looks const& looks) {
  std::vector<SceneRun*> runs;
  for (auto const& group : groups_) runs.push_back(group.columns.get());
  auto const outcomes = SceneRun::advance_all(runs, target, looks, SceneRun::SideBySide::all);
  Ended ended;
  for (std::size_t number = 0; number < outcomes.size(); ++number) {
    auto const& [advanced, error] = outcomes[number];
    ended.interrupted = ended.interrupted || advanced == Advanced::interrupted;
    if (!error) continue;
    if (!ended.error) ended.error = error;
    auto const& group = groups_[number];
    for (std::int64_t column = 0; column < group.count; ++column)
      ended.failed.push_back(group.first + column);
  }
  return ended;
}

void ReplicaColumns::continue_in(SceneRun& run, std::int64_t replica) const {
  auto const group = std::ranges::find_if(
      groups_, [&](Group const& group) { return replica < group.first + group.count; });
  run.continue_from_column(*group->columns, replica - group->first);
}

void ReplicaColumns::continue_from(std::int64_t step, std::vector<double> const& spins) {
  for (auto const& group : groups_) {
    auto const sites = io::sites(group.one->scene());
    auto const size = static_cast<std::size_t>(3 * sites);
    std::vector<double> columns(size * static_cast<std::size_t>(group.count));
    for (std::int64_t column = 0; column < group.count; ++column) {
      auto const begin = size * static_cast<std::size_t>(group.first + column);
      put_column(std::span(spins).subspan(begin, size), sites, column, group.count, columns);
    }
    group.columns->continue_from(step, columns);
  }
}

std::vector<io::ReplicaState> ReplicaColumns::states() const {
  std::vector<io::ReplicaState> states;
  for (auto const& group : groups_) {
    io::ReplicaState of_all;
    group.columns->exchange_with(of_all);
    // The guard of a lattice of columns has seen the energy of all of them.
    std::erase_if(of_all.numbers,
                  [](auto const& entry) { return io::ReplicaState::is_of_guard(entry.first); });
    for (std::int64_t column = 0; column < group.count; ++column) {
      auto& state = states.emplace_back();
      state.step = group.columns->steps();
      state.numbers = of_all.numbers;
      for (auto const& [name, all] : of_all.fields)
        state.fields[name] = of_column(all, io::sites(group.one->scene()), column, group.count);
    }
  }
  return states;
}

void ReplicaColumns::restore(std::vector<io::ReplicaState> const& states) {
  for (auto const& group : groups_) {
    auto const first = states.begin() + group.first;
    io::ReplicaState all;
    all.numbers = first->numbers;
    std::erase_if(all.numbers,
                  [](auto const& entry) { return io::ReplicaState::is_of_guard(entry.first); });
    auto const sites = io::sites(group.one->scene());
    for (auto const& [name, of_first] : first->fields) {
      auto& columns = all.fields[name];
      columns.resize(of_first.size() * static_cast<std::size_t>(group.count));
      for (std::int64_t column = 0; column < group.count; ++column)
        put_column(first[column].fields.at(name), sites, column, group.count, columns);
    }
    group.columns->continue_from(first->step, all.fields.at("spins"));
    all.close();
    group.columns->exchange_with(all);
  }
}

std::vector<Sample> ReplicaColumns::samples() const {
  std::vector<SceneRun::ColumnsToSample> all;
  for (auto const& [first, count, columns, one] : groups_)
    all.push_back({columns.get(), one.get(), first, count, &values_});
  std::vector<Sample> samples;
  for (auto const& of_lattice : SceneRun::sample_columns(all))
    samples.insert(samples.end(), of_lattice.begin(), of_lattice.end());
  return samples;
}

template <class Real>
std::vector<Real> ReplicaColumns::spins() const {
  std::vector<Real> all;
  for (auto const& group : groups_) {
    auto const of_lattice = packed<Real>(group.columns->spins().vectors);
    auto const sites = std::ssize(of_lattice) / 3 / group.count;
    for (std::int64_t column = 0; column < group.count; ++column) {
      auto const of_replica = of_column(of_lattice, sites, column, group.count);
      all.insert(all.end(), of_replica.begin(), of_replica.end());
    }
  }
  return all;
}
template std::vector<double> ReplicaColumns::spins() const;
template std::vector<float> ReplicaColumns::spins() const;

}  // namespace cayspin::simulation
