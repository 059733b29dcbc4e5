// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Numbers that a program passes in memory. Numbers per site are in the order of initial_spins.
using GivenNumbers = std::shared_ptr<std::vector<double> const>;

/// Data that a program passes with the text of a scene.
struct Given {
  GivenNumbers spins;                                        ///< for initial.given = true
  std::map<std::string, GivenNumbers, std::less<>> numbers;  ///< for keys with { given = true }
};

/// Returns an empty array for each key with { given = true } of a scene's text, so that the text
/// can be parsed without the program's numbers. Do not read values per site of such a scene. The
/// result has no spins, so override initial.given.
Given without_numbers(std::string const& scene_text);

}  // namespace cayspin::inline v0_2::io
