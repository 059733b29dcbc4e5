// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <span>
#include <string_view>

namespace cayspin::inline v0_1::io {

struct Scene;

/// Terms and sites of a scene that do not go with a key of its [integrator], where each is right
/// alone. What a method itself does not take, such as a rotation, is in its row of the methods.
struct RefusedPair {
  std::string_view terms, with;  ///< both in words
  std::string_view why;          ///< for the message; "{}" stands for the method
  std::string_view key, accepted;
  bool (*has_terms)(Scene const&);
  bool (*has_other)(Scene const&);
};

/// All of them, in the order in which a scene is looked at.
std::span<RefusedPair const> refused_pairs();

}  // namespace cayspin::inline v0_1::io
