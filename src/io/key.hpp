// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace cayspin::inline v0_2::io {

using Triple = std::array<double, 3>;

/// A number, or the text of an expression in t.
using AppliedComponent = std::variant<double, std::string>;

/// The values that a key accepts: their description for messages, and the range of a number.
struct Limits {
  std::string_view accepted = "a finite number";
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool excludes_least = false;  ///< `least` itself is refused
};
inline constexpr Limits not_negative{"a number >= 0", 0};
inline constexpr Limits positive{"a number > 0", 0, std::numeric_limits<double>::infinity(), true};

/// A key in a table of the scene, and the member of Section that it sets. Most tables accept the
/// keys in Section::keys() and no other. A Triple is read as a direction and normalised.
template <class Section>
struct Key {
  std::string_view name;
  /// std::monostate if a separate function reads the key.
  std::variant<std::monostate, bool Section::*, std::optional<bool> Section::*, int Section::*,
               std::int64_t Section::*, double Section::*, std::optional<double> Section::*,
               Triple Section::*, AppliedComponent Section::*>
      member = {};
  Limits limits = {};
  bool required = false;
};

}  // namespace cayspin::inline v0_2::io
