// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ovf.hpp"

#include <istream>
#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// The first value of a binary block, by which readers know the byte order: big endian in OVF 1.0,
/// little endian in OVF 2.0.
inline constexpr float check_value_4 = 1234567.0F;
inline constexpr double check_value_8 = 123456789012345.0;

/// Returns "Text", "Binary 4" or "Binary 8", as in the lines around the values.
std::string_view representation(OvfFormat format);

struct OvfHeader {
  OvfField field;  ///< without its values
  OvfFormat format = OvfFormat::text;
  int version = 2;
  std::int64_t components = 3;
  double multiplier = 1;  ///< multiplies the values of OVF 1.0
};

/// A header line "# label: value". The label is in lower case without blanks; the value ends at a
/// comment.
struct OvfLine {
  std::string label, value;
};

/// Splits a header line. Returns empty strings for a comment and for a line without a label.
OvfLine split_line(std::string_view line);

/// Returns the text in lower case without blanks.
std::string squeezed(std::string_view text);

/// Reads up to the line `# Begin: Data ...`, after which the values start.
OvfHeader read_header(std::istream& stream, std::filesystem::path const& path);

/// Throws std::runtime_error("PATH: cannot read the OVF file: REASON").
[[noreturn]] void refuse_ovf(std::filesystem::path const& path, std::string const& reason);

}  // namespace cayspin::inline v0_2::io
