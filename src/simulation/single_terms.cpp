// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_run_in_space.hpp"

namespace cayspin::simulation {

std::vector<std::pair<std::string, io::Scene>> single_terms(io::Scene const& scene) {
  auto const& field = scene.field;
  std::vector<std::pair<std::string, io::Scene>> terms;
  auto const add = [&](std::string_view name) -> io::Field& {
    terms.emplace_back(name, scene);
    auto& alone = terms.back().second.field;
    alone = {};
    alone.mu0 = field.mu0;
    alone.exchange_factors = field.exchange_factors;
    alone.dmi_factors = field.dmi_factors;
    return alone;
  };
  std::apply(
      [&](auto... member) {
        auto const add_lattice_term = [&](auto one) {
          using Term = typename std::remove_cvref_t<decltype(field.*one)>::value_type;
          if (field.*one) add(Term::key).*one = field.*one;
        };
        (add_lattice_term(member), ...);
      },
      io::Field::lattice_terms);
  if (!field.couplings.empty() || !field.couplings_file.empty()) {
    auto& alone = add("couplings");
    alone.couplings = field.couplings;
    alone.couplings_file = field.couplings_file;
    alone.couplings_scale = field.couplings_scale;
  }
  if (!field.anisotropies.empty() || !field.cubic_anisotropies.empty()) {
    auto& alone = add("anisotropy");
    alone.anisotropies = field.anisotropies;
    alone.cubic_anisotropies = field.cubic_anisotropies;
  }
  if (field.applied) add("applied").applied = field.applied;
  if (field.own.uniform) add("applied").own.uniform = field.own.uniform;
  if (field.slab_demag) add("slab_demag").slab_demag = field.slab_demag;
  if (field.demag) add("demag").demag = field.demag;
  if (field.own.nonlocal) add("nonlocal").own.nonlocal = field.own.nonlocal;
  for (auto& [name, alone] : terms) {
    auto& of_alone = alone.field;
    if (!of_alone.exchange) of_alone.exchange_factors = {};
    if (!of_alone.dmi && !of_alone.bulk_dmi) of_alone.dmi_factors = {};
  }
  return terms;
}

}  // namespace cayspin::simulation
