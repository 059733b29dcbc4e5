// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "paragraph.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

std::string printed(std::string const& text) {
  ::testing::internal::CaptureStdout();
  cayspin::paper::print_paragraph(text);
  return ::testing::internal::GetCapturedStdout();
}

// Lines have an indent of two columns and at most 116 more; a longer word gets a line of its own.
TEST(Paragraph, BreaksAtSpaces) {
  EXPECT_EQ(printed("a b"), "\n  a b\n");
  std::string const word(117, 'w'), line(116, 'x');
  EXPECT_EQ(printed(word), "\n  " + word + "\n");
  EXPECT_EQ(printed(word + " a " + word + " b"), "\n  " + word + "\n  a\n  " + word + "\n  b\n");
  EXPECT_EQ(printed(line + " a"), "\n  " + line + "\n  a\n");
  EXPECT_EQ(printed(line + word + " a b"), "\n  " + line + word + "\n  a b\n");
}

}  // namespace
