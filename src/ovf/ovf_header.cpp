// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ovf_header.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::size_t longest_line = 65536;
constexpr std::string_view blanks = " \t\r\v\f";
constexpr std::string_view axes = "xyz";

std::string_view trimmed(std::string_view text) {
  auto const begin = text.find_first_not_of(blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

/// The records of a header by label. Errors name the label.
class Records {
 public:
  explicit Records(std::filesystem::path const& path) : path_(path) {}

  void add(OvfLine line) {
    auto const [place, is_new] = values_.try_emplace(line.label, line.value);
    if (is_new || place->second == line.value) return;
    repeated_.insert(line.label);
    place->second = std::move(line.value);
  }

  std::optional<std::string> find(std::string const& label) const {
    if (label != "title" && repeated_.contains(label))
      refuse_ovf(path_, fmt::format("its header has several values of {}; accepted: one", label));
    auto const found = values_.find(label);
    return found == values_.end() ? std::nullopt : std::optional(found->second);
  }

  std::string required(std::string const& label) const {
    auto const value = find(label);
    if (!value) refuse_ovf(path_, fmt::format("its header has no {}", label));
    return *value;
  }

  std::int64_t count(std::string const& label) const {
    return parse<std::int64_t>(label, required(label), "a whole number >= 1",
                               [](auto number) { return number >= 1; });
  }

  double number(std::string const& label, double otherwise) const {
    auto const value = find(label);
    if (!value) return otherwise;
    return parse<double>(label, *value, "a finite number",
                         [](double number) { return std::isfinite(number); });
  }

  [[noreturn]] void refuse(std::string const& label, std::string const& value,
                           std::string_view accepted) const {
    refuse_ovf(path_,
               fmt::format("{} is \"{}\"; accepted: {}", label, value.substr(0, 40), accepted));
  }

 private:
  template <class Number, class Holds>
  Number parse(std::string const& label, std::string const& text, std::string_view accepted,
               Holds holds) const {
    Number number{};
    auto const* const end = text.data() + text.size();
    auto const* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    auto const [stop, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || stop != end || !holds(number)) refuse(label, text, accepted);
    return number;
  }

  std::filesystem::path const& path_;
  std::map<std::string, std::string> values_;
  std::set<std::string> repeated_;  // labels with several different values
};

/// Returns the next line, or nothing at the end of the file.
std::optional<std::string> next_line(std::istream& stream, std::filesystem::path const& path) {
  std::string line;
  for (int c = stream.get(); c != std::istream::traits_type::eof(); c = stream.get()) {
    if (c == '\n') return line;
    if (line.size() == longest_line) refuse_ovf(path, "a line of its header does not end");
    line += static_cast<char>(c);
  }
  if (line.empty()) return std::nullopt;
  return line;
}

/// Returns the version of the format, 1 or 2.
int version_of(std::string const& line, std::filesystem::path const& path) {
  auto const first = squeezed(line);
  if (first == "#oommfovf2.0") return 2;
  if (first == "#oommf:rectangularmeshv1.0") return 1;
  if (first.starts_with("#oommf:irregularmeshv"))
    refuse_ovf(path, "its mesh is irregular; accepted: a rectangular mesh");
  constexpr std::string_view accepted =
      "OVF 2.0 (# OOMMF OVF 2.0) or OVF 1.0 (# OOMMF: rectangular mesh v1.0)";
  if (first.starts_with("#oommf"))
    refuse_ovf(path, fmt::format("its first line is \"{}\"; accepted: {}",
                                 trimmed(line).substr(0, 40), accepted));
  refuse_ovf(path, fmt::format("it is not an OVF file; accepted: {}", accepted));
}

OvfMesh mesh_of(Records const& records) {
  if (auto const type = records.required("meshtype"); squeezed(type) != "rectangular")
    records.refuse("meshtype", type, "rectangular");
  OvfMesh mesh;
  if (auto const unit = records.find("meshunit")) mesh.unit = *unit;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const label = [&](char const* rest) { return axes[axis] + std::string(rest); };
    mesh.nodes[axis] = records.count(label("nodes"));
    mesh.step[axis] = records.number(label("stepsize"), 1);
    mesh.base[axis] = records.number(label("base"), mesh.step[axis] / 2);
  }
  return mesh;
}

void read_values_of(Records const& records, OvfHeader& header) {
  if (header.version == 1) {
    header.field.value_unit = records.find("valueunit").value_or("1");
    header.multiplier = records.number("valuemultiplier", 1);
    return;
  }
  header.components = records.count("valuedim");
  auto const units = records.find("valueunits").value_or("1");
  header.field.value_unit = units.substr(0, units.find_first_of(blanks));
}

std::optional<OvfFormat> format_of(std::string const& block) {
  for (auto const& word : words<OvfFormat>())
    if (block == "data" + squeezed(representation(word.value))) return word.value;
  return std::nullopt;
}

}  // namespace

template <>
std::span<Word<OvfFormat> const> words() {
  static constexpr std::array<Word<OvfFormat>, 3> table{{{"text", OvfFormat::text},
                                                         {"binary4", OvfFormat::binary4},
                                                         {"binary8", OvfFormat::binary8}}};
  return table;
}

std::string_view representation(OvfFormat format) {
  switch (format) {
    case OvfFormat::text:
      return "Text";
    case OvfFormat::binary4:
      return "Binary 4";
    default:
      return "Binary 8";
  }
}

void refuse_ovf(std::filesystem::path const& path, std::string const& reason) {
  throw std::runtime_error(fmt::format("{}: cannot read the OVF file: {}", path.string(), reason));
}

std::string squeezed(std::string_view text) {
  std::string result;
  for (char const c : text)
    if (blanks.find(c) == blanks.npos)
      result += 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

OvfLine split_line(std::string_view line) {
  line = trimmed(line);
  if (!line.starts_with('#')) return {};
  line.remove_prefix(1);
  line = line.substr(0, line.starts_with('#') ? 0 : line.find("##"));
  auto const colon = line.find(':');
  if (colon == line.npos) return {};
  return {squeezed(line.substr(0, colon)), std::string(trimmed(line.substr(colon + 1)))};
}

OvfHeader read_header(std::istream& stream, std::filesystem::path const& path) {
  OvfHeader header;
  header.version = version_of(next_line(stream, path).value_or(""), path);
  Records records(path);
  while (auto const text = next_line(stream, path)) {
    if (!trimmed(*text).empty() && !trimmed(*text).starts_with('#'))
      refuse_ovf(path, "a line of its header does not begin with #");
    auto line = split_line(*text);
    if (line.label == "desc") {
      header.field.description.push_back(line.value);
    } else if (line.label != "begin") {
      records.add(std::move(line));
    } else if (auto const block = squeezed(line.value); block.starts_with("data")) {
      auto const format = format_of(block);
      if (!format) records.refuse("Begin", line.value, "Data Text, Data Binary 4, Data Binary 8");
      header.format = *format;
      if (records.find("segmentcount") && records.count("segmentcount") != 1)
        records.refuse("segmentcount", *records.find("segmentcount"), "1");
      header.field.title = records.find("title").value_or("");
      header.field.mesh = mesh_of(records);
      read_values_of(records, header);
      return header;
    }
  }
  refuse_ovf(path, "it ends before # Begin: Data");
}

}  // namespace cayspin::inline v0_2::io
