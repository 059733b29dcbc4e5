// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "io/notes.hpp"
#include "io/stages.hpp"
#include "print_json.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/plan.hpp"
#include "simulation/text.hpp"
#include "trade/resolved.hpp"
#include "trade/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cayspin::program {
namespace {

using namespace trade;

/// Options of commands that try methods.
struct TryOptions : SceneOptions {
  std::optional<Precision> precision;  // if given, only this one is tried
  std::optional<std::string> space;
  std::optional<int> threads;
  bool json = false, quiet = false;
};

struct TradeOptions : TryOptions {
  double seconds = 10;  // a method whose run takes longer is not tried with finer steps
  bool advice = false;
};

struct AdviseOptions : TryOptions {
  double error = 0;
  std::optional<double> budget;  // seconds
};

constexpr double errors_compared[] = {1e-2, 1e-4, 1e-6, 1e-8};
constexpr double least_error_of_trade = 1e-9;

// Describes the steps of a Rung or of an Advice: a tolerance or dt.
template <class Run>
std::string steps_text(Pilot const& pilot, Candidate const& candidate, Run const& run) {
  auto const& units = pilot.scene().units;
  return candidate.method->adaptive
             ? fmt::format("tol {:.1e}", run.steps.tolerance)
             : fmt::format("dt {:.3e}{}", run.dt * units.time, units.si ? " s" : "");
}

// Returns the number of threads of a space, which is 1 on devices.
int threads_in(std::string const& space) {
  return in_space(space, Precision::double_precision,
                  []<class, class Space>() { return threads_of(Space()); });
}

std::string amount_text(double amount, char const* form) {
  return std::isfinite(amount) ? fmt::format(fmt::runtime(form), amount) : "-";
}

void print_horizon(Pilot const& pilot, double horizon, std::string const& why_shorter) {
  if (why_shorter.empty()) return;
  auto const& units = pilot.scene().units;
  fmt::print("horizon     t = {} of {}: {}\n", time_text(units, horizon, 6),
             time_text(units, pilot.end(), 6), why_shorter);
}

void print_text(Pilot const& pilot, Reference const& reference,
                std::vector<Ladder> const& ladders) {
  fmt::print("scene       {}\n", pilot.scene().path.string());
  print_horizon(pilot, reference.horizon.time, reference.horizon.why_shorter);
  fmt::print(
      "reference   tsit5 and dp5 at a tolerance of 1e-13 agree to {:.1e}\n"
      "error       the largest distance of any spin at a dozen times, the last t = {}\n\n",
      reference.uncertainty, time_text(pilot.scene().units, reference.horizon.time, 6));
  constexpr auto line = "{:<33} {:>14} {:>10} {:>11} {:>12} {}\n";
  fmt::print(line, "method", "steps", "error", "seconds", "evaluations", "front");
  for (auto const& ladder : ladders)
    for (auto const& rung : ladder.rungs)
      fmt::print(line, ladder.candidate.name(), steps_text(pilot, ladder.candidate, rung),
                 fmt::format("{:.2e}", rung.error), fmt::format("{:.3e}", rung.seconds),
                 rung.evaluations, rung.on_front ? "*" : "");

  fmt::print("\nseconds (evaluations) to an error of\n{:<33}", "");
  for (double const error : errors_compared) fmt::print(" {:>20.0e}", error);
  fmt::print("\n");
  for (auto const& ladder : ladders) {
    fmt::print("{:<33}", ladder.candidate.name());
    for (double const error : errors_compared)
      fmt::print(" {:>20}", fmt::format("{} ({})", amount_text(seconds_to(ladder, error), "{:.2e}"),
                                        amount_text(evaluations_to(ladder, error), "{:.0f}")));
    fmt::print("\n");
  }
}

Json as_json(Pilot const& pilot, Reference const& reference, std::vector<Ladder> const& ladders) {
  Json all;
  all["scene"] = pilot.scene().path.string();
  auto const& units = pilot.scene().units;
  all["units"] = units.si ? "SI" : "reduced";
  all["horizon"] = reference.horizon.time * units.time;
  all["end"] = pilot.end() * units.time;
  all["why_shorter"] = reference.horizon.why_shorter;
  all["uncertainty"] = reference.uncertainty;
  all["methods"] = Json::array();
  for (auto const& ladder : ladders) {
    Json one;
    one["method"] = ladder.candidate.name();
    one["baseline"] = ladder.candidate.method->is_baseline();
    one["rungs"] = Json::array();
    for (auto const& rung : ladder.rungs) {
      Json step{{"error", rung.error},
                {"seconds", rung.seconds},
                {"evaluations", rung.evaluations},
                {"front", rung.on_front}};
      if (ladder.candidate.method->adaptive)
        step["tolerance"] = rung.steps.tolerance;
      else
        step["dt"] = rung.dt * units.time;
      one["rungs"].push_back(step);
    }
    one["costs"] = Json::array();
    for (double const error : errors_compared)
      one["costs"].push_back({{"error", error},
                              {"seconds", seconds_to(ladder, error)},
                              {"evaluations", evaluations_to(ladder, error)}});
    all["methods"].push_back(one);
  }
  return all;
}

void print_verdicts(Pilot const& pilot, std::vector<Verdict> const& verdicts) {
  constexpr auto line = "{:>8} {:<33} {:>14} {:>15} {:>15} {:>15} {:>10}\n";
  fmt::print("\nwhat `cayspin advise` says, and how it turns out\n");
  fmt::print(line, "asked", "advised", "steps", "error / asked", "time / best", "time / predicted",
             "tried for");
  for (auto const& [asked, advised, error, seconds, best] : verdicts) {
    auto const& choice = advised.choice;
    if (!choice) {
      fmt::print(line, fmt::format("{:.0e}", asked), "nothing", "-", "-", "-", "-",
                 duration_text(advised.seconds));
      continue;
    }
    fmt::print(line, fmt::format("{:.0e}", asked), choice->candidate.name(),
               steps_text(pilot, choice->candidate, *choice), fmt::format("{:.2f}", error / asked),
               fmt::format("{:.2f}", seconds / best),
               fmt::format("{:.2f}", seconds / choice->seconds), duration_text(advised.seconds));
  }
}

// Returns the command that runs the scene as advised, with the space and threads of the
// measurement, and with an output file if the scene names none.
std::string command_of(AdviseOptions const& options, io::Scene const& scene,
                       Resolved const& resolved, Precision precision) {
  std::string command = "cayspin run " + shell_word(options.scene.string());
  for (auto const& overrides : {options.overrides, resolved.overrides})
    for (auto const& override : overrides)
      command += fmt::format(" --set {}", shell_word(override));
  if (!scene.output.file)
    command +=
        " --set " + shell_word(fmt::format("output.file=\"{}.h5\"", options.scene.stem().string()));
  if (precision == Precision::single_precision) command += " --precision single";
  auto const space = chosen_space(options.space);
  command += " --space " + space;
  if (auto const threads = is_on_host(space) ? std::optional(threads_in(space)) : options.threads)
    command += fmt::format(" --threads {}", *threads);
  return command;
}

// Returns the warning that `run` would print.
std::optional<std::string> warning_of(io::Scene const& scene, Resolved const& resolved,
                                      Precision precision) {
  auto const plan = make_plan(io::with_overrides(scene, resolved.overrides), precision);
  return dt_warning(plan, scene.units);
}

Json as_json(io::Scene const& scene, Advised const& advised, Resolved const& resolved,
             std::string const& space) {
  auto const& units = scene.units;
  auto const& choice = *advised.choice;
  Json all{{"method", choice.candidate.name()},
           {"precision", to_string(choice.candidate.precision)},
           {"dt", resolved.dt},
           {"steps", resolved.steps},
           {"tolerance", nullptr},
           {"error", choice.error},
           {"seconds", choice.seconds},
           {"memory", choice.memory},
           {"horizon", advised.horizon * units.time},
           {"space", space},
           {"threads", threads_in(space)},
           {"units", units.si ? "SI" : "reduced"},
           {"overrides", resolved.overrides},
           {"warning", nullptr},
           {"others", Json::array()}};
  if (auto const reason = warning_of(scene, resolved, choice.candidate.precision))
    all["warning"] = *reason;
  if (choice.candidate.method->adaptive) all["tolerance"] = choice.steps.tolerance;
  for (std::size_t i = 1; i < advised.others.size(); ++i)
    all["others"].push_back(
        {{"method", advised.others[i].candidate.name()}, {"seconds", advised.others[i].seconds}});
  return all;
}

void print_text(AdviseOptions const& options, io::Scene const& scene, Advised const& advised,
                Resolved const& resolved) {
  auto const& units = scene.units;
  auto const& choice = *advised.choice;
  auto const& candidate = choice.candidate;
  fmt::print("method      {}\n", candidate.name());
  if (candidate.method->adaptive)
    fmt::print("tolerance   {:.3g}\n", choice.steps.tolerance);
  else
    fmt::print("dt          {:.9g}{}, {}\n", resolved.dt, units.si ? " s" : "",
               counted(resolved.steps, "step"));
  fmt::print("error       {:.2g}, predicted, at a dozen times{}\n", choice.error,
             advised.why_shorter.empty() ? "" : " up to the horizon");
  fmt::print("time        {}, predicted, without files\n", duration_text(choice.seconds));
  fmt::print("memory      {}\n", bytes_text(choice.memory));
  if (auto const reason = warning_of(scene, resolved, candidate.precision))
    fmt::print("run warns   dt {}; the error takes that into account\n", *reason);
  fmt::print("run it      {}\n", command_of(options, scene, resolved, candidate.precision));
  fmt::print("\nfound in {}{}\n", duration_text(advised.seconds),
             advised.others.size() > 1 ? "; the next best:" : "");
  for (std::size_t i = 1; i < std::min<std::size_t>(advised.others.size(), 4); ++i)
    fmt::print("  {:<33} {}\n", advised.others[i].candidate.name(),
               duration_text(advised.others[i].seconds));
}

io::Scene scene_to_try(std::filesystem::path const& path,
                       std::vector<std::string> const& overrides) {
  auto const scene = io::with_shape_of_start(io::read_scene(path, overrides));
  io::require_no_stages(scene, "cayspin trade or advise");
  io::check_files(scene);
  // Refuses substeps without an expensive field. With an expensive field, the scene's own method
  // need not fit, because candidates replace it.
  if (!scene.integrator.method->automatic && !has_slow_field(scene))
    require_slow_field_fits(scene, find_variant(scene));
  return scene;
}

int trade_off(TradeOptions const& options) {
  if (!(options.seconds > 0) || !std::isfinite(options.seconds))
    throw UsageError(fmt::format("--seconds {}; accepted: a number > 0", options.seconds));
  auto const scene = scene_to_try(options.scene, options.overrides);
  auto const space = chosen_space(options.space);
  KokkosSession const kokkos(space, options.threads, {});
  Pilot const pilot(scene, space, least_error_of_trade);
  TrialProgress progress(options.quiet, !options.json);
  auto const reference = converged_reference(pilot, options.seconds);
  LadderLimits limits;
  limits.progress = &progress;
  limits.seconds = options.seconds;
  limits.least_error = std::max(limits.least_error, 10 * reference.uncertainty);
  std::vector<Ladder> ladders;
  auto all = candidates(scene, options.precision);
  std::erase_if(all, [&](Candidate const& one) { return !pilot.fits(one); });
  for (auto const& candidate : all) {
    limits.share = static_cast<double>(ladders.size()) / static_cast<double>(all.size());
    ladders.push_back(climb(pilot, candidate, reference, ladders, limits));
  }
  progress.clear();
  mark_front(ladders);
  if (options.json)
    print_json(as_json(pilot, reference, ladders));
  else
    print_text(pilot, reference, ladders);
  if (!options.advice) return Status::done;
  auto as_far = scene;
  as_far.integrator.dt *= reference.horizon.time / pilot.end();
  Pilot const pilot_as_far(as_far, space, least_error_of_trade);
  std::vector<Verdict> verdicts;
  for (double const error : errors_compared)
    verdicts.push_back(judge(pilot_as_far, reference, ladders, error, options.precision));
  print_verdicts(pilot, verdicts);
  return Status::done;
}

int advise_on(AdviseOptions const& options) {
  if (!(options.error >= 1e-13) || options.error > 1)
    throw UsageError(fmt::format("--error {}; accepted: a number from 1e-13 to 1", options.error));
  if (options.budget && !(*options.budget > 0 && std::isfinite(*options.budget)))
    throw UsageError(fmt::format(
        "--budget {}; accepted: a number of seconds > 0, or a time such as 60s, 2min or 1h",
        *options.budget));
  auto const scene = scene_to_try(options.scene, options.overrides);
  auto const space = chosen_space(options.space);
  KokkosSession const kokkos(space, options.threads, {});
  Pilot const pilot(scene, space, options.error);
  TrialProgress progress(options.quiet, !options.json);
  auto const advised = advise(pilot, {options.error, options.budget, options.precision, &progress});
  progress.clear();
  if (!options.json) {
    fmt::print("scene       {}\n", scene.path.string());
    print_horizon(pilot, advised.horizon, advised.why_shorter);
  }
  if (!advised.choice) {
    if (advised.others.empty())
      throw NumbersFailed(fmt::format("{}: no method reaches an error of {:g}", scene.path.string(),
                                      options.error));
    auto const& first = advised.others.front();
    throw NumbersFailed(fmt::format("{}: {} would take {}, beyond the budget of {}",
                                    scene.path.string(), first.candidate.name(),
                                    duration_text(first.seconds), duration_text(*options.budget)));
  }
  auto const resolved = resolve(scene, *advised.choice);
  if (options.json)
    print_json(as_json(scene, advised, resolved, space));
  else
    print_text(options, scene, advised, resolved);
  return Status::done;
}

void add_try_options(CLI::App& command, TryOptions& options) {
  add_scene_options(command, options, "only double, or only single (default: both)");
  add_space_options(command, options);
  command.add_flag("--quiet", options.quiet, "No progress");
}

}  // namespace

