// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "../support/wrong_call.hpp"
#include "ovf_test.hpp"

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <iostream>
#include <limits>

namespace cayspin::inline v0_2::io::test {
namespace {

namespace fs = std::filesystem;

/// Returns a field whose nodes, spacings and origins differ from axis to axis, and whose numbers
/// need all digits.
OvfField asymmetric_field() {
  OvfField field;
  field.title = "m of a test";
  field.description = {"Total simulation time: 0.1", "step 7"};
  field.mesh = {{4, 3, 2}, {0.1, 0.2, 0.7}, {0.05, 0.1, 0.35}, "1"};
  for (int i = 0; i < 72; ++i) field.values.push_back(std::sin(1.0 / (1 + i)));
  return field;
}

TEST_F(OvfTest, WhatIsWrittenIsReadBack) {
  auto const field = asymmetric_field();
  for (auto const& [name, format] : words<OvfFormat>()) {
    auto const path = folder_ / (std::string(name) + ".ovf");
    write_ovf(path, field, format, false);
    auto const back = read_ovf(path);
    EXPECT_EQ(back.title, field.title);
    EXPECT_EQ(back.description, field.description);
    EXPECT_EQ(back.mesh.nodes, field.mesh.nodes);
    EXPECT_EQ(back.mesh.step, field.mesh.step);
    EXPECT_EQ(back.mesh.base, field.mesh.base);
    ASSERT_EQ(back.values.size(), field.values.size());
    for (std::size_t i = 0; i < back.values.size(); ++i)
      EXPECT_EQ(back.values[i], format == OvfFormat::binary4
                                    ? static_cast<double>(static_cast<float>(field.values[i]))
                                    : field.values[i])
          << name;
  }
}

// The file has more values than the writer and the reader take at a time.
TEST_F(OvfTest, LongFilesAreReadBack) {
  OvfField field;
  field.mesh.nodes = {70001, 1, 1};
  for (int i = 0; i < 3 * 70001; ++i) field.values.push_back(1.0 / (1 + i));
  for (auto const& [name, format] : words<OvfFormat>()) {
    write_ovf(folder_ / "long.ovf", field, format, true);
    auto expected = field.values;
    if (format == OvfFormat::binary4)
      for (double& value : expected) value = static_cast<double>(static_cast<float>(value));
    EXPECT_EQ(read_ovf(folder_ / "long.ovf").values, expected) << name;
  }
}

TEST_F(OvfTest, HeaderIsThatOfTheUserGuide) {
  auto const path = folder_ / "m.ovf";
  OvfField field;
  field.title = "a title\nin two lines";
  field.mesh = {{2, 1, 1}, {4, 5, 3}, {2, 2.5, 1.5}, "nm"};
  field.values = small_values();
  write_ovf(path, field, OvfFormat::text, false);
  EXPECT_EQ(read_bytes(path), R"(# OOMMF OVF 2.0
# Segment count: 1
# Begin: Segment
# Begin: Header
# Title: a title in two lines
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
# Begin: Data Text
1 0 0
0 0.6 -0.8
# End: Data Text
# End: Segment
)");
}

TEST_F(OvfTest, FilesAreReplacedOnlyWhenAsked) {
  auto const path = write("kept");
  auto const field = asymmetric_field();
  EXPECT_THROW(write_ovf(path, field, OvfFormat::text, false), std::runtime_error);
  EXPECT_EQ(read_bytes(path), "kept");
  write_ovf(path, field, OvfFormat::text, true);
  EXPECT_EQ(read_ovf(path).values, field.values);
  EXPECT_THROW(write_ovf(folder_ / "none" / "m.ovf", field, OvfFormat::text, false),
               std::runtime_error);
}

TEST_F(OvfTest, ValuesHaveToBeThoseOfTheMesh) {
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  std::vector<cayspin::test::WrongCall> calls;
  auto const add = [&](std::string const& what, auto const& change) {
    auto wrong = asymmetric_field();
    change(wrong);
    calls.push_back(
        {what, [this, wrong] { write_ovf(folder_ / "m.ovf", wrong, OvfFormat::text, false); }});
  };
  add("a value less", [](auto& wrong) { wrong.values.pop_back(); });
  add("a value more", [](auto& wrong) { wrong.values.push_back(1); });
  add("no values", [](auto& wrong) { wrong.values.clear(); });
  for (auto const& nodes : {std::array<std::int64_t, 3>{4, 3, 1},
                            {4, 3, 4},
                            {4, 3, 0},
                            {-4, -3, 2},
                            {most, most, 24},
                            {1L << 32, 1L << 32, 24}})
    add("nodes", [&](auto& wrong) { wrong.mesh.nodes = nodes; });
  add("no nodes and no values", [](auto& wrong) {
    wrong.values.clear();
    wrong.mesh.nodes = {0, 1, 1};
  });
  for (double const number : {std::nan(""), HUGE_VAL}) {
    add("step", [&](auto& wrong) { wrong.mesh.step[1] = number; });
    add("base", [&](auto& wrong) { wrong.mesh.base[2] = number; });
  }
  cayspin::test::expect_refused(calls);
  EXPECT_TRUE(fs::is_empty(folder_));
}

// A line break would end the header line, and the rest would be read as another header entry.
TEST_F(OvfTest, LineBreaksInUnitsAreBlanks) {
  auto field = asymmetric_field();
  field.mesh.unit = "nm\n# xnodes: 1";
  field.value_unit = "A/m\n# ynodes: 1";
  write_ovf(folder_ / "m.ovf", field, OvfFormat::binary8, false);
  auto const back = read_ovf(folder_ / "m.ovf");
  EXPECT_EQ(back.mesh.unit, "nm # xnodes: 1");
  EXPECT_EQ(back.mesh.nodes, field.mesh.nodes);
  EXPECT_EQ(back.values, field.values);
}

[[noreturn]] void write_on_full_disk(fs::path const& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit const limit{10000, 10000};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  OvfField field;
  field.mesh.nodes = {1000, 1, 1};
  field.values.resize(3000, 0.5);
  try {
    write_ovf(path, field, OvfFormat::binary8, true);
    std::exit(0);
  } catch (std::runtime_error const& error) {
    std::cerr << error.what() << std::flush;
    std::exit(3);
  }
}

TEST_F(OvfTest, FullDiskKeepsTheOldFile) {
  if (std::getenv("CAYSPIN_COVERAGE"))
    GTEST_SKIP() << "the counts of executed lines do not fit on this disk, either";
  auto const path = write("kept");
  EXPECT_EXIT(write_on_full_disk(path), testing::ExitedWithCode(3),
              "m.ovf: cannot write the file: File too large$");
  EXPECT_EQ(read_bytes(path), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
