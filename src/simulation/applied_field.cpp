// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "applied_field.hpp"

#include "failure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace cayspin::simulation {

namespace {

std::array<io::AppliedComponent, 3> const none{0.0, 0.0, 0.0};

}  // namespace

AppliedField::AppliedField(io::Field const& field)
    : AppliedField(field.applied.value_or(none), "field.applied") {
  own_ = field.own.uniform;
  mu0_ = field.mu0;
  present_ = field.applied || own_;
  depends_on_time_ = depends_on_time_ || own_;
}

AppliedField::AppliedField(std::array<io::AppliedComponent, 3> const& components, std::string key)
    : key_(std::move(key)) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (auto const* text = std::get_if<std::string>(&components[c])) {
      io::Expression expression(*text, {"t"});
      depends_on_time_ = depends_on_time_ || expression.depends_on("t");
      components_[c] = std::move(expression);
    } else {
      components_[c] = std::get<double>(components[c]);
    }
  }
}

Vec3<double> AppliedField::operator()(double t) const {
  if (own_) {
    auto const h = own_(t);
    if (!std::isfinite(h[0]) || !std::isfinite(h[1]) || !std::isfinite(h[2]))
      throw NumbersFailed(fmt::format("field.applied, t = {}: the result is not finite", t));
    return {mu0_ * h[0], mu0_ * h[1], mu0_ * h[2]};
  }
  auto const at = [&](std::size_t c) {
    auto const* expression = std::get_if<io::Expression>(&components_[c]);
    if (!expression) return mu0_ * std::get<double>(components_[c]);
    try {
      return mu0_ * (*expression)(&t);
    } catch (std::runtime_error const& error) {
      throw NumbersFailed(fmt::format("{}, t = {}: {}", key_, t, error.what()));
    }
  };
  return {at(0), at(1), at(2)};
}

}  // namespace cayspin::simulation
