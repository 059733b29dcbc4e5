// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/rkmk4.hpp>
#include <cayspin/stepper/series4.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using Direct = Series4<Spins>;
template <class Spins, class Rotation>
using Paper = Series4Paper<Spins>;
template <class Spins, class Rotation>
using BodyDirect = Series4<Spins, isotropy::Energy>;
template <class Spins, class Rotation>
using BodyPaper = Series4Paper<Spins, isotropy::Energy>;

// Without a sigma its linear stages are those of RKMK4. Rigid bodies are asked for at run time.
template <template <class, class> class StepperOf>
struct Family : PlainFamily<StepperOf> {
  template <class Spins, class Rotation>
  using Linear = Rkmk4<Spins>;
};
template <template <class, class> class StepperOf>
struct Bodies : PlainFamily<StepperOf>, OfRigidBodies, Unbounded {
  using OfRigidBodies::generator;
  using Unbounded::Linear;
  static constexpr int work_fields = 1;
};

}  // namespace

MethodEntries series4_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Family<Direct>>::make({series4}),
          Entry<Family<Paper>>::make({series4_paper}),
          Entry<Bodies<Direct>>::make({series4, zero, false, true}),
          Entry<Bodies<Paper>>::make({series4_paper, zero, false, true}),
          Entry<Bodies<BodyDirect>>::make({series4, energy, false, true}),
          Entry<Bodies<BodyPaper>>::make({series4_paper, energy, false, true})};
}

}  // namespace cayspin::program
