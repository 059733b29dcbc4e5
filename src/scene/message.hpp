// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/io/scene.hpp>

#include <span>
#include <string>
#include <string_view>

namespace cayspin::io::detail {

/// Control characters become '?', so that a name typed in a scene cannot break the line.
std::string one_line(std::string text);

/// `place: key: what; accepted: accepted`; empty parts are left out.
[[noreturn]] void fail(std::string_view place, std::string_view key, std::string_view what,
                       std::string_view accepted = {});

/// `, did you mean "..."?` when one of the known words is within two edits, otherwise empty.
std::string did_you_mean(std::string_view word, std::span<std::string_view const> known);

}  // namespace cayspin::io::detail
