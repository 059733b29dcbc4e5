// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_1::io {

/// A function of two numbers and the values of an expression's variables, for use in it. May throw
/// std::runtime_error with one line.
struct ExpressionFunction {
  std::string name;
  std::function<double(double, double, double const*)> value;
};

/// A formula typed in a scene, such as "0.3 + 0.2*cos(pi*x)", compiled once and evaluated on the
/// host. Knows the variables and functions it is given, the constants pi, _pi and _e, and
/// muParser's functions and operators except assignment. One object must not be evaluated by two
/// threads at a time.
class Expression {
 public:
  /// Compiles. Throws std::invalid_argument with one line that says what is wrong and what is
  /// known.
  Expression(std::string text, std::vector<std::string> variables,
             std::vector<ExpressionFunction> functions = {});
  Expression(Expression const& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression other) noexcept;
  ~Expression();

  /// The value at `values`, one per variable in the constructor's order.
  /// Throws std::runtime_error with one line when the result is not finite, or a function throws.
  double operator()(double const* values) const;

  std::string const& text() const;

  /// True when the formula contains the variable.
  bool depends_on(std::string_view variable) const;

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace cayspin::inline v0_1::io
