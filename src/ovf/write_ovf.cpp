// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "files/file_beside.hpp"
#include "ovf_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ostream>
#include <stdexcept>

namespace cayspin::inline v0_2::io {
namespace {

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

void write_header(std::ostream& stream, OvfField const& field) {
  auto const& nodes = field.mesh.nodes;
  auto const& step = field.mesh.step;
  auto const& base = field.mesh.base;
  auto const line = [&](std::string_view label, auto const& value) {
    stream << fmt::format("# {}: {}\n", label, value);
  };
  auto const per_axis = [&](std::string_view label, auto const& value) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      line(fmt::format("{}{}", "xyz"[axis], label), value(axis));
  };
  auto const least = [&](std::size_t axis) { return base[axis] - step[axis] / 2; };
  stream << "# OOMMF OVF 2.0\n# Segment count: 1\n# Begin: Segment\n# Begin: Header\n";
  line("Title", one_line(field.title));
  for (auto const& text : field.description) line("Desc", one_line(text));
  line("meshtype", "rectangular");
  line("meshunit", one_line(field.mesh.unit));
  per_axis("min", least);
  per_axis("max", [&](std::size_t axis) {
    return least(axis) + static_cast<double>(nodes[axis]) * step[axis];
  });
  per_axis("base", [&](std::size_t axis) { return base[axis]; });
  per_axis("nodes", [&](std::size_t axis) { return nodes[axis]; });
  per_axis("stepsize", [&](std::size_t axis) { return step[axis]; });
  line("valuedim", 3);
  line("valuelabels", "m_x m_y m_z");
  line("valueunits", fmt::format("{0} {0} {0}", one_line(field.value_unit)));
  stream << "# End: Header\n";
}

void require_valid(std::filesystem::path const& path, OvfField const& field) {
  auto const& mesh = field.mesh;
  auto rest = field.values.size() / 3;
  bool whole = field.values.size() % 3 == 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const nodes = static_cast<std::size_t>(std::max<std::int64_t>(mesh.nodes[axis], 0));
    whole = whole && nodes > 0 && rest % nodes == 0;
    if (whole) rest /= nodes;
    if (!std::isfinite(mesh.step[axis]) || !std::isfinite(mesh.base[axis]))
      throw std::invalid_argument(
          fmt::format("{}: a step or base of the mesh is not finite", path.string()));
  }
  if (!whole || rest != 1)
    throw std::invalid_argument(fmt::format("{}: {} values for {} x {} x {} nodes of three",
                                            path.string(), field.values.size(), mesh.nodes[0],
                                            mesh.nodes[1], mesh.nodes[2]));
}

template <class Real>
void write_binary(std::ostream& stream, std::vector<double> const& values, Real check) {
  std::vector<Real> block{check};
  auto const write = [&] {
    stream.write(reinterpret_cast<char const*>(block.data()),
                 static_cast<std::streamsize>(block.size() * sizeof(Real)));
    block.clear();
  };
  for (auto const value : values) {
    block.push_back(static_cast<Real>(value));
    if (block.size() == 65536) write();
  }
  write();
  stream << '\n';
}

// Writes the fewest digits that restore the double.
void write_text(std::ostream& stream, std::vector<double> const& values) {
  fmt::memory_buffer lines;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    fmt::format_to(std::back_inserter(lines), "{} {} {}\n", values[i], values[i + 1],
                   values[i + 2]);
    if (lines.size() < 65536) continue;
    stream.write(lines.data(), static_cast<std::streamsize>(lines.size()));
    lines.clear();
  }
  stream.write(lines.data(), static_cast<std::streamsize>(lines.size()));
}

}  // namespace

void write_ovf(std::filesystem::path const& path, OvfField const& field, OvfFormat format,
               bool overwrite) {
  require_valid(path, field);
  FileBeside file(path, overwrite);
  auto& stream = file.stream();
  write_header(stream, field);
  stream << fmt::format("# Begin: Data {}\n", representation(format));
  if (format == OvfFormat::text)
    write_text(stream, field.values);
  else if (format == OvfFormat::binary4)
    write_binary(stream, field.values, check_value_4);
  else
    write_binary(stream, field.values, check_value_8);
  stream << fmt::format("# End: Data {}\n# End: Segment\n", representation(format));
  file.commit();
}

}  // namespace cayspin::inline v0_2::io
