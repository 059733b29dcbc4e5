// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Translates another program's `word` into the key of a scene or a command, as the end of a
/// message: `, here it is material.Ms`. Empty if the word is not known.
std::string hint_for_word_of_others(std::string_view word);

/// Translates a word that is typed as a value: `, here it is dp5`.
std::string hint_for_value_of_others(std::string_view value);

/// Names the key of this name in another table: `, did you mean "integrator.dt"?`. Empty if there
/// is none.
std::string hint_for_other_table(std::string_view key);

/// Names a key, of any table, that differs from `key` only in case, '_' and '-': integrator.min_dt
/// for MinDt. Empty if there is none, and for a single letter.
std::string hint_for_other_case(std::string_view key);

/// Returns a word in lower case, without '_' and '-'.
std::string without_case(std::string_view word);

}  // namespace cayspin::inline v0_2::io
