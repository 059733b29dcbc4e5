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
    return {Entry<Group>::make({on_sphere}), Entry<OnChartFamily>::make(on_chart(on_sphere)),
            Entry<InSpaceFamily>::make({projected})};
  }
  static MethodEntries entries_with_compensation(io::Method on_sphere, io::Method projected) {
    return together({plain_and_compensated<Group>({on_sphere}),
                     plain_and_compensated<OnChartFamily>(on_chart(on_sphere)),
                     plain_and_compensated<InSpaceFamily>({projected})});
  }

 private:
  using OnChartFamily = PlainFamily<OnChart>;
  using InSpaceFamily = typename Baseline<InSpace>::Family;
  static MethodKey on_chart(io::Method method) { return {method, io::Isotropy::zero, true}; }
};

}  // namespace cayspin::program
