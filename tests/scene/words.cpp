// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <cayspin/io/words.hpp>

#include <gtest/gtest.h>

namespace cayspin::io {
namespace {

template <class Value>
class Words : public testing::Test {};
using Kinds = testing::Types<SystemKind, BoundaryKind, Method, Generator, Isotropy, Rotation>;
TYPED_TEST_SUITE(Words, Kinds);

TYPED_TEST(Words, NamesAndValuesBelongTogether) {
  for (auto const& word : words<TypeParam>()) {
    ASSERT_NE(find_word<TypeParam>(word.name), nullptr);
    EXPECT_EQ(find_word<TypeParam>(word.name)->value, word.value);
    EXPECT_EQ(to_string(word.value), word.name);
  }
  EXPECT_EQ(find_word<TypeParam>("no such word"), nullptr);
}

TEST(Methods, HaveTheirTraits) {
  int baselines = 0;
  int classical = 0;
  for (auto const& word : words<Method>()) {
    EXPECT_EQ(is_classical(word.value), word.name.starts_with("classical_")) << word.name;
    bool const outside = word.name.starts_with("classical_") || word.name.starts_with("projected_");
    EXPECT_EQ(is_baseline(word.value), outside) << word.name;
    baselines += is_baseline(word.value) ? 1 : 0;
    classical += is_classical(word.value) ? 1 : 0;
  }
  EXPECT_EQ(baselines, 9);
  EXPECT_EQ(classical, 3);
  EXPECT_EQ(words<Method>().size(), 29U);
}

}  // namespace
}  // namespace cayspin::io
