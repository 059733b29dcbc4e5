// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "extremes/table.hpp"
#include "failure.hpp"
#include "kokkos_settings.hpp"

#include <fmt/format.h>

namespace cayspin::program {
namespace {

// Those that the many steps can be had of in minutes.
std::vector<extremity::Choice> simplest(std::vector<extremity::Choice> const& all) {
  std::vector<extremity::Choice> few;
  for (auto const& choice : all)
    if (choice.entry->key == MethodKey{io::Method::rkmk4} &&
        choice.generator == io::Generator::standard)
      few.push_back(choice);
  return few;
}

}  // namespace

int extremes(ExtremesOptions const& options) {
  KokkosSession const kokkos(space_name<Kokkos::DefaultHostExecutionSpace>(), 1, {});
  auto const choices = extremity::fixed_step_choices();
  bool kept = true;
  auto const show = [&](extremity::Section const& section,
                        std::vector<extremity::Choice> const& tried) {
    extremity::Table const table(section, tried);
    options.json ? table.print_json() : table.print_markdown();
    kept = kept && table.is_kept();
  };
  if (options.longest) {
    show(extremity::longest_runs(), simplest(choices));
  } else {
    if (!options.json) extremity::print_head();
    for (auto const& section : extremity::sections()) show(section, choices);
    show(extremity::adaptive_steps(), extremity::adaptive_choices());
  }
  if (!kept) throw NumbersFailed("cayspin: a promise of the tables is broken");
  return Status::done;
}

}  // namespace cayspin::program
