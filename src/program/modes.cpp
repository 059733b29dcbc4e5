// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/modes.hpp"

#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "end_of_search.hpp"
#include "files/file_beside.hpp"
#include "info_file.hpp"
#include "info_found.hpp"
#include "io/notes.hpp"
#include "io/path.hpp"
#include "io/relax.hpp"
#include "progress.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/plan.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/scene_modes.hpp"
#include "simulation/space.hpp"
#include "simulation/text.hpp"
#include "start_of_modes.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace cayspin::program {
namespace {

struct ModesCommand : DeviceOptions {
  double torque = 1e-6;
  ModesOptions search{.poll = [] { return interrupt_requested() ? Next::stop : Next::proceed; }};
  std::optional<std::string> frame;  // which state of a file is the start
  bool at_rest = false, hessian = false, quiet = false, json = false;
  std::vector<std::string> corners;  // wave vectors at the corners of a path
  int points = 50;                   // wave vectors from one corner to the next
};

using WaveVector = std::array<double, 3>;

WaveVector wave_vector(std::string const& text) {
  WaveVector wave{};
  char const *at = text.data(), *const end = at + text.size();
  bool is_right = true;
  for (std::size_t axis = 0; axis < 3 && is_right; ++axis) {
    if (axis > 0) is_right = at != end && *at++ == ',';
    auto const [stop, error] = std::from_chars(at, end, wave[axis]);
    is_right = is_right && error == std::errc() && std::isfinite(wave[axis]);
    at = stop;
  }
  if (!is_right || at != end)
    throw UsageError(fmt::format("--wave-vector {}: accepted: three numbers, as in 0.5,0,0", text));
  return wave;
}

std::vector<WaveVector> path_of(ModesCommand const& options) {
  std::vector<WaveVector> path;
  for (auto const& text : options.corners) {
    auto const corner = wave_vector(text);
    if (!path.empty()) {
      auto const from = path.back();
      for (int point = 1; point < options.points; ++point) {
        double const part = static_cast<double>(point) / options.points;
        auto& between = path.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
          between[axis] = from[axis] + part * (corner[axis] - from[axis]);
      }
    }
    path.push_back(corner);
  }
  return path;
}

template <class Real, class Space>
class ModesOfScene {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  ModesOfScene(io::Scene const& scene, Lattice const& lattice, ModesCommand const& options)
      : scene_(scene), options_(options), spins_("spins", lattice) {
    copy_from_host(start_spins(scene, options.scene), spins_);
  }

  int run(std::filesystem::path const& path) {
    auto const field = field_of<Spins>(scene_, spins_.lattice(), false).made_for(FieldFor::energy);
    auto at = equilibrium(field);
    if (at.end == MinimizeEnd::converged && io::has_torque(scene_.field))
      at = equilibrium_with_torques(at.evaluations);
    if (at.end == MinimizeEnd::interrupted) return interrupted();
    if (at.end != MinimizeEnd::converged)
      throw NumbersFailed(fmt::format("{}: no equilibrium was found: {}", scene_.path.string(),
                                      end_text(at.end, at.evaluations)));
    auto contents = header();
    contents.torque = at.torque * scene_.units.field;
    auto const numbers = copy_to_host(spins_);
    contents.spins.assign(numbers.begin(), numbers.end());
    contents.evaluations = at.evaluations;
    if (!options_.corners.empty()) return find_waves(path, field, contents);

    auto const modes = find_modes<Real, Space>(exec_, scene_, field, spins_, options_.search);
    if (modes.end == ModesEnd::interrupted) return interrupted();
    FoundCurvatures curvatures;
    curvatures.end = ModesEnd::converged;
    if (options_.hessian)
      curvatures = find_curvatures<Real, Space>(exec_, scene_, field, spins_, options_.search);
    if (!curvatures.values.empty())
      add_errors_of_torque<Real, Space>(exec_, scene_, field, spins_, options_.search.time,
                                        curvatures);
    if (curvatures.end == ModesEnd::interrupted) return interrupted();
    auto const end = modes.end == ModesEnd::converged ? curvatures.end : modes.end;

    contents.converged = end == ModesEnd::converged;
    contents.evaluations += modes.evaluations + curvatures.evaluations;
    contents.frequencies = modes.frequencies;
    contents.decays = modes.decays;
    contents.residuals = modes.errors;
    contents.shapes = modes.shapes;
    contents.curvatures = curvatures.values;
    contents.curvature_errors = curvatures.value_errors;
    contents.curvature_residuals = curvatures.errors;
    contents.curvature_vectors = curvatures.vectors;
    io::write_modes(path, contents, options_.overwrite);
    if (options_.json)
      print_json(as_json(read_info_file(path)));
    else if (!options_.quiet)
      report(contents, modes.growing);
    if (contents.converged) return Status::done;
    print_message("{}: the {} did not converge: {}\n", scene_.path.string(),
                  modes.end == ModesEnd::converged ? "curvatures" : "modes",
                  why_ended(to_string(end)));
    return Status::numbers_failed;
  }

