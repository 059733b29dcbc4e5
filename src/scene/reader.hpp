// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Replaces control characters by '?', so that a name typed in a scene cannot break the line.
std::string one_line(std::string text);

/// Returns a value typed on the command line as TOML: puts quotes around a word or a file name
/// without them.
std::string as_toml_value(std::string_view value);

/// Throws SceneError("PLACE: KEY: WHAT; accepted: ACCEPTED"), without the parts that are empty.
[[noreturn]] void fail(std::string_view place, std::string_view key, std::string_view what,
                       std::string_view accepted = {});

/// Returns `, did you mean "..."?` if a known word differs only in case, '_' and '-', or by one or
/// two edits that are fewer than half the letters of the longer word; otherwise "".
std::string did_you_mean(std::string_view word, std::span<std::string_view const> known);

/// A value of the scene with its full key and the place where it was typed.
struct Item {
  toml::node const* node;
  std::string key;
  std::string place;

  [[noreturn]] void fail(std::string_view what, std::string_view accepted = {}) const {
    detail::fail(place, key, what, accepted);
  }
  /// Throws an error that describes the typed value: `"big" is a string`.
  [[noreturn]] void wrong_type(std::string_view accepted) const;
};

/// Returns "FILE:LINE", or "--set key=value"; `otherwise` for a node that was never typed.
std::string place_of(toml::source_region const& source, std::string_view otherwise);

/// A table whose keys are read by name. The scene keeps the places of these keys for later
/// messages.
class Table {
 public:
  Table(Item item, Scene& scene);

  /// Refuses keys that are not in `known`.
  void accept_only(std::vector<std::string_view> const& known) const;

  std::optional<Item> find(std::string_view name) const;
  Item required(std::string_view name, std::string_view accepted) const;
  bool contains(std::string_view name) const { return find(name).has_value(); }
  Table table(std::string_view name, std::string_view accepted) const;

  Item const& item() const { return item_; }
  Scene& scene() const { return *scene_; }

 private:
  Item item_;
  Scene* scene_;
};

/// Returns the value of an integer or a floating-point number, which may be infinite or NaN.
double value_of(toml::node const& number);
double number(Item const& item, Limits const& limits = {});
inline double positive_number(Item const& item) { return number(item, positive); }
/// Limits of a number in place of which there may be site-dependent numbers.
inline constexpr Limits not_negative_or_of_sites{"a number >= 0, or values per site", 0};
inline constexpr Limits positive_or_of_sites{"a number > 0, or values per site", 0,
                                             std::numeric_limits<double>::infinity(), true};
std::int64_t integer(Item const& item, Limits const& limits);
bool boolean(Item const& item);
std::string string(Item const& item, std::string_view accepted);
/// Describes what a key with site-dependent numbers accepts instead of one number.
std::string accepted_site_numbers(Lattice const& lattice);
/// Returns true for an expression, a file, an image, numbers of regions, or given numbers; false
/// for a number with its unit.
bool are_numbers_of_sites(Item const& item);
/// Reads site-dependent numbers. Returns false for an item that is neither a string nor a table.
bool read_site_numbers(Item const& item, Scene& scene, SiteNumbers& numbers);
/// Reads site-dependent numbers into `numbers` and returns 1, or reads one number and returns it.
double number_of_sites(Item const& item, Scene& scene, SiteNumbers& numbers);
/// Describes, for messages, what read_site_vectors accepts: a vector for each site.
std::string accepted_site_vectors(Lattice const& lattice);
SiteVectors read_site_vectors(Item const& item, Scene& scene);
/// Reads one direction and returns it; or reads site-dependent vectors into `axes`, and returns the
/// zero vector.
Triple axis_of_sites(Item const& item, Scene& scene, SiteVectors& axes);
/// Reads a number, or an expression in t.
AppliedComponent component_in_time(Item const& item);

/// Returns the entries of an array; refuses fewer than `least` or more than `most`.
std::vector<Item> entries(Item const& item, std::size_t least, std::size_t most,
                          std::string_view accepted);
