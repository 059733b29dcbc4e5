// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random fields on small lattices: the energy falls from iteration to iteration. Converged states
// have no torque and, as the eigenvalues of the Hessian show, no direction of descent.
#include "films.hpp"
#include "least_curvature.hpp"

namespace cayspin::test {
namespace {

class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double uniform(double least, double most) { return least + (most - least) * engine_() * 0x1p-32; }
  std::int64_t whole(std::int64_t least, std::int64_t most) {
    return least + static_cast<std::int64_t>(engine_() % static_cast<unsigned>(most - least + 1));
  }
  double power_of_ten(double least, double most) { return std::pow(10, uniform(least, most)); }
  Vec3<double> vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

 private:
  std::mt19937 engine_;
};

struct RandomScene {
  explicit RandomScene(unsigned seed) : numbers(seed) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lattice.shape[axis] = numbers.whole(1, axis == 0 ? 9 : 3);
      lattice.boundary[axis] = numbers.whole(0, 1) ? Boundary::periodic : Boundary::open;
    }
    exchange = numbers.power_of_ten(-2, 2) * (numbers.whole(0, 3) == 0 ? -1 : 1);
    dmi = numbers.whole(0, 2) == 0 ? 0.5 * std::abs(exchange) * numbers.uniform(0, 1) : 0;
    anisotropy = numbers.whole(0, 3) == 0 ? 0 : numbers.uniform(-1, 1);
    axis = numbers.vector();
    demag = numbers.uniform(0, 1);
    applied = numbers.power_of_ten(-2, 0) * numbers.vector();
  }
  auto field() const {
    return EffectiveField(Exchange(lattice, exchange), InterfacialDmi(lattice, dmi, {0, 0, 1}),
                          UniaxialAnisotropy(anisotropy, axis), SlabDemag({0, 0, 1}, demag),
                          Zeeman{applied});
  }

  Numbers numbers;
  Lattice lattice;
  double exchange = 0, dmi = 0, anisotropy = 0, demag = 0;
  Vec3<double> axis, applied;
};

using Host = SpinField<double, Kokkos::HostSpace>;

TEST(RandomScenes, EndInMinima) {
  Kokkos::DefaultHostExecutionSpace const exec;
  int converged = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    RandomScene const scene(seed);
    auto spins =
        spins_of<Host>(scene.lattice, random_directions(scene.lattice.sites(), seed + 5000));
    double last = energy(exec, scene.field(), spins).value;
    double const field = 12 * std::abs(scene.exchange) + 4;
    auto const found =
        minimize(exec, scene.field(), spins,
                 {.torque = 1e-9 * field, .observer = [&](Minimum const& now) {
                    EXPECT_LE(now.energy.value, last + 16 * epsilon<double> * now.energy.magnitude)
                        << "seed " << seed << ", iteration " << now.iterations;
                    last = now.energy.value;
                    return Next::proceed;
                  }});
    auto const m = numbers_of(spins);
    EXPECT_LT(norm_defect(exec, spins), 4 * epsilon<double>) << seed;
    if (found.end != MinimizeEnd::converged) continue;
    ++converged;
    LandauLifshitz const generator(scene.field(), 0);
    EXPECT_LT(largest_rate(exec, generator, spins), 1.1e-9 * field) << seed;
    if (seed % 5 == 0) {
      double const least = least_curvature(scene.field(), scene.lattice, m);
      EXPECT_GT(least, -1e-6 * field) << seed;
      EXPECT_GE(found.curvature, least - 1e-9 * field) << seed;
    }
  }
  EXPECT_GE(converged, 990);
}

}  // namespace
}  // namespace cayspin::test
