// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method.hpp"

#include <algorithm>
#include <stdexcept>

namespace cayspin::program {

std::span<MethodEntry const> method_entries() {
  static auto const entries = [] {
    MethodEntries all;
    for (auto const& some :
         {euler_entries(), corrected_euler_entries(), heun_entries(), rkmk4_entries(),
          rkmk5_entries(), rkmk8_entries(), adams_bashforth_entries(), implicit_entries(),
          series4_entries(), tangent_entries(), commutator_free_entries(),
          field_extrapolation_entries(), red_black_entries(), tsitouras_entries(),
          dormand_prince_entries(), bogacki_shampine_entries(), classical_entries(),
          projected_entries()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return entries;
}

MethodEntry const& find_method(io::Scene const& scene) {
  auto const& integrator = scene.integrator;
  MethodKey key{integrator.method, integrator.isotropy,
                integrator.generator == io::Generator::tangent, false, integrator.compensated};
  if (key.isotropy == io::Isotropy::constant) key.isotropy = io::Isotropy::zero;
  if (key.isotropy == io::Isotropy::energy || io::is_series(key.method))
    key.rigid_body = scene.system.kind == io::SystemKind::rigid_body;
  auto const entries = method_entries();
  auto const found = std::ranges::find(entries, key, &MethodEntry::key);
  if (found == entries.end())
    throw std::logic_error("no entry for the method " +
                           std::string(io::to_string(integrator.method)));
  return *found;
}

}  // namespace cayspin::program
