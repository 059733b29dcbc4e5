// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Minimum energy paths and their saddles: macrospins, walls and the collapse of a skyrmion.
#include "../support/wrong_call.hpp"
#include "films.hpp"

#include <cayspin/minimum_energy_path.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace cayspin::test {
namespace {

template <class Backend>
class Paths : public MinimizerTest<Backend> {
 protected:
  using Spins = typename MinimizerTest<Backend>::Spins;

  struct Found : MinimumEnergyPath {
    std::vector<Spins> images;
    Spins saddle_spins;
  };

  template <class Field>
  Found find(Field const& field, Lattice const& lattice, std::vector<double> const& from,
             std::vector<double> const& to, PathOptions const& options = {},
             std::size_t count = 16) const {
    Found found{{}, {}, Spins("saddle", lattice)};
    for (std::size_t k = 0; k < count; ++k) found.images.emplace_back("image", lattice);
    copy_from_host(from, found.images.front());
    copy_from_host(to, found.images.back());
    static_cast<MinimumEnergyPath&>(found) =
        minimum_energy_path(this->exec, field, found.images, found.saddle_spins, options);
    return found;
  }
  PathOptions options() const { return {.torque = this->is_double ? 1e-8 : 1e-5}; }
  static double exact() { return MinimizerTest<Backend>::is_double ? 1e-12 : 1e-5; }
};
TYPED_TEST_SUITE(Paths, Backends, BackendName);

std::vector<double> const up{0, 0, 1}, down{0, 0, -1};

// E = -easy * m_z^2 / 2 + hard * m_y^2 / 2 - h.m; paths lie in the plane of x and z.
auto macrospin(double easy, double hard, Vec3<double> const& applied) {
  return EffectiveField(UniaxialAnisotropy(easy, {0, 0, 1}), UniaxialAnisotropy(-hard, {0, 1, 0}),
                        Zeeman{applied});
}

// Henkelman and Jonsson's tangent: at an extremum, the larger difference of energies is the weight
// of the side with the higher neighbour.
TEST(PathDirection, WeighsBothSidesOfAPeak) {
  using Weights = std::array<double, 2>;
  EXPECT_EQ(detail::weights_of_direction(1, 3, 2), (Weights{1, 2}));
  EXPECT_EQ(detail::weights_of_direction(2, 3, 1), (Weights{2, 1}));
  EXPECT_EQ(detail::weights_of_direction(4, 1, 2), (Weights{3, 1}));
  EXPECT_EQ(detail::weights_of_direction(1, 2, 3), (Weights{0, 1}));
  EXPECT_EQ(detail::weights_of_direction(3, 2, 1), (Weights{1, 0}));
  EXPECT_EQ(detail::weights_of_direction(2, 2, 2), (Weights{1, 1}));
}

TYPED_TEST(Paths, OfAMacrospinAcrossAField) {
  double const easy = 1.3, applied = 0.4;
  auto const found = this->find(macrospin(easy, 0.7, {applied, 0, 0}), Lattice::chain(1), up, down,
                                this->options());
  ASSERT_EQ(found.end, PathEnd::converged);
  double const barrier = 0.5 * easy * std::pow(1 - applied / easy, 2);
  EXPECT_NEAR(found.barrier_forward(), barrier, this->exact());
  EXPECT_NEAR(found.barrier_backward(), barrier, this->exact());
  EXPECT_NEAR(found.saddle().curvature, applied - easy, 1e-5);
  EXPECT_LT(found.evaluations, 60 * 16);
  EXPECT_EQ(found.saddles.size(), 1U);
  EXPECT_NEAR(at(numbers_of(found.saddle_spins), 0).x, 1, 1e-5);
}

TYPED_TEST(Paths, OfAMacrospinAlongAField) {
  double const easy = 1.3, applied = 0.4;
  auto const found = this->find(macrospin(easy, 0.7, {0, 0, applied}), Lattice::chain(1), up, down,
                                this->options());
  ASSERT_EQ(found.end, PathEnd::converged);
  EXPECT_NEAR(found.barrier_forward(), 0.5 * easy * std::pow(1 + applied / easy, 2), this->exact());
  EXPECT_NEAR(found.barrier_backward(), 0.5 * easy * std::pow(1 - applied / easy, 2),
              this->exact());
}

// The path leaves a state that points against a strong field. The barrier is about a thirtieth of
// the difference in energy between the ends.
TYPED_TEST(Paths, OfAMacrospinWithALowBarrier) {
  double const easy = 1.3, applied = 0.9;
  auto const found = this->find(macrospin(easy, 0.7, {0, 0, applied}), Lattice::chain(1), down, up,
                                this->options());
  ASSERT_EQ(found.end, PathEnd::converged);
  EXPECT_NEAR(found.barrier_forward(), 0.5 * easy * std::pow(1 - applied / easy, 2), this->exact());
}

// The energy falls steeply between close images, and the direction of the path at an image depends
// on the neighbour with the higher energy. A chain with strong exchange turns as one spin.
TYPED_TEST(Paths, SettleWithManyImagesInAnyField) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> fields(0.2, 0.9);
  std::uniform_int_distribution<int> images(16, 64), sites(2, 32);
  for (int scene = 0; scene < 6; ++scene) {
    double const applied = scene == 0 ? 0.9 : fields(engine);
    int const count = scene == 0 ? 64 : images(engine), length = scene % 2 == 0 ? 1 : sites(engine);
    auto const lattice = Lattice::chain(length);
    EffectiveField const field(UniaxialAnisotropy(1, {0, 0, 1}), Zeeman{{0, 0, -applied}},
                               Exchange(lattice, length > 1 ? 400 : 0));
    std::vector<double> from, to;
    for (int site = 0; site < length; ++site) {
      from.insert(from.end(), up.begin(), up.end());
      to.insert(to.end(), down.begin(), down.end());
    }
    auto options = this->options();
    if (length > 1) options.torque = this->is_double ? 1e-6 : 1e-3;
    auto const found =
        this->find(field, lattice, from, to, options, static_cast<std::size_t>(count));
    ASSERT_EQ(found.end, PathEnd::converged) << applied << ' ' << count << ' ' << length;
    double const barrier = 0.5 * length * std::pow(1 - applied, 2);
    EXPECT_NEAR(found.barrier_forward(), barrier, this->is_double ? 1e-10 : 1e-4 * length);
  }
}

