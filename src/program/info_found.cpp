// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_found.hpp"

#include "command.hpp"
#include "describe.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

namespace cayspin::program {
namespace {

constexpr std::size_t most_rows = 64;

void print_lattice(io::Units const& units, std::array<std::int64_t, 3> const& shape,
                   std::int64_t cell_sites, std::string const& precision) {
  fmt::print("{:<12} {}, {} precision\n", "lattice", sites_text(shape, cell_sites), precision);
  fmt::print("{:<12} {}\n", "units", describe_units(units));
}

void print_scene(std::string const& text) {
  fmt::print("scene:\n{}{}", text, text.ends_with('\n') ? "" : "\n");
}

void print_rest(std::size_t rows) {
  if (rows > most_rows) fmt::print("{:<12} {} more\n", "", rows - most_rows);
}

void print_saddles(io::Path const& path) {
  auto const& units = path.header.units;
  auto const text = [&](double energy) { return energy_text(units, energy / units.energy); };
  if (path.saddles.empty()) return;
  fmt::print("{:<12} {} forward, {} backward\n", "barriers", text(path.barrier_forward()),
             text(path.barrier_backward()));
  for (auto const& saddle : path.saddles)
    fmt::print("{:<12} image {}: energy {}, curvature {:.9g}{}\n", "saddle", saddle.image,
               text(saddle.energy), saddle.curvature, units.si ? " J" : "");
  if (!path.rates) return;
  auto const& rates = *path.rates;
  auto const forward = unit_of_prefactor(path, true), backward = unit_of_prefactor(path, false);
  fmt::print("{:<12} {:.8g}{} forward, {:.8g}{} backward; with damping {:.8g}{}, {:.8g}{}\n",
             "prefactors", rates.prefactor_forward, forward, rates.prefactor_backward, backward,
             rates.langer_forward, forward, rates.langer_backward, backward);
  fmt::print("{:<12} {}, {}, {}\n", "zero modes", rates.zero_modes[0], rates.zero_modes[1],
             rates.zero_modes[2]);
}

void print_spectrum(io::BandsContents const& found) {
  bool const si = found.units.si;
  fmt::print("{:>6}  {:>16}  {:>16}  {:>8}\n", "mode", si ? "frequency, GHz" : "frequency",
             si ? "decay, 1/ns" : "decay", "error");
  double const giga = si ? 1e-9 : 1;
  auto const count = found.frequencies.size();
  for (std::size_t i = 0; i < std::min(count, most_rows); ++i)
    fmt::print("{:>6}  {:>16.9g}  {:>16.9g}  {:>8.1e}\n", i, giga * found.frequencies[i],
               giga * found.decays[i], found.residuals[i]);
  print_rest(count);
  for (std::size_t i = 0; i < std::min(found.curvatures.size(), most_rows); ++i)
    fmt::print("{:<12} {:.9g}{}\n", i == 0 ? "curvatures" : "", found.curvatures[i],
               si ? " J" : "");
  if (auto const text = saddle_text(found); !text.empty()) fmt::print("{}\n", text);
}

void print_bands(io::BandsContents const& found) {
  auto const waves = found.wave_vectors.size();
  auto const branches = found.frequencies.size() / waves;
  double const giga = found.units.si ? 1e-9 : 1;
  fmt::print("{:<12} {}\n", "wave vectors", waves);
  for (std::size_t branch = 0; branch < branches; ++branch) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t wave = 0; wave < waves; ++wave) {
      least = std::min(least, found.frequencies[wave * branches + branch]);
      most = std::max(most, found.frequencies[wave * branches + branch]);
    }
    fmt::print("{:<12} frequencies {:.9g} to {:.9g}{}\n", fmt::format("band {}", branch),
               giga * least, giga * most, found.units.si ? " GHz" : "");
  }
}

}  // namespace

std::string saddle_text(io::ModesContents const& found) {
  auto const negative = io::negative_curvatures(found), all = found.curvatures.size();
  if (negative == 0) return {};
  if (negative < all)
    return fmt::format("the state is a saddle: {} of these curvatures {} negative", negative,
                       negative == 1 ? "is" : "are");
  return fmt::format(
      "the state is a saddle or a maximum: {} negative",
      all == 1 ? "this curvature is" : fmt::format("all {} of these curvatures are", all));
}

std::string unit_of_prefactor(io::Path const& path, bool forward) {
  if (!path.header.units.si) return {};
  auto const& [start, saddle, end] = path.rates->zero_modes;
  auto const more = (forward ? start : end) - saddle;
  return more == 0 ? " 1/s" : fmt::format(" 1/s K^{:g}", -0.5 * static_cast<double>(more));
}

void print_path(std::filesystem::path const& file, io::Path const& path) {
  auto const& header = path.header;
  fmt::print("{:<12} {}, a path of {} images\n", "file", file.string(), path.energy.size());
  fmt::print("{:<12} {}\n", "converged", path.converged ? "yes" : "no: " + path.end);
  fmt::print("{:<12} {}\n", "from", path.from);
  if (!path.to.empty()) fmt::print("{:<12} {}\n", "to", path.to);
  print_lattice(header.units, header.shape, header.cell_sites, header.precision);
  print_saddles(path);
  fmt::print("{:>6}  {:>12}  {:>20}\n", "image", "distance",
             header.units.si ? "energy, J" : "energy");
  for (std::size_t k = 0; k < std::min(path.energy.size(), most_rows); ++k)
    fmt::print("{:>6}  {:>12.6g}  {:>20.12g}\n", k, path.distance[k], path.energy[k]);
  print_rest(path.energy.size());
  fmt::print("{:<12} {}, {}\n", "cost", counted(path.evaluations, "evaluation"),
             duration_text(path.wall_seconds));
  fmt::print("{:<12} {}, {}\n", "space", header.space, counted(header.threads, "thread"));
  fmt::print("{:<12} {} ({})\n", "written by", header.cayspin_version, header.git_commit);
  print_scene(header.scene_text);
}

void print_modes(std::filesystem::path const& file, io::BandsContents const& found) {
  bool const has_waves = !found.wave_vectors.empty();
  fmt::print("{:<12} {}, {} of an equilibrium\n", "file", file.string(),
             has_waves ? "waves" : "modes");
  fmt::print("{:<12} {}\n", "converged", found.converged ? "yes" : "no");
  print_lattice(found.units, found.shape, found.cell_sites, found.precision);
  fmt::print("{:<12} max |m x H| = {:.3g}{}\n", "at rest", found.torque,
             found.units.si ? " T" : "");
  has_waves ? print_bands(found) : print_spectrum(found);
  fmt::print("{:<12} {}\n{:<12} {}\n", "cost", counted(found.evaluations, "evaluation"), "space",
             found.space);
  fmt::print("{:<12} cayspin {} ({})\n", "written by", found.cayspin_version, found.git_commit);
  print_scene(found.scene_text);
}

}  // namespace cayspin::program
