// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/rkmk.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using ChartEuler = StereographicRungeKutta<Spins, tableau::Euler>;
template <class Spins, class Rotation>
using ChartHeun = StereographicRungeKutta<Spins, tableau::Heun>;
template <class Spins, class Rotation>
using ChartRungeKutta4 = StereographicRungeKutta<Spins, tableau::Classical4>;

}  // namespace

MethodEntries tangent_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return together({{Entry<PlainFamily<ChartEuler>>::make({euler, zero, true}),
                    Entry<PlainFamily<ChartHeun>>::make({heun, zero, true})},
                   plain_and_compensated<PlainFamily<ChartRungeKutta4>>({rkmk4, zero, true})});
}

}  // namespace cayspin::program
