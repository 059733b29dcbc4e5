// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Paths with too few images for all their saddles.
#include "films.hpp"

#include <cayspin/minimum_energy_path.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::test {
namespace {

template <class Backend>
class FewImages : public MinimizerTest<Backend> {
 protected:
  using Spins = typename MinimizerTest<Backend>::Spins;

  /// Turns spins of a chain over, one after the other.
  MinimumEnergyPath find(std::vector<double> const& constants, std::size_t count) const {
    auto const lattice = Lattice::chain(static_cast<std::int64_t>(constants.size()));
    ScalarField<typename Backend::Real, typename Backend::MemorySpace> const of_sites("k", lattice);
    copy_from_host(constants, of_sites);
    EffectiveField const field(SiteDependentUniaxialAnisotropy(of_sites, {0, 0, 1}),
                               UniaxialAnisotropy(-0.5, {0, 1, 0}), Exchange(lattice, 0.1));
    std::vector<double> up, down;
    for (std::size_t site = 0; site < constants.size(); ++site) {
      up.insert(up.end(), {0, 0, 1});
      down.insert(down.end(), {0, 0, -1});
    }
    std::vector<Spins> images;
    for (std::size_t k = 0; k < count; ++k) images.emplace_back("image", lattice);
    copy_from_host(up, images.front());
    copy_from_host(down, images.back());
    Spins saddle("saddle", lattice);
    return minimum_energy_path(this->exec, field, images, saddle,
                               {.torque = this->is_double ? 1e-8 : 1e-5});
  }
};
TYPED_TEST_SUITE(FewImages, Backends, BackendName);

// The only image between the ends becomes one of the two saddles. From it the energy falls to the
// state with one turned spin, not to the other end.
TYPED_TEST(FewImages, AreNotAPathOverTwoSaddles) {
  auto const found = this->find({1.0, 1.7}, 3);
  EXPECT_EQ(found.end, PathEnd::unsettled);
  EXPECT_TRUE(found.needs_images);
}

TYPED_TEST(FewImages, GiveTheRightBarrierIfTheyConverge) {
  std::vector<std::vector<double>> const chains{{1.0, 1.7}, {1.7, 1.0}, {1.3}};
  for (auto const& constants : chains) {
    auto const many = this->find(constants, 16);
    ASSERT_EQ(many.end, PathEnd::converged);
    EXPECT_FALSE(many.needs_images);
    for (std::size_t count = 3; count < 9; ++count) {
      auto const few = this->find(constants, count);
      if (constants.size() == 1) {
        EXPECT_FALSE(few.needs_images) << count;
      }
      if (few.end != PathEnd::converged) continue;
      EXPECT_NEAR(few.barrier_forward(), many.barrier_forward(), this->is_double ? 1e-9 : 1e-4)
          << count;
    }
  }
}

}  // namespace
}  // namespace cayspin::test
