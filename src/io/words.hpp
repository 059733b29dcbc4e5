// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string_view>

/// Named values of a scene. Methods are in io/method.hpp.
namespace cayspin::inline v0_2::io {

enum class SystemKind { llg, rigid_body };
enum class BoundaryKind { open, periodic };

/// `standard` is "default" in a scene: the system's own generator A, unchanged.
enum class Generator { standard, orthogonal, tangent };
enum class Isotropy {
  zero,
  constant,
  analytic,
  finite_difference,
  finite_difference_backward,
  energy
};
enum class Rotation { cayley, exponential };

/// A named value of a scene.
template <class Value>
struct Word {
  std::string_view name;
  Value value;
};

/// All names of the values of an enum, in the order of the documentation. Specialised for every
/// enum above.
template <class Value>
std::span<Word<Value> const> words();

/// The kinds of system.
template <>
inline std::span<Word<SystemKind> const> words() {
  static constexpr Word<SystemKind> all[] = {
      {"llg", SystemKind::llg},
      {"rigid_body", SystemKind::rigid_body},
  };
  return all;
}
/// The boundaries of an axis.
template <>
inline std::span<Word<BoundaryKind> const> words() {
  static constexpr Word<BoundaryKind> all[] = {
      {"open", BoundaryKind::open},
      {"periodic", BoundaryKind::periodic},
  };
  return all;
}
/// The generators.
template <>
inline std::span<Word<Generator> const> words() {
  static constexpr Word<Generator> all[] = {
      {"default", Generator::standard},
      {"orthogonal", Generator::orthogonal},
      {"tangent", Generator::tangent},
  };
  return all;
}
/// The isotropies.
template <>
inline std::span<Word<Isotropy> const> words() {
  static constexpr Word<Isotropy> all[] = {
      {"zero", Isotropy::zero},
      {"constant", Isotropy::constant},
      {"analytic", Isotropy::analytic},
      {"finite_difference", Isotropy::finite_difference},
      {"finite_difference_backward", Isotropy::finite_difference_backward},
      {"energy", Isotropy::energy},
  };
  return all;
}
/// The rotations.
template <>
inline std::span<Word<Rotation> const> words() {
  static constexpr Word<Rotation> all[] = {
      {"cayley", Rotation::cayley},
      {"exponential", Rotation::exponential},
  };
  return all;
}

/// Returns the name of a value in a scene.
template <class Value>
std::string_view to_string(Value value) {
  auto const table = words<Value>();
  return std::ranges::find(table, value, &Word<Value>::value)->name;
}

/// Returns the table entry named `name`, or nullptr.
template <class Value>
Word<Value> const* find_word(std::string_view name) {
  auto const table = words<Value>();
  auto const found = std::ranges::find(table, name, &Word<Value>::name);
  return found == table.end() ? nullptr : &*found;
}

/// A set of values of an enum.
template <class Value>
class SetOf {
 public:
  constexpr SetOf() = default;
  constexpr SetOf(std::initializer_list<Value> values) {
    for (auto const value : values) bits_ |= bit(value);
  }
  constexpr bool contains(Value value) const { return (bits_ & bit(value)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr bool operator==(SetOf const&) const = default;

 private:
  static constexpr unsigned bit(Value value) { return 1U << static_cast<unsigned>(value); }
  unsigned bits_ = 0;
};

}  // namespace cayspin::inline v0_2::io
