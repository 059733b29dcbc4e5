// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hand_written_steps.hpp"

namespace hand_written {

// The site itself stands in for a missing neighbour, so that this bond has no field.
template <Loops loops, class Body>
HAND_WRITTEN_INLINE void for_each(Chain<loops> const& c, Numbers<double> const v, Body body) {
  auto const slope = [&](std::size_t i, std::size_t left, std::size_t right) {
    Vector<double> const m{v.x[i], v.y[i], v.z[i]};
    return rate(c.damping, m,
                {c.exchange * (v.x[left] + v.x[right] - 2 * m.x),
                 c.exchange * (v.y[left] + v.y[right] - 2 * m.y),
                 c.exchange * (v.z[left] + v.z[right] - 2 * m.z) + c.anisotropy * m.z + c.applied});
  };
  std::size_t const end = c.n - 1;
  body(0, slope(0, 0, 1));
#pragma GCC ivdep
  for (std::size_t i = 1; i < end; ++i) body(i, slope(i, i - 1, i + 1));
  body(end, slope(end, end - 1, end));
}

template class Steps<Chain<Loops::HAND_WRITTEN_LOOPS>>;

}  // namespace hand_written
