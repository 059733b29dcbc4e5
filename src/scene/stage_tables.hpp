// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// The tables [[stage]] of a document.
namespace cayspin::inline v0_2::io::detail {

/// Returns the number of stages. Throws SceneError for a key "stage" that is not a list of tables.
std::size_t count_stages(toml::table const& document, std::string const& path);

/// Removes all stages from a document, and merges the first `count` into its tables. Returns the
/// last of these stages, without the keys that were merged. Throws SceneError for keys that no
/// stage may change.
toml::table apply_stages(toml::table& document, std::size_t count, std::string const& path);

/// Merges the changes of a stage into a document, and removes them from the stage. `prefix`: put
/// before the stage's keys in messages. Throws SceneError for keys that no stage may change.
void apply_stage(toml::table& document, toml::table& stage, std::string const& prefix,
                 std::string const& path);

/// Reads the keys of the stage itself: name and relax.
void read_stage(Table const& table, Stage& stage);

/// Refuses a list of fields, the method "auto", and a unit-cell file that gives the stage another
/// lattice.
void check_stage(Scene const& own, Scene const& stage);

}  // namespace cayspin::inline v0_2::io::detail
