// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Invalid files are refused with one line that says what is wrong.
#include "ovf_test.hpp"

#include <sys/stat.h>

namespace cayspin::inline v0_2::io::test {
namespace {

class OvfRefusal : public OvfTest {
 protected:
  void expect_refused(std::string const& content, std::string const& part) const {
    expect_file_refused(write(content), part);
  }

  static void expect_file_refused(std::filesystem::path const& path, std::string const& part) {
    try {
      read_ovf(path);
      ADD_FAILURE() << "accepted: " << part;
    } catch (std::runtime_error const& error) {
      std::string const message = error.what();
      EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
      EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }

  std::string binary(std::string const& format, std::string const& values) const {
    return small_header() + "# Begin: Data " + format + "\n" + values + "\n# End: Data " + format +
           "\n# End: Segment\n";
  }
};

TEST_F(OvfRefusal, AnotherFormat) {
  expect_refused("", "it is not an OVF file");
  expect_refused(std::string(100, '\0'), "it is not an OVF file");
  for (std::string const other :
       {"rectangular mesh v0.99", "rectangular mesh v2.0", "rectangular mesh v10.0", "mesh"})
    expect_refused(replaced(small_text(), "# OOMMF OVF 2.0", "# OOMMF: " + other),
                   "its first line is \"# OOMMF: " + other + "\"");
  expect_refused(replaced(small_text(), "OVF 2.0", "OVF 3.0"), "its first line is \"# OOMMF OVF 3");
  expect_refused(std::string(100000, 'x'), "a line of its header does not end");
}

TEST_F(OvfRefusal, AnotherKindOfField) {
  auto const text = small_text();
  expect_refused(replaced(text, "rectangular", "irregular"),
                 "meshtype is \"irregular\"; accepted: rectangular");
  expect_refused(replaced(text, "valuedim: 3", "valuedim: 1"), "valuedim is \"1\"; accepted: 3");
  expect_refused(replaced(text, "valuedim: 3", "valuedim: three"), "accepted: a whole number >= 1");
  expect_refused(replaced(text, "count: 1", "count: 2"), "segmentcount is \"2\"; accepted: 1");
  expect_refused(replaced(text, "Begin: Data Text", "Begin: Data Binary 2"),
                 "accepted: Data Text, Data Binary 4, Data Binary 8");
}

TEST_F(OvfRefusal, HeaderWithoutItsNumbers) {
  auto const text = small_text();
  expect_refused(replaced(text, "# ynodes: 1\n", ""), "its header has no ynodes");
  expect_refused(replaced(text, "# meshtype: rectangular\n", ""), "its header has no meshtype");
  expect_refused(replaced(text, "# valuedim: 3\n", ""), "its header has no valuedim");
  for (std::string const wrong : {"0", "-2", "2.5", "two", "", "99999999999999999999"})
    expect_refused(replaced(text, "xnodes: 2", "xnodes: " + wrong),
                   "xnodes is \"" + wrong + "\"; accepted: a whole number >= 1");
  expect_refused(replaced(text, "xstepsize: 4", "xstepsize: inf"), "accepted: a finite number");
  expect_refused(replaced(text, "# End: Header", "End: Header"), "does not begin with #");
  expect_refused(small_header(), "it ends before # Begin: Data");
}

TEST_F(OvfRefusal, TruncatedText) {
  auto const text = small_text();
  std::string const truncated = "it is truncated: its header says 2 x 1 x 1 nodes";
  expect_refused(replaced(text, " -8e-1", ""), truncated);
  expect_refused(text.substr(0, text.find("# End: Data")), truncated);
  expect_refused(text.substr(0, text.find("0 0.6")), truncated);
  expect_refused(replaced(text, "xnodes: 2", "xnodes: 4611686018427387904"), "it is truncated");
}

TEST_F(OvfRefusal, TextThatIsNotThreeNumbersANode) {
  auto const text = small_text();
  expect_refused(replaced(text, "0.6", "O.6"), "value 4 is \"O.6 -8e-1\"; accepted: a number");
  expect_refused(replaced(text, "0.6", "0.6,"), "value 4 is \"0.6, -8e-1\"");
  expect_refused(replaced(text, "-8e-1", "-8e-1 1"), "more values than its 2 nodes");
}

// Some of these are infinities and NaN as C runtimes write them.
TEST_F(OvfRefusal, TextThatIsNoNumber) {
  for (std::string const wrong :
       {"1.#QNAN", "-1.#IND", "1.#INF", "-1.#INF00", "1.#SNAN", "1#0", "NA", "0x", "1,5", "--1"}) {
    SCOPED_TRACE(wrong);
    expect_refused(replaced(small_text(), "0.6", wrong),
                   "value 4 is \"" + wrong + " -8e-1\"; accepted: a number");
    expect_refused(replaced(small_text(), "-8e-1", wrong), "value 5 is \"" + wrong);
  }
}

TEST_F(OvfRefusal, SecondSegment) {
  auto const begin = small_text().find("# Begin: Segment");
  auto const segment = small_text().substr(begin);
  expect_refused(small_text() + segment,
                 "goes on with \"# Begin: Segment\" after its values; "
                 "accepted: one segment");
  expect_refused(replaced(small_text(), "# Segment count: 1\n", "") + segment, "one segment");
  expect_refused(small_text() + "# Begin: Data Text\n", "one segment");
  expect_refused(small_text() + "1 0 0\n", "goes on with \"1 0 0\" after its values");
  expect_refused(
      binary("Binary 4", bytes(std::vector<float>{1234567, 1, 0, 0, 0, 0.6F, -0.8F})) + segment,
      "one segment");
}

TEST_F(OvfRefusal, TwoValuesOfALabel) {
  auto const text = small_text();
  for (std::string const line : {"# xnodes: 3\n", "# meshtype: irregular\n", "# zstepsize: 4\n",
                                 "# Segment count: 2\n", "# valueunits: A/m A/m A/m\n"})
    expect_refused(replaced(text, "# End: Header\n", line + "# End: Header\n"),
                   "its header has several values of ");
}

TEST_F(OvfRefusal, TruncatedBinary) {
  std::vector<double> const whole{123456789012345.0, 1, 0, 0, 0, 0.6, -0.8};
  for (std::size_t const kept : {0U, 8U, 55U})
    expect_refused(small_header() + "# Begin: Data Binary 8\n" + bytes(whole).substr(0, kept),
                   "it is truncated");
  expect_refused(small_header() + "# Begin: Data Binary 8\n" + bytes(whole),
                 "do not end with # End: Data Binary 8");
  auto longer = whole;
  longer.push_back(1);
  expect_refused(binary("Binary 8", bytes(longer)), "do not end with # End: Data Binary 8");
}

TEST_F(OvfRefusal, WrongCheckValue) {
  auto const big_endian = std::string("\x49\x96\xb4\x38", 4) + bytes(std::vector<float>(6, 1));
  expect_refused(binary("Binary 4", big_endian), "accepted: 1234567, little endian");
  expect_refused(binary("Binary 8", bytes(std::vector<double>(7, 1))),
                 "its check value is 1; accepted: 123456789012345, little endian");
}

TEST_F(OvfRefusal, NoFile) {
  auto const pipe = folder_ / "pipe.ovf";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_file_refused(folder_ / "none.ovf", "No such file");
  expect_file_refused(folder_, "not a regular file");
  expect_file_refused(pipe, "not a regular file");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
