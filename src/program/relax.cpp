// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/relax.hpp"

#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "end_of_search.hpp"
#include "info_file.hpp"
#include "io/notes.hpp"
#include "io/run_output.hpp"
#include "progress.hpp"
#include "run_ensemble.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/more_of_sample.hpp"
#include "simulation/plan.hpp"
#include "simulation/run_files.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/space.hpp"
#include "simulation/text.hpp"

#include <cayspin/observer/record.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace cayspin::program {
namespace {

struct RelaxOptions : DeviceOptions {
  double torque = 1e-6;
  std::int64_t evaluations = 100000;  // at most, for each field
  bool keep_saddles = false, quiet = false, json = false;
};

template <class Real, class Space>
class Relaxation {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  Relaxation(io::Scene const& scene, Lattice const& lattice, RelaxOptions const& options)
      : scene_(scene), options_(options), spins_("spins", lattice), minimizer_(spins_) {
    copy_from_host(io::initial_spins(scene), spins_);
    auto header = run_header(scene, options.precision, chosen_space(options.space),
                             threads_of(exec_), CAYSPIN_GIT_COMMIT);
    header.relaxes = true;
    auto in_field = scene;
    in_field.field = io::fields_in_turn(scene).front();
    header.more = more_scalars(in_field);
    header.more.shift = false;
    file_.emplace(open_output(output_file(scene, options.output), header,
                              run_output_options(scene, options.overwrite)));
  }

  int run() {
    auto const fields = io::fields_in_turn(scene_);
    try {
      return relax_all(fields);
    } catch (NumbersFailed const& error) {
      end_after_failure();
      if (fields.size() == 1) throw;
      throw NumbersFailed(fmt::format("{}; {} has {} of {} states", error.what(),
                                      output_file(scene_, options_.output).string(), states_,
                                      fields.size()));
    }
  }

 private:
  int relax_all(std::vector<io::Field> const& fields) {
    for (auto const& field : fields) {
      auto in_field = scene_;
      in_field.field = field;
      auto const found = relax_in(
          in_field, field_of<Spins>(in_field, spins_.lattice(), false).made_for(FieldFor::energy));
      cost_.evaluations += found.evaluations;
      cost_.relaxed->torque = std::max(cost_.relaxed->torque, found.torque * scene_.units.field);
      bool const interrupted = found.end == MinimizeEnd::interrupted;
      if (found.end != MinimizeEnd::converged && failures_++ == 0) first_failure_ = found.end;
      searches_.push_back({{"converged", found.end == MinimizeEnd::converged},
                           {"end", std::string(to_string(found.end))},
                           {"evaluations", found.evaluations},
                           {"torque", found.torque * scene_.units.field}});
      if (!options_.quiet && !options_.json) report(fields.size(), found);
      if (interrupted) break;
      ++states_;
    }
    cost_.wall_seconds = clock_.seconds();
    cost_.relaxed->converged = failures_ == 0;
    bool const interrupted = states_ < static_cast<std::int64_t>(fields.size());
    interrupted ? file_->close(cost_) : file_->finish(cost_);
    if (options_.json) print_found();
    if (failures_ == 0) return Status::done;
    auto const why = why_ended(to_string(first_failure_));
    if (fields.size() == 1)
      print_message("{}: not converged: {}\n", scene_.path.string(), why);
    else
      print_message("{}: {} of {} states did not converge; the first: {}\n", scene_.path.string(),
                    failures_, fields.size(), why);
    return interrupted ? Status::interrupted : Status::numbers_failed;
  }

  // Keeps the states that were found before a field or an energy that is not finite.
  void end_after_failure() {
    cost_.wall_seconds = clock_.seconds();
    file_->close(cost_);
    if (options_.json && states_ > 0) print_found();
  }

