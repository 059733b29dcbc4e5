// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cayspin::inline v0_2::io {

/// Computes the checksum of HDF5's filter fletcher32. Bytes are added in pieces of even length.
class Fletcher32 {
 public:
  void add(std::span<std::byte const> bytes);

  std::uint32_t value() const;

 private:
  std::uint64_t sum_ = 0, sum_of_sums_ = 0;
};

inline std::uint32_t fletcher32(std::span<std::byte const> bytes) {
  Fletcher32 sum;
  sum.add(bytes);
  return sum.value();
}

}  // namespace cayspin::inline v0_2::io
