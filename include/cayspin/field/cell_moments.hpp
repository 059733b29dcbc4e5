// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/table.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/vec3.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

/// One number for each site of a crystal's cell, for kernels. A prepared term reads the number of
/// its site with at(stencil.site()).
struct NumbersOfCell {
  double const* numbers;
  std::int32_t cell_sites;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto at(Site const& site) const {
    return as_value<ValueOf<Site>>(numbers[site.z() % cell_sites]);
  }
};

/// The moment mu and the gyromagnetic ratio g of each site of a crystal's cell. A site with moment
/// 0 has no spin.
template <class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class CellMoments {
 public:
  /// `gyromagnetic`: if it is empty, all ratios are 1. Throws std::invalid_argument unless there is
  /// one finite moment >= 0 and one finite gyromagnetic ratio > 0 for each site of a cell. Also
  /// throws it for a part of a lattice.
  CellMoments(Lattice const& lattice, std::vector<double> const& moments,
              std::vector<double> const& gyromagnetic = {})
      : lattice_(lattice),
        factors_(detail::table_of<MemorySpace>("cayspin::CellMoments::factors",
                                               checked_factors(lattice, moments, gyromagnetic))),
        moments_(detail::table_of<MemorySpace>("cayspin::CellMoments::moments", moments)) {}

  Lattice const& lattice() const { return lattice_; }

  NumbersOfCell moments() const { return numbers(moments_); }
  /// Returns g / mu, or 0 for sites without a spin.
  NumbersOfCell factors() const { return numbers(factors_); }

 private:
  using Table = Kokkos::View<double*, MemorySpace>;

  static NumbersOfCell numbers(Table const& table) {
    return {table.data(), static_cast<std::int32_t>(table.size())};
  }

  static std::vector<double> checked_factors(Lattice const& lattice,
                                             std::vector<double> const& moments,
                                             std::vector<double> const& gyromagnetic) {
    detail::require_whole("cayspin::CellMoments", lattice);
    auto const sites = static_cast<std::size_t>(lattice.cell_sites);
    require(moments.size() == sites, "there is not one moment for each site of a cell");
    require(gyromagnetic.empty() || gyromagnetic.size() == sites,
            "there is not one gyromagnetic ratio for each site of a cell");
    std::vector<double> made;
    for (std::size_t site = 0; site < sites; ++site) {
      double const moment = moments[site], ratio = gyromagnetic.empty() ? 1 : gyromagnetic[site];
      require(moment >= 0 && std::isfinite(moment),
              "a moment must be finite and positive, or 0 without a spin");
      require(ratio > 0 && std::isfinite(ratio),
              "a gyromagnetic ratio must be finite and positive");
      made.push_back(moment == 0 ? 0 : ratio / moment);
    }
    return made;
  }
  static void require(bool holds, char const* what) {
    if (!holds) throw std::invalid_argument(std::string("cayspin::CellMoments: ") + what);
  }

  Lattice lattice_;
  Table factors_, moments_;
};

CellMoments(Lattice, std::vector<double>, std::vector<double> = {}) -> CellMoments<>;

}  // namespace cayspin::inline v0_2
