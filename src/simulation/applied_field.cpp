// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "applied_field.hpp"

#include "failure.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cayspin::simulation {

AppliedField::AppliedField(io::Field const& field)
    : own_(field.own.uniform),
      mu0_(field.mu0),
      present_(field.applied || own_),
      depends_on_time_(io::depends_on_time(field)) {
  if (!field.applied) return;
  for (std::size_t c = 0; c < 3; ++c) {
    auto const& component = (*field.applied)[c];
    if (auto const* text = std::get_if<std::string>(&component))
      components_[c] = io::Expression(*text, {"t"});
    else
      components_[c] = std::get<double>(component);
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
      throw NumbersFailed(fmt::format("field.applied, t = {}: {}", t, error.what()));
    }
  };
  return {at(0), at(1), at(2)};
}

}  // namespace cayspin::simulation