Command add_trade(CLI::App& program) {
  auto const options = std::make_shared<TradeOptions>();
  auto* const command = program.add_subcommand(
      "trade", "Measure error against time and evaluations for every method on a scene");
  add_try_options(*command, *options);
  command->add_option("--seconds", options->seconds,
                      "Seconds that the longest run may take (default: 10)");
  auto* const json = add_json_option(*command, options->json);
  command->add_flag("--advice", options->advice, "Also judge what `advise` says of the scene")
      ->excludes(json);
  return {command, [options](Ranks&) { return trade_off(*options); }};
}

Command add_advise(CLI::App& program) {
  auto const options = std::make_shared<AdviseOptions>();
  auto* const command = program.add_subcommand(
      "advise",
      "Name the cheapest method and its dt or tolerance for an error. Takes at most a tenth of the "
      "run's time, or 2 s");
  add_try_options(*command, *options);
  command->add_option("--error", options->error, "Largest distance of any spin")->required();
  command->add_option("--budget", options->budget, "Time that the run may take")
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                CLI::AsNumberWithUnit::CASE_SENSITIVE, "TIME"))
      ->type_name("TIME");
  add_json_option(*command, options->json);
  return {command, [options](Ranks&) { return advise_on(*options); }};
}

}  // namespace cayspin::program
