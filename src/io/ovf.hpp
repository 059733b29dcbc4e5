// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/words.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Vector fields in OVF 2.0, the file format of OOMMF and mumax3: three components on a rectangular
/// mesh. Every failure throws std::runtime_error whose message is one line that begins with the
/// file.
namespace cayspin::inline v0_1::io {

/// How an OVF file stores its values. `text` has as many digits as a double needs.
enum class OvfFormat { text, binary4, binary8 };

/// The formats, as options spell them.
template <>
std::span<Word<OvfFormat> const> words();

/// Nodes along x, y and z, each in the middle of a cell.
struct OvfMesh {
  std::array<std::int64_t, 3> nodes = {1, 1, 1};
  std::array<double, 3> step = {1, 1, 1};        ///< between neighbouring nodes, in `unit`
  std::array<double, 3> base = {0.5, 0.5, 0.5};  ///< position of node (0, 0, 0), in `unit`
  std::string unit = "1";                        ///< "1": reduced units
};

/// What an OVF file holds.
struct OvfField {
  std::string title = "m";
  std::vector<std::string> description;  ///< lines of free text: time, step, ...
  OvfMesh mesh;
  std::string value_unit = "1";
  std::vector<double> values;  ///< packed as (nz, ny, nx, 3)
};

/// True for the name of an OVF file (.ovf, .omf, .ohf, .oef) and for a file that begins as one.
bool is_ovf(std::filesystem::path const& path);

/// Reads the mesh alone.
OvfMesh read_ovf_mesh(std::filesystem::path const& path);

/// Reads a file of one segment, in any of the formats.
OvfField read_ovf(std::filesystem::path const& path);

/// Writes a file of one segment, as PATH.partial until it is whole. A file that exists is an error
/// unless `overwrite`. Throws std::invalid_argument unless there are three values a node and the
/// mesh is finite.
void write_ovf(std::filesystem::path const& path, OvfField const& field, OvfFormat format,
               bool overwrite);

}  // namespace cayspin::inline v0_1::io
