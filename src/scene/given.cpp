// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/given.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cstddef>

namespace cayspin::inline v0_2::io {
namespace {

void add_keys(toml::node const& node, std::string const& key, Given& given) {
  if (auto const* const array = node.as_array())
    for (std::size_t i = 0; i < array->size(); ++i)
      add_keys((*array)[i], fmt::format("{}[{}]", key, i), given);
  auto const* const table = node.as_table();
  if (table == nullptr) return;
  if (table->contains("given"))
    given.numbers[key] = std::make_shared<std::vector<double> const>();
  else
    for (auto const& [name, value] : *table)
      add_keys(value, key.empty() ? std::string(name.str()) : fmt::format("{}.{}", key, name.str()),
               given);
}

}  // namespace

Given without_numbers(std::string const& scene_text) {
  Given given;
  add_keys(toml::parse(scene_text), {}, given);
  return given;
}

}  // namespace cayspin::inline v0_2::io
