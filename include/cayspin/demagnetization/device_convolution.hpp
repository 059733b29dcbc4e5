// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/device_transforms.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/demagnetization/spectrum_of_interactions.hpp>
#include <cayspin/demagnetization/spectrum_of_parts.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/row_layout.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Extents of the lattice and of its padded period, and the sizes of a DeviceConvolution's arrays.
struct DeviceSpectrum {
  std::int64_t cells[3], period[3], octant[3];
  std::int64_t waves;  // wave numbers along x that the planes hold at once

  std::int64_t rows() const { return cells[1] * cells[2]; }
  std::int64_t numbers() const { return 3 * rows() * period[0]; }
  std::int64_t spectrum() const { return 3 * rows() * octant[0]; }
  std::int64_t lines() const { return 3 * waves; }
  std::int64_t planes() const { return lines() * period[1] * period[2]; }
  std::int64_t octant_plane() const { return octant[1] * octant[2]; }
};

/// Functor that copies the rows of spins and pads them with zeros up to a period. Output order:
/// component, row, x.
template <class Real>
struct PadRows {
  DeviceSpectrum at;
  SiteArray<Real, 3> spins;
  RowLayout layout;
  Real* numbers;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    std::int64_t const x = i % at.period[0], row = i / at.period[0];
    std::int64_t const rows = layout.rows();
    numbers[i] = x < at.cells[0]
                     ? spins.data[row / rows * spins.stride + layout.row_offset(row % rows) + x]
                     : Real(0);
  }
};

/// Functor that copies the rows of a field back from the layout of PadRows.
template <class Real>
struct TakeRows {
  DeviceSpectrum at;
  Real const* numbers;
  RowLayout layout;
  SiteArray<Real, 3> field;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    std::int64_t const x = i % at.cells[0], row = i / at.cells[0];
    std::int64_t const rows = layout.rows();
    field.data[row / rows * field.stride + layout.row_offset(row % rows) + x] =
        numbers[row * at.period[0] + x];
  }
};

/// Functor that copies the spectrum (order: line, z, y) into planes (order: z, line, y) and pads
/// them with zeros up to the periods. A line is one component at one wave number along x.
template <class Real>
struct PadPlanes {
  DeviceSpectrum at;
  Kokkos::complex<Real> const* spectrum;  // points to the first line of this batch
  std::int64_t lines, all_lines;
  Kokkos::complex<Real>* planes;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    std::int64_t const y = i % at.period[1], rest = i / at.period[1];
    std::int64_t const line = rest % all_lines, z = rest / all_lines;
    bool const is_there = y < at.cells[1] && z < at.cells[2] && line < lines;
    planes[i] =
        is_there ? spectrum[(line * at.cells[2] + z) * at.cells[1] + y] : Kokkos::complex<Real>();
  }
};

/// Functor that copies the planes back into the spectrum, without the padding.
template <class Real>
struct CutPlanes {
  DeviceSpectrum at;
  Kokkos::complex<Real> const* planes;
  std::int64_t all_lines;
  Kokkos::complex<Real>* spectrum;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    std::int64_t const y = i % at.cells[1], rest = i / at.cells[1];
    std::int64_t const z = rest % at.cells[2], line = rest / at.cells[2];
    spectrum[i] = planes[(z * all_lines + line) * at.period[1] + y];
  }
};

/// Functor that multiplies the spectrum of the spins by the interactions, wave number by wave
/// number. The kernel stores wave numbers up to half a period of each axis; the others follow by
/// parity.
template <class Real>
struct MultiplyPlanes {
  DeviceSpectrum at;
  Real const* kernel;  // points to the first wave number along x of this batch
  std::int64_t waves;
  Kokkos::complex<Real>* planes;

  KOKKOS_FUNCTION void operator()(std::int64_t i) const {
    std::int64_t const y = i % at.period[1], rest = i / at.period[1];
    std::int64_t const k = rest % waves, z = rest / waves;
    bool const mirrored_y = y >= at.octant[1], mirrored_z = z >= at.octant[2];
    std::int64_t const next = at.octant[1] * at.octant[2];
    Real const* const n = kernel + k * 6 * next +
                          (mirrored_z ? at.period[2] - z : z) * at.octant[1] +
                          (mirrored_y ? at.period[1] - y : y);
    Real const sign_y = mirrored_y ? -1 : 1, sign_z = mirrored_z ? -1 : 1;
    Real const xx = n[0], yy = n[next], zz = n[2 * next];
    Real const xy = sign_y * n[3 * next], xz = sign_z * n[4 * next],
               yz = sign_y * sign_z * n[5 * next];
    auto* const m = planes + ((z * at.waves + k) * 3) * at.period[1] + y;
    auto const mx = m[0], my = m[at.period[1]], mz = m[2 * at.period[1]];
    m[0] = xx * mx + xy * my + xz * mz;
    m[at.period[1]] = xy * mx + yy * my + yz * mz;
    m[2 * at.period[1]] = xz * mx + yz * my + zz * mz;
  }
};

/// The field of interactions between cells, computed in device memory. Rows along x are transformed
/// first. Then some wave numbers at a time are copied into planes, transformed along y and z,
/// multiplied by the interactions and transformed back. Only these planes are padded along y and z.
template <class Real, class Exec>
class DeviceConvolution {
  using Complex = Kokkos::complex<Real>;
  using Memory = typename Exec::memory_space;
  using Transforms = DeviceTransforms<Exec>;
  static_assert(Transforms::exist,
                "DemagnetizingField knows no transforms for this execution space; one for "
                "Kokkos::HostSpace, in a HostField, goes with any.");

