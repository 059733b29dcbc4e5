// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/host_field.hpp>
#include <cayspin/vec3.hpp>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_1 {

/// The slab's demagnetising field computed on the host, a solver for HostField: the numbers of
/// SlabDemag, or of LayerAveragedSlabDemag, which needs an axis-aligned normal.
class SlabDemagOnHost {
 public:
  static constexpr int degree = 2;

  explicit SlabDemagOnHost(Vec3<double> const& normal, double strength = 1,
                           bool average_over_layers = false)
      : normal_(normalized(normal, "cayspin::SlabDemagOnHost: the normal")),
        strength_(detail::finite(strength, "cayspin::SlabDemagOnHost: the strength")) {
    if (!average_over_layers) return;
    double const component[3] = {normal_.x, normal_.y, normal_.z};
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(component[axis]) == 1) layer_axis_ = axis;
    if (layer_axis_ < 0)
      throw std::invalid_argument(
          "cayspin::SlabDemagOnHost: an average over layers needs a normal along x, y or z");
  }

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double) const {
    require_lattice("cayspin::SlabDemagOnHost's field", field.lattice(), spins.lattice());
    using Real = typename HostSpins::value_type;
    auto const n = as_value<Real>(normal_);
    Real const strength = static_cast<Real>(-strength_);
    if (layer_axis_ >= 0)
      detail::require_whole("cayspin::SlabDemagOnHost with averages over layers", spins.lattice());
    auto const averages = layer_axis_ < 0 ? std::vector<double>{} : layer_averages(spins);
    for (std::int64_t site = 0; site < spins.sites(); ++site) {
      Real const along = layer_axis_ < 0 ? dot(spins.get(site), n)
                                         : static_cast<Real>(averages[layer(spins, site)]);
      field.set(site, Real(strength * along) * n);
    }
  }

 private:
  template <class HostSpins>
  std::size_t layer(HostSpins const& spins, std::int64_t site) const {
    auto const& shape = spins.lattice().shape;
    std::int64_t const index[3] = {site % shape[0], site / shape[0] % shape[1],
                                   site / (shape[0] * shape[1])};
    return static_cast<std::size_t>(index[layer_axis_]);
  }

  template <class HostSpins>
  std::vector<double> layer_averages(HostSpins const& spins) const {
    std::int64_t const layers = spins.lattice().shape[static_cast<std::size_t>(layer_axis_)];
    std::vector<double> sum(static_cast<std::size_t>(layers), 0.0);
    for (std::int64_t site = 0; site < spins.sites(); ++site) {
      auto const m = spins.get(site);
      sum[layer(spins, site)] += m.x * normal_.x + m.y * normal_.y + m.z * normal_.z;
    }
    for (double& total : sum)
      total *= static_cast<double>(layers) / static_cast<double>(spins.sites());
    return sum;
  }

  Vec3<double> normal_;
  double strength_;
  int layer_axis_ = -1;
};

}  // namespace cayspin::inline v0_1