// The extrema of Stoner and Wohlfarth's energy, at any angle, are found by Newton's method.
TYPED_TEST(Paths, OfAMacrospinAtAnAngleToAField) {
  double const easy = 1, applied = 0.3;
  for (double const angle : {0.2, 0.7, 1.2}) {
    auto const energy = [&](double theta) {
      return -0.5 * easy * std::pow(std::cos(theta), 2) - applied * std::cos(theta - angle);
    };
    auto const extremum = [&](double theta) {
      for (int step = 0; step < 50; ++step)
        theta -= (0.5 * easy * std::sin(2 * theta) + applied * std::sin(theta - angle)) /
                 (easy * std::cos(2 * theta) + applied * std::cos(theta - angle));
      return energy(theta);
    };
    auto const found =
        this->find(macrospin(easy, 0.5, {applied * std::sin(angle), 0, applied * std::cos(angle)}),
                   Lattice::chain(1), up, {0.6, 0, -0.8}, this->options());
    ASSERT_EQ(found.end, PathEnd::converged);
    EXPECT_NEAR(found.barrier_forward(), extremum(1.8) - extremum(0.1), this->exact()) << angle;
    EXPECT_NEAR(found.barrier_backward(), extremum(1.8) - extremum(3.1), this->exact()) << angle;
  }
}

// Except for a small disturbance, the path starts as the great circle through the hard axis, which
// has the highest barrier of all paths.
TYPED_TEST(Paths, LeaveAHardAxis) {
  EffectiveField const field(UniaxialAnisotropy(1, {0, 0, 1}), UniaxialAnisotropy(-0.7, {1, 0, 0}));
  auto const found = this->find(field, Lattice::chain(1), up, down, this->options());
  ASSERT_EQ(found.end, PathEnd::converged);
  EXPECT_NEAR(found.barrier_forward(), 0.5, this->exact());
  EXPECT_NEAR(std::abs(at(numbers_of(found.saddle_spins), 0).y), 1, 1e-5);
}

