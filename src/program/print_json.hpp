// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/units.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <optional>

// The option --json, which is the same for all commands that have it.
namespace cayspin::program {

/// A JSON value. Objects keep their keys in the order in which they were added.
using Json = nlohmann::ordered_json;

/// Adds --json.
CLI::Option* add_json_option(CLI::App& command, bool& json);

/// Prints the object on standard output, in one line. Numbers that are not finite become null.
void print_json(Json const& object);

/// Adds the key "units" and, in SI, the SI value of each reduced unit.
void add_units(Json& object, io::Units const& units);

/// Returns the value, or null if there is none.
template <class Value>
Json or_null(std::optional<Value> const& value) {
  return value ? Json(*value) : Json();
}

}  // namespace cayspin::program
