// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// OVF 1.0 as written by OOMMF and mumax3: binary values are big endian.
#include "ovf_test.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io::test {
namespace {

std::string old_header() {
  return R"(# OOMMF: rectangular mesh v1.0
# Segment count: 1
# Begin: Segment
# Begin: Header
# Desc: Time (s) : 1e-9
# Title: m
# meshtype: rectangular
# meshunit: m
# xbase: 2e-9
# ybase: 2.5e-9
# zbase: 1.5e-9
# xstepsize: 4e-9
# ystepsize: 5e-9
# zstepsize: 3e-9
# xmin: 0
# ymin: 0
# zmin: 0
# xmax: 8e-9
# ymax: 5e-9
# zmax: 3e-9
# xnodes: 2
# ynodes: 1
# znodes: 1
# ValueRangeMinMag: 1e-08
# ValueRangeMaxMag: 1
# valueunit: kA/m
# valuemultiplier: 1
# End: Header
)";
}

std::string old_file(std::string const& format, std::string const& values) {
  return old_header() + "# Begin: Data " + format + "\n" + values + "\n# End: Data " + format +
         "\n# End: Segment\n";
}

std::string old_text() { return old_file("Text", "1 0 0\n0 0.6 -8e-1"); }

/// Returns the bytes of numbers, the most significant byte first.
template <class Real>
std::string big_endian(std::vector<Real> const& numbers) {
  auto result = bytes(numbers);
  for (std::size_t at = 0; at < result.size(); at += sizeof(Real)) {
    auto const begin = result.begin() + static_cast<std::ptrdiff_t>(at);
    std::reverse(begin, begin + sizeof(Real));
  }
  return result;
}

std::vector<float> const four{1234567.0F, 1, 0, 0, 0, 0.6F, -0.8F};
std::vector<double> const eight{123456789012345.0, 1, 0, 0, 0, 0.6, -0.8};

TEST_F(OvfTest, Version1IsReadAsText) {
  auto const field = read_ovf(write(old_text()));
  EXPECT_EQ(field.title, "m");
  EXPECT_EQ(field.description, std::vector<std::string>{"Time (s) : 1e-9"});
  EXPECT_EQ(field.mesh.nodes, (std::array<std::int64_t, 3>{2, 1, 1}));
  EXPECT_EQ(field.mesh.step, (std::array<double, 3>{4e-9, 5e-9, 3e-9}));
  EXPECT_EQ(field.mesh.base, (std::array<double, 3>{2e-9, 2.5e-9, 1.5e-9}));
  EXPECT_EQ(field.mesh.unit, "m");
  EXPECT_EQ(field.value_unit, "kA/m");
  EXPECT_EQ(field.values, small_values());
}

TEST_F(OvfTest, Version1IsBigEndian) {
  EXPECT_EQ(big_endian(std::vector<float>{1234567.0F}), "\x49\x96\xb4\x38");
  EXPECT_EQ(big_endian(std::vector<double>{123456789012345.0}), "\x42\xdc\x12\x21\x83\x77\xde\x40");
  EXPECT_EQ(read_ovf(write(old_file("Binary 4", big_endian(four)))).values,
            std::vector<double>(four.begin() + 1, four.end()));
  EXPECT_EQ(read_ovf(write(old_file("Binary 8", big_endian(eight)))).values, small_values());
}

// The file has more values than the reader takes at a time.
TEST_F(OvfTest, LongFilesOfVersion1AreRead) {
  std::vector<double> values{123456789012345.0};
  for (int i = 0; i < 3 * 70001; ++i) values.push_back(1.0 / (1 + i));
  auto const back = read_ovf(
      write(replaced(old_file("Binary 8", big_endian(values)), "# xnodes: 2", "# xnodes: 70001")));
  EXPECT_EQ(back.values, std::vector<double>(values.begin() + 1, values.end()));
}

TEST_F(OvfTest, ValuesOfVersion1AreMultiplied) {
  std::vector<double> const expected{2, 0, 0, 0, 2 * 0.6, -1.6};
  for (auto const& content : {old_text(), old_file("Binary 8", big_endian(eight))})
    EXPECT_EQ(
        read_ovf(write(replaced(content, "# valuemultiplier: 1", "#Value Multiplier: 2"))).values,
        expected);
  EXPECT_EQ(read_ovf(write(replaced(old_text(), "# valuemultiplier: 1\n", ""))).values,
            small_values());
  // OVF 2.0 has no such label.
  EXPECT_EQ(read_ovf(write(replaced(small_text(), "# valuedim: 3",
                                    "# valuedim: 3\n# valuemultiplier: 2")))
                .values,
            small_values());
}

TEST_F(OvfTest, LabelsOfVersion1AreReadInAnyCase) {
  auto text =
      replaced(old_text(), "# OOMMF: rectangular mesh v1.0", "#oommf:Rectangular MESH V1.0");
  text = replaced(text, "# meshtype: rectangular", "# MeshType: Rectangular  ## of OOMMF");
  text = replaced(text, "# xnodes: 2", "#\tX Nodes :2\r");
  EXPECT_EQ(read_ovf(write(text)).values, small_values());
}

class OldOvfRefusal : public OvfTest {
 protected:
  void expect_refused(std::string const& content, std::string const& part) const {
    auto const path = write(content);
    try {
      read_ovf(path);
      ADD_FAILURE() << "accepted: " << part;
    } catch (std::runtime_error const& error) {
      std::string const message = error.what();
      EXPECT_TRUE(message.starts_with(path.string() + ": cannot read the OVF file: ")) << message;
      EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
};

TEST_F(OldOvfRefusal, IrregularMesh) {
  std::string const irregular = "its mesh is irregular; accepted: a rectangular mesh";
  for (std::string const version : {"v1.0", "v0.0"})
    expect_refused(replaced(old_text(), "rectangular mesh v1.0", "irregular mesh " + version),
                   irregular);
  expect_refused(replaced(old_text(), "meshtype: rectangular", "meshtype: irregular"),
                 "meshtype is \"irregular\"; accepted: rectangular");
}

TEST_F(OldOvfRefusal, WrongNumbers) {
  expect_refused(replaced(old_text(), "# znodes: 1\n", ""), "its header has no znodes");
  for (std::string const wrong : {"two", "inf", "nan", ""})
    expect_refused(replaced(old_text(), "valuemultiplier: 1", "valuemultiplier: " + wrong),
                   "valuemultiplier is \"" + wrong + "\"; accepted: a finite number");
  expect_refused(replaced(old_text(), "0.6", "O.6"), "value 4 is \"O.6 -8e-1\"");
}

TEST_F(OldOvfRefusal, LittleEndianValues) {
  expect_refused(old_file("Binary 4", bytes(four)), "accepted: 1234567, big endian");
  expect_refused(old_file("Binary 8", bytes(eight)), "accepted: 123456789012345, big endian");
}

TEST_F(OldOvfRefusal, TruncatedFiles) {
  std::string const truncated = "it is truncated: its header says 2 x 1 x 1 nodes of three values";
  expect_refused(replaced(old_text(), " -8e-1", ""), truncated);
  for (std::size_t const kept : {0U, 4U, 27U})
    expect_refused(old_header() + "# Begin: Data Binary 4\n" + big_endian(four).substr(0, kept),
                   truncated);
  for (std::size_t const kept : {0U, 8U, 55U})
    expect_refused(old_header() + "# Begin: Data Binary 8\n" + big_endian(eight).substr(0, kept),
                   truncated);
  auto longer = eight;
  longer.push_back(1);
  expect_refused(old_file("Binary 8", big_endian(longer)), "do not end with # End: Data Binary 8");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
