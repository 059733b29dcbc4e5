// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/fftw.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/demagnetization/spectrum_of_parts.hpp>
#include <cayspin/demagnetization/workers.hpp>

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// The Fourier transform of the interactions, which is real: each component is even or odd along
/// each axis, and odd along two axes or none. One octant of wave numbers is kept; along x, only
/// this part's share of the wave numbers.
class SpectrumOfInteractions {
 public:
  SpectrumOfInteractions(InteractionsOfCells const& interactions, Parts const& parts)
      : octant_{interactions.octant(0), interactions.octant(1), interactions.octant(2)},
        period_(interactions.period()),
        lines_(shares(interactions.lines(), parts)),
        own_lines_(lines_[parts.index()]),
        tensors_(interactions.of_lines(parts.begin_of_share(interactions.lines(), parts.index()),
                                       own_lines_)),
        along_x_("cayspin::DemagnetizingField: spectrum of interactions", parts, octant_[0],
                 lines_) {}

  /// Returns the transform of `component`. Order: wave number along x, z, y.
  std::vector<double> operator()(double DemagnetizingTensor::*component,
                                 std::array<bool, 3> const& is_odd) const {
    along(
        0, is_odd[0], own_lines_,
        [&](std::int64_t line, std::int64_t x) {
          return tensors_[static_cast<std::size_t>(line * octant_[0] + x)].*component;
        },
        [&](std::int64_t line, std::int64_t x, double value) {
          along_x_.of_own_lines(x)[line] = value;
        });
    along_x_.lines_to_waves();
    std::vector<double> values;
    for (std::int64_t x = 0; x < along_x_.own_waves(); ++x)
      for (std::size_t part = 0; part < lines_.size(); ++part) {
        double const* const of_part = along_x_.of_own_wave(x, part);
        values.insert(values.end(), of_part, of_part + lines_[part]);
      }
    for (std::size_t const axis : {1UL, 2UL}) {
      std::int64_t const count = octant_[axis], step = axis == 1 ? 1 : octant_[1];
      auto const number = [&](std::int64_t line, std::int64_t i) -> double& {
        return values[static_cast<std::size_t>((line / step * count + i) * step + line % step)];
      };
      along(axis, is_odd[axis], static_cast<std::int64_t>(values.size()) / count, number,
            [&](std::int64_t line, std::int64_t i, double value) { number(line, i) = value; });
    }
    if (is_odd[0] || is_odd[1] || is_odd[2])
      for (double& value : values) value = -value;  // odd along two axes: i * i = -1
    return values;
  }

 private:
  static std::vector<std::int64_t> shares(std::int64_t total, Parts const& parts) {
    std::vector<std::int64_t> of_parts;
    for (std::size_t part = 0; part < parts.count(); ++part)
      of_parts.push_back(parts.share(total, part));
    return of_parts;
  }

  /// Transforms number(line, i) along an axis, and calls result(line, i, value) for each
  /// transformed value.
  template <class Number, class Result>
  void along(std::size_t axis, bool is_odd, std::int64_t lines, Number const& number,
             Result const& result) const {
    int const length = period_[axis], count = octant_[axis];
    RowTransforms<double> const transforms(length, 1);
    Workers<double> const workers(
        "cayspin::DemagnetizingField: lines", lines,
        static_cast<std::size_t>(length) + 2 * static_cast<std::size_t>(count) + 8);
    workers.run(lines, [&](std::int64_t line, double* line_values) {
      auto* const waves = reinterpret_cast<std::complex<double>*>(line_values);
      double* const whole = line_values + (2 * count + 7) / 8 * 8;
      for (int i = 0; i < count; ++i) {
        double const value = number(line, i);
        whole[i] = value;
        if (i > 0) whole[length - i] = is_odd ? -value : value;
      }
      // At half a period, two images are equally near, and their odd parts cancel to 0. `whole`
      // holds another number there, but imaginary parts depend neither on it nor on the first
      // number.
      transforms.forward(whole, waves);
      for (int i = 0; i < count; ++i) result(line, i, is_odd ? waves[i].imag() : waves[i].real());
    });
  }

  std::array<int, 3> octant_, period_;
  std::vector<std::int64_t> lines_;  // number on each part
  std::int64_t own_lines_;
  std::vector<DemagnetizingTensor> tensors_;
  SpectrumOfParts<double> along_x_;
};

/// Writes the transformed interactions to `kernel` in host memory, divided by the number of cells
/// of the cyclic convolution. Order: this part's wave numbers along x, components xx, yy, zz, xy,
/// xz, yz, wave numbers of the octant along z and y.
template <class Kernel>
void transform_interactions(InteractionsOfCells const& interactions, Parts const& parts,
                            Kernel const& kernel) {
  using Real = typename Kernel::value_type;
  using N = DemagnetizingTensor;
  struct Component {
    double N::*of;
    std::array<bool, 3> is_odd;
  };
  SpectrumOfInteractions const spectrum(interactions, parts);
  auto const& period = interactions.period();
  double const scale = 1.0 / (double(period[0]) * period[1] * period[2]);
  auto const plane = static_cast<std::size_t>(interactions.lines());
  std::size_t c = 0;
  for (auto const& component : {Component{&N::xx, {}},
                                {&N::yy, {}},
                                {&N::zz, {}},
                                {&N::xy, {true, true, false}},
                                {&N::xz, {true, false, true}},
                                {&N::yz, {false, true, true}}}) {
    auto const values = spectrum(component.of, component.is_odd);
    for (std::size_t i = 0; i < values.size(); ++i)
      kernel((i / plane * 6 + c) * plane + i % plane) = static_cast<Real>(scale * values[i]);
    ++c;
  }
}

}  // namespace cayspin::inline v0_2::detail
