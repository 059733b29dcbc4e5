// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "applied_field.hpp"

#include "failure.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace cayspin::simulation {

namespace {

std::array<io::AppliedComponent, 3> const none{0.0, 0.0, 0.0};

}  // namespace

AppliedField::AppliedField(io::Field const& field, io::Units const& units)
    : AppliedField(field.applied.value_or(none), "field.applied", units) {
  own_ = field.own.uniform;
  mu0_ = field.mu0;
  present_ = field.applied || own_;
  depends_on_time_ = depends_on_time_ || own_;
}

AppliedField::AppliedField(std::array<io::AppliedComponent, 3> const& components, std::string key,
                           io::Units const& units)
    : key_(std::move(key)), units_(units) {
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
  auto const not_finite = [&] {
    return NumbersFailed(fmt::format("{}: is not finite at t = {}", key_, time_text(units_, t)));
  };
  if (own_) {
    auto const h = own_(t);
    if (!std::isfinite(h[0]) || !std::isfinite(h[1]) || !std::isfinite(h[2])) throw not_finite();
    return {mu0_ * h[0], mu0_ * h[1], mu0_ * h[2]};
  }
  auto const at = [&](std::size_t c) {
    auto const* expression = std::get_if<io::Expression>(&components_[c]);
    if (!expression) return mu0_ * std::get<double>(components_[c]);
    try {
      return mu0_ * (*expression)(&t);
    } catch (std::runtime_error const&) {
      throw not_finite();
    }
  };
  return {at(0), at(1), at(2)};
}

}  // namespace cayspin::simulation
