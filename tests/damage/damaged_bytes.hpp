// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/file_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>
#include <string>

namespace cayspin::test {

inline long number_from(char const* variable, long otherwise) {
  char const* const text = std::getenv(variable);
  return text ? std::atol(text) : otherwise;
}

/// Random numbers that are the same on every platform, unlike those of the standard library's
/// distributions.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  /// Returns a random number from 0 to `end` - 1; 0 if `end` is 0.
  std::size_t below(std::size_t end) { return end == 0 ? 0 : engine_() % end; }

 private:
  std::mt19937_64 engine_;
};

/// For each thing that was tried, the number of times that each outcome occurred.
using OutcomeCounts = std::map<std::string, std::map<std::string, long>>;

/// Prints the counts. Expects that some files were read as they had been written, about a fifth
/// usually are, and that some were refused. If a thing was tried with 50 files or more, expects
/// both for this thing, too.
inline void print_and_expect_both(OutcomeCounts const& tried) {
  long all_right = 0, all_refused = 0;
  for (auto const& [name, counts] : tried) {
    std::cout << name << ':';
    long files = 0, right = 0, refused = 0;
    for (auto const& [outcome, count] : counts) {
      std::cout << "  " << count << ' ' << outcome;
      files += count;
      if (outcome == "right")
        right += count;
      else if (outcome != "WRONG" && outcome != "changed, without a checksum")
        refused += count;  // or a message about the kind of damage
    }
    std::cout << '\n';
    EXPECT_GE(right, files / 50) << name;
    EXPECT_GE(refused, files / 50) << name;
    all_right += right;
    all_refused += refused;
  }
  EXPECT_GT(all_right, 0);
  EXPECT_GT(all_refused, 0);
}

/// Returns the bytes with damage of one kind: bits flipped, bytes replaced, the end cut off, a
/// block zeroed, two blocks swapped, or a block repeated elsewhere. More than half of the places
/// are in the first 4 KiB.
inline std::string damaged(std::string bytes, Chance& chance) {
  auto const place = [&] {
    return chance.below(chance.below(2) ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096));
  };
  auto const block = std::size_t{1} << chance.below(13);
  auto const room = bytes.size() - std::min(bytes.size(), block);
  auto const from = std::min(place(), room), to = std::min(place(), room);
  switch (chance.below(6)) {
    case 0:
      for (auto left = 1 + chance.below(8); left > 0; --left)
        bytes[place()] ^= static_cast<char>(1U << chance.below(8));
      break;
    case 1:
      for (auto left = 1 + chance.below(64); left > 0; --left)
        bytes[place()] = static_cast<char>(chance.below(256));
      break;
    case 2:
      bytes.resize(chance.below(bytes.size()));
      break;
    case 3:
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), std::min(block, bytes.size()),
                  '\0');
      break;
    case 4:
      for (std::size_t i = 0; i < block && std::max(from, to) + i < bytes.size(); ++i)
        std::swap(bytes[from + i], bytes[to + i]);
      break;
    default:
      bytes.replace(to, std::min(block, bytes.size()), bytes.substr(from, block));
  }
  return bytes;
}

}  // namespace cayspin::test
