// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/units.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <optional>

// The option --json, which is the same for all commands that have it.
namespace cayspin::program {

/// Keeps the order of its keys.
using Json = nlohmann::ordered_json;

/// Adds --json.
CLI::Option* add_json_option(CLI::App& command, bool& json);

/// Prints one line on standard output. Numbers that are not finite become null.
void print_json(Json const& object);

/// Adds `units`, and in SI the value of each reduced unit.
void add_units(Json& object, io::Units const& units);

/// Returns the value, or null if there is none.
template <class Value>
Json or_null(std::optional<Value> const& value) {
  return value ? Json(*value) : Json();
}

}  // namespace cayspin::program
