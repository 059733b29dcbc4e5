// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/path.hpp"

#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "file_as_start.hpp"
#include "info_file.hpp"
#include "info_found.hpp"
#include "io/notes.hpp"
#include "io/relax.hpp"
#include "progress.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/scene_path.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {
namespace {

constexpr std::int64_t default_modes = 4;

struct PathCommandOptions : DeviceOptions {
  std::filesystem::path from;
  std::optional<std::filesystem::path> to;  // empty if only one state is known
  ScenePathOptions search;
  bool quiet = false, json = false;
};

/// The option that names the file of one end of the path.
struct EndOption {
  char const* name;
  std::filesystem::path const& file;
};

/// Calls work() and returns its result. If the option's file is at fault, throws UsageError with
/// the option and the file as it was typed.
template <class Work>
auto for_option(EndOption const& option, Work const& work) {
  try {
    return work();
  } catch (io::SceneError const& error) {
    auto const fault = fault_of_start(error, option.file);
    if (!fault) throw;
    throw UsageError(fmt::format("{} {}: {}", option.name, option.file.string(), *fault));
  }
}

/// Returns the scene with one end of the path as its start.
io::Scene scene_from(PathCommandOptions const& options, EndOption const& option) {
  auto overrides = options.overrides;
  overrides.push_back(as_start(option.file));
  auto const scene = io::read_scene_to_relax(options.scene, overrides);
  return for_option(option, [&] { return io::with_shape_of_start(scene); });
}

std::vector<double> spins_of(io::Scene const& scene, EndOption const& option) {
  return for_option(option, [&] {
    io::check_files(scene);
    return io::initial_spins(scene);
  });
}

// `from` and `to`: spins of lattices of the same shape. A site without a spin has a zero vector.
void require_same_vacancies(PathCommandOptions const& options, std::vector<double> const& from,
                            std::vector<double> const& to) {
  auto const is_vacant = [](std::vector<double> const& spins, std::size_t at) {
    return spins[at] == 0 && spins[at + 1] == 0 && spins[at + 2] == 0;
  };
  for (std::size_t at = 0; at < from.size(); at += 3)
    if (is_vacant(from, at) != is_vacant(to, at))
      throw UsageError(fmt::format(
          "--to {}: has {} spin on site {} (counted from 0, x fastest), where --from {} "
          "has {}; accepted: spins on the same sites",
          options.to->string(), is_vacant(to, at) ? "no" : "a", at / 3, options.from.string(),
          is_vacant(from, at) ? "none" : "one"));
}

/// Returns the spins of the file that --to names.
std::vector<double> other_end(PathCommandOptions const& options, io::Scene const& scene,
                              std::filesystem::path const& output,
                              std::vector<double> const& from) {
  EndOption const last{"--to", *options.to};
  auto const other = scene_from(options, last);
  output_file(other, output);  // this file must not be replaced either
  auto const cells_of = [](io::Lattice const& lattice) {
    return cells_text(lattice.shape, std::ssize(lattice.basis));
  };
  if (scene.lattice.shape != other.lattice.shape)
    throw UsageError(
        fmt::format("--to {}: its lattice is {}, that of --from {} is {}; accepted: the same shape",
                    options.to->string(), cells_of(other.lattice), options.from.string(),
                    cells_of(scene.lattice)));
  auto to = spins_of(other, last);
  require_same_vacancies(options, from, to);
  return to;
}

std::string barrier_text(io::Scene const& scene, io::Path const& path) {
  auto const text = [&](double energy) {
    return energy_text(scene.units, energy / scene.units.energy);
  };
  auto line = fmt::format("barriers {} forward, {} backward; saddle energy {}, curvature {:.8g}{}",
                          text(path.barrier_forward()), text(path.barrier_backward()),
                          text(path.saddles.front().energy), path.saddles.front().curvature,
                          scene.units.si ? " J" : "");
  if (path.saddles.size() > 1) line += fmt::format("; {} saddles", path.saddles.size());
  if (auto const& rates = path.rates) {
    auto const forward = unit_of_prefactor(path, true), backward = unit_of_prefactor(path, false);
    line += fmt::format(
        "\nprefactors {:.8g}{} forward, {:.8g}{} backward; zero modes {}, {}, {}"
        "\nwith damping {:.8g}{} forward, {:.8g}{} backward",
        rates->prefactor_forward, forward, rates->prefactor_backward, backward,
        rates->zero_modes[0], rates->zero_modes[1], rates->zero_modes[2], rates->langer_forward,
        forward, rates->langer_backward, backward);
  }
  return line;
}

int find_path(PathCommandOptions const& options) {
  EndOption const first{"--from", options.from};
  auto const scene = scene_from(options, first);
  auto search = options.search;
  bool const has_end = options.to.has_value();
  if (has_end && search.modes)
    throw UsageError("--modes: --to names the other end; accepted: one of them");
  if (!has_end && !search.modes) search.modes = default_modes;
  try {
    require_path(scene, search);
  } catch (UsageError const& error) {
    throw UsageError(std::string("--") + error.what());
  }
  auto output_name = options.output;
  if (!output_name && !scene.output.file) output_name = "path.h5";
  auto const output = output_file(scene, output_name);
  auto const from = spins_of(scene, first);
  auto const to = has_end ? other_end(options, scene, output, from) : std::vector<double>();
  io::require_writable(output, options.overwrite);
  auto const space = chosen_space(options.space);
  KokkosSession const kokkos(space, options.threads, options.device);
  require_memory(scene, make_plan_of_path(scene, options.precision, search));
  warn_of_notes(scene);
  catch_signals();
  search.observer = [](PathProgress const&) {
    return interrupt_requested() ? Next::stop : Next::proceed;
  };
  auto [end, path, rates_failed, needs_images] =
      find_scene_path(scene, from, to, space, options.precision, search, CAYSPIN_GIT_COMMIT);
  path.from = options.from.string();
  if (has_end) path.to = options.to->string();
  // An interrupt may also come after the path was found, during the computation of rates, which
  // takes long.
  if (end == PathEnd::interrupted || interrupt_requested()) {
    print_message("{}: interrupted; nothing is written\n", scene.path.string());
    return Status::interrupted;
  }
  bool const has_path = !path.energy.empty() && end != PathEnd::same_ends;
  bool const has_saddles = end == PathEnd::unsettled && !path.saddles.empty();
  if (has_path) io::write_path(output, path, options.overwrite);
  if (options.json && has_path)
    print_json(as_json(read_info_file(output)));
  else if (!options.quiet && !options.json && (end == PathEnd::converged || has_saddles))
    fmt::print("{} after {}, {}\n{}\n", path.end, counted(path.evaluations, "evaluation"),
               counted(std::ssize(path.energy), "image"), barrier_text(scene, path));
  if (end == PathEnd::converged && rates_failed.empty()) return Status::done;
  if (end == PathEnd::converged)
    print_message("{}: {} has the path, but no {}\n", scene.path.string(), output.string(),
                  rates_failed);
  else if (needs_images)
    print_message(
        "{}: the path needs more images: between neighbouring ones, it misses a saddle; {} has the "
        "images as they are; accepted: a larger --images\n",
        scene.path.string(), output.string());
  else if (has_saddles)
    print_message(
        "{}: the saddles are found, but the path between them does not settle within {}; {} has "
        "the saddles and the path as it is; accepted: more --images\n",
        scene.path.string(), counted(path.evaluations, "evaluation"), output.string());
  else
    print_message(
        "{}: no {}path: {}, after {}{}\n", scene.path.string(), has_path ? "converged " : "",
        path.end, counted(path.evaluations, "evaluation"),
        has_path ? fmt::format("; {} has the images as they are", output.string()) : std::string());
  return Status::numbers_failed;
}

}  // namespace

