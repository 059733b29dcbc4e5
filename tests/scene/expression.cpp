// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/expression.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2::io {
namespace {

double value(char const* text, double x = 0, double y = 0) {
  std::array<double, 2> const at = {x, y};
  return Expression(text, {"x", "y"})(at.data());
}

TEST(Expression, FollowsTheUsualRules) {
  constexpr double x = 0.375;
  constexpr double y = -1.5;
  EXPECT_EQ(value("1 + 2*3"), 7);
  EXPECT_EQ(value("-x^2", x), -x * x);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("x - y - 1", x, y), x - y - 1);
  EXPECT_EQ(value("x/y/2", x, y), x / y / 2);
  EXPECT_EQ(value("1e-3*x", x), 1e-3 * x);
  EXPECT_EQ(value("pi"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(value("0.3+0.2*cos(pi*x)", x), 0.3 + 0.2 * std::cos(std::numbers::pi * x));
  EXPECT_DOUBLE_EQ(value("exp(y)*sqrt(abs(y))", x, y), std::exp(y) * std::sqrt(-y));
  EXPECT_EQ(value("x < 0.5 ? 1 : -1", x), 1);
  EXPECT_EQ(value("x < 0.5 ? 1 : -1", 0.5), -1);
  EXPECT_EQ(value("(x >= y) + (x != y) + (x == x) + (y <= x)", x, y), 4);
}

TEST(Expression, FractionsOtherThanZeroAreTrue) {
  for (double const x : {0.0, 0.25, -0.5, 1.0, 2.5})
    for (double const y : {0.0, 0.25, -0.5, 1.0}) {
      auto const numbers = "(" + std::to_string(x) + ") && (" + std::to_string(y) + ")";
      EXPECT_EQ(value("x && y", x, y), x != 0 && y != 0) << numbers;
      EXPECT_EQ(value("x || y", x, y), x != 0 || y != 0) << numbers;
      EXPECT_EQ(value(numbers.c_str()), x != 0 && y != 0) << numbers;
      EXPECT_EQ(value(("0 || " + numbers + " || 0").c_str()), x != 0 && y != 0) << numbers;
      EXPECT_EQ(value(("!(" + numbers + ")").c_str()), x == 0 || y == 0) << numbers;
    }
  EXPECT_EQ(value("0.5 || 0"), 1);
  EXPECT_EQ(value("0 && 0 || 0.5"), 1);
  EXPECT_EQ(value("0.5 || 0 && 0"), 1);
  EXPECT_EQ(value("x > 0.5 && !y || 0.5 ? 3 : 4"), 3);
  EXPECT_EQ(value("x > 0.5&&!y ? 3 : 4", 1, 0), 3);
}

TEST(Expression, RintRoundsHalvesUp) {
  EXPECT_EQ(value("rint(x)", 2.5), 3);
  EXPECT_EQ(value("rint(x)", -1.5), -1);
  EXPECT_EQ(value("rint(x)", -1.75), -2);
}

TEST(Expression, SincIsOneAtZero) {
  EXPECT_EQ(value("sinc(x)", 0), 1);
  EXPECT_EQ(value("sinc(x)", -0.375), std::sin(0.375) / 0.375);
  EXPECT_NEAR(value("sinc(pi)"), 0, 1e-16);
}

TEST(Expression, TakesNewValuesInEveryCall) {
  Expression const product("x*y", {"x", "y"});
  for (int n = 1; n <= 4; ++n) {
    std::array<double, 2> const at = {static_cast<double>(n), 10};
    EXPECT_EQ(product(at.data()), 10 * n);
  }
}

TEST(Expression, CopiesAreIndependent) {
  double const one = 1;
  double const two = 2;
  Expression const first("3*t", {"t"});
  Expression second = first;
  EXPECT_EQ(first(&one), 3);
  EXPECT_EQ(second(&two), 6);
  second = Expression("t+1", {"t"});
  EXPECT_EQ(second(&one), 2);
  EXPECT_EQ(first(&two), 6);
  EXPECT_EQ(second.text(), "t+1");
}

TEST(Expression, KnowsItsVariables) {
  Expression const expression("x + 1", {"x", "y"});
  EXPECT_TRUE(expression.depends_on("x"));
  EXPECT_FALSE(expression.depends_on("y"));
  double const at[] = {2, 0};
  EXPECT_EQ(expression(at), 3);
}

class WrongExpression : public testing::TestWithParam<char const*> {};

TEST_P(WrongExpression, IsRefusedInOneLine) {
  try {
    Expression(GetParam(), {"x", "y"});
    FAIL() << "accepted: " << GetParam();
  } catch (std::invalid_argument const& error) {
    std::string const message = error.what();
    EXPECT_TRUE(message.starts_with("expression \"" + std::string(GetParam()) + "\": ")) << message;
    EXPECT_TRUE(message.ends_with("; accepted: a formula in x, y")) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(All, WrongExpression,
                         testing::Values("", " ", "x+", "(x", "x)", "t", "sin()", "foo(x)", "x,y",
                                         "x = 3", "x=3", "\"x\"", "5 6", "x y", "1 = 1", "x & y",
                                         "x &~ y", "x && && y", "1 && 2 |~ y"));

TEST(Expression, RefusesAResultThatIsNotFinite) {
  for (auto const* const text : {"1/x", "log(x)", "sqrt(x-1)", "x/x", "exp(1000 + x)"}) {
    try {
      value(text);
      FAIL() << "accepted: " << text;
    } catch (std::runtime_error const& error) {
      EXPECT_EQ(error.what(),
                "expression \"" + std::string(text) + "\" is not finite at x = 0, y = 0");
    }
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
