// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>
#include <cayspin/stepper/rkmk.hpp>
#include <cayspin/stepper/tableau_dormand_prince8.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class>
using OnGroup = Rkmk<Spins, tableau::DormandPrince8, SceneIsotropy>;
template <class Spins, class>
using OnChart = StereographicRungeKutta<Spins, tableau::DormandPrince8>;
template <class Spins>
using InSpace = ClassicalRungeKutta<Spins, tableau::DormandPrince8, true>;

struct Group : LieFamily<OnGroup> {
  static constexpr bool exponential = false;
};

}  // namespace

MethodEntries rkmk8_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Group>::make({rkmk8}), Entry<PlainFamily<OnChart>>::make({rkmk8, zero, true}),
          Entry<Baseline<InSpace>::Family>::make({projected_rk8})};
}

}  // namespace cayspin::program
