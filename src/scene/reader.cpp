// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "reader.hpp"

#include "io/expression.hpp"
#include "io/words_of_others.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace cayspin::inline v0_2::io::detail {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      std::size_t const replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string type_name(toml::node const& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

constexpr std::size_t longest_word = 64;  // longer words get no hint

std::string hint_for_case(std::string_view word, std::span<std::string_view const> known) {
  auto const plain = without_case(word);
  auto const found =
      std::ranges::find_if(known, [&](auto const other) { return without_case(other) == plain; });
  return found == known.end() ? std::string() : fmt::format(", did you mean \"{}\"?", *found);
}

// Words that exist, in any case, are suggested before similar spellings: first keys of this table,
// then of other tables and words of other programs.
std::string hint_for_key(std::string_view key, std::span<std::string_view const> known) {
  if (key.size() > longest_word) return {};
  if (auto hint = hint_for_case(key, known); !hint.empty()) return hint;
  for (auto* const hint_for : {hint_for_other_table, hint_for_word_of_others, hint_for_other_case})
    if (auto hint = hint_for(key); !hint.empty()) return hint;
  return did_you_mean(key, known);
}

std::string typed_text(toml::node const& node) {
  std::ostringstream stream;
  node.visit([&](auto const& value) { stream << value; });
  return stream.str();
}

}  // namespace

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

void fail(std::string_view place, std::string_view key, std::string_view what,
          std::string_view accepted) {
  std::string line(place);
  if (!key.empty()) line += fmt::format(": {}", key);
  line += fmt::format(": {}", what);
  if (!accepted.empty()) line += fmt::format("; accepted: {}", accepted);
  throw SceneError(one_line(std::move(line)));
}

