// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/commutator_free4.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class>
using CommutatorFree = CommutatorFree4<Spins, SceneIsotropy>;

struct Family : LieFamily<CommutatorFree> {
  static constexpr bool exponential = false;  // the stepper has its own
};

}  // namespace

MethodEntries commutator_free_entries() { return {Entry<Family>::make({io::Method::cf4})}; }

}  // namespace cayspin::program
