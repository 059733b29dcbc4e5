// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/crystal.hpp>
#include <cayspin/demagnetization/convolution.hpp>
#include <cayspin/demagnetization/dipole_interactions.hpp>
#include <cayspin/demagnetization/kernel_of_pairs.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <memory>
#include <type_traits>

namespace cayspin::inline v0_2 {

/// The field of point dipoles at the sites of a crystal, by FFTs:
/// H_i = strength * V * sum_j (3 * (r.m_j) * r - r^2 * m_j) / (4 * pi * r^5), with the vector r
/// from site j to site i. V is the product of the lattice's spacings, so that a dipole of 1
/// corresponds to a cell with these edges and magnetization 1. Far away, the dipole's field is that
/// of such a cell in a DemagnetizingField. The energy per site is -m.H/2. DipolarField is a solver
/// for HostField, and the HostField can be put into a SlowField. The spins passed in are taken as
/// dipole moments: multiply them by the moments of their sites beforehand.
///
/// Copies share their work memory, so evaluate one at a time. On a part of a lattice (mpi::Domain)
/// the field is that of the dipoles of all parts, bitwise identical to that on the whole lattice.
/// All parts must construct and evaluate it together. Needs the target cayspin::fftw.
template <class Real>
class DipolarField {
  using Convolution = detail::Convolution<Real, detail::KernelOfPairs<Real>>;

 public:
  static constexpr int degree = 2;

  /// Sites are at the positions of `crystal`, times the lattice's spacings. Throws
  /// std::invalid_argument for an invalid lattice or crystal, if they have different numbers of
  /// sites in a cell, for several replicas, a non-finite strength or demagnetising factor, a
  /// negative number of images, and infinitely_many_images along vectors whose periods have a ratio
  /// above 1e4, or together with another number of images that is not 0. Throws std::runtime_error
  /// if FFTW fails.
  DipolarField(Lattice const& lattice, Crystal const& crystal, DipolarOptions const& options = {})
      : lattice_(lattice),
        convolution_(std::make_shared<Convolution const>(
            lattice, detail::InteractionsOfDipoles(lattice, crystal, options))) {}

  /// Returns the bytes of the spectrum and of the interactions. On a part of a lattice, these are
  /// the bytes of that part.
  static std::int64_t work_bytes(Lattice const& lattice, Crystal const& crystal,
                                 DipolarOptions const& options = {}) {
    return Convolution::work_bytes(lattice, {lattice, crystal, options});
  }

  /// Writes H of the spins into `field`. Throws std::invalid_argument for spins on another lattice.
  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double /*t*/) const {
    static_assert(std::is_same_v<typename HostSpins::value_type, Real>,
                  "DipolarField was made for spins of another precision.");
    require_lattice("cayspin::DipolarField", lattice_, spins.lattice());
    require_lattice("cayspin::DipolarField", lattice_, field.lattice());
    (*convolution_)(spins, field);
  }

 private:
  Lattice lattice_;
  std::shared_ptr<Convolution const> convolution_;
};

}  // namespace cayspin::inline v0_2
