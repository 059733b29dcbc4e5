// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/file_bytes.hpp"
#include "io/ovf.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io::test {

using cayspin::test::read_bytes;
using cayspin::test::write_bytes;

/// A separate folder for each test, removed afterwards.
class OvfTest : public testing::Test {
 protected:
  OvfTest() {
    auto pattern = (std::filesystem::path(testing::TempDir()) / "cayspin_ovf_XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("cannot create " + pattern);
    folder_ = pattern;
  }
  ~OvfTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(std::string const& content, std::string const& name = "m.ovf") const {
    write_bytes(folder_ / name, content);
    return folder_ / name;
  }

  std::filesystem::path folder_;
};

/// Returns the bytes of numbers as stored in memory.
template <class Real>
std::string bytes(std::vector<Real> const& numbers) {
  std::string result(numbers.size() * sizeof(Real), '\0');
  std::memcpy(result.data(), numbers.data(), result.size());
  return result;
}

/// Returns `text` with the first occurrence of `from` replaced; it must have one.
inline std::string replaced(std::string text, std::string const& from, std::string const& to) {
  auto const at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("not in the file: " + from);
  return text.replace(at, from.size(), to);
}

/// Returns a header for two nodes, in the format of the OOMMF user guide.
inline std::string small_header() {
  return R"(# OOMMF OVF 2.0
# Segment count: 1
# Begin: Segment
# Begin: Header
# Title: two spins
# Desc: made by hand
# meshtype: rectangular
# meshunit: nm
# xmin: 0
# ymin: 0
# zmin: 0
# xmax: 8
# ymax: 5
# zmax: 3
# xbase: 2
# ybase: 2.5
# zbase: 1.5
# xnodes: 2
# ynodes: 1
# znodes: 1
# xstepsize: 4
# ystepsize: 5
# zstepsize: 3
# valuedim: 3
# valuelabels: m_x m_y m_z
# valueunits: 1 1 1
# End: Header
)";
}

inline std::string small_text() {
  return small_header() + R"(# Begin: Data Text
1 0 0
0 0.6 -8e-1
# End: Data Text
# End: Segment
)";
}

inline std::vector<double> small_values() { return {1, 0, 0, 0, 0.6, -0.8}; }

}  // namespace cayspin::inline v0_2::io::test
