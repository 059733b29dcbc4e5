// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "tangent_basis.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace cayspin::simulation {

TangentBasis::TangentBasis(std::vector<double> numbers_of_spins,
                           std::vector<unsigned char> const& frozen)
    : spins(std::move(numbers_of_spins)) {
  for (std::size_t site = 0; site < spins.size() / 3; ++site) {
    Eigen::Vector3d const m = Eigen::Map<Eigen::Vector3d const>(&spins[3 * site]);
    if (m.isZero() || (!frozen.empty() && frozen[site])) continue;
    sites.push_back(site);
    Eigen::Vector3d const beside =
        std::abs(m.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    Eigen::Vector3d const first = m.cross(beside).normalized(), second = m.cross(first);
    for (auto const& v : {first, second}) basis.insert(basis.end(), v.data(), v.data() + 3);
  }
}

}  // namespace cayspin::simulation
