// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Returns the key or value of a scene for another program's `word`, as the end of a message: `,
/// here it is material.Ms`. Empty if no other program has this word.
std::string hint_for_word_of_others(std::string_view word);

/// Returns the key of this name in another table: `, did you mean "integrator.dt"?`.
std::string hint_for_other_table(std::string_view key);

}  // namespace cayspin::inline v0_2::io
