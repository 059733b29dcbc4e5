// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The values in --over, and the grid that they make.
#include "io/scene.hpp"
#include "io/sweep.hpp"

#include <gtest/gtest.h>

namespace cayspin::inline v0_2::io::test {
namespace {

using Values = std::vector<std::string>;

TEST(SweptKey, CommasInsideBracketsAndQuotesDoNotSeparate) {
  EXPECT_EQ(read_swept_key("a.b=0.1, -2e-3,+1").values, (Values{"0.1", "-2e-3", "+1"}));
  EXPECT_EQ(read_swept_key("a=[0,0,1],[0,[1, 2]]").values, (Values{"[0,0,1]", "[0,[1, 2]]"}));
  EXPECT_EQ(read_swept_key("a='x,y',\"é\\\",\" , 'µ'").values,
            (Values{"'x,y'", "\"é\\\",\"", "'µ'"}));
  EXPECT_EQ(read_swept_key("a={b=1,c=[2,3]},{}").values, (Values{"{b=1,c=[2,3]}", "{}"}));
  EXPECT_EQ(read_swept_key("a=true").values, (Values{"true"}));
  EXPECT_EQ(read_swept_key(" a . b = 1").key, "a.b");
}

TEST(SweptKey, WordsNeedNoQuotes) {
  EXPECT_EQ(read_swept_key("a=heun, rkmk4 ,'dp5'").values,
            (Values{"\"heun\"", "\"rkmk4\"", "'dp5'"}));
  EXPECT_EQ(read_swept_key("a=/tmp/x.h5,../y.h5,2nd.h5,2").values,
            (Values{"\"/tmp/x.h5\"", "\"../y.h5\"", "\"2nd.h5\"", "2"}));
  EXPECT_EQ(read_swept_key("a=true,inf,['x',\"y\"],{b=\"c\"}").values,
            (Values{"true", "inf", "['x',\"y\"]", "{b=\"c\"}"}));
  EXPECT_EQ(read_swept_key("a='x # y',2").values, (Values{"'x # y'", "2"}));
  EXPECT_TRUE(read_swept_key("a=heun,1").numbers.empty());
  EXPECT_THROW(read_swept_key("a=heun,heun"), SceneError);
}

TEST(SweptKey, NumbersAreKnownAsNumbers) {
  EXPECT_EQ(read_swept_key("a=0.1,1e-3,-4").numbers, (std::vector<double>{0.1, 1e-3, -4}));
  EXPECT_EQ(read_swept_key("a=9007199254740995,3").numbers,
            (std::vector<double>{9007199254740996, 3}));
  EXPECT_TRUE(read_swept_key("a=0.1,true").numbers.empty());
  EXPECT_TRUE(read_swept_key("a='0.1'").numbers.empty());
}

TEST(SweptKey, WhatIsNoListOfValuesIsRefused) {
  for (char const* text :
       {"a", "=1", "a=", "a=1,,2", "a=[1", "a=1]", "a=1\nb=2", "a=1,1", "a=x y", "a=1] # [",
        "a=1]\nvalue=[2", " =1", "a=1,2 # 3", "a=1, # 2, 3", "a=[1, # 2], [3]"})
    EXPECT_THROW(read_swept_key(text), SceneError) << text;
}

TEST(SweptGrid, TheLastKeyTurnsFastest) {
  SweepHeader header;
  header.keys = {read_swept_key("a=1,2"), read_swept_key("b='p','q','r'")};
  EXPECT_EQ(header.runs(), 6);
  EXPECT_EQ(header.overrides(0), (Values{"a=1", "b='p'"}));
  EXPECT_EQ(header.overrides(1), (Values{"a=1", "b='q'"}));
  EXPECT_EQ(header.overrides(5), (Values{"a=2", "b='r'"}));
  EXPECT_EQ(header.indices(4), (std::vector<std::size_t>{1, 1}));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
