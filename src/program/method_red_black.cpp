// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method_entry.hpp"

#include <cayspin/stepper/red_black.hpp>

namespace cayspin::program {
namespace {

template <class Spins, class>
using RedBlack2 = RedBlack<Spins, 2>;
template <class Spins, class>
using RedBlack4 = RedBlack<Spins, 4>;

template <template <class, class> class Stepper>
struct OfSpins : PlainFamily<Stepper> {
  template <class, class>
  using Linear = void;
  template <class Generator>
  static auto const& generator(Generator const& of_the_scene) {
    return of_the_scene.landau_lifshitz();
  }
};

}  // namespace

MethodEntries red_black_entries() {
  using enum io::Method;
  return {Entry<OfSpins<RedBlack2>>::make({red_black2}),
          Entry<OfSpins<RedBlack4>>::make({red_black4})};
}

}  // namespace cayspin::program
