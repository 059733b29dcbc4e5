// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {

/// A function that an expression may call. `value` is called with the two arguments and the values
/// of the expression's variables. It may throw std::runtime_error with one line.
struct ExpressionFunction {
  std::string name;
  std::function<double(double, double, double const*)> value;
};

/// A formula typed in a scene, such as "0.3 + 0.2*cos(pi*x)", compiled once and evaluated on the
/// host. It may use the given variables and functions, the constants pi, _pi and _e, the operators
/// % (remainder) and ! (not), sinc, and muParser's functions and operators except assignment. Not
/// thread-safe.
class Expression {
 public:
  /// Compiles the text. Throws std::invalid_argument with one line that says what is wrong and
  /// which names are known.
  Expression(std::string text, std::vector<std::string> variables,
             std::vector<ExpressionFunction> functions = {});
  Expression(Expression const& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression other) noexcept;
  ~Expression();

  /// Returns the value of the formula. `values`: one for each variable, in the constructor's order.
  /// Throws std::runtime_error with one line when the result is not finite, or a function throws.
  double operator()(double const* values) const;

  std::string const& text() const;

  /// Returns true if the formula contains the variable.
  bool depends_on(std::string_view variable) const;

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace cayspin::inline v0_2::io
