// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace cayspin::paper {

/// Options of all parts of the reproduction.
struct Context {
  std::int64_t bodies;
  std::uint64_t seed;
  std::optional<std::filesystem::path> folder;  // folder of the CSV files
};

void table1(Context const& context);
void table2(Context const& context);
void table3(Context const& context);
void table4(Context const& context);
void separatrix(Context const& context);
void figures(Context const& context);
void errata(Context const& context);

}  // namespace cayspin::paper
