// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/demagnetization/workers.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::inline v0_1::detail {

/// The transform of one component of the interactions, which is real: each axis is even or odd, and
/// of the odd ones there are two or none. Of an octant in an octant's place, x first.
class TransformOfOctant {
 public:
  TransformOfOctant(InteractionsOfCells const& interactions)
      : octant_{interactions.octant(0), interactions.octant(1), interactions.octant(2)},
        period_(interactions.period()) {}

  void operator()(std::vector<double>& values, std::array<bool, 3> const& is_odd) const {
    for (std::size_t axis = 0; axis < 3; ++axis) along(axis, is_odd[axis], values);
    if (is_odd[0] || is_odd[1] || is_odd[2])
      for (double& value : values) value = -value;  // i times i
  }

 private:
  void along(std::size_t axis, bool is_odd, std::vector<double>& values) const {
    int const length = period_[axis], count = octant_[axis];
    RowTransforms<double> const transforms(length, 1);
    std::ptrdiff_t const step = axis == 0 ? 1 : axis == 1 ? octant_[0] : octant_[0] * octant_[1];
    auto const lines = static_cast<std::int64_t>(values.size()) / count;
    Workers<double> const workers(
        "cayspin::DemagnetizingField: lines", lines,
        static_cast<std::size_t>(length) + 2 * static_cast<std::size_t>(count) + 8);
    workers.run(lines, [&](std::int64_t line, double* line_values) {
      auto* const waves = reinterpret_cast<std::complex<double>*>(line_values);
      double* const whole = line_values + (2 * count + 7) / 8 * 8;
      double* const here = values.data() + line / step * step * count + line % step;
      for (int i = 0; i < count; ++i) {
        double const value = here[i * step];
        whole[i] = value;
        if (i > 0) whole[length - i] = is_odd ? -value : value;
      }
      // Half a period away there are two nearest images, whose odd parts cancel: into the imaginary
      // part goes neither that number nor the first.
      transforms.forward(whole, waves);
      for (int i = 0; i < count; ++i) here[i * step] = is_odd ? waves[i].imag() : waves[i].real();
    });
  }

  std::array<int, 3> octant_, period_;
};

/// store(component, i, value) for all wave numbers of the octant, x first, and the components xx, yy,
/// zz, xy, xz, yz: the transforms of the interactions, divided by the number of cells in a period.
template <class Store>
void transform_interactions(InteractionsOfCells const& interactions, Store const& store) {
  using N = DemagnetizingTensor;
  struct Component {
    double N::*of;
    std::array<bool, 3> is_odd;
  };
  auto const tensors = interactions.all();
  TransformOfOctant const transform(interactions);
  auto const& period = interactions.period();
  double const scale = 1.0 / (double(period[0]) * period[1] * period[2]);
  std::size_t c = 0;
  for (auto const& component : {Component{&N::xx, {}},
                                {&N::yy, {}},
                                {&N::zz, {}},
                                {&N::xy, {true, true, false}},
                                {&N::xz, {true, false, true}},
                                {&N::yz, {false, true, true}}}) {
    std::vector<double> values(tensors.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = tensors[i].*component.of;
    transform(values, component.is_odd);
    for (std::size_t i = 0; i < values.size(); ++i) store(c, i, scale * values[i]);
    ++c;
  }
}

}  // namespace cayspin::inline v0_1::detail
