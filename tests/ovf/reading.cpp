// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Files in the format of OOMMF and mumax3, assembled byte by byte.
#include "ovf_test.hpp"

#include <cmath>

namespace cayspin::inline v0_2::io::test {
namespace {

TEST_F(OvfTest, TextOfTheUserGuideIsRead) {
  auto const field = read_ovf(write(small_text()));
  EXPECT_EQ(field.title, "two spins");
  EXPECT_EQ(field.description, std::vector<std::string>{"made by hand"});
  EXPECT_EQ(field.mesh.nodes, (std::array<std::int64_t, 3>{2, 1, 1}));
  EXPECT_EQ(field.mesh.step, (std::array<double, 3>{4, 5, 3}));
  EXPECT_EQ(field.mesh.base, (std::array<double, 3>{2, 2.5, 1.5}));
  EXPECT_EQ(field.mesh.unit, "nm");
  EXPECT_EQ(field.value_unit, "1");
  EXPECT_EQ(field.values, small_values());
}

TEST_F(OvfTest, BinaryBlocksAreLittleEndianAfterTheirCheckValue) {
  std::vector<float> const four{1234567.0F, 1, 0, 0, 0, 0.6F, -0.8F};
  EXPECT_EQ(bytes(std::vector<float>{1234567.0F}), "\x38\xb4\x96\x49");
  auto const single = read_ovf(write(small_header() + "# Begin: Data Binary 4\n" + bytes(four) +
                                     "\n# End: Data Binary 4\n# End: Segment\n"));
  EXPECT_EQ(single.values, std::vector<double>(four.begin() + 1, four.end()));

  std::vector<double> eight{123456789012345.0};
  for (double const value : small_values()) eight.push_back(value);
  EXPECT_EQ(bytes(std::vector<double>{eight[0]}), "\x40\xde\x77\x83\x21\x12\xdc\x42");
  auto const twice = read_ovf(write(small_header() + "# Begin: Data Binary 8\n" + bytes(eight) +
                                    "\n# End: Data Binary 8\n# End: Segment\n"));
  EXPECT_EQ(twice.values, small_values());
}

TEST_F(OvfTest, LabelsAreReadInAnyCaseWithBlanksAndComments) {
  auto text = small_text();
  text = replaced(text, "# xnodes: 2", "#\tX Nodes :2  ## along x\r\n##\n#\n\n# a remark");
  text = replaced(text, "# Segment count: 1", "# segment Count: 000001");
  text = replaced(text, "# Begin: Data Text", "# begin: data TEXT\r");
  text = replaced(text, "# End: Data Text", "# a remark\n# END: Data  text");
  text = replaced(text, "0 0.6 -8e-1", "  0\t+0.6 # half way\n -.8  \r");
  auto const field = read_ovf(write(text));
  EXPECT_EQ(field.mesh.nodes[0], 2);
  EXPECT_EQ(field.values, small_values());
}

TEST_F(OvfTest, SitesFollowWithXFastest) {
  auto text = replaced(replaced(small_text(), "# ynodes: 1", "# ynodes: 2"), "1 0 0\n0 0.6 -8e-1\n",
                       "1 2 3 4 5 6\n7 8 9 10 11 12\n");
  EXPECT_EQ(read_ovf(write(text)).values,
            (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST_F(OvfTest, OneComponentIsReadWhereItIsAskedFor) {
  auto const one = replaced(replaced(small_text(), "valuedim: 3", "valuedim: 1"),
                            "1 0 0\n0 0.6 -8e-1\n", "0.25\n7\n");
  EXPECT_EQ(read_ovf(write(one), 1).values, (std::vector<double>{0.25, 7}));
  EXPECT_EQ(ovf_components(write(one)), 1);
  EXPECT_EQ(ovf_components(write(small_text())), 3);
  EXPECT_THROW(read_ovf(write(one)), std::runtime_error);
  EXPECT_THROW(read_ovf(write(small_text()), 1), std::runtime_error);
  EXPECT_THROW(read_ovf_mesh(write(small_text()), 1), std::runtime_error);
  try {
    read_ovf(write(replaced(one, "7\n", "")), 1);
    ADD_FAILURE();
  } catch (std::runtime_error const& error) {
    EXPECT_NE(std::string(error.what()).find("2 x 1 x 1 nodes of one value"), std::string::npos);
  }
}

TEST_F(OvfTest, NumbersBeyondADoubleAreKeptAsFarAsTheyGo) {
  auto const text = replaced(small_text(), "1 0 0", "1e-400 nan 5e-324");
  auto const values = read_ovf(write(text)).values;
  EXPECT_EQ(values[0], 0);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], 5e-324);
}

TEST_F(OvfTest, CommentsMayFollowANumberAndTheSegment) {
  auto text = replaced(small_text(), "1 0 0\n", "1 0 0## the first\n");
  text = replaced(text, "0.6 -8e-1", "0.6 -8e-1 # 1.#QNAN");
  text =
      replaced(text, "# End: Segment\n", "# End: Segment\n\n# a remark\n##\n \t\r\n# end: segment");
  EXPECT_EQ(read_ovf(write(text)).values, small_values());
  EXPECT_EQ(read_ovf(write(replaced(text, "# End: Segment", "#"))).values, small_values());
}

// Descriptions, and labels that are not read, may be repeated; other labels may be repeated with
// equal values.
TEST_F(OvfTest, OtherLabelsMayBeRepeated) {
  auto const text = replaced(small_text(), "# Desc: made by hand\n",
                             "# Desc: made\n# Desc: by hand\n# Note: 1\n# Note: 2\n# xnodes: 2\n");
  EXPECT_EQ(read_ovf(write(text)).values, small_values());
}

TEST_F(OvfTest, FilesAreKnownByNameOrBegin) {
  EXPECT_TRUE(is_ovf("nowhere.OVF"));
  EXPECT_TRUE(is_ovf("nowhere.omf"));
  EXPECT_FALSE(is_ovf("nowhere.h5"));
  EXPECT_TRUE(is_ovf(write(small_text(), "state")));
  EXPECT_FALSE(is_ovf(write("# remark", "remark")));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