// Strong exchange must not hide that the path has not yet left the hard axis.
TYPED_TEST(Paths, OfAStiffChainLeaveAHardAxis) {
  constexpr std::int64_t length = 16;
  auto const lattice = Lattice::chain(length);
  EffectiveField const field(UniaxialAnisotropy(1, {0, 0, 1}), UniaxialAnisotropy(-0.7, {1, 0, 0}),
                             Exchange(lattice, 400));
  std::vector<double> from, to;
  for (std::int64_t site = 0; site < length; ++site) {
    from.insert(from.end(), up.begin(), up.end());
    to.insert(to.end(), down.begin(), down.end());
  }
  auto const found =
      this->find(field, lattice, from, to, {.torque = this->is_double ? 1e-6 : 1e-3});
  ASSERT_EQ(found.end, PathEnd::converged);
  EXPECT_NEAR(found.barrier_forward(), 0.5 * length, this->is_double ? 1e-8 : 1e-3);
  EXPECT_LT(found.across, 0.1);
  for (std::size_t k = 0; k < found.images.size(); ++k) {
    auto const spins = numbers_of(found.images[k]);
    double easy = 0;
    for (std::size_t z = 2; z < spins.size(); z += 3) easy -= 0.5 * spins[z] * spins[z];
    EXPECT_NEAR(found.energy[k], easy, 0.01 * length) << k;
  }
}

// A direction with which the field is measured may be normal to the easy axis.
TYPED_TEST(Paths, BetweenEasyAxesInAnyDirection) {
  for (Vec3<double> axis : {Vec3<double>{2, -1, 0}, Vec3<double>{1, 1, -1}, Vec3<double>{1, -2, 1},
                            Vec3<double>{4, 1, -2}}) {
    axis = 1 / std::sqrt(dot(axis, axis)) * axis;
    EffectiveField const field(UniaxialAnisotropy(1, axis));
    auto const found = this->find(field, Lattice::chain(1), {axis.x, axis.y, axis.z},
                                  {-axis.x, -axis.y, -axis.z}, this->options());
    ASSERT_EQ(found.end, PathEnd::converged) << axis.x << axis.y << axis.z;
    EXPECT_NEAR(found.barrier_forward(), 0.5, this->exact());
  }
}

// Two spins that turn one after the other: two saddles, and the higher one counts.
TYPED_TEST(Paths, HaveTwoSaddles) {
  auto const lattice = Lattice::chain(2);
  ScalarField<typename TypeParam::Real, typename TypeParam::MemorySpace> const constants("k",
                                                                                         lattice);
  copy_from_host(std::vector<double>{1.0, 1.7}, constants);
  double const coupling = 0.1;
  EffectiveField const field(SiteDependentUniaxialAnisotropy(constants, {0, 0, 1}),
                             UniaxialAnisotropy(-0.5, {0, 1, 0}), Exchange(lattice, coupling));
  auto options = this->options();
  std::int64_t evaluations = 0;
  options.observer = [&](PathProgress const& now) {
    EXPECT_GE(now.evaluations, evaluations);
    evaluations = now.evaluations;
    return Next::proceed;
  };
  auto const found = this->find(field, lattice, {0, 0, 1, 0, 0, 1}, {0, 0, -1, 0, 0, -1}, options);
  ASSERT_EQ(found.end, PathEnd::converged);
  ASSERT_EQ(found.saddles.size(), 2U);
  // At each saddle, one spin is nearly perpendicular to its easy axis, and the other is tilted by
  // the coupling. Newton's method finds both angles.
  auto const energy = [&](double a, double b) {
    return -0.5 * std::pow(std::cos(a), 2) - 0.85 * std::pow(std::cos(b), 2) -
           coupling * (std::cos(a - b) - 1);
  };
  auto const saddle = [&](double a, double b) {
    for (int step = 0; step < 50; ++step) {
      double const s = coupling * std::sin(a - b), c = coupling * std::cos(a - b);
      double const ga = 0.5 * std::sin(2 * a) + s, gb = 0.85 * std::sin(2 * b) - s;
      double const aa = std::cos(2 * a) + c, bb = 1.7 * std::cos(2 * b) + c, det = aa * bb - c * c;
      a -= (bb * ga + c * gb) / det;
      b -= (aa * gb + c * ga) / det;
    }
    return energy(a, b);
  };
  double const start = -0.5 - 0.85;
  EXPECT_NEAR(found.saddles[0].energy, saddle(std::numbers::pi, 1.5), this->exact());
  EXPECT_NEAR(found.saddles[1].energy, saddle(1.5, 0), this->exact());
  EXPECT_NEAR(found.energy.front(), start, this->exact());
  for (auto const& known : found.saddles) EXPECT_EQ(found.energy[known.image], known.energy);
}

