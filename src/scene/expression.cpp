// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/expression.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

// Returns true for an assignment: muParser would let "x = 3" change the variable.
bool assigns(std::string_view text) {
  for (std::size_t at = text.find('='); at != text.npos; at = text.find('=', at + 1)) {
    bool const follows_comparison =
        at > 0 && std::string_view("=<>!").find(text[at - 1]) != text.npos;
    bool const starts_comparison = at + 1 < text.size() && text[at + 1] == '=';
    if (!follows_comparison && !starts_comparison) return true;
  }
  return false;
}

// Returns a remainder with the sign of the divisor, so that (i - 1) % 2 is 1 for i = 0.
double remainder_of(double a, double b) { return a - b * std::floor(a / b); }
double is_zero(double a) { return a == 0 ? 1 : 0; }
double both(double a, double b) { return a != 0 && b != 0 ? 1 : 0; }
double either(double a, double b) { return a != 0 || b != 0 ? 1 : 0; }
double sinc(double a) { return a == 0 ? 1 : std::sin(a) / a; }

// Joins lines: a formula may have line breaks, a message must not.
std::string in_one_line(std::string message) {
  std::ranges::replace(message, '\n', ' ');
  std::ranges::replace(message, '\r', ' ');
  return message;
}

// Replaces && and || by operators of our own in a formula that the parser accepts. muParser
// computes its own for two constants from the whole parts of these, so that 0.5 && 1 would be 0.
void replace_logic(mu::Parser& parser, std::string const& text) {
  constexpr std::pair<std::string_view, char const*> operators[] = {{"&&", "&~"}, {"||", "|~"}};
  auto replaced = text;
  for (auto const& [sign, name] : operators)
    for (auto at = replaced.find(sign); at != replaced.npos; at = replaced.find(sign, at))
      replaced.replace(at, sign.size(), name);
  if (replaced == text) return;
  parser.DefineOprt(operators[0].second, &both, mu::prLAND, mu::oaLEFT, true);
  parser.DefineOprt(operators[1].second, &either, mu::prLOR, mu::oaLEFT, true);
  parser.SetExpr(replaced);
  parser.Eval();
}

}  // namespace

struct Expression::Compiled {
  std::string text;
  std::vector<std::string> variables;
  std::vector<double> values;
  struct Function {
    ExpressionFunction function;
    Compiled const* compiled;
  };
  std::vector<Function> functions;
  bool is_ready = false;  // false during compilation, when variables have no values yet
  mu::Parser parser;

  static double call(void* called, double a, double b) {
    auto const& [function, compiled] = *static_cast<Function const*>(called);
    return compiled->is_ready ? function.value(a, b, compiled->values.data()) : 0;
  }
};

Expression::Expression(std::string text, std::vector<std::string> variables,
                       std::vector<ExpressionFunction> functions)
    : compiled_(std::make_unique<Compiled>()) {
  compiled_->text = std::move(text);
  compiled_->variables = std::move(variables);
  compiled_->values.resize(compiled_->variables.size());
  for (auto& function : functions)
    compiled_->functions.push_back({std::move(function), compiled_.get()});
  auto const refuse = [&](std::string_view reason) {
    return std::invalid_argument(
        in_one_line(fmt::format("expression \"{}\": {}; accepted: a formula in {}", compiled_->text,
                                reason, fmt::join(compiled_->variables, ", "))));
  };
  auto& parser = compiled_->parser;
  try {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineOprt("%", &remainder_of, mu::prMUL_DIV, mu::oaLEFT, true);
    parser.DefineInfixOprt("!", &is_zero);
    parser.DefineFun("sinc", &sinc);
    for (std::size_t n = 0; n < compiled_->variables.size(); ++n) {
      parser.DefineVar(compiled_->variables[n], &compiled_->values[n]);
    }
    for (auto& function : compiled_->functions)
      parser.DefineFunUserData(function.function.name, &Compiled::call, &function, false);
    parser.SetExpr(compiled_->text);
    parser.Eval();
    replace_logic(parser, compiled_->text);
  } catch (mu::ParserError const& error) {
    throw refuse(error.GetMsg());
  }
  if (parser.GetNumResults() != 1) throw refuse("gives several values");
  if (assigns(compiled_->text)) throw refuse("assignment has no meaning here");
  compiled_->is_ready = true;
}

Expression::Expression(Expression const& other)
    : Expression(other.compiled_->text, other.compiled_->variables, [&] {
        std::vector<ExpressionFunction> functions;
        for (auto const& [function, unused] : other.compiled_->functions)
          functions.push_back(function);
        return functions;
      }()) {}
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression other) noexcept {
  compiled_ = std::move(other.compiled_);
  return *this;
}
Expression::~Expression() = default;

double Expression::operator()(double const* values) const {
  std::copy_n(values, compiled_->values.size(), compiled_->values.begin());
  double result = 0;
  try {
    result = compiled_->parser.Eval();
  } catch (std::runtime_error const& error) {
    throw std::runtime_error(
        in_one_line(fmt::format("expression \"{}\": {}", compiled_->text, error.what())));
  }
  if (std::isfinite(result)) return result;
  std::string at;
  for (std::size_t n = 0; n < compiled_->values.size(); ++n) {
    at += fmt::format("{}{} = {}", n == 0 ? "" : ", ", compiled_->variables[n], values[n]);
  }
  throw std::runtime_error(
      in_one_line(fmt::format("expression \"{}\" is not finite at {}", compiled_->text, at)));
}

std::string const& Expression::text() const { return compiled_->text; }

bool Expression::depends_on(std::string_view variable) const {
  auto const& used = compiled_->parser.GetUsedVar();
  return used.contains(std::string(variable));
}

}  // namespace cayspin::inline v0_2::io
