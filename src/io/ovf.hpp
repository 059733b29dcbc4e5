// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/words.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Fields in OVF, the file format of OOMMF and mumax3: three components, or one, on a rectangular
/// mesh. Versions 1.0 and 2.0 are read, and 2.0 is written. Failures to read or write throw
/// std::runtime_error, with one line that starts with the path.
namespace cayspin::inline v0_2::io {

/// Storage format of an OVF file's values. `text` has as many digits as a double needs.
enum class OvfFormat { text, binary4, binary8 };

/// The formats by their option names.
template <>
std::span<Word<OvfFormat> const> words();

/// Nodes along x, y and z, each in the middle of a cell.
struct OvfMesh {
  std::array<std::int64_t, 3> nodes = {1, 1, 1};
  std::array<double, 3> step = {1, 1, 1};        ///< between adjacent nodes, in `unit`
  std::array<double, 3> base = {0.5, 0.5, 0.5};  ///< position of node (0, 0, 0), in `unit`
  std::string unit = "1";                        ///< "1": reduced units
};

/// Contents of an OVF file.
struct OvfField {
  std::string title = "m";
  std::vector<std::string> description;  ///< lines of free text: time, step, ...
  OvfMesh mesh;
  std::string value_unit = "1";
  std::vector<double> values;  ///< packed as (nz, ny, nx, components)
};

/// Returns true for the name of an OVF file (.ovf, .omf, .ohf, .oef) and for a file that starts
/// like one.
bool is_ovf(std::filesystem::path const& path);

/// Returns the number of values per node.
std::int64_t ovf_components(std::filesystem::path const& path);

/// Reads only the mesh. Throws unless the file has this number of components, 3 or 1.
OvfMesh read_ovf_mesh(std::filesystem::path const& path, std::int64_t components = 3);

/// Reads a file of one segment, in any of the formats. Throws unless it has this number of
/// components, 3 or 1.
OvfField read_ovf(std::filesystem::path const& path, std::int64_t components = 3);

/// Writes three components per node as a file of one segment. The file is called PATH.partial until
/// it is complete. An existing file is an error unless `overwrite`. Throws std::invalid_argument
/// unless there are three values per node and the mesh is finite.
void write_ovf(std::filesystem::path const& path, OvfField const& field, OvfFormat format,
               bool overwrite);

}  // namespace cayspin::inline v0_2::io
