// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The switching slab of Lewis and Nigam 2002: the path of one spin compared with a converged one,
// and lengths of spins.
#include "../support/figures.hpp"
#include "../support/larger.hpp"
#include "../support/unit_slab.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr int samples = 400, watched = 37;
Vector const strong{5, 0, 0}, weak{0.05, 0.05, 0};

struct Path {
  std::vector<Vector> samples;
  double norm_defect = 0;
  Spins end;
};

/// Returns the observed spin at equally spaced times, the largest norm defect at these times, and
/// all spins at the end.
template <class Stepper, class Generator, class... Options>
Path path(Generator const& generator, double end_time, double dt, Options const&... options) {
  Space const exec;
  Path path;
  Spins& spins = path.end = slab_start();
  Stepper stepper(spins, options...);
  auto const steps = std::llround(end_time / samples / dt);
  for (int n = 0; n < samples; ++n) {
    advance(stepper, generator, spins, dt, steps, n * steps);
    path.samples.push_back(spin(spins, watched));
    path.norm_defect = larger(path.norm_defect, norm_defect(exec, spins));
  }
  return path;
}

double distance(Path const& a, Path const& b) {
  double largest = 0;
  for (int n = 0; n < samples; ++n) largest = larger(largest, length(a.samples[n] - b.samples[n]));
  return largest;
}

/// The backward difference, with the sign that sigma has in the paper.
struct PrintedDifference : detail::BackwardDifference {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(detail::TwoPoints<Value>& p) const {
    Vec3<Value> const f = detail::BackwardDifference::operator()(p);
    return Value(Value(2.0) * p.dt) * p.kept - f;
  }
};
struct PrintedMethod : detail::BackwardDifferenceMethod {
  PrintedDifference next(double ratio) const { return {{cap, ratio}}; }
};
struct EulerAsPrinted : TwoPoint<Spins, PrintedMethod, isotropy::Zero, Cayley> {
  explicit EulerAsPrinted(Spins const& like) : TwoPoint("LieEulerAsPrinted", like, {}) {}
};

class SwitchingSlab : public ::testing::Test {
 protected:
  SwitchingSlab(Slab const& slab, double end_time)
      : slab_(slab),
        end_time_(end_time),
        reference_(path<Rkmk4<Spins>>(slab.natural(), end_time, 0.0025)) {}

  template <class Stepper, class Generator, class... Options>
  Path expect(std::string const& what, Generator const& generator, double dt,
              std::string const& distance_figure, std::string const& norm_figure,
              Options const&... options) const {
    Path result = path<Stepper>(generator, end_time_, dt, options...);
    expect_figure(what + ", distance", distance(result, reference_), distance_figure);
    if (norm_figure.empty())
      expect_below(what + ", max ||m| - 1|", result.norm_defect, 1e-14);
    else
      expect_figure(what + ", max ||m| - 1|", result.norm_defect, norm_figure);
    return result;
  }

  Slab slab_;
  double end_time_;
  Path reference_;
};

struct Precessing : SwitchingSlab {
  Precessing() : SwitchingSlab(unit_slab(strong, 0.05), 60) {}
};
struct Overdamped : SwitchingSlab {
  Overdamped() : SwitchingSlab(unit_slab(strong, 1, false), 20) {}
};
struct OverdampedInWeakField : SwitchingSlab {
  OverdampedInWeakField() : SwitchingSlab(unit_slab(weak, 1, false), 20) {}
};

TEST_F(Precessing, Euler) {
  auto const a = slab_.natural();
  expect<ClassicalEuler<Spins>>("Euler, dt 1e-2", a, 1e-2, ".569", ".416");
  expect<ClassicalEuler<Spins>>("Euler, dt 1e-3", a, 1e-3, ".0469", "3.753e-2");
  auto const fine = expect<ClassicalEuler<Spins>>("Euler, dt 1e-4", a, 1e-4, ".0045", "3.699e-3");

  // The mean of ln|m| is dt / 2 * (1 + damping^2) / damping * (E_start - E_end) / N, with energies
  // on the exact path.
  Space const exec;
  double const fall = energy(exec, slab_.field(), slab_start()).value -
                      energy(exec, slab_.field(), reference_.end).value;
  double mean = 0;
  auto const numbers = copy_to_host(fine.end);
  auto const sites = fine.end.sites();
  for (std::int64_t i = 0; i < sites; ++i)
    mean += std::log(length({numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]})) / sites;
  double const law = 0.5e-4 * (1 + 0.05 * 0.05) / 0.05 * fall / sites;
  std::printf("    %-58s %.6g  (law %.6g)\n", "Euler, dt 1e-4, mean ln|m|", mean, law);
  EXPECT_NEAR(mean, law, 0.003 * law);
}

TEST_F(Precessing, EulerRenormalised) {
  expect<ProjectedEuler<Spins>>("Euler renormalised, dt 1e-2", slab_.natural(), 1e-2, ".282", "");
}

TEST_F(Precessing, GeometricEuler) {
  using Shifted = LieEuler<Spins, isotropy::Constant>;
  isotropy::Constant const ten{10};
  auto const natural = slab_.natural();
  auto const orthogonal = slab_.orthogonal();
  expect<LieEuler<Spins>>("default, dt 1e-2", natural, 1e-2, ".037", "");
  expect<LieEuler<Spins>>("orthogonal, dt 1e-2", orthogonal, 1e-2, ".283", "");
  expect<Shifted>("orthogonal, sigma 10, dt 1e-2", orthogonal, 1e-2, ".375", "", ten);
  expect<Shifted>("default, sigma 10, dt 1e-2", natural, 1e-2, ".462", "", ten);
}

TEST_F(Precessing, BackwardDifferenceSigma) {
  using Backward = LieEuler<Spins, isotropy::FiniteDifferenceBackward>;
  auto const natural = slab_.natural();
  expect<Backward>("backward difference, dt 1e-2", natural, 1e-2, ".0061", "");
  expect<EulerAsPrinted>("of the printed sign, dt 1e-2", natural, 1e-2, ".66", "");
}

TEST_F(Overdamped, Euler) {
  auto const a = slab_.natural();
  expect<ClassicalEuler<Spins>>("Euler, dt 1e-2", a, 1e-2, ".0142", "1.9e-2");
  expect<ClassicalEuler<Spins>>("Euler, dt 1e-4", a, 1e-4, ".0001", "1.8e-4");
}

TEST_F(Overdamped, GeometricEuler) {
  auto const a = slab_.natural();
  expect<LieEuler<Spins>>("default, dt 1e-2", a, 1e-2, ".0074", "");
  expect<LieEuler<Spins>>("orthogonal, dt 1e-2", slab_.orthogonal(), 1e-2, ".0074", "");
  expect<LieEuler<Spins, isotropy::FiniteDifferenceBackward>>("backward difference, dt 1e-2", a,
                                                              1e-2, ".0074", "");
}

TEST_F(OverdampedInWeakField, EulerAndGeometricEuler) {
  auto const a = slab_.natural();
  expect<ClassicalEuler<Spins>>("Euler, dt 1e-2", a, 1e-2, ".0017", "1.5e-3");
  expect<ClassicalEuler<Spins>>("Euler, dt 1e-4", a, 1e-4, "0.0000", "1.5e-5");
  expect<LieEuler<Spins>>("geometric Euler, dt 1e-2", a, 1e-2, ".0012", "");
}

}  // namespace
