// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_ensemble.hpp"

#include "describe.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace cayspin::program {

using namespace simulation;

namespace {

void print_range(std::string const& name, std::vector<double> const& values) {
  auto const [least, most] = std::ranges::minmax(values);
  fmt::print("{:<12} {:.9g} to {:.9g}\n", name, least, most);
}

void print_sublattices(io::EnsembleInfo const& info, std::size_t replica) {
  if (info.last_sublattices.empty()) return;
  auto const sites = static_cast<std::size_t>(info.header.cell_sites);
  for (std::size_t site = 0; site < sites; ++site) {
    auto const& mean = info.last_sublattices[replica * sites + site];
    fmt::print("{:<12} site {}: magnetization ({:.6f}, {:.6f}, {:.6f})\n", "", site, mean[0],
               mean[1], mean[2]);
  }
}

}  // namespace

void print_ensemble(std::filesystem::path const& file, io::EnsembleInfo const& info,
                    bool is_running) {
  auto const& header = info.header;
  auto const* const joule = header.units.si ? " J" : "";
  fmt::print("{:<12} {}, an ensemble of {}\n", "file", file.string(),
             counted(info.ensemble.replicas, "replica"));
  fmt::print("{:<12} {}\n", "complete",
             info.complete ? "yes"
             : is_running  ? "no: still running"
                           : "no");
  fmt::print("{:<12} {} in each replica, {} precision\n", "lattice",
             sites_text(header.shape, header.cell_sites), header.precision);
  fmt::print("{:<12} {}\n{:<12} {}\n", "frames", info.frames, "samples", info.samples);
  fmt::print("{:<12} {}\n", "units", describe_units(header.units));
  for (auto const& [key, values] : info.ensemble.vary) print_range("vary " + key, values);
  if (info.frames > 0) {
    constexpr std::size_t most_shown = 16;
    fmt::print("{:<12} step {}, t = {:.9g}{}\n", "last frame", info.step, info.time,
               header.units.si ? " s" : "");
    for (std::size_t r = 0; r < std::min(most_shown, info.last.size()); ++r) {
      auto const& [energy, defect, m] = info.last[r];
      fmt::print(
          "{:<12} energy {:.9g}{}, norm defect {:.3g}, magnetization ({:.6f}, {:.6f}, {:.6f})"
          "\n",
          fmt::format("replica {}", r), energy, joule, defect, m[0], m[1], m[2]);
      print_sublattices(info, r);
    }
    if (info.last.size() > most_shown)
      fmt::print("{:<12} {} in all\n", "replicas", info.last.size());
  }
  if (!info.relaxed.empty())
    fmt::print("{:<12} {} of {}\n", "converged",
               std::ranges::count(info.relaxed, true, &io::RelaxedReplica::converged),
               counted(info.ensemble.replicas, "replica"));
  if (info.cost.wall_seconds > 0)
    fmt::print("{:<12} {}, {} in all, {} stepping\n", "cost",
               counted(info.cost.evaluations, "evaluation"), duration_text(info.cost.wall_seconds),
               duration_text(info.cost.step_seconds));
  fmt::print("{:<12} {}, {}\n", "space", header.space, counted(header.threads, "thread"));
  fmt::print("{:<12} {} ({}), Kokkos {}\n", "written by", header.cayspin_version, header.git_commit,
             header.kokkos_version);
  fmt::print("scene:\n{}{}", header.scene_text, header.scene_text.ends_with('\n') ? "" : "\n");
}

}  // namespace cayspin::program
