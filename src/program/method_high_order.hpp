// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "method_entry.hpp"

#include <cayspin/stepper/classical.hpp>
#include <cayspin/stepper/rkmk.hpp>

namespace cayspin::program {

/// A tableau in equal steps on the group and in the chart, and one in space, projected.
template <class Tableau, class TableauInSpace>
struct HighOrder {
  template <class Spins, class>
  using OnGroup = Rkmk<Spins, Tableau, SceneIsotropy>;
  template <class Spins, class>
  using OnChart = StereographicRungeKutta<Spins, Tableau>;
  template <class Spins>
  using InSpace = ClassicalRungeKutta<Spins, TableauInSpace, true>;

  struct Group : LieFamily<OnGroup> {
    static constexpr bool exponential = false;
  };

  static MethodEntries entries(io::Method on_sphere, io::Method projected) {
    return {Entry<Group>::make({on_sphere}),
            Entry<PlainFamily<OnChart>>::make({on_sphere, io::Isotropy::zero, true}),
            Entry<typename Baseline<InSpace>::Family>::make({projected})};
  }
};

}  // namespace cayspin::program
