// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "print_json.hpp"

#include <fmt/format.h>

namespace cayspin::program {

CLI::Option* add_json_option(CLI::App& command, bool& json) {
  return command.add_flag("--json", json, "The numbers as JSON");
}

void print_json(Json const& object) {
  // File names need not be valid UTF-8, and by default dump() throws for invalid bytes.
  fmt::print("{}\n", object.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void add_units(Json& object, io::Units const& units) {
  object["units"] = units.si ? "SI" : "reduced";
  if (!units.si) return;
  object["time_unit"] = units.time;
  object["length_unit"] = units.length;
  object["field_unit"] = units.field;
  object["energy_unit"] = units.energy;
}

}  // namespace cayspin::program
