// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Returns the key of a scene, or the command, for another program's `word`, as the end of a
/// message: `, here it is material.Ms`. Empty if no other program has this word.
std::string hint_for_word_of_others(std::string_view word);

/// Returns the same for a word that is typed as a value: `, here it is dp5`.
std::string hint_for_value_of_others(std::string_view value);

/// Returns the key of this name in another table: `, did you mean "integrator.dt"?`.
std::string hint_for_other_table(std::string_view key);

/// Returns the same for a key that differs only in case, '_' and '-': MinDt.
std::string hint_for_other_case(std::string_view key);

/// Returns a word in lower case, without '_' and '-'.
std::string without_case(std::string_view word);

}  // namespace cayspin::inline v0_2::io
