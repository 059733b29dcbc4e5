// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/lie_adams_bashforth2.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class Rotation>
using AdamsBashforth = LieAdamsBashforth2<Spins, SceneIsotropy, Rotation>;

struct Family : LieFamily<AdamsBashforth>, Unbounded {
  using Unbounded::Linear;
};

}  // namespace

MethodEntries adams_bashforth_entries() {
  using enum io::Method;
  using enum io::Isotropy;
  return {Entry<Family>::make({ab2})};
}

}  // namespace cayspin::program
