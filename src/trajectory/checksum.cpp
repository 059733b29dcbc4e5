// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "checksum.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace cayspin::io {
namespace {

constexpr std::uint64_t prime_1 = 0x9E3779B185EBCA87, prime_2 = 0xC2B2AE3D27D4EB4F,
                        prime_3 = 0x165667B19E3779F9, prime_4 = 0x85EBCA77C2B2AE63,
                        prime_5 = 0x27D4EB2F165667C5;

template <class Word>
std::uint64_t load(std::byte const* data) {
  Word word;
  std::memcpy(&word, data, sizeof word);
  return word;
}

std::uint64_t mixed(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * prime_2, 31) * prime_1;
}

// Every bit of the input reaches every bit of the result.
std::uint64_t spread(std::uint64_t hash) {
  hash = (hash ^ hash >> 33U) * prime_2;
  hash = (hash ^ hash >> 29U) * prime_3;
  return hash ^ hash >> 32U;
}

std::uint64_t hash_of_stripes(std::byte const*& data, std::byte const* end, std::uint64_t seed) {
  std::array<std::uint64_t, 4> lanes{seed + prime_1 + prime_2, seed + prime_2, seed,
                                     seed - prime_1};
  for (; end - data >= 32; data += 32)
    for (std::size_t lane = 0; lane < 4; ++lane)
      lanes[lane] = mixed(lanes[lane], load<std::uint64_t>(data + 8 * lane));
  auto hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
              std::rotl(lanes[3], 18);
  for (auto const lane : lanes) hash = (hash ^ mixed(0, lane)) * prime_1 + prime_4;
  return hash;
}

// 56 bytes: step, time, energy, norm_defect, magnetization.
std::uint64_t row_hash(Sample const& sample) {
  static_assert(sizeof(Sample) == 56 && std::is_trivially_copyable_v<Sample>);
  return xxh64(std::as_bytes(std::span(&sample, 1)));
}

std::uint32_t never_zero(std::uint64_t hash) {
  return std::max(static_cast<std::uint32_t>(hash >> 32U), std::uint32_t{1});
}

}  // namespace

std::uint64_t xxh64(std::span<std::byte const> bytes, std::uint64_t seed) {
  auto const* data = bytes.data();
  auto const* const end = data + bytes.size();
  auto hash = bytes.size() >= 32 ? hash_of_stripes(data, end, seed) : seed + prime_5;
  hash += bytes.size();
  for (; end - data >= 8; data += 8)
    hash = std::rotl(hash ^ mixed(0, load<std::uint64_t>(data)), 27) * prime_1 + prime_4;
  if (end - data >= 4) {
    hash = std::rotl(hash ^ load<std::uint32_t>(data) * prime_1, 23) * prime_2 + prime_3;
    data += 4;
  }
  for (; data != end; ++data)
    hash = std::rotl(hash ^ std::to_integer<std::uint64_t>(*data) * prime_5, 11) * prime_1;
  return spread(hash);
}

std::uint32_t row_checksum(Sample const& sample) { return never_zero(row_hash(sample)); }

std::uint64_t text_checksum(TrajectoryHeader const& header) {
  std::uint64_t hash = 0;
  for (auto const* text :
       {&header.scene_text, &header.resolved_scene, &header.cayspin_version, &header.git_commit,
        &header.kokkos_version, &header.space, &header.precision})
    hash = xxh64(std::as_bytes(std::span(*text)), hash);
  return hash;
}

std::uint32_t spins_checksum(Sample const& sample, std::span<std::byte const> spins) {
  return never_zero(xxh64(spins, row_hash(sample)));
}

}  // namespace cayspin::io
