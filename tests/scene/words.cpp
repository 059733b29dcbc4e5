// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/words.hpp"

#include "io/method.hpp"

#include <gtest/gtest.h>

#include <set>

namespace cayspin::inline v0_2::io {
namespace {

template <class Value>
class Words : public testing::Test {};
using Kinds = testing::Types<SystemKind, BoundaryKind, Generator, Isotropy, Rotation>;
TYPED_TEST_SUITE(Words, Kinds);

TYPED_TEST(Words, NamesAndValuesBelongTogether) {
  for (auto const& word : words<TypeParam>()) {
    ASSERT_NE(find_word<TypeParam>(word.name), nullptr);
    EXPECT_EQ(find_word<TypeParam>(word.name)->value, word.value);
    EXPECT_EQ(to_string(word.value), word.name);
  }
  EXPECT_EQ(find_word<TypeParam>("no such word"), nullptr);
}

TEST(Methods, HaveWordsOfTheirOwn) {
  std::set<std::string_view> words;
  for (auto const* const method : methods()) {
    words.insert(method->word);
    EXPECT_EQ(find_method(method->word), method);
  }
  EXPECT_EQ(words.size(), methods().size());
  EXPECT_EQ(find_method("no such word"), nullptr);
}

TEST(Methods, HaveTheTraitsThatTheirWordsSay) {
  for (auto const* const method : methods()) {
    bool const classical = method->word.starts_with("classical_");
    EXPECT_EQ(method->keeps_length, !classical) << method->word;
    EXPECT_EQ(method->is_baseline(), classical || method->word.starts_with("projected_"))
        << method->word;
    EXPECT_EQ(method->automatic, method->word == "auto");
    EXPECT_EQ(method->order > 0, !method->automatic) << method->word;
  }
}

// Finds contradictory rows in the table of methods: every scene with such a method would be
// refused.
TEST(Methods, AreConsistent) {
  for (auto const* const method : methods()) {
    auto const& word = method->word;
    bool const on_group = !method->rotations.empty();
    EXPECT_EQ(method->takes(Generator::standard), on_group) << word;
    EXPECT_EQ(method->takes(Isotropy::zero, SystemKind::llg), on_group) << word;
    if (method->takes(Generator::tangent)) {
      EXPECT_TRUE(method->takes(Rotation::cayley)) << word;
    }
    if (method->trials.contains(Trial::in_chart)) {
      EXPECT_TRUE(method->takes(Generator::tangent)) << word;
    }
    if (method->trials.contains(Trial::sigma)) {
      EXPECT_TRUE(method->takes(Isotropy::constant, SystemKind::llg)) << word;
    }
    if (method->trials.contains(Trial::compensated_single_precision)) {
      EXPECT_TRUE(method->compensated) << word;
    }
    if (!method->has_equal_steps()) {
      EXPECT_FALSE(method->evaluations) << word;
    }
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
