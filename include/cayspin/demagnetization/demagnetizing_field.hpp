// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/convolution.hpp>
#include <cayspin/demagnetization/interactions.hpp>
#include <cayspin/lattice.hpp>

#include <cstdint>
#include <memory>
#include <type_traits>

namespace cayspin::inline v0_1 {

/// The demagnetising field of a lattice of cells, each uniformly magnetized and as large as the
/// lattice's spacings: H_i = -strength sum_j N_ij m_j, by FFTs. A solver for HostField, which Dear
/// can take: E = -m.H/2. An axis with images is periodic: a cell sees the nearest image of another
/// one and `periodic_images` more on both sides of it, whatever the lattice's boundary says to its
/// other terms. Real: of the spins. Copies share their work memory; one at a time can be evaluated.
/// On a part of a lattice (mpi::Domain) it is the field of all parts, with the bits of one: all
/// make it and evaluate it together. Needs the target cayspin::fftw.
template <class Real>
class DemagnetizingField {
 public:
  static constexpr int degree = 2;

  /// Throws std::invalid_argument for a crystal, a strength that is not finite and a negative
  /// number of images.
  explicit DemagnetizingField(Lattice const& lattice, DemagnetizationOptions const& options = {})
      : lattice_(lattice),
        convolution_(std::make_shared<detail::Convolution<Real> const>(
            lattice, detail::InteractionsOfCells(lattice, options))) {}

  /// Of such a field, on a part that part's: the spectrum and the interactions.
  static std::int64_t work_bytes(Lattice const& lattice,
                                 DemagnetizationOptions const& options = {}) {
    return detail::Convolution<Real>::work_bytes(lattice, {lattice, options});
  }

  /// `field`: H of the spins. Throws std::invalid_argument for another lattice.
  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    static_assert(std::is_same_v<typename HostSpins::value_type, Real>,
                  "DemagnetizingField was made for spins of another precision.");
    require_lattice("cayspin::DemagnetizingField", lattice_, spins.lattice());
    (*convolution_)(spins, field);
  }

 private:
  Lattice lattice_;
  std::shared_ptr<detail::Convolution<Real> const> convolution_;
};

}  // namespace cayspin::inline v0_1