// The wall may be anywhere. It is 5 sites wide, so its energy is nearly that of the continuum,
// 2 * sqrt(A * K).
TYPED_TEST(Paths, OfAWallThroughAChain) {
  auto const lattice = Lattice::chain(100);
  EffectiveField const field(Exchange(lattice, 10), UniaxialAnisotropy(0.4, {0, 0, 1}),
                             UniaxialAnisotropy(-0.3, {0, 1, 0}));
  std::vector<double> from, to;
  for (int site = 0; site < 100; ++site) {
    from.insert(from.end(), up.begin(), up.end());
    to.insert(to.end(), down.begin(), down.end());
  }
  auto const found =
      this->find(field, lattice, from, to, {.torque = this->is_double ? 1e-6 : 1e-4});
  if (this->is_double) {
    EXPECT_EQ(found.end, PathEnd::converged);
  }
  ASSERT_FALSE(found.saddles.empty());
  EXPECT_NEAR(found.barrier_forward(), 2 * std::sqrt(10 * 0.4), 0.01);
}

struct Skyrmion {
  Lattice lattice;
  std::vector<double> spins, uniform;
};

// As in the tests of other programs: J = 10 meV, D = 6 meV, and 25 T on two Bohr magnetons.
auto skyrmion_field(Lattice const& lattice) {
  return EffectiveField(Exchange(lattice, 10.0), BulkDmi(lattice, 6.0),
                        Zeeman{{0, 0, 2.894190905}});
}

Skyrmion skyrmion(std::int64_t n, double x0, double y0) {
  Skyrmion state{
      {{n, n, 1}, {1, 1, 1}, {Boundary::periodic, Boundary::periodic, Boundary::open}}, {}, {}};
  for (std::int64_t j = 0; j < n; ++j)
    for (std::int64_t i = 0; i < n; ++i) {
      double const x = static_cast<double>(i) - x0, y = static_cast<double>(j) - y0;
      double const r = std::hypot(x, y) + 1e-12;
      double const angle = std::numbers::pi * std::exp(-std::pow(r / 4, 1.5));
      for (double const c : {-y / r * std::sin(angle), x / r * std::sin(angle), std::cos(angle)})
        state.spins.push_back(c);
      state.uniform.insert(state.uniform.end(), up.begin(), up.end());
    }
  return state;
}

TYPED_TEST(Paths, OfASkyrmionThatCollapses) {
  for (double const x : {8.0, 7.7}) {
    auto const state = skyrmion(16, x, 2 * x - 8);
    auto const found = this->find(skyrmion_field(state.lattice), state.lattice, state.spins,
                                  state.uniform, {.torque = this->is_double ? 1e-6 : 1e-3});
    ASSERT_EQ(found.end, PathEnd::converged);
    double const tolerance = this->is_double ? 1e-6 : 1e-2;
    // In the other programs, unlike here, parallel spins have the exchange energy -2 * 256 * 10.
    EXPECT_NEAR(found.saddle().energy, -5811.52452552 + 2 * 256 * 10, tolerance);
    EXPECT_NEAR(found.barrier_forward(), 38.16697354, tolerance);
    EXPECT_NEAR(found.barrier_backward(), 49.38834616, tolerance);
    EXPECT_NEAR(found.saddle().curvature, -11.821835, this->is_double ? 1e-5 : 1e-2);
    EXPECT_NEAR(magnetization(this->exec, found.saddle_spins).z, 0.966573, 1e-5);
    EXPECT_EQ(*std::ranges::max_element(found.energy), found.saddle().energy);
  }
}

