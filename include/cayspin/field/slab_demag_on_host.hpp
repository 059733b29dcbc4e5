// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/host_field.hpp>
#include <cayspin/vec3.hpp>

#include <cstdint>

namespace cayspin::inline v0_2 {

/// SlabDemag's field computed on the host: a solver for HostField.
class SlabDemagOnHost {
 public:
  static constexpr int degree = 2;

  explicit SlabDemagOnHost(Vec3<double> const& normal, double strength = 1)
      : normal_(normalized(normal, "cayspin::SlabDemagOnHost: the normal")),
        strength_(detail::finite(strength, "cayspin::SlabDemagOnHost: the strength")) {}

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double) const {
    require_lattice("cayspin::SlabDemagOnHost's field", field.lattice(), spins.lattice());
    using Real = typename HostSpins::value_type;
    auto const n = as_value<Real>(normal_);
    Real const strength = static_cast<Real>(-strength_);
    for (std::int64_t site = 0; site < spins.sites(); ++site)
      field.set(site, Real(strength * dot(spins.get(site), n)) * n);
  }

 private:
  Vec3<double> normal_;
  double strength_;
};

}  // namespace cayspin::inline v0_2
