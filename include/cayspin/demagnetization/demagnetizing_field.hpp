// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/convolution.hpp>
#include <cayspin/demagnetization/device_convolution.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <memory>
#include <type_traits>

namespace cayspin::inline v0_1 {

/// The demagnetising field of a lattice of cells, each uniformly magnetized and as large as the
/// lattice's spacings: H_i = -strength sum_j N_ij m_j, by FFTs. A solver for HostField, which Dear
/// can take: E = -m.H/2. An axis with images is periodic: a cell sees the nearest image of another
/// one and `periodic_images` more on both sides of it, whatever the lattice's boundary says to its
/// other terms. Real and MemorySpace: of the spins; DemagnetizingField(spins) takes both from them.
/// On CUDA the transforms are cuFFT's; elsewhere FFTW's, on the host. Copies share their work
/// memory; one at a time can be evaluated. On a part of a lattice (mpi::Domain) the host's is the
/// field of all parts, with the bits of one: all make it and evaluate it together. Needs the target
/// cayspin::fftw.
template <class Real, class MemorySpace = Kokkos::HostSpace>
class DemagnetizingField {
  static constexpr bool on_host = std::is_same_v<MemorySpace, Kokkos::HostSpace>;
  using Convolution =
      std::conditional_t<on_host, detail::Convolution<Real>,
                         detail::DeviceConvolution<Real, typename MemorySpace::execution_space>>;

 public:
  static constexpr int degree = 2;

  /// Throws std::invalid_argument for a crystal, edges of a cell that differ by more than 1e9 : 1,
  /// a strength that is not finite, a negative number of images, infinitely_many_images along three
  /// axes, and on a device for a part of a lattice.
  explicit DemagnetizingField(Lattice const& lattice, DemagnetizationOptions const& options = {})
      : lattice_(lattice),
        convolution_(std::make_shared<Convolution const>(
            lattice, detail::InteractionsOfCells(lattice, options))) {}
  /// For spins like these: their lattice, precision and memory space.
  explicit DemagnetizingField(SpinField<Real, MemorySpace> const& like,
                              DemagnetizationOptions const& options = {})
      : DemagnetizingField(like.lattice(), options) {}

  /// Of such a field, on a part that part's: the spectrum and the interactions.
  static std::int64_t work_bytes(Lattice const& lattice,
                                 DemagnetizationOptions const& options = {}) {
    return Convolution::work_bytes(lattice, {lattice, options});
  }

  /// `field`: H of the spins. Throws std::invalid_argument for another lattice.
  template <class HostSpins>
    requires on_host
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    static_assert(std::is_same_v<typename HostSpins::value_type, Real>,
                  "DemagnetizingField was made for spins of another precision.");
    require_lattice("cayspin::DemagnetizingField", lattice_, spins.lattice());
    (*convolution_)(spins, field);
  }
  /// The same in the memory of a device.
  template <class Exec, class Spins>
    requires(!on_host)
  void operator()(Exec const& exec, Spins const& spins, Spins const& field, double /*t*/) const {
    require_lattice("cayspin::DemagnetizingField", lattice_, spins.lattice());
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

}  // namespace cayspin::inline v0_1
