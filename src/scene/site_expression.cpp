// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "site_expression.hpp"

#include "grains.hpp"
#include "random_bits.hpp"

#include <fmt/format.h>

#include <bit>
#include <stdexcept>
#include <utility>

namespace cayspin::inline v0_2::io::detail {
namespace {

double random_of(double n, double seed, double const*) {
  if (!std::isfinite(n))
    throw std::runtime_error("random of a number that is not finite; accepted: a finite number");
  // Treats -0 as 0.
  return random_number(random_bits(whole_seed(seed, "random"), 1),
                       std::bit_cast<std::uint64_t>(n + 0.0));
}

}  // namespace

std::uint64_t whole_seed(double seed, std::string_view function) {
  if (!(seed >= 0 && seed <= 0x1p53 && seed == std::floor(seed)))
    throw std::runtime_error(
        fmt::format("{} of seed {}; accepted: a whole number >= 0", function, seed));
  return static_cast<std::uint64_t>(seed);
}

std::vector<std::string> site_variables(Lattice const& lattice) {
  std::vector<std::string> variables{"x", "y", "z", "i", "j", "k"};
  if (lattice.basis.size() > 1) variables.emplace_back("s");
  return variables;
}

Expression site_expression(std::string text, Lattice const& lattice, double length) {
  auto const grain = [grains = Grains(lattice, length)](double size, double seed,
                                                        double const* values) {
    return grains.at({values[0], values[1], values[2]}, size, seed);
  };
  return {std::move(text), site_variables(lattice), {{"grain", grain}, {"random", random_of}}};
}

}  // namespace cayspin::inline v0_2::io::detail
