// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "check_ensemble.hpp"
#include "check_text.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "io/notes.hpp"
#include "io/relax.hpp"
#include "print_json.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/parts.hpp"
#include "simulation/plan.hpp"
#include "simulation/run_files.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/text.hpp"
#include "simulation/thermal.hpp"
#include "terminal_picture.hpp"
#include "trade/resolved.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace cayspin::program {
namespace {

struct CheckOptions : SceneOptions {
  Precision precision = Precision::double_precision;
  std::optional<std::string> ranks;  // Y,Z as typed
  bool json = false;
};

double bytes_per_site(Plan const& plan) {
  return static_cast<double>(plan.memory.simulation()) / static_cast<double>(plan.lattice.sites());
}

/// Returns the work that a step repeats on the requested ranks, relative to the work of a part.
/// Returns nothing without --ranks.
std::optional<double> repeated_on(CheckOptions const& options, io::Scene const& scene,
                                  Plan const& plan) {
  if (!options.ranks) return std::nullopt;
  if (plan.variant.ghosts == 0)
    throw UsageError(
        fmt::format("--ranks {}: method \"{}\" runs only on one rank; accepted: no --ranks, or "
                    "another integrator.method",
                    *options.ranks, plan.variant.method->word));
  auto const depth = depth_of_parts(scene, plan.lattice, plan.variant.ghosts);
  auto const parts = read_parts(*options.ranks, plan.lattice, depth);
  return repeated_share(plan.lattice, plan.variant.ghosts, parts);
}

void add_memory(Json& object, Plan const& plan) {
  auto const& memory = plan.memory;
  object["sites"] = plan.lattice.sites();
  object["bytes_per_site"] = bytes_per_site(plan);
  object["spins_bytes"] = memory.spins;
  object["work_bytes"] = memory.work;
  object["field_bytes"] = memory.field;
  object["host_buffer_bytes"] = memory.files;
  object["memory_bytes"] = memory.total();
}

void print_notes(io::Scene const& scene) {
  for (auto const& note : io::notes(scene)) print("note", note);
}

void add_notes(Json& object, io::Scene const& scene) {
  if (auto const all = io::notes(scene); !all.empty()) object["notes"] = all;
}

Json run_json(io::Scene const& scene, Plan const& plan, Precision precision,
              std::optional<double> const& repeated, std::optional<ReplicaTotals> const& totals) {
  auto const& units = scene.units;
  // If no limit is known, stable_dt is infinite, which JSON prints as null.
  Json object{{"stable_dt", plan.stable_dt * units.time},
              {"dt", plan.times.dt * units.time},
              {"steps", scene.integrator.steps}};
  add_memory(object, plan);
  object["evaluations_per_step"] = or_null(evaluations(scene, plan.variant));
  object["order"] = order(scene, plan.variant);
  object["frames"] = plan.frames;
  object["file_bytes"] = bytes_json(plan.file_bytes);
  object["method"] = std::string(plan.variant.method->word);
  object["precision"] = std::string(to_string(precision));
  add_units(object, units);
  if (units.si) object["reduced"] = {{"stable_dt", plan.stable_dt}, {"dt", plan.times.dt}};
  if (is_thermal(scene)) {
    object["temperature"] = typed_temperature(scene);
    object["noise_turn"] = plan.noise_turn;
  }
  if (scene.system.kind == io::SystemKind::llg && io::depends_on_time(scene.field)) {
    auto const& shortest = plan.features->shortest;
    object["shortest_feature"] = shortest ? Json(shortest->length * units.time) : Json();
    object["jumps"] = plan.features->jumps;
  }
  if (repeated) object["repeated"] = *repeated;
  if (totals) add_totals(object, *totals);
  add_notes(object, scene);
  return object;
}

Json relax_json(io::Scene const& scene, Plan const& plan, Precision precision,
                std::optional<ReplicaTotals> const& totals) {
  Json object;
  object["stable_dt"] = nullptr;
  add_memory(object, plan);
  object["evaluations_per_step"] = nullptr;
  object["states"] = plan.frames;
  object["file_bytes"] = bytes_json(plan.file_bytes);
  object["precision"] = std::string(to_string(precision));
  add_units(object, scene.units);
  if (totals) add_totals(object, *totals);
  add_notes(object, scene);
  return object;
}

Json staged_json(io::Scene const& scene, std::vector<CheckedStage> const& stages,
                 Plan const& largest, Precision precision) {
  Json object;
  object["stages"] = stages_json(stages);
  add_memory(object, largest);
  object["precision"] = std::string(to_string(precision));
  add_units(object, scene.units);
  std::vector<std::string> notes;
  for (auto const& stage : stages)
    for (auto const& note : io::notes(stage.stage.scene))
      if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  if (!notes.empty()) object["notes"] = notes;
  return object;
}

std::string output_text(io::Scene const& scene, std::int64_t frames, double file_bytes) {
  auto const& output = scene.output;
  auto text = fmt::format("{}, {}, to {}", counted(frames, "frame"), bytes_text(file_bytes),
                          output.file ? output.file->string() : "the file that --output names");
  if (output.compression > 0) text += fmt::format(", compressed at level {}", output.compression);
  if (output.xdmf) text += ", described by an XDMF file";
  if (output.table) text += ", samples also in a text table";
  if (output.regions) text += ", samples of each region";
  if (output.terms) text += ", energies of each term";
  if (output.sync) text += ", each frame protected against power cuts";
  return text;
}

// The spins of the start and the inertia tensors are read and checked only up to this many sites,
// which takes only seconds.
constexpr std::int64_t most_sites_checked = 10'000'000;

bool is_start_checked(Plan const& plan) {
  return plan.lattice.sites() <= most_sites_checked && fits(plan);
}

// Checks the start and, for rigid bodies, the inertia. Returns the spins of the start.
std::vector<double> check_start(io::Scene const& scene) {
  if (scene.system.kind == io::SystemKind::rigid_body) io::inertia(scene);
  return io::initial_spins(scene);
}

void draw(io::Scene const& scene, std::vector<double> const& start) {
  if (!start.empty() && terminal_shows_pictures())
    fmt::print("{}", terminal_picture(scene.lattice, start));
}

// Returns why a run would now refuse to write the scene's output file. Returns nothing if the run
// would write it.
std::optional<std::string> refusal_of_output(io::Scene const& scene) {
  try {
    if (scene.output.file) output_file(scene, {});
  } catch (UsageError const& error) {
    return error.what();
  }
  return output_refusal(scene.output);
}

// For an ensemble, `totals` is set, and the file has all replicas.
void print_output(io::Scene const& scene, Plan const& plan,
                  std::optional<ReplicaTotals> const& totals) {
  print("output", output_text(scene, plan.frames, totals ? totals->file_bytes : plan.file_bytes));
  if (auto const refusal = refusal_of_output(scene)) print("", "as it stands: " + *refusal);
}

void print_memory(Plan const& plan, Precision precision, char const* work) {
  auto const& memory = plan.memory;
  print("memory",
        fmt::format("{}: spins {}, {} {}, fields {}, and {} of buffers on the host; {:.6g} bytes "
                    "per site in {} precision, without the buffers",
                    bytes_text(memory.total()), bytes_text(memory.spins), work,
                    bytes_text(memory.work), bytes_text(memory.field), bytes_text(memory.files),
                    bytes_per_site(plan), to_string(precision)));
  if (!is_start_checked(plan))
    print("", "the numbers of the start are not checked: the lattice is too large");
  if (!fits(plan)) print("", "more memory than is available now");
}

void print_text(io::Scene const& scene, Plan const& plan, Precision precision,
                std::optional<double> const& repeated, std::optional<ReplicaTotals> const& totals) {
  for (auto const& [name, text] : describe(scene)) print(name, text);
  print_steps(scene, plan);
  print_memory(plan, precision, "method");
  if (totals) print_totals(*totals);
  print_notes(scene);
  if (repeated)
    print("ranks",
          fmt::format("each does {:.3g} % more work than on its own sites, and holds {} of each "
                      "neighbour",
                      100 * *repeated,
                      mpi::to_text(depth_of_parts(scene, plan.lattice, plan.variant.ghosts))));
  print_output(scene, plan, totals);
}

// Describes the search as far as it is known beforehand. The other choices depend on the field, and
// are made when the search starts.
std::string search_text(io::Scene const& scene) {
  return fmt::format(
      "L-BFGS {}, until max |m x H| is below the --torque of cayspin relax{}",
      scene.field.exchange ? "preconditioned by exchange" : "without exchange",
      scene.field.applied_in_turn.empty() ? "" : "; each field starts at the state found before");
}

// `whole`: the scene with its table [ensemble], if it has one.
int check_to_relax(CheckOptions const& options, io::Scene const& whole, io::Scene const& scene) {
  if (options.ranks)
    throw UsageError(
        fmt::format("--ranks {}: the scene is for cayspin relax, which runs on one rank; accepted: "
                    "no --ranks",
                    *options.ranks));
  auto const plan = make_plan_to_relax(scene, options.precision);
  auto const totals = replica_totals(whole, scene, plan, options.precision);
  auto const start = is_start_checked(plan) ? check_start(scene) : std::vector<double>();
  if (options.json) {
    print_json(relax_json(scene, plan, options.precision, totals));
    return Status::done;
  }
  for (auto const& [name, text] : describe(scene)) print(name, text);
  print("relax", search_text(scene));
  print_memory(plan, options.precision, "search");
  if (totals) print_totals(*totals);
  print_notes(scene);
  print_output(scene, plan, totals);
  draw(scene, start);
  return Status::done;
}

int check_in_stages(CheckOptions const& options, io::Scene const& scene) {
  if (options.ranks)
    throw UsageError(
        fmt::format("--ranks {}: check does not report this for a run in stages; accepted: no "
                    "--ranks, or a scene without [[stage]]",
                    *options.ranks));
  auto const planned = plan_stages(scene, options.precision);
  auto const& largest = *std::ranges::max_element(
      planned, {}, [](auto const& one) { return one.plan.memory.total(); });
  auto const start = is_start_checked(largest.plan) ? check_start(scene) : std::vector<double>();
  if (options.json) {
    print_json(staged_json(scene, planned, largest.plan, options.precision));
    return Status::done;
  }
  for (auto const& [name, text] : describe(planned.front().stage.scene)) print(name, text);
  print_stages(planned);
  print_memory(largest.plan, options.precision, "method");
  auto whole = planned.back().plan;
  whole.frames = 0, whole.file_bytes = 0;
  for (auto const& [stage, plan] : planned) {
    whole.frames += stage.scene.begin.stage == 0 ? plan.frames : plan.frames - !stage.relax;
    whole.file_bytes += plan.file_bytes;
  }
  print_output(scene, whole, {});
  draw(scene, start);
  return Status::done;
}

// Returns the scene of the first replica, which the command then checks. Without --json, also
// prints the number of replicas.
io::Scene first_replica(CheckOptions const& options, io::Scene const& scene) {
  auto const& ensemble = scene.ensemble;
  std::vector<std::string> keys;
  for (auto const& varied : ensemble.vary) keys.push_back(varied.key);
  if (!options.json)
    print("ensemble",
          fmt::format("{}{}; the lines below describe the first replica, and the memory of one",
                      counted(ensemble.replicas, "replica"),
                      keys.empty() ? std::string()
                                   : fmt::format(", which vary in {}", fmt::join(keys, ", "))));
  return io::with_shape_of_start(io::is_to_relax(scene) ? io::replica_to_relax(scene, 0)
                                                        : io::replica_of(scene, 0));
}

int check(CheckOptions const& options) {
  auto scene =
      io::with_shape_of_start(io::read_scene_to_run_or_relax(options.scene, options.overrides));
  io::check_files(scene);
  require_divisible(scene, options.ranks);
  auto const whole = scene;
  if (whole.ensemble.there()) scene = first_replica(options, whole);
  if (io::is_to_relax(scene)) return check_to_relax(options, whole, scene);
  if (!scene.stages.empty()) return check_in_stages(options, scene);
  if (scene.integrator.method->automatic) {
    auto const space = chosen_space({});
    KokkosSession const kokkos(space, {}, {});
    scene = trade::with_method(scene, space, options.precision, options.ranks.has_value());
  }
  auto const plan = make_plan(scene, options.precision);
  auto const repeated = repeated_on(options, scene, plan);
  auto const totals = replica_totals(whole, scene, plan, options.precision);
  auto const start = is_start_checked(plan) ? check_start(scene) : std::vector<double>();
  if (options.json) {
    print_json(run_json(scene, plan, options.precision, repeated, totals));
  } else {
    print_text(scene, plan, options.precision, repeated, totals);
    draw(scene, start);
  }
  return Status::done;
}

}  // namespace

Command add_check(CLI::App& program) {
  auto const options = std::make_shared<CheckOptions>();
  auto* const command = program.add_subcommand(
      "check", "Validate a scene and say what it models, the stable dt, memory and cost");
  add_scene_options(*command, *options);
  add_json_option(*command, options->json);
  add_ranks_option(*command, options->ranks,
                   "Report the work that a run with Y x Z parts along y and z would repeat");
  return {command, [options](Ranks&) { return check(*options); }};
}

}  // namespace cayspin::program
