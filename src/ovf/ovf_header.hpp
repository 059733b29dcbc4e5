// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ovf.hpp"

#include <istream>
#include <string>
#include <string_view>

namespace cayspin::inline v0_1::io {

/// The first datum of a binary block, by which readers know the byte order.
inline constexpr float check_value_4 = 1234567.0F;
inline constexpr double check_value_8 = 123456789012345.0;

/// "Text", "Binary 4", "Binary 8": as the lines around the values spell it.
std::string_view representation(OvfFormat format);

struct OvfHeader {
  OvfField field;  ///< without its values
  OvfFormat format;
};

/// A line of a header without its '#': "label: value". The label is in small letters without
/// blanks; the value ends at a comment.
struct OvfLine {
  std::string label, value;
};

/// Empty for a comment and for a line without a label.
OvfLine split_line(std::string_view line);

/// Lower case, blanks removed.
std::string squeezed(std::string_view text);

/// Reads up to the line `# Begin: Data ...`, after which the values begin.
OvfHeader read_header(std::istream& stream, std::filesystem::path const& path);

/// Throws std::runtime_error("PATH: cannot read the OVF file: REASON").
[[noreturn]] void refuse_ovf(std::filesystem::path const& path, std::string const& reason);

}  // namespace cayspin::inline v0_1::io
