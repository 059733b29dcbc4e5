// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "print_json.hpp"
#include "simulation/failure.hpp"
#include "simulation/variant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {
namespace {

using Words = std::vector<std::string>;

Words isotropies(Variant const& variant) {
  if (variant.method->is_baseline()) return {};
  Words words{std::string(io::to_string(variant.isotropy))};
  if (variant.isotropy == io::Isotropy::zero && !variant.in_chart &&
      variant.method->takes(io::Isotropy::constant, io::SystemKind::llg))
    words.emplace_back("constant");
  return words;
}

Words generators(Variant const& variant) {
  if (variant.method->is_baseline()) return {};
  return variant.in_chart ? Words{"tangent"} : Words{"default", "orthogonal"};
}

Words rotations(Variant const& variant) {
  Words words;
  for (auto const& [name, rotation] : io::words<io::Rotation>())
    if (variant.rotations.contains(rotation)) words.emplace_back(name);
  return words;
}

std::vector<Variant> listed_variants() {
  std::vector<Variant> listed;
  for (auto const& variant : variants()) {
    // This row would be the same as that for spins.
    if (variant.of_rigid_bodies && variant.isotropy == io::Isotropy::zero) continue;
    listed.push_back(variant);
  }
  return listed;
}

std::string joined(Words const& words) {
  return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ", "));
}

std::string evaluations(Variant const& variant) {
  if (variant.evaluations) return fmt::format("{}", *variant.evaluations);
  return variant.method->adaptive ? "adaptive" : "iterates";
}

void print_table() {
  constexpr auto line = "{:<25} {:<27} {:<20} {:<20} {:>5} {:>11} {:>11}\n";
  fmt::print(line, "method", "isotropy", "generator", "rotation", "order", "evaluations",
             "work fields");
  for (auto const& variant : listed_variants()) {
    auto const* const bodies = variant.isotropy == io::Isotropy::energy ? " (rigid_body)" : "";
    fmt::print(
        line, std::string(variant.method->word) + (variant.compensated ? " compensated" : ""),
        joined(isotropies(variant)) + bodies, joined(generators(variant)),
        joined(rotations(variant)), variant.order, evaluations(variant), variant.work_fields);
  }
  fmt::print(
      "\nevaluations: evaluations of the generator per step; adaptive methods choose their steps\n"
      "by integrator.tolerance. work fields: the largest memory in addition to the spins, in\n"
      "fields of three numbers per site. A constant isotropy is typed {{ constant = SIGMA }},\n"
      "compensated as integrator.compensated = true. The baselines, at the end, take neither\n"
      "generator, isotropy nor rotation.\n");
}

Json table_json() {
  auto rows = Json::array();
  for (auto const& variant : listed_variants())
    rows.push_back(Json{{"method", std::string(variant.method->word)},
                        {"compensated", variant.compensated},
                        {"adaptive", variant.method->adaptive},
                        {"isotropy", isotropies(variant)},
                        {"generator", generators(variant)},
                        {"rotation", rotations(variant)},
                        {"order", variant.order},
                        {"evaluations", or_null(variant.evaluations)},
                        {"work_fields", variant.work_fields}});
  Json object;
  object["methods"] = std::move(rows);
  return object;
}

int print_methods(bool json) {
  json ? print_json(table_json()) : print_table();
  return Status::done;
}

}  // namespace

Command add_methods(CLI::App& program) {
  auto const json = std::make_shared<bool>(false);
  auto* const command = program.add_subcommand("methods", "List the integrators and their options");
  add_json_option(*command, *json);
  return {command, [json](Ranks&) { return print_methods(*json); }};
}

}  // namespace cayspin::program
