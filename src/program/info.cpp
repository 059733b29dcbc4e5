// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "describe.hpp"
#include "info_ensemble.hpp"
#include "info_file.hpp"
#include "info_found.hpp"
#include "info_progress.hpp"
#include "simulation/failure.hpp"
#include "simulation/text.hpp"
#include "sweep/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <variant>

namespace cayspin::program {
namespace {

// `si`: true if the file's numbers are in SI. `is_state`: true if the sample is an equilibrium,
// whose step and time are its number.
void print_sample(char const* name, io::Sample const& sample, bool si, bool is_state) {
  auto const& [step, time, scalars] = sample;
  auto const& m = scalars.magnetization;
  auto const when = is_state ? fmt::format("state {}", step)
                             : fmt::format("step {}, t = {:.9g}{}", step, time, si ? " s" : "");
  fmt::print(
      "{:<12} {}: energy {:.9g}{}, norm defect {:.3g}, "
      "magnetization ({:.6f}, {:.6f}, {:.6f})\n",
      name, when, scalars.energy, si ? " J" : "", scalars.norm_defect, m[0], m[1], m[2]);
}

void print_frame(char const* name, io::TrajectoryInfo const& info, std::size_t frame) {
  print_sample(name, {info.frame_steps[frame], info.frame_times[frame], info.frame_scalars[frame]},
               info.header.units.si, info.cost.relaxed.has_value());
  auto const sites = static_cast<std::size_t>(info.header.cell_sites);
  if (sites == 1) return;
  for (std::size_t site = 0; site < sites; ++site) {
    auto const& mean = info.frame_sublattices[frame * sites + site];
    fmt::print("{:<12} site {}: magnetization ({:.6f}, {:.6f}, {:.6f})\n", "", site, mean[0],
               mean[1], mean[2]);
  }
}

// Prints the optional values of the last sample: those of regions, the energies of terms, and the
// shift.
void print_more(io::TrajectoryInfo const& info) {
  constexpr std::int64_t most_regions = 16;
  auto const& more = info.header.more;
  auto const* const joule = info.header.units.si ? " J" : "";
  auto const* means = info.more_of_last_sample.data();
  if (info.more_of_last_sample.empty()) return;
  auto const* energy = means + 3 * more.regions;
  auto const shown = std::min(most_regions, more.regions);
  for (std::int64_t region = 0; region < shown; ++region, means += 3)
    fmt::print("{:<12} energy {:.9g}{}, magnetization ({:.6f}, {:.6f}, {:.6f})\n",
               fmt::format("region {}", region), energy[region], joule, means[0], means[1],
               means[2]);
  if (shown < more.regions) fmt::print("{:<12} {} in all\n", "regions", more.regions);
  energy += more.regions;
  for (auto const& term : more.terms)
    fmt::print("{:<12} energy {:.9g}{}\n", term, *energy++, joule);
  if (more.shift) fmt::print("{:<12} {} {}\n", "shift", *energy, *energy == 1 ? "cell" : "cells");
}

void print_scene(char const* name, std::string const& text) {
  fmt::print("{}:\n{}{}", name, text, text.ends_with('\n') ? "" : "\n");
}

void print_sweep(std::filesystem::path const& file, io::SweepInfo const& sweep) {
  auto const& header = sweep.header;
  fmt::print("{:<12} {}, a sweep of {}\n", "file", file.string(),
             counted(std::ssize(sweep.runs), "run"));
  fmt::print("{:<12} {}\n", "complete",
             sweep.complete ? "yes" : "no: the same command continues it");
  fmt::print("{:<12} {}\n{:<12} {}\n", "precision", header.precision, "space", header.space);
  fmt::print("{:<12} cayspin {} ({})\n", "written by", header.cayspin_version, header.git_commit);
  sweep::print_table(sweep);
  print_scene("scene of run 0000", header.scene_text);
}

void print_trajectory(io::TrajectoryInfo const& info, std::optional<bool> being_written) {
  auto const& header = info.header;
  fmt::print("{:<12} {} (format {})\n", "file", info.path.string(), info.format);
  if (info.complete) fmt::print("{:<12} yes\n", "complete");
  if (!info.complete)
    for (auto const& [name, text] : progress_lines(info, being_written))
      fmt::print("{:<12} {}\n", name, text);
  fmt::print("{:<12} {}, {} precision\n", "lattice", sites_text(header.shape, header.cell_sites),
             header.precision);
  fmt::print("{:<12} {}\n{:<12} {}\n", "frames", info.frames, "samples", info.samples);
  if (!info.frame_stages.empty())
    fmt::print("{:<12} {} at the last frame\n", "stage", info.frame_stages.back());
  fmt::print("{:<12} {}\n", "units", describe_units(header.units));
  if (info.frames > 0) print_frame("first frame", info, 0);
  if (info.frames > 1) print_frame("last frame", info, static_cast<std::size_t>(info.frames) - 1);
  auto const& sample = info.last_sample;
  if (sample && (info.frames == 0 || sample->step > info.frame_steps.back()))
    print_sample("last sample", *sample, header.units.si, info.cost.relaxed.has_value());
  print_more(info);
  bool const has_ended = info.complete || info.cost.wall_seconds > 0;
  if (has_ended && info.cost.relaxed)
    fmt::print("{:<12} {}, max |m x H| = {:.3g}{}\n", "at rest",
               info.cost.relaxed->converged ? "yes" : "no", info.cost.relaxed->torque,
               header.units.si ? " T" : "");
  if (has_ended)
    fmt::print("{:<12} {}, {} in all, {} stepping\n", "cost",
               counted(info.cost.evaluations, "evaluation"), duration_text(info.cost.wall_seconds),
               duration_text(info.cost.step_seconds));
  fmt::print("{:<12} {}, {}\n", "space", header.space, counted(header.threads, "thread"));
  fmt::print("{:<12} cayspin {} ({}), Kokkos {}\n", "written by", header.cayspin_version,
             header.git_commit, header.kokkos_version);
  print_scene("scene", header.scene_text);
  if (!header.resolved_scene.empty()) print_scene("scene as resolved", header.resolved_scene);
}

void print_text(InfoFile const& file) {
  struct Printer {
    InfoFile const& file;

    void operator()(io::TrajectoryInfo const& info) const {
      print_trajectory(info, file.being_written);
    }
    void operator()(io::SweepInfo const& sweep) const { print_sweep(file.path, sweep); }
    void operator()(io::EnsembleInfo const& info) const {
      print_ensemble(file.path, info, file.being_written == true);
    }
    void operator()(io::Path const& path) const { print_path(file.path, path); }
    void operator()(io::BandsContents const& found) const { print_modes(file.path, found); }
  };
  std::visit(Printer{file}, file.contents);
}

struct InfoOptions {
  std::filesystem::path file;
  bool json = false;
};

int print_info(InfoOptions const& options) {
  auto const file = read_info_file(options.file);
  options.json ? print_json(as_json(file)) : print_text(file);
  return Status::done;
}

}  // namespace

Command add_info(CLI::App& program) {
  auto const options = std::make_shared<InfoOptions>();
  auto* const command = program.add_subcommand(
      "info",
      "Summarise a file of cayspin: a trajectory, also while a run writes it, an ensemble, a sweep, "
      "a path or modes");
  command->add_option("FILE", options->file, "The file (HDF5)")->required();
  add_json_option(*command, options->json);
  return {command, [options](Ranks&) { return print_info(*options); }};
}

}  // namespace cayspin::program