/// Reads three entries with `read`.
template <class Read>
auto three(Item const& item, std::string_view accepted, Read const& read) {
  auto const each = entries(item, 3, 3, accepted);
  return std::array{read(each[0]), read(each[1]), read(each[2])};
}
Triple triple(Item const& item);
/// Returns v times the power of two that takes `largest`, the largest component's magnitude, to
/// [1, 2).
inline Triple scaled_to_one(Triple const& v, double largest) {
  constexpr std::uint64_t of_infinity = 2047;  // biased exponents
  auto const exponent = std::bit_cast<std::uint64_t>(largest) >> 52U;
  if (exponent > 0 && exponent < of_infinity - 1) {
    auto const scale = std::bit_cast<double>((of_infinity - 1 - exponent) << 52U);
    return {scale * v[0], scale * v[1], scale * v[2]};
  }
  int const shift = -std::ilogb(largest);  // 2^shift may be no normal number
  return {std::scalbn(v[0], shift), std::scalbn(v[1], shift), std::scalbn(v[2], shift)};
}
/// Returns v/|v|; nothing when v is zero or not finite. Scaling by a power of two is exact and
/// keeps |v|^2 from overflowing or underflowing.
inline std::optional<Triple> normalise(Triple const& v) {
  if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) return std::nullopt;
  double const largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (largest == 0) return std::nullopt;
  auto const [x, y, z] = scaled_to_one(v, largest);
  double const norm = std::sqrt(x * x + y * y + z * z);
  return Triple{x / norm, y / norm, z / norm};
}
/// Reads three numbers and normalises them; refuses the zero vector.
Triple direction(Item const& item);

/// Reads a file name, which is relative to the scene file's folder. Returns its path and adds it to
/// Scene::files.
std::filesystem::path input_file(Table const& table, std::string_view name,
                                 std::string_view accepted = "the name of an HDF5 file");

/// Returns the names, each in quotes.
template <class Value>
std::string quoted(std::span<Word<Value> const> words) {
  std::string list;
  for (auto const& word : words)
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", word.name);
  return list;
}
template <class Value>
std::string all_words() {
  return quoted(words<Value>());
}

/// Refuses a word that is not one of `known`.
[[noreturn]] void unknown_word(Item const& item, std::string_view name,
                               std::vector<std::string_view> const& known,
                               std::string_view accepted);

/// Reads one of these words and returns its value. `accepted`: for messages; if it is empty, they
/// list all words.
template <class Value>
Value word_among(std::span<Word<Value> const> words, Item const& item,
                 std::string_view accepted = {}) {
  auto const all = accepted.empty() ? quoted(words) : std::string(accepted);
  auto const name = string(item, all);
  std::vector<std::string_view> known;
  for (auto const& word : words) {
    if (word.name == name) return word.value;
    known.push_back(word.name);
  }
  unknown_word(item, name, known, all);
}
/// Reads one of the words<Value>().
template <class Value>
Value word(Item const& item, std::string_view accepted = {}) {
  return word_among(words<Value>(), item, accepted);
}

template <class Section>
std::vector<std::string_view> names_of_keys() {
  std::vector<std::string_view> names;
  for (auto const& key : Section::keys()) names.push_back(key.name);
  return names;
}

template <class Member>
void read_member(Item const& item, Limits const& limits, Member& member) {
  if constexpr (std::is_same_v<Member, bool> || std::is_same_v<Member, std::optional<bool>>)
    member = boolean(item);
  else if constexpr (std::is_integral_v<Member>)
    member = static_cast<Member>(integer(item, limits));
  else if constexpr (std::is_same_v<Member, Triple>)
    member = direction(item);
  else if constexpr (std::is_same_v<Member, AppliedComponent>)
    member = component_in_time(item);
  else
    member = number(item, limits);
}

/// Sets the members named by the section's keys().
template <class Section>
void read_keys(Table const& table, Section& section) {
  for (auto const& key : Section::keys()) {
    auto const item = key.required ? std::optional(table.required(key.name, key.limits.accepted))
                                   : table.find(key.name);
    if (!item) continue;
    auto const read = [&](auto pointer) {
      if constexpr (!std::is_same_v<decltype(pointer), std::monostate>)
        read_member(*item, key.limits, section.*pointer);
    };
    std::visit(read, key.member);
  }
}

}  // namespace cayspin::inline v0_2::io::detail
