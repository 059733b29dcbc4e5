// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/field_extrapolation.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class>
using Third = FieldExtrapolation3<Spins>;
template <class Spins, class>
using Fourth = FieldExtrapolation4<Spins>;

}  // namespace

MethodEntries field_extrapolation_entries() {
  using enum io::Method;
  return {Entry<PlainFamily<Third>>::make({fx3}), Entry<PlainFamily<Fourth>>::make({fx4})};
}

}  // namespace cayspin::program
