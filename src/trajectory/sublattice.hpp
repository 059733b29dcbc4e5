// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_1::io {

/// The mean spin of some rows, in double. A zero vector is a site without a spin.
class SublatticeMean {
 public:
  /// Adds one row. Rows are added in the order of the file: the same rows give the same bits.
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

  /// Zero where no site has a spin.
  std::array<double, 3> value() const {
    if (count_ == 0) return {};
    auto const count = static_cast<double>(count_);
    return {sum_[0] / count, sum_[1] / count, sum_[2] / count};
  }

 private:
  std::array<double, 3> sum_{};
  std::int64_t count_ = 0;
};

}  // namespace cayspin::inline v0_1::io