 private:
  // Finds the equilibrium of the energy. With --at-rest, keeps the start. Then, if the scene has no
  // [torque], warns of a start whose torque is above --torque.
  Minimum equilibrium(SceneField<Spins> const& field) {
    SceneMinimizer<Real, Space> minimizer(spins_);
    MinimizeOptions minimize{.torque = options_.torque / scene_.units.field,
                             .evaluations = options_.search.evaluations,
                             .observer = [](Minimum const&) {
                               return interrupt_requested() ? Next::stop : Next::proceed;
                             }};
    if (options_.at_rest) {
      minimize.torque = std::numeric_limits<double>::max();
      minimize.keep_saddles = true;
    }
    auto const found = minimizer.relax(exec_, scene_, field, spins_, minimize);
    if (double const torque = found.torque * scene_.units.field;
        options_.at_rest && !io::has_torque(scene_.field) && torque > options_.torque)
      print_message(
          "warning: {}: max |m x H| is {:.3g}{}, above --torque {:.3g}: these are modes of a "
          "state that moves\n",
          scene_.path.string(), torque, scene_.units.si ? " T" : "", options_.torque);
    return found;
  }

  // Finds the equilibrium under [torque], starting at the result of equilibrium(). `evaluations`:
  // the number that equilibrium() took.
  Minimum equilibrium_with_torques(std::int64_t evaluations) {
    auto found =
        find_rest_with_torques<Real, Space>(exec_, scene_, spins_, options_.search,
                                            options_.torque / scene_.units.field, options_.at_rest);
    found.evaluations += evaluations;
    auto const* const tesla = scene_.units.si ? " T" : "";
    if (found.end == MinimizeEnd::stagnated)
      throw NumbersFailed(fmt::format(
          "{}: {}: max |m x H| is {:.3g}{}, with the torque's field in H; accepted: at most "
          "{:.3g}{}",
          scene_.path.string(),
          options_.at_rest ? "the start is not at rest" : "no equilibrium with [torque] was found",
          found.torque * scene_.units.field, tesla, options_.torque, tesla));
    return found;
  }

  int find_waves(std::filesystem::path const& path, SceneField<Spins> const& field,
                 io::ModesContents const& state) const {
    io::BandsContents contents{state, path_of(options_)};
    auto const found = find_bands<Real, Space>(exec_, scene_, field, spins_, contents.wave_vectors,
                                               options_.search.time, options_.search.poll);
    if (found.is_interrupted) return interrupted();
    contents.converged = true;
    contents.evaluations += found.evaluations;
    for (auto const& branches : found.frequencies)
      contents.frequencies.insert(contents.frequencies.end(), branches.begin(), branches.end());
    for (auto const& branches : found.decays)
      contents.decays.insert(contents.decays.end(), branches.begin(), branches.end());
    io::write_bands(path, contents, options_.overwrite);
    if (options_.json) print_json(as_json(read_info_file(path)));
    if (options_.json || options_.quiet) return Status::done;
    fmt::print("wave vector, in cycles per cell; frequencies{}\n", scene_.units.si ? ", GHz" : "");
    for (std::size_t i = 0; i < found.frequencies.size(); ++i) {
      auto const& k = contents.wave_vectors[i];
      fmt::print("{:>8.5g} {:>8.5g} {:>8.5g} ", k[0], k[1], k[2]);
      for (double const frequency : found.frequencies[i])
        fmt::print(" {:.9g}", (scene_.units.si ? 1e-9 : 1) * frequency);
      fmt::print("\n");
    }
    return Status::done;
  }

  int interrupted() const {
    print_message("{}: interrupted; no file was written\n", scene_.path.string());
    return Status::interrupted;
  }

  io::ModesContents header() const {
    io::ModesContents contents;
    contents.scene_text = scene_.text;
    contents.cayspin_version = CAYSPIN_VERSION_STRING;
    contents.git_commit = CAYSPIN_GIT_COMMIT;
    contents.space = chosen_space(options_.space);
    contents.precision = to_string(options_.precision);
    contents.shape = scene_.lattice.shape;
    contents.cell_sites = std::ssize(scene_.lattice.basis);
    contents.units = scene_.units;
    return contents;
  }

  // `growing_of_all`: the growing modes, also those that are not listed, if they are known.
  void report(io::ModesContents const& found, std::size_t growing_of_all) const {
    bool const si = scene_.units.si;
    double const giga = si ? 1e-9 : 1;
    fmt::print("max |m x H| = {:.3g}{}, {} evaluations\n", found.torque, si ? " T" : "",
               found.evaluations);
    fmt::print("{:>4}  {:>16}  {:>16}  {:>8}\n", "mode", si ? "frequency, GHz" : "frequency",
               si ? "decay, 1/ns" : "decay", "error");
    for (std::size_t i = 0; i < found.frequencies.size(); ++i)
      fmt::print("{:>4}  {:>16.9g}  {:>16.9g}  {:>8.1e}\n", i, giga * found.frequencies[i],
                 giga * found.decays[i], found.residuals[i]);
    double fastest = 0;
    for (std::size_t i = 0; i < found.decays.size(); ++i)
      fastest = std::max(fastest, std::hypot(found.frequencies[i], found.decays[i]));
    // Zero modes have decays of either sign, due to round-off.
    auto const growing = static_cast<std::size_t>(
        std::ranges::count_if(found.decays, [&](double decay) { return decay < -1e-7 * fastest; }));
    if (growing > 0)
      fmt::print("{} of these modes {}: the decay is negative\n", growing,
                 growing == 1 ? "grows" : "grow");
    if (growing_of_all > growing)
      fmt::print("growing in all: {}; a larger --count lists them\n",
                 counted(static_cast<std::int64_t>(growing_of_all), "mode"));
    if (!found.curvatures.empty()) fmt::print("{:>4}  curvature{}\n", "", si ? ", J" : "");
    for (std::size_t i = 0; i < found.curvatures.size(); ++i)
      fmt::print("{:>4}  {:.9g}\n", i, found.curvatures[i]);
    if (auto const text = saddle_text(found); !text.empty()) fmt::print("{}\n", text);
  }

