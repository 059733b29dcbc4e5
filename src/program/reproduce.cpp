// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "failure.hpp"
#include "kokkos_settings.hpp"
#include "reproduce/context.hpp"

#include <algorithm>
#include <array>

namespace cayspin::program {
namespace {

struct Part {
  std::string_view name;
  void (*print)(reproduction::Context const&);
};

constexpr auto parts = std::to_array<Part>({
    {"table1", reproduction::table1},
    {"table2", reproduction::table2},
    {"table3", reproduction::table3},
    {"table4", reproduction::table4},
    {"separatrix", reproduction::separatrix},
    {"figures", reproduction::figures},
    {"errata", reproduction::errata},
});

}  // namespace

std::vector<std::string> reproducible_parts() {
  std::vector<std::string> names;
  for (auto const& part : parts) names.emplace_back(part.name);
  names.emplace_back("all");
  return names;
}

int reproduce(ReproduceOptions const& options) {
  KokkosSession const kokkos(space_name<Kokkos::DefaultHostExecutionSpace>(), options.threads, {});
  auto const asked = [&](std::string_view name) {
    return std::ranges::find(options.parts, name) != options.parts.end();
  };
  reproduction::Context context{options.bodies, options.seed, options.output};
  if (!context.folder && (asked("all") || asked("figures"))) context.folder = "reproduction";
  for (auto const& part : parts)
    if (asked("all") || asked(part.name)) part.print(context);
  return Status::done;
}

}  // namespace cayspin::program
