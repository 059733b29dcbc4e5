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
  auto choices = extremity::all_choices();
  auto sections = extremity::sections();
  if (options.longest) {
    choices = simplest(choices);
    sections = {extremity::longest_runs()};
  } else if (!options.json) {
    extremity::print_head();
  }
  bool kept = true;
  for (auto const& section : sections) {
    extremity::Table const table(section, choices);
    options.json ? table.print_json() : table.print_markdown();
    kept = kept && table.is_kept();
  }
  if (!kept) throw NumbersFailed("cayspin: a promise of the tables is broken");
  return Status::done;
}

}  // namespace cayspin::program
