// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"

#include <cayspin/crystal.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace cayspin::inline v0_2::io {

/// The demagnetising field of a slab in the local approximation, H = -strength * (m.n) n.
struct SlabDemagnetization {
  Triple normal = {};  ///< unit vector n
  double strength = 1;
  bool on_host = false;    ///< computed on the host through a mirror copy
  bool multirate = false;  ///< evaluated once or twice per dt, and interpolated in the substeps

  static constexpr auto keys() {
    using Slab = SlabDemagnetization;
    return std::to_array<Key<Slab>>({{"normal", &Slab::normal, {"three numbers"}, true},
                                     {"strength", &Slab::strength},
                                     {"where"},
                                     {"multirate", &Slab::multirate}});
  }
};

/// The demagnetising field of the cells, or the field of point dipoles. That of the cells is
///   H = -strength * (sum of N m over all cells),
/// where N is the demagnetising tensor of a pair of cells.
struct Demagnetization {
  double strength = 1;
  std::array<int, 3> periodic_images{};  ///< per axis: images on each side, besides the nearest one
  std::optional<Crystal> dipoles;        ///< cell and sites of the dipoles; empty: field of cells
  Triple demagnetizing_factors = {};     ///< for dipoles with three periodic axes
  std::string key = "demag";             ///< name of the key in [field]: "demag" or "dipoles"
  std::optional<bool> multirate;         ///< default: true if method and scene allow it
  std::filesystem::path cache;           ///< file for tensors that take long to compute; or empty

  static constexpr auto keys() {
    return std::to_array<Key<Demagnetization>>({{"strength", &Demagnetization::strength},
                                                {"periodic_images"},
                                                {"multirate", &Demagnetization::multirate}});
  }
};

}  // namespace cayspin::inline v0_2::io
