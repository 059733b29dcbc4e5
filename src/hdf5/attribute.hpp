// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "handle.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Returns the HDF5 datatype of variable-length UTF-8 strings.
DatatypeHandle text_type();

/// Writes an attribute that is a list of names. They are strings of fixed length, because HDF5's
/// checksums do not cover strings of variable length.
void write_names(hid_t object, char const* name, std::vector<std::string> const& names,
                 std::filesystem::path const& path);
std::vector<std::string> read_names(hid_t object, char const* name,
                                    std::filesystem::path const& path);

/// Attributes of a file's root group, or of another object.
class RootAttributes {
 public:
  RootAttributes(hid_t file, std::filesystem::path const& path) : file_(file), path_(path) {}

  void create(char const* name, std::string const& value) const;
  void create(char const* name, std::int64_t value) const;
  void create(char const* name, double value) const;

  /// Overwrites the value of a numeric attribute in place, without allocating space on the disk.
  void replace(char const* name, std::int64_t value) const;
  void replace(char const* name, double value) const;

  bool has(char const* name) const;
  std::string read_text(char const* name) const;
  /// Returns true if the text of an attribute is `yes`, and false if it is `no`. Throws for any
  /// other text.
  bool read_word(char const* name, char const* yes, char const* no) const;
  std::int64_t read_integer(char const* name) const;
  double read_real(char const* name) const;
  /// Throws std::runtime_error("PATH: ACTION: REASON") unless the attribute `name`, which holds the
  /// version of the file layout, has the value `accepted`.
  void require_version(char const* name, std::int64_t accepted, char const* action) const;

 private:
  AttributeHandle open(char const* name) const;
  void create(char const* name, hid_t stored, hid_t given, void const* value) const;
  void replace(char const* name, hid_t given, void const* value) const;
  void read(char const* name, hid_t wanted, void* value) const;

  hid_t file_;
  std::filesystem::path const& path_;
};

}  // namespace cayspin::inline v0_2::io
