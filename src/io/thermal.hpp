// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"
#include "io/site_numbers.hpp"

#include <array>
#include <cstdint>

namespace cayspin::inline v0_2::io {

/// The table [thermal]. A site has kB T = temperature * in_time(t) * of_sites, in the unit of
/// energy.
struct Thermal {
  double temperature = 0;          ///< >= 0
  AppliedComponent in_time = 1.0;  ///< an expression in t, or 1
  SiteNumbers of_sites;            ///< empty: 1
  std::int64_t seed = 0;

  static constexpr auto keys() {
    return std::to_array<Key<Thermal>>(
        {{"temperature"}, {"seed", &Thermal::seed, {"a whole number >= 0", 0}}});
  }
};

}  // namespace cayspin::inline v0_2::io
