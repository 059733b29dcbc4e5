// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hand_written_steps.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hand_written {

void advise_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::uintptr_t page = std::uintptr_t(2) << 20;
  auto const address = reinterpret_cast<std::uintptr_t>(begin);
  std::uintptr_t const first = (address + page - 1) / page * page;
  std::uintptr_t const last = (address + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

template <class Real>
void fill(Vectors<Real>& vectors, std::vector<double> const& from) {
  std::size_t const sites = from.size() / 3;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < sites; ++i) {
    vectors.x.data[i] = static_cast<Real>(from[3 * i]);
    vectors.y.data[i] = static_cast<Real>(from[3 * i + 1]);
    vectors.z.data[i] = static_cast<Real>(from[3 * i + 2]);
  }
}

template <class Real>
std::vector<double> numbers_of(Vectors<Real> const& vectors, std::size_t sites) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < sites; ++i)
    for (auto const* component : {&vectors.x, &vectors.y, &vectors.z})
      numbers.push_back(component->data[i]);
  return numbers;
}

// The site itself stands in for a missing neighbour, so that this bond has no field. The inner loop
// has no branch; the two ends of a row are handled outside it.
template <class Real, class Body>
void for_each(Cube<Real> const& cube, Numbers<Real> const v, Body body) {
  std::size_t const row = static_cast<std::size_t>(cube.n), plane = row * row;
  int const n = cube.n;
#pragma omp parallel for collapse(2) schedule(static) firstprivate(body)
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y) {
      std::size_t const o = static_cast<std::size_t>(z) * plane + static_cast<std::size_t>(y) * row;
      std::size_t const down = y > 0 ? o - row : o, up = y + 1 < n ? o + row : o;
      std::size_t const front = z > 0 ? o - plane : o, back = z + 1 < n ? o + plane : o;
      auto const at = [=, c = cube](std::size_t x, std::size_t left, std::size_t right) {
        auto const beside = [=](Real const* m) {
          return m[left] + m[right] + m[down + x] + m[up + x] + m[front + x] + m[back + x] -
                 6 * m[o + x];
        };
        Vector<Real> const m{v.x[o + x], v.y[o + x], v.z[o + x]};
        body(o + x, rate(c.damping, m,
                         {c.exchange * beside(v.x), c.exchange * beside(v.y),
                          c.exchange * beside(v.z) + c.anisotropy * m.z + c.applied}));
      };
      at(0, o, o + 1);
#pragma GCC ivdep
      for (std::size_t x = 1; x < row - 1; ++x) at(x, o + x - 1, o + x + 1);
      at(row - 1, o + row - 2, o + row - 1);
    }
}

template void fill(Vectors<float>&, std::vector<double> const&);
template void fill(Vectors<double>&, std::vector<double> const&);
template std::vector<double> numbers_of(Vectors<float> const&, std::size_t);
template std::vector<double> numbers_of(Vectors<double> const&, std::size_t);
template class Steps<Cube<float>>;
template class Steps<Cube<double>>;

}  // namespace hand_written