std::string did_you_mean(std::string_view word, std::span<std::string_view const> known) {
  if (word.size() > longest_word) return {};
  if (auto hint = hint_for_case(word, known); !hint.empty()) return hint;
  std::string_view best;
  std::size_t best_distance = 3;
  for (auto const candidate : known) {
    auto const distance = edit_distance(word, candidate);
    // A short word is within two edits of many others.
    if (distance < best_distance && 2 * distance < std::max(word.size(), candidate.size())) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best.empty() ? std::string{} : fmt::format(", did you mean \"{}\"?", best);
}

void Item::wrong_type(std::string_view accepted) const {
  constexpr std::size_t longest = 40;
  bool const short_value = node->is_value() && typed_text(*node).size() <= longest;
  fail(short_value ? fmt::format("{} is {}", typed_text(*node), type_name(*node))
                   : "is " + type_name(*node),
       accepted);
}

std::string place_of(toml::source_region const& source, std::string_view otherwise) {
  if (!source.path || !source.begin) return std::string(otherwise);
  if (source.path->starts_with("--set ")) return *source.path;
  return fmt::format("{}:{}", *source.path, source.begin.line);
}

Table::Table(Item item, Scene& scene) : item_(std::move(item)), scene_(&scene) {
  if (!item_.node->is_table()) item_.wrong_type("a table");
}

void Table::accept_only(std::vector<std::string_view> const& known) const {
  for (auto const& [key, node] : *item_.node->as_table()) {
    if (std::ranges::find(known, key.str()) != known.end()) continue;
    if (key.str() == "given" && scene_->given.numbers.contains(item_.key))
      item_.fail("is an array of values per site", fmt::format("{}", fmt::join(known, ", ")));
    auto const place = place_of(node.source(), item_.place);
    auto const full =
        item_.key.empty() ? std::string(key.str()) : fmt::format("{}.{}", item_.key, key.str());
    detail::fail(place, full, "unknown key" + hint_for_key(key.str(), known),
                 fmt::format("{}", fmt::join(known, ", ")));
  }
}

std::optional<Item> Table::find(std::string_view name) const {
  auto const* const node = item_.node->as_table()->get(name);
  if (node == nullptr) return std::nullopt;
  auto full = item_.key.empty() ? std::string(name) : fmt::format("{}.{}", item_.key, name);
  auto place = place_of(node->source(), item_.place);
  scene_->places[full] = place;
  return Item{node, std::move(full), std::move(place)};
}

Item Table::required(std::string_view name, std::string_view accepted) const {
  auto found = find(name);
  if (found) return std::move(*found);
  auto const full = item_.key.empty() ? std::string(name) : fmt::format("{}.{}", item_.key, name);
  detail::fail(item_.place, full, "is missing", accepted);
}

Table Table::table(std::string_view name, std::string_view accepted) const {
  return Table(required(name, accepted), *scene_);
}

// Converts integers itself, because toml::node::value returns nothing for one that a double would
// round.
double value_of(toml::node const& number) {
  auto const* const whole = number.as_integer();
  return whole ? static_cast<double>(whole->get()) : number.as_floating_point()->get();
}

double number(Item const& item, Limits const& limits) {
  if (!item.node->is_number()) item.wrong_type(limits.accepted);
  double const value = value_of(*item.node);
  if (!std::isfinite(value)) item.fail(fmt::format("{} is not finite", value), limits.accepted);
  if (limits.excludes_least && value <= limits.least)
    item.fail(fmt::format("{} is not positive", value), limits.accepted);
  if (value < limits.least)
    item.fail(fmt::format("{} is {}", value, limits.least == 0 ? "negative" : "too small"),
              limits.accepted);
  if (value > limits.most) item.fail(fmt::format("{} is too large", value), limits.accepted);
  return value;
}

std::int64_t integer(Item const& item, Limits const& limits) {
  auto const* const whole = item.node->as_integer();
  if (whole == nullptr) item.wrong_type(limits.accepted);
  auto const value = static_cast<double>(whole->get());
  if (value < limits.least)
    item.fail(fmt::format("{} is too small", whole->get()), limits.accepted);
  if (value > limits.most) item.fail(fmt::format("{} is too large", whole->get()), limits.accepted);
  return whole->get();
}

bool boolean(Item const& item) {
  auto const* const value = item.node->as_boolean();
  if (value == nullptr) item.wrong_type("true, false");
  return value->get();
}

std::string string(Item const& item, std::string_view accepted) {
  auto const* const value = item.node->as_string();
  if (value == nullptr) item.wrong_type(accepted);
  return value->get();
}

AppliedComponent component_in_time(Item const& item) {
  constexpr std::string_view accepted = "a finite number, or a string with an expression in t";
  if (!item.node->is_string()) return number(item, {accepted});
  auto text = string(item, accepted);
  try {
    double const start = 0;
    Expression(text, {"t"})(&start);
  } catch (std::invalid_argument const& error) {
    item.fail(error.what());
  } catch (std::runtime_error const& error) {
    item.fail(error.what(), "a formula that is finite from t = 0 on");
  }
  return text;
}

std::vector<Item> entries(Item const& item, std::size_t least, std::size_t most,
                          std::string_view accepted) {
  auto const* const array = item.node->as_array();
  if (array == nullptr) item.wrong_type(accepted);
  if (array->size() < least || array->size() > most) {
    item.fail(fmt::format("has {} entries", array->size()), accepted);
  }
  std::vector<Item> result;
  for (auto const& node : *array) {
    result.push_back({&node, fmt::format("{}[{}]", item.key, result.size()),
                      place_of(node.source(), item.place)});
  }
  return result;
}

Triple triple(Item const& item) {
  return three(item, "three numbers", [](Item const& each) { return number(each); });
}

Triple direction(Item const& item) {
  auto const normalised = normalise(triple(item));
  if (!normalised) item.fail("is a zero vector", "three numbers that are not all zero");
  return *normalised;
}

void unknown_word(Item const& item, std::string_view name,
                  std::vector<std::string_view> const& known, std::string_view accepted) {
  auto hint = hint_for_value_of_others(name);
  if (hint.empty()) hint = did_you_mean(name, known);
  item.fail(fmt::format("\"{}\" is not known{}", name, hint), accepted);
}

std::filesystem::path input_file(Table const& table, std::string_view name,
                                 std::string_view accepted) {
  auto const item = table.required(name, accepted);
  auto const file = string(item, accepted);
  if (file.empty()) item.fail("the file name is empty", accepted);
  auto& scene = table.scene();
  return scene.files.emplace_back(scene.path.parent_path() / file);
}

}  // namespace cayspin::inline v0_2::io::detail