  io::Scene const& scene_;
  ModesCommand const& options_;
  Space exec_;
  Spins spins_;
};

int find_modes_of_scene(ModesCommand options) {
  auto const start = start_of_modes(options.scene, options.overrides, options.frame);
  auto const& scene = start.scene;
  options.at_rest = options.at_rest || start.is_saddle;
  require_rest(without_torque(scene));
  if (io::has_torque(scene.field) && (options.hessian || !options.corners.empty()))
    throw io::scene_error(scene, "torque",
                          fmt::format("does not go with {0}; accepted: no such table, or no {0}",
                                      options.hessian ? "--hessian" : "--wave-vector"));
  auto const path = output_file(scene, options.output.value_or("modes.h5"));
  io::require_free(path, options.overwrite);
  check_files(scene, options.scene);
  constexpr double least = Minimizer<SpinField<double>>::least_bound;
  if (!(options.torque / scene.units.field >= least) || !std::isfinite(options.torque))
    throw UsageError(fmt::format("--torque {}; accepted: a number of at least {}", options.torque,
                                 least * scene.units.field));
  if (!(options.search.tolerance > 0 && options.search.tolerance < 1))
    throw UsageError(fmt::format("--tolerance {}; accepted: a number between 0 and 1",
                                 options.search.tolerance));
  if (!options.corners.empty()) require_bands(scene, path_of(options));
  io::require_writable(path, options.overwrite);
  auto const space = chosen_space(options.space);
  KokkosSession const kokkos(space, options.threads, options.device);
  auto plan = make_plan_of_modes(scene, options.precision, options.search, options.hessian);
  if (!options.corners.empty()) plan.memory.work += memory_of_bands(scene);
  require_memory(scene, plan);
  warn_of_notes(scene);
  catch_signals();
  return in_space(space, options.precision, [&]<class Real, class Space>() {
    return ModesOfScene<Real, Space>(scene, plan.lattice, options).run(path);
  });
}

}  // namespace

Command add_modes(CLI::App& program) {
  auto const options = std::make_shared<ModesCommand>();
  auto* const command = program.add_subcommand(
      "modes",
      "Find the normal modes of a scene's equilibrium, also under [torque]: frequencies, decays and "
      "shapes");
  add_device_options(*command, *options);
  command->get_option("SCENE")->description(
      "Scene file (TOML), a trajectory file (HDF5), whose last frame is the start, or the file of a "
      "path (HDF5) with --frame");
  command->get_option("--output")->description("The file to write (default: modes.h5)");
  auto* const count =
      command->add_option("--count", options->search.count, "Modes, the slowest first (default: 8)")
          ->check(CLI::Range(std::size_t{1}, ModesOptions::most));
  command->add_option("--torque", options->torque, "Largest |m x H| at rest (default: 1e-6)");
  auto* const tolerance = command->add_option("--tolerance", options->search.tolerance,
                                              "Error of the shapes (default: 1e-9)");
  command
      ->add_option("--evaluations", options->search.evaluations,
                   "Largest number of evaluations of the field in each search (default: 100000)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53U));
  command
      ->add_option("--frame", options->frame,
                   "The start: a frame of a trajectory file, or an image of a path; saddle: its "
                   "highest saddle, which is not relaxed")
      ->type_name("N|last|saddle");
  command->add_flag("--at-rest", options->at_rest, "The start is the equilibrium: do not relax");
  auto* const hessian =
      command->add_flag("--hessian", options->hessian,
                        "Also the lowest eigenvalues of the energy's Hessian, and their vectors");
  auto* const waves =
      command
          ->add_option("--wave-vector", options->corners,
                       "Waves in place of modes: a corner of a path of wave vectors, in cycles per "
                       "cell")
          ->allow_extra_args(false)
          ->type_name("KX,KY,KZ");
  for (auto* const of_modes : {count, tolerance, hessian}) waves->excludes(of_modes);
  command->add_option("--points", options->points, "From one corner to the next (default: 50)")
      ->check(CLI::Range(1, 100000))
      ->needs(waves);
  command->add_flag("--quiet", options->quiet, "No table");
  add_json_option(*command, options->json);
  return {command, [options](Ranks&) { return find_modes_of_scene(*options); }};
}

}  // namespace cayspin::program
