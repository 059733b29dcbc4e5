// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "terminal_picture.hpp"

#include "bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>

namespace cayspin::program {
namespace {

using Color = std::array<int, 3>;

std::string_view environment(char const* name) {
  char const* const value = std::getenv(name);
  return value ? value : "";
}

bool has_all_colors() {
  auto const said = environment("COLORTERM");
  return said == "truecolor" || said == "24bit";
}

// Returns the escape sequence for a colour. `ground`: 38 for the foreground, 48 for the background.
std::string escape(int ground, Color const& color) {
  if (has_all_colors())
    return fmt::format("\x1b[{};2;{};{};{}m", ground, color[0], color[1], color[2]);
  auto const level = [](int part) { return (part * 5 + 127) / 255; };
  return fmt::format("\x1b[{};5;{}m", ground,
                     16 + 36 * level(color[0]) + 6 * level(color[1]) + level(color[2]));
}

// Returns the colour of a spin: its hue is given by the angle in the plane, its lightness by the
// normal component. `spin`: the components to the right, upwards and along the normal.
Color color_of(std::array<double, 3> const& spin) {
  double const length = std::hypot(spin[0], spin[1], spin[2]);
  if (!(length > 0)) return {255, 255, 255};
  double const normal = spin[2] / length, saturation = 1 - std::abs(normal);
  double const sixths = std::atan2(spin[1], spin[0]) * 3 / std::numbers::pi;
  Color color{};
  for (int channel = 0; channel < 3; ++channel) {
    double const around = std::fmod(sixths - 2 * channel + 9, 6.0);
    double const share = std::clamp(2 - std::abs(around - 3), 0.0, 1.0);
    double const value = 0.5 + 0.4 * normal + saturation * (share - 0.5);
    color[static_cast<std::size_t>(channel)] =
        static_cast<int>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  }
  return color;
}

// The plane of cells in the picture.
class Plane {
 public:
  Plane(io::Lattice const& lattice, std::vector<double> const& spins) : spins_(spins) {
    sites_ = static_cast<std::int64_t>(lattice.basis.size());
    cells_ = lattice.shape;
    cells_[2] /= sites_;
    // The normal is the axis with the fewest cells. If several have equally few, it is z rather
    // than y, and y rather than x.
    axes_ = {0, 1, 2};
    for (std::size_t axis : {1, 0})
      if (cells_[axis] < cells_[axes_[2]]) axes_ = {axis == 0 ? 1U : 0U, 2, axis};
    for (std::size_t i = 0; i < 2; ++i)
      lengths_[i] = static_cast<double>(cells_[axes_[i]]) * lattice.spacing[axes_[i]];
    if (cells_[axes_[0]] == 1) {  // a chain along z or y
      std::swap(axes_[0], axes_[1]);
      std::swap(lengths_[0], lengths_[1]);
    }
  }

  bool is_chain() const { return cells_[axes_[1]] == 1; }
  double height_over_width() const { return lengths_[1] / lengths_[0]; }
  std::int64_t cells(std::size_t across) const { return cells_[axes_[across]]; }
  char axis(std::size_t which) const { return "xyz"[axes_[which]]; }

  /// Returns the colour at a point, given as fractions of the plane's width and height.
  Color color(double right, double up) const {
    std::array<std::int64_t, 3> at{};
    at[axes_[0]] = cell(right, 0);
    at[axes_[1]] = cell(up, 1);
    at[axes_[2]] = cells_[axes_[2]] / 2;
    auto const site =
        static_cast<std::size_t>((at[2] * sites_ * cells_[1] + at[1]) * cells_[0] + at[0]);
    return color_of(
        {spins_[3 * site + axes_[0]], spins_[3 * site + axes_[1]], spins_[3 * site + axes_[2]]});
  }

 private:
  std::int64_t cell(double share, std::size_t across) const {
    auto const count = cells(across);
    return std::min(count - 1, static_cast<std::int64_t>(share * static_cast<double>(count)));
  }

  std::vector<double> const& spins_;
  std::int64_t sites_;
  std::array<std::int64_t, 3> cells_;
  std::array<std::size_t, 3> axes_;  // right, up, normal
  std::array<double, 2> lengths_;
};

std::string key(Plane const& plane) {
  std::string text = fmt::format("{:<11} ", "");
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int const sign : {1, -1}) {
      std::array<double, 3> spin{};
      spin[axis] = sign;
      text += fmt::format("{}██\x1b[0m {}{}  ", escape(38, color_of(spin)), sign > 0 ? '+' : '-',
                          plane.axis(axis));
    }
  return text + "\n";
}

}  // namespace

bool terminal_shows_pictures() {
  auto const terminal = environment("TERM");
  return is_terminal(stdout) && has_blocks() && environment("NO_COLOR").empty() &&
         (has_all_colors() || terminal.find("256color") != std::string_view::npos);
}

// Draws half blocks: each character shows two points of a column, the upper one as foreground, the
// lower one as background.
std::string terminal_picture(io::Lattice const& lattice, std::vector<double> const& spins) {
  constexpr std::int64_t least = 32, most = 64;
  Plane const plane(lattice, spins);
  auto const columns = std::clamp(plane.cells(0), least, most);
  auto const wanted = static_cast<double>(columns) * plane.height_over_width();
  std::int64_t const rows =
      plane.is_chain() ? 1 : std::lround(std::clamp(wanted / 2, 1.0, most / 2.0));
  std::string text;
  for (auto row = rows - 1; row >= 0; --row) {
    text += fmt::format("{:<11} ", row == rows - 1 ? "picture" : "");
    for (std::int64_t column = 0; column < columns; ++column) {
      double const right = (static_cast<double>(column) + 0.5) / static_cast<double>(columns);
      auto const up = [&](double half) {
        return (static_cast<double>(row) + half) / static_cast<double>(rows);
      };
      text +=
          escape(38, plane.color(right, up(0.75))) + escape(48, plane.color(right, up(0.25))) + "▀";
    }
    text += "\x1b[0m\n";
  }
  return text + key(plane);
}

}  // namespace cayspin::program
