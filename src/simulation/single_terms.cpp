// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_run_in_space.hpp"

namespace cayspin::simulation {

std::vector<std::pair<std::string, io::Field>> single_terms(io::Field const& field) {
  std::vector<std::pair<std::string, io::Field>> terms;
  auto const add = [&](std::string_view name) -> io::Field& {
    terms.emplace_back(name, io::Field{});
    terms.back().second.mu0 = field.mu0;
    return terms.back().second;
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
  if (!field.anisotropies.empty()) add("anisotropy").anisotropies = field.anisotropies;
  if (field.applied) add("applied").applied = field.applied;
  if (field.own.uniform) add("applied").own.uniform = field.own.uniform;
  if (field.slab_demag) add("slab_demag").slab_demag = field.slab_demag;
  if (field.own.nonlocal) add("nonlocal").own.nonlocal = field.own.nonlocal;
  return terms;
}

}  // namespace cayspin::simulation
