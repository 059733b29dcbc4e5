// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "checksum.hpp"

#include "fletcher32.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <type_traits>

namespace cayspin::inline v0_2::io {
namespace {

// Mixes a sum into the hash; each bit of the sum changes many bits of the result.
std::uint64_t mixed(std::uint64_t hash, std::uint32_t sum) {
  hash = (hash ^ sum) * 0x9E3779B97F4A7C15U;
  return hash ^ hash >> 32U;
}

std::uint32_t never_zero(std::uint64_t hash) {
  return std::max(static_cast<std::uint32_t>(hash), std::uint32_t{1});
}

// Sums 56 bytes: step, time, energy, norm_defect, magnetization.
std::uint32_t sum_of(Sample const& sample) {
  static_assert(sizeof(Sample) == 56 && std::is_trivially_copyable_v<Sample>);
  return fletcher32(std::as_bytes(std::span(&sample, 1)));
}

}  // namespace

std::uint32_t row_checksum(Sample const& sample, std::span<double const> more) {
  auto const row = mixed(0, sum_of(sample));
  if (more.empty()) return never_zero(row);
  return never_zero(mixed(row, fletcher32(std::as_bytes(more))));
}

std::uint32_t spins_checksum(Sample const& sample, std::uint32_t fletcher32) {
  return never_zero(mixed(mixed(0, sum_of(sample)), fletcher32));
}

std::uint64_t frame_checksum(Sample const& sample, std::uint32_t fletcher32,
                             std::span<double const> more) {
  return std::uint64_t{row_checksum(sample, more)} << 32U | spins_checksum(sample, fletcher32);
}

std::uint64_t text_checksum(TrajectoryHeader const& header) {
  std::uint64_t hash = 0;
  for (auto text : {header.scene_text, header.resolved_scene, header.cayspin_version,
                    header.git_commit, header.kokkos_version, header.space, header.precision}) {
    text.append(2 - text.size() % 2, '\n');
    hash = mixed(hash, fletcher32(std::as_bytes(std::span(text))));
  }
  return hash;
}

}  // namespace cayspin::inline v0_2::io
