// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/convolution.hpp>
#include <cayspin/demagnetization/device_convolution.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/demagnetization/kernel_of_cells.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <memory>
#include <type_traits>

namespace cayspin::inline v0_2 {

/// The demagnetising field of a lattice of uniformly magnetised cells whose edges are the lattice's
/// spacings, averaged over each cell: H_i = -strength * sum_j N_ij m_j, by FFTs. The energy per
/// site is -m.H/2. DemagnetizingField is a solver for HostField, and the HostField can be put into
/// a SlowField.
///
/// An axis with images is periodic: a cell sees the nearest image of another cell and
/// `periodic_images` more on each side of it, whatever boundary the lattice has for other terms.
///
/// Real and MemorySpace are those of the spins; DemagnetizingField(spins) deduces both. The
/// transforms use FFTW in host memory and cuFFT on CUDA; code for other devices does not compile.
/// Copies share their work memory, so evaluate one at a time. On a part of a lattice (mpi::Domain,
/// host only) the field is that of the spins of all parts, bitwise identical to that on the whole
/// lattice. All parts must construct and evaluate it together. Needs the target cayspin::fftw.
template <class Real, class MemorySpace = Kokkos::HostSpace>
class DemagnetizingField {
  static constexpr bool on_host = std::is_same_v<MemorySpace, Kokkos::HostSpace>;
  using Convolution =
      std::conditional_t<on_host, detail::Convolution<Real, detail::KernelOfCells<Real>>,
                         detail::DeviceConvolution<Real, typename MemorySpace::execution_space>>;

 public:
  static constexpr int degree = 2;

  /// Throws std::invalid_argument for an invalid lattice, several sites in a cell, several
  /// replicas, cell edges with a ratio above 1e9, a non-finite strength, a negative number of
  /// images, and infinitely_many_images along three axes, along two whose lengths have a ratio
  /// above 1e4, or with a tensor function other than the default; also if the cache returns another
  /// number of tensors, and on a device for a part of a lattice. Throws std::runtime_error if FFTW
  /// or cuFFT fails.
  explicit DemagnetizingField(Lattice const& lattice, DemagnetizationOptions const& options = {})
      : lattice_(lattice),
        convolution_(std::make_shared<Convolution const>(
            lattice, detail::InteractionsOfCells(lattice, options))) {}
  /// Uses the lattice, precision and memory space of the spins `like`.
  explicit DemagnetizingField(SpinField<Real, MemorySpace> const& like,
                              DemagnetizationOptions const& options = {})
      : DemagnetizingField(like.lattice(), options) {}

  /// Returns the bytes of the spectrum and of the interactions; on a device, those of the padded
  /// rows are included. On a part of a lattice, these are the bytes of that part.
  static std::int64_t work_bytes(Lattice const& lattice,
                                 DemagnetizationOptions const& options = {}) {
    return Convolution::work_bytes(lattice, {lattice, options});
  }

  /// Writes H of the spins into `field`. Throws std::invalid_argument for spins on another lattice.
  template <class HostSpins>
    requires on_host
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    static_assert(std::is_same_v<typename HostSpins::value_type, Real>,
                  "DemagnetizingField was made for spins of another precision.");
    require_lattice("cayspin::DemagnetizingField", lattice_, spins.lattice());
    require_lattice("cayspin::DemagnetizingField", lattice_, field.lattice());
    (*convolution_)(spins, field);
  }
  /// Writes H of the spins into `field`, both in device memory. Throws std::invalid_argument for
  /// spins on another lattice, and std::runtime_error if cuFFT fails.
  template <class Exec, class Spins>
    requires(!on_host)
  void operator()(Exec const& exec, Spins const& spins, Spins const& field, double /*t*/) const {
    require_lattice("cayspin::DemagnetizingField", lattice_, spins.lattice());
    require_lattice("cayspin::DemagnetizingField", lattice_, field.lattice());
    (*convolution_)(exec, spins, field);
  }

 private:
  Lattice lattice_;
  std::shared_ptr<Convolution const> convolution_;
};

template <class Spins>
DemagnetizingField(Spins)
    -> DemagnetizingField<typename Spins::value_type, typename Spins::memory_space>;
template <class Spins>
DemagnetizingField(Spins, DemagnetizationOptions)
    -> DemagnetizingField<typename Spins::value_type, typename Spins::memory_space>;

}  // namespace cayspin::inline v0_2
