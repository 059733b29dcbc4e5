// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>
#include <cayspin/stepper/rkmk.hpp>
#include <cayspin/stepper/tableau.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class>
using OnGroup = Rkmk<Spins, tableau::Tsitouras5, SceneIsotropy>;
template <class Spins, class>
using OnChart = StereographicRungeKutta<Spins, tableau::Tsitouras5>;
template <class Spins>
using InSpace = ClassicalRungeKutta<Spins, tableau::DormandPrince5, true>;

struct Group : LieFamily<OnGroup> {
  static constexpr bool exponential = false;
};

}  // namespace

MethodEntries rkmk5_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Group>::make({rkmk5}), Entry<PlainFamily<OnChart>>::make({rkmk5, zero, true}),
          Entry<Baseline<InSpace>::Family>::make({projected_rk5})};
}

}  // namespace cayspin::program
