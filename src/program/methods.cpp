// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "failure.hpp"

#include <fmt/format.h>

namespace cayspin::program {
namespace {

template <class Word>
std::string list(bool cayley_only = false) {
  std::string names;
  for (auto const& word : io::words<Word>()) {
    if (!word.built || (cayley_only && word.name != "cayley")) continue;
    if (!names.empty()) names += ", ";
    names += word.name;
  }
  return names;
}

}  // namespace

int methods() {
  fmt::print("{:<17} {:>5} {:>11} {:>11}  {}\n", "method", "order", "evaluations", "work fields",
             "rotations");
  for (auto const& entry : method_entries()) {
    bool const baseline = io::is_baseline(entry.method);
    fmt::print("{:<17} {:>5} {:>11} {:>11}  {}\n", io::to_string(entry.method), entry.order,
               entry.evaluations, entry.work_fields,
               baseline ? "-" : list<io::Rotation>(io::needs_cayley(entry.method)));
  }
  fmt::print(
      "\nevaluations: of the generator, per step. work fields: memory beside the state, in fields\n"
      "of three numbers per site. Methods with a rotation take\n"
      "  generator  {}\n  isotropy   {}; constant as {{ constant = SIGMA }}\n"
      "The others are the baselines, which take neither generator, isotropy nor rotation.\n",
      list<io::Generator>(), list<io::Isotropy>());
  return Status::done;
}

}  // namespace cayspin::program