Command add_path(CLI::App& program) {
  auto const options = std::make_shared<PathCommandOptions>();
  auto* const command = program.add_subcommand(
      "path", "Find the minimum-energy path between two states, and its barrier (HDF5)");
  add_device_options(*command, *options);
  command->get_option("--output")
      ->description("The file to write; wins over output.file (default: path.h5)");
  command->add_option("--from", options->from, "The state where it begins: HDF5 or OVF")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "--to", options->to,
          "The state where it ends; without it, the path over the lowest saddle to which a "
          "mode of --from leads")
      ->type_name("FILE");
  command->add_option("--modes", options->search.modes,
                      "Without --to: modes of lowest curvature to climb along (default: 4)");
  command->add_option("--images", options->search.images,
                      "States of the path, both ends among them (default: 16)");
  command->add_option("--torque", options->search.torque,
                      "Largest |m x H| of the ends and the saddle (default: 1e-6)");
  command
      ->add_option("--evaluations", options->search.evaluations,
                   "Largest number of evaluations of the field (default: 1000000)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53U));
  command->add_flag(
      "--rates", options->search.rates,
      "Also the prefactors of harmonic transition state theory and of Langer's theory, for small "
      "lattices");
  command->add_flag("--quiet", options->quiet, "No report");
  add_json_option(*command, options->json);
  return {command, [options](Ranks&) { return find_path(*options); }};
}

}  // namespace cayspin::program
