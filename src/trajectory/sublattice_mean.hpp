// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::io {

/// Mean spin of some rows, in double. A zero vector is a site without a spin.
class SublatticeMean {
 public:
  /// Adds the sum of one row. Rows are added in the order of the file, so that equal frames give
  /// bitwise equal means.
  template <class Real>
  void add_row(Real const* spins, std::int64_t sites) {
    std::array<double, 3> row{};
    for (std::int64_t site = 0; site < sites; ++site, spins += 3) {
      if (spins[0] == 0 && spins[1] == 0 && spins[2] == 0) continue;
      ++count_;
      for (std::size_t c = 0; c < 3; ++c) row[c] += static_cast<double>(spins[c]);
    }
    for (std::size_t c = 0; c < 3; ++c) sum_[c] += row[c];
  }

  /// Returns zero if no site has a spin.
  std::array<double, 3> value() const {
    if (count_ == 0) return {};
    auto const count = static_cast<double>(count_);
    return {sum_[0] / count, sum_[1] / count, sum_[2] / count};
  }

 private:
  std::array<double, 3> sum_{};
  std::int64_t count_ = 0;
};

}  // namespace cayspin::inline v0_2::io