 public:
  /// `bytes_at_once`: the planes hold no more wave numbers along x than fit into this size, but at
  /// least one. 32 MiB fit into the second-level cache of a large device.
  DeviceConvolution(Lattice const& lattice, InteractionsOfCells const& interactions,
                    std::int64_t bytes_at_once = 32 << 20)
      : at_(places(interactions, bytes_at_once)),
        row_transforms_(int(at_.period[0]), int(3 * at_.rows())),
        along_y_(int(at_.period[1]), 1, int(at_.lines() * at_.cells[2]), int(at_.period[1])),
        along_z_(int(at_.period[2]), int(at_.lines() * at_.period[1]),
                 int(at_.lines() * at_.period[1]), 1),
        numbers_("cayspin::DemagnetizingField: rows", std::size_t(at_.numbers())),
        spectrum_("cayspin::DemagnetizingField: spectrum", std::size_t(at_.spectrum())),
        planes_("cayspin::DemagnetizingField: planes", std::size_t(at_.planes())),
        kernel_("cayspin::DemagnetizingField: interactions", kernel_size(at_)) {
    if (lattice.part != nullptr)
      throw std::invalid_argument(
          "cayspin::DemagnetizingField: on a device a lattice must be whole");
    auto const kernel = Kokkos::create_mirror_view(kernel_);
    transform_interactions(interactions, Parts(lattice), kernel);
    Kokkos::deep_copy(kernel_, kernel);
  }

  /// Returns the bytes of all arrays of a DeviceConvolution, except the planes and the work memory
  /// of the transforms.
  static std::int64_t work_bytes(Lattice const&, InteractionsOfCells const& interactions) {
    auto const at = places(interactions, 0);
    return (at.numbers() + 2 * at.spectrum() + static_cast<std::int64_t>(kernel_size(at))) *
           static_cast<std::int64_t>(sizeof(Real));
  }

  template <class Spins>
  void operator()(Exec const& exec, Spins const& spins, Spins const& field) const {
    auto const& layout = spins.layout();
    run(exec, "pad rows", at_.numbers(),
        PadRows<Real>{at_, spins.array(), layout, numbers_.data()});
    row_transforms_.forward(exec, numbers_.data(), spectrum_.data());
    for (std::int64_t first = 0; first < at_.octant[0]; first += at_.waves)
      convolve(exec, first, std::min(at_.waves, at_.octant[0] - first));
    row_transforms_.backward(exec, spectrum_.data(), numbers_.data());
    run(exec, "take rows", 3 * layout.sites(),
        TakeRows<Real>{at_, numbers_.data(), layout, field.array()});
  }

 private:
  static DeviceSpectrum places(InteractionsOfCells const& interactions,
                               std::int64_t bytes_at_once) {
    DeviceSpectrum at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at.cells[axis] = interactions.cells()[axis];
      at.period[axis] = interactions.period()[axis];
      at.octant[axis] = interactions.octant(axis);
    }
    std::int64_t const plane = 3 * at.period[1] * at.period[2] * std::int64_t(sizeof(Complex));
    std::int64_t const most = std::clamp<std::int64_t>(bytes_at_once / plane, 1, at.octant[0]);
    std::int64_t const turns = (at.octant[0] + most - 1) / most;
    at.waves = (at.octant[0] + turns - 1) / turns;
    return at;
  }
  static std::size_t kernel_size(DeviceSpectrum const& at) {
    return std::size_t(6 * at.octant[0] * at.octant_plane());
  }

  void convolve(Exec const& exec, std::int64_t first, std::int64_t count) const {
    std::int64_t const lines = 3 * count;
    Complex* const spectrum = spectrum_.data() + 3 * first * at_.rows();
    Complex* const planes = planes_.data();
    run(exec, "pad planes", at_.planes(),
        PadPlanes<Real>{at_, spectrum, lines, at_.lines(), planes});
    if (at_.period[1] > 1) along_y_.forward(exec, planes);
    if (at_.period[2] > 1) along_z_.forward(exec, planes);
    run(exec, "interactions", count * at_.period[1] * at_.period[2],
        MultiplyPlanes<Real>{at_, kernel_.data() + 6 * first * at_.octant_plane(), count, planes});
    if (at_.period[2] > 1) along_z_.backward(exec, planes);
    if (at_.period[1] > 1) along_y_.backward(exec, planes);
    run(exec, "cut planes", lines * at_.rows(),
        CutPlanes<Real>{at_, planes, at_.lines(), spectrum});
  }

  template <class Body>
  static void run(Exec const& exec, char const* name, std::int64_t count, Body const& body) {
    Kokkos::parallel_for(std::string("cayspin::DemagnetizingField: ") + name,
                         Kokkos::RangePolicy<Exec, TaskIndex>(exec, 0, count), body);
  }

  DeviceSpectrum at_;
  typename Transforms::template Rows<Real> row_transforms_;
  typename Transforms::template Lines<Real> along_y_, along_z_;
  // Indices of each array, the slowest first.
  Kokkos::View<Real*, Memory> numbers_;      // component, z, y, x of a period
  Kokkos::View<Complex*, Memory> spectrum_;  // wave number along x, component, z, y
  Kokkos::View<Complex*, Memory> planes_;    // z of a period, wave number, component, y of a period
  Kokkos::View<Real*, Memory> kernel_;       // wave number, component, z, y of octants
};

}  // namespace cayspin::inline v0_2::detail
