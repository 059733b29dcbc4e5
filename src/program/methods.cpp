// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "simulation/failure.hpp"
#include "simulation/variant.hpp"

#include <fmt/format.h>

namespace cayspin::program {
namespace {

std::string method(Variant const& variant) {
  return std::string(variant.method->word) + (variant.compensated ? " compensated" : "");
}

std::string isotropies(Variant const& variant) {
  if (variant.method->is_baseline()) return "-";
  if (variant.isotropy == io::Isotropy::energy) return "energy (rigid_body)";
  bool const constant = variant.isotropy == io::Isotropy::zero && !variant.in_chart &&
                        variant.method->takes(io::Isotropy::constant, io::SystemKind::llg);
  return std::string(io::to_string(variant.isotropy)) + (constant ? ", constant" : "");
}

std::string generators(Variant const& variant) {
  if (variant.method->is_baseline()) return "-";
  return variant.in_chart ? "tangent" : "default, orthogonal";
}

std::string rotations(Variant const& variant) {
  std::string text;
  for (auto const& [name, rotation] : io::words<io::Rotation>())
    if (variant.rotations.contains(rotation))
      text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
  return text.empty() ? "-" : text;
}

std::string evaluations(Variant const& variant) {
  if (variant.evaluations) return fmt::format("{}", *variant.evaluations);
  return variant.method->adaptive ? "adaptive" : "iterates";
}

int print_methods() {
  constexpr auto line = "{:<25} {:<27} {:<20} {:<20} {:>5} {:>11} {:>11}\n";
  fmt::print(line, "method", "isotropy", "generator", "rotation", "order", "evaluations",
             "work fields");
  for (auto const& variant : variants()) {
    // Printed once already, as the method for spins.
    if (variant.of_rigid_bodies && variant.isotropy == io::Isotropy::zero) continue;
    fmt::print(line, method(variant), isotropies(variant), generators(variant), rotations(variant),
               variant.order, evaluations(variant), variant.work_fields);
  }
  fmt::print(
      "\nevaluations: of the generator, per step; adaptive methods choose their steps by\n"
      "integrator.tolerance. work fields: memory beside the state, in fields\n"
      "of three numbers per site; at most so many. A constant isotropy is typed\n"
      "{{ constant = SIGMA }}, compensated as integrator.compensated = true. The baselines, at "
      "the\n"
      "end, take neither generator, isotropy nor rotation.\n");
  return Status::done;
}

}  // namespace

Command add_methods(CLI::App& program) {
  return {program.add_subcommand("methods", "List the integrators and their options"),
          [](Ranks&) { return print_methods(); }};
}

}  // namespace cayspin::program