  Minimum relax_in(io::Scene const& in_field, SceneField<Spins> const& field) {
    Kokkos::Timer const clock;
    auto const found =
        minimizer_.relax(exec_, scene_, field, spins_,
                         {.torque = options_.torque / scene_.units.field,
                          .evaluations = options_.evaluations,
                          .keep_saddles = options_.keep_saddles,
                          .observer = [](Minimum const&) {
                            return interrupt_requested() ? Next::stop : Next::proceed;
                          }});
    cost_.step_seconds += clock.seconds();
    Step const step{states_, static_cast<double>(states_), 1, true};
    last_ = sample_scene(exec_, field, step, spins_);
    auto const scalars = as_scalars(last_, scene_.units);
    auto const numbers = copy_to_host(spins_);
    std::ranges::copy(numbers, file_->template frame<Real>());
    MoreOfSample<Spins> const more(in_field, spins_.lattice());
    file_->write_scalars(step.number, step.time, scalars, more(exec_, field, step, spins_));
    file_->write_frame(step.number, step.time, scalars);
    return found;
  }

  void print_found() const {
    auto object = as_json(read_info_file(output_file(scene_, options_.output)));
    object["searches"] = searches_;
    print_json(object);
  }

  void report(std::size_t count, Minimum const& found) const {
    auto const& m = last_.magnetization;
    write_text(
        stdout,
        fmt::format(
            "{} of {}: {}, max |m x H| = {:.3g}{}, energy {}, <m> = ({:.6g}, {:.6g}, {:.6g})\n",
            states_ + 1, count, end_text(found.end, found.evaluations),
            found.torque * scene_.units.field, scene_.units.si ? " T" : "",
            energy_text(scene_.units, last_.energy.value), m.x, m.y, m.z));
    std::fflush(stdout);
  }

  io::Scene const& scene_;
  RelaxOptions const& options_;
  Space exec_;
  Spins spins_;
  SceneMinimizer<Real, Space> minimizer_;
  std::optional<io::RunOutput> file_;
  io::RunCost cost_{.relaxed = io::Relaxed{}};
  Kokkos::Timer clock_;
  Sample last_;
  std::int64_t states_ = 0, failures_ = 0;
  MinimizeEnd first_failure_ = MinimizeEnd::converged;
  Json searches_ = Json::array();
};

io::Scene checked_scene(RelaxOptions const& options, bool on_one_rank) {
  auto scene = io::with_shape_of_start(io::read_scene_to_relax(options.scene, options.overrides));
  if (!on_one_rank && !scene.ensemble.there())
    throw UsageError("relax runs on one rank; accepted: run, or a scene with [ensemble]");
  require_rest(scene);
  output_file(scene, options.output);
  io::check_files(scene);
  constexpr double least = Minimizer<SpinField<double>>::least_bound;
  if (!(options.torque / scene.units.field >= least) || !std::isfinite(options.torque))
    throw UsageError(fmt::format("--torque {}; accepted: a number of at least {}", options.torque,
                                 least * scene.units.field));
  return scene;
}

int relax(RelaxOptions const& options, Ranks& ranks) {
  auto const scene = ranks.together([&] { return checked_scene(options, !ranks.many()); });
  if (scene.ensemble.there())
    return relax_ensemble(
        scene, options,
        {options.torque, options.evaluations, options.keep_saddles, options.quiet, options.json},
        ranks);
  auto const space = chosen_space(options.space);
  KokkosSession const kokkos(space, options.threads, options.device);
  auto const plan = make_plan_to_relax(scene, options.precision);
  require_memory(scene, plan);
  warn_of_notes(scene);
  catch_signals();
  return in_space(space, options.precision, [&]<class Real, class Space>() {
    return Relaxation<Real, Space>(scene, plan.lattice, options).run();
  });
}

}  // namespace

Command add_relax(CLI::App& program) {
  auto const options = std::make_shared<RelaxOptions>();
  auto* const command = program.add_subcommand(
      "relax", "Find the equilibrium of a scene, or one for each of its fields (HDF5)");
  add_device_options(*command, *options);
  command->add_option("--torque", options->torque, "Largest |m x H| (default: 1e-6)");
  command
      ->add_option("--evaluations", options->evaluations,
                   "Largest number of evaluations of the field (default: 100000)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53U));
  command->add_flag("--keep-saddles", options->keep_saddles,
                    "Accept a state without torque even if the energy falls from it");
  command->add_flag("--quiet", options->quiet, "No progress");
  add_json_option(*command, options->json);
  return {command, [options](Ranks& ranks) { return relax(*options, ranks); }};
}

}  // namespace cayspin::program
