// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <span>
#include <string_view>

namespace cayspin::inline v0_2::io {

struct Scene;

/// Terms and sites of a scene that cannot be combined with a key of its [integrator], though each
/// is valid by itself. Options that a method never accepts, such as a rotation, are in the method's
/// Method instead.
struct RefusedPair {
  std::string_view terms, with;  ///< names of the terms and of the key, for lists of pairs
  std::string_view why;          ///< reason for the message; "{}" stands for the method
  std::string_view key, accepted;
  bool (*has_terms)(Scene const&);
  bool (*has_other)(Scene const&);
};

/// Returns all refused pairs, in the order in which a scene is checked.
std::span<RefusedPair const> refused_pairs();

}  // namespace cayspin::inline v0_2::io