// The first image is relaxed beforehand. The number of evaluations does not depend on the size of
// the lattice.
TYPED_TEST(Paths, TakeFewEvaluations) {
  double const torque = this->is_double ? 1e-6 : 1e-3;
  for (std::int64_t const n : {16, 48}) {
    double const middle = static_cast<double>(n) / 2;
    auto state = skyrmion(n, middle, middle);
    auto const field = skyrmion_field(state.lattice);
    auto spins = spins_of<typename TestFixture::Spins>(state.lattice, state.spins);
    minimize(this->exec, field, spins, {.torque = torque});
    auto const found =
        this->find(field, state.lattice, numbers_of(spins), state.uniform, {.torque = torque});
    ASSERT_EQ(found.end, PathEnd::converged);
    EXPECT_LE(found.evaluations, 60 * 16) << n;
  }
}

// An observer can stop a search for a saddle, also between the products with the Hessian.
TYPED_TEST(Paths, StopAtOnce) {
  auto const state = skyrmion(16, 8, 8);
  auto options = this->options();
  options.torque = this->is_double ? 1e-6 : 1e-3;
  std::int64_t asked = 0, last = 0;
  options.observer = [&](PathProgress const& now) {
    last = now.evaluations;
    return now.evaluations < asked ? Next::proceed : Next::stop;
  };
  for (asked = 400; asked < 700; asked += 37) {
    auto const found = this->find(skyrmion_field(state.lattice), state.lattice, state.spins,
                                  state.uniform, options);
    EXPECT_EQ(found.end, PathEnd::interrupted) << asked;
    EXPECT_LT(last, asked + 120) << asked;
  }
}

/// E = -m_z^2, and NaN near the equator.
struct HoleAtTheEquator {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Vec3<Value>{Value(0.0), Value(0.0), Value(2.0) * within(stencil.center().z)};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const z = within(stencil.center().z);
    return Value(-z * z);
  }

 private:
  template <class Value>
  KOKKOS_FUNCTION static Value within(Value const& z) {
    return select<Value>(z * z < Value(0.09), Value(std::numeric_limits<float>::quiet_NaN()), z);
  }
};

TYPED_TEST(Paths, EndWhereTheFieldIsNotFinite) {
  EffectiveField const field(HoleAtTheEquator{});
  auto const found = this->find(field, Lattice::chain(1), up, down, this->options(), 5);
  EXPECT_EQ(found.end, PathEnd::not_finite);
}

// Copies of a field share its memory.
TYPED_TEST(Paths, NeedMemoryForEachImage) {
  using Spins = typename TestFixture::Spins;
  auto const field = macrospin(1, 0.5, {0.1, 0, 0});
  auto const lattice = Lattice::chain(1);
  Spins saddle("saddle", lattice);
  std::vector<Spins> copies(5, Spins("image", lattice)), images;
  for (int k = 0; k < 5; ++k) images.emplace_back("image", lattice);
  auto overlapping = images;
  overlapping[1] = overlapping[3];
  expect_refused({
      {"copies", [&] { minimum_energy_path(this->exec, field, copies, saddle); }},
      {"two images", [&] { minimum_energy_path(this->exec, field, overlapping, saddle); }},
      {"saddle", [&] { minimum_energy_path(this->exec, field, images, images[2]); }},
  });
}

TYPED_TEST(Paths, AreRefused) {
  auto const field = macrospin(1, 0.5, {0.1, 0, 0});
  EXPECT_THROW(this->find(field, Lattice::chain(1), up, down, {}, 2), std::invalid_argument);
  EXPECT_EQ(this->find(field, Lattice::chain(1), up, {0.6, 0, 0.8}, this->options()).end,
            PathEnd::same_ends);
  auto limited = this->options();
  limited.evaluations = 100;
  EXPECT_EQ(this->find(field, Lattice::chain(1), up, down, limited).end, PathEnd::evaluation_limit);
  int steps = 0;
  auto stopped = this->options();
  stopped.observer = [&](PathProgress const&) { return ++steps < 5 ? Next::proceed : Next::stop; };
  EXPECT_EQ(this->find(field, Lattice::chain(1), up, down, stopped).end, PathEnd::interrupted);
}

}  // namespace
}  // namespace cayspin::test
