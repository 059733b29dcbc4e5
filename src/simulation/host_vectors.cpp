// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "host_vectors.hpp"

#include "scene_run.hpp"

#include <cstddef>
#include <cstdint>

namespace cayspin::simulation {
namespace {

template <class Work>
void for_each_number(io::HostVectors const& vectors, Work const& work) {
  auto const& [nz, ny, nx] = vectors.shape;
  auto const& strides = vectors.strides;
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i)
        for (std::int64_t c = 0; c < 3; ++c)
          work(k * strides[0] + j * strides[1] + i * strides[2] + c * strides[3]);
}

template <class From, class Real>
std::vector<Real> packed_from(io::HostVectors const& vectors) {
  auto const& [nz, ny, nx] = vectors.shape;
  auto const* data = static_cast<From const*>(vectors.data);
  std::vector<Real> numbers;
  numbers.reserve(static_cast<std::size_t>(3 * nz * ny * nx));
  for_each_number(vectors,
                  [&](std::int64_t at) { numbers.push_back(static_cast<Real>(data[at])); });
  return numbers;
}

}  // namespace

void scale(io::HostVectors const& vectors, double factor) {
  if (factor == 1) return;
  for_each_number(vectors, [&](std::int64_t at) {
    if (vectors.is_double)
      static_cast<double*>(vectors.data)[at] *= factor;
    else
      static_cast<float*>(vectors.data)[at] *= static_cast<float>(factor);
  });
}

void scale_by_site(io::HostVectors const& vectors, std::vector<double> const& factors) {
  auto const sites = static_cast<std::int64_t>(factors.size());
  for (std::int64_t plane = 0; plane < vectors.shape[0]; ++plane) {
    auto of_plane = vectors;
    auto const from = plane * vectors.strides[0];
    of_plane.shape[0] = 1;
    of_plane.data = vectors.is_double
                        ? static_cast<void*>(static_cast<double*>(vectors.data) + from)
                        : static_cast<void*>(static_cast<float*>(vectors.data) + from);
    scale(of_plane, factors[static_cast<std::size_t>(plane % sites)]);
  }
}

template <class Real>
std::vector<Real> packed(io::HostVectors const& vectors) {
  return vectors.is_double ? packed_from<double, Real>(vectors) : packed_from<float, Real>(vectors);
}
template std::vector<double> packed(io::HostVectors const&);
template std::vector<float> packed(io::HostVectors const&);

}  // namespace cayspin::simulation
