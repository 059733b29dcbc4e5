// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "failure.hpp"

#include <fmt/format.h>

namespace cayspin::program {
namespace {

std::string method(MethodKey const& key) {
  return std::string(io::to_string(key.method)) + (key.compensated ? " compensated" : "");
}

std::string isotropies(MethodKey const& key) {
  if (io::is_baseline(key.method)) return "-";
  if (key.isotropy == io::Isotropy::energy)
    return key.rigid_body ? "energy (rigid_body)" : "energy (llg)";
  bool const constant = key.isotropy == io::Isotropy::zero && !key.tangent &&
                        io::takes_isotropy(key.method, io::Isotropy::constant, io::SystemKind::llg);
  return std::string(io::to_string(key.isotropy)) + (constant ? ", constant" : "");
}

std::string generators(MethodKey const& key) {
  if (io::is_baseline(key.method)) return "-";
  return key.tangent ? "tangent" : "default, orthogonal";
}

std::string rotations(MethodEntry const& entry) {
  if (io::is_baseline(entry.key.method)) return "-";
  if (io::needs_exponential(entry.key.method)) return "exponential";
  return entry.exponential ? "cayley, exponential" : "cayley";
}

std::string evaluations(MethodEntry const& entry) {
  if (io::is_adaptive(entry.key.method)) return "adaptive";
  return entry.evaluations == 0 ? "iterates" : fmt::format("{}", entry.evaluations);
}

}  // namespace

int methods() {
  constexpr auto line = "{:<25} {:<27} {:<20} {:<20} {:>5} {:>11} {:>11}\n";
  fmt::print(line, "method", "isotropy", "generator", "rotation", "order", "evaluations",
             "work fields");
  for (auto const& entry : method_entries()) {
    if (io::is_series(entry.key.method) && entry.key.rigid_body &&
        entry.key.isotropy == io::Isotropy::zero)
      continue;  // the same words as on spins
    fmt::print(line, method(entry.key), isotropies(entry.key), generators(entry.key),
               rotations(entry), entry.order, evaluations(entry), entry.work_fields);
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

}  // namespace cayspin::program
