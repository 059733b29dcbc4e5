// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compares CVODE of SUNDIALS with cayspin's methods on one thread, with the same kernel for the
// right-hand side: prints the milliseconds and evaluations that each takes to reach given errors.
// `bench_cvode [SCENE..]`; without names it runs all scenes: slab_fine, slab_fine_damped, film,
// heisenberg, film_256. The error is the largest distance of any spin, at four times, from a run of
// tsit5 with a tolerance of 1e-12, after the spins have been divided by their lengths. Times are
// the shortest of several runs.
#include "cvode_run.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/stepper/stiff_gauss.hpp>
#include <cayspin/stepper/tableau_dormand_prince8.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

namespace {

using namespace cayspin;
using ladder::Ladder;
using ladder::Spins;
using ladder::start_of;

std::vector<double> const errors{1e-2, 5e-4, 1e-6};

template <class Generator>
struct Problem {
  char const* name;
  Lattice lattice;
  Generator generator;
  double field_bound, damping, horizon;
  std::vector<double> start;
  ladder::Limits limits = {};
};

template <bool Smooth, class Generator>
class Comparison {
 public:
  explicit Comparison(Problem<Generator> const& problem)
      : problem_(problem), like_("bench::like", problem.lattice) {
    AdaptiveStereographic<Spins> fine(like_, {.tolerance = 1e-12}),
        less(like_, {.tolerance = 1e-11});
    reference_ = run(fine, ladder::looks).states;
    std::printf("\n%s, to t = %g: tsit5 at 1e-11 and 1e-12 agree to %.1e\n", problem_.name,
                problem_.horizon, ladder::distance(run(less, ladder::looks).states, reference_));
  }

  void print() {
    explicit_steps<ProjectedRungeKutta<Spins, tableau::Oscillatory64>>("projected_rk64");
    explicit_steps<ProjectedRungeKutta<Spins, tableau::Oscillatory74>>("projected_rk74");
    explicit_steps<ProjectedRungeKutta<Spins, tableau::DormandPrince8>>("projected_rk8");
    add("tsit5 tangent", true, [&](int rung) {
      AdaptiveStereographic<Spins> stepper(like_, {.tolerance = 0.1 * std::pow(10, -0.5 * rung)});
      return run(stepper, ladder::looks);
    });
    if constexpr (Smooth)
      stiff_steps();
    else
      steps_with_sigma();
    cvode("CVODE Adams, fixed point", {.method = CV_ADAMS, .max_order = 12});
    for (bool const preconditioned : {false, true})
      for (int const order : {5, 2})
        cvode("CVODE BDF to order " + std::to_string(order) +
                  (preconditioned ? ", preconditioned" : ""),
              {.max_order = order, .preconditioned = preconditioned});
    ladder::print(ladders_, errors);
  }

 private:
  template <class Stepper>
  ladder::Run run(Stepper& stepper, std::int64_t steps) const {
    return ladder::take_steps(stepper, problem_.generator, problem_.lattice, problem_.start,
                              problem_.horizon, steps);
  }
  template <class Run>
  void add(std::string const& name, bool is_own, Run const& run) {
    ladders_.push_back(ladder::climb(name, is_own, reference_, problem_.limits, run));
    std::fprintf(stderr, "%-34s", name.c_str());
    for (auto const& rung : ladders_.back().rungs)
      std::fprintf(stderr, " %.1e/%.2g/%.0f", rung.error, 1e3 * rung.seconds, rung.evaluations);
    std::fprintf(stderr, "\n");
  }
  template <class Make>
  void equal_steps(std::string const& name, Make const& make, double largest) {
    add(name, true, [&](int rung) {
      auto stepper = make(like_);
      return run(stepper, ladder::steps_of(rung, problem_.horizon / largest));
    });
  }
  template <class Stepper>
  void explicit_steps(std::string const& name) {
    equal_steps(
        name, [](Spins const& like) { return Stepper(like); },
        largest_stable_step<Stepper>(problem_.field_bound, problem_.damping));
  }
  void stiff_steps() {
    add("stiff4", true, [&](int rung) {
      StiffGauss4<Spins> stepper(like_);
      try {
        return run(stepper, ladder::steps_of(rung, ladder::looks));
      } catch (NotConverged const&) {
        return ladder::Run{};
      }
    });
  }
  /// A method of order 8 that is suited only to disordered spins with nothing but exchange.
  void steps_with_sigma() {
    using Plain = Rkmk<Spins, tableau::DormandPrince8>;
    using WithSigma = Rkmk<Spins, tableau::DormandPrince8, isotropy::Constant>;
    equal_steps(
        "rkmk8 sigma 6", [](Spins const& like) { return WithSigma(like, {6}); },
        largest_stable_step<Plain>(problem_.field_bound, problem_.damping));
  }
  void cvode(std::string const& name, by_sundials::CvodeOptions const& options) {
    by_sundials::Cvode<Generator> solver(problem_.lattice, problem_.generator, options);
    // The limit ends runs that a loose tolerance makes unstable.
    double const rate = problem_.field_bound * std::hypot(1, problem_.damping);
    auto const most = static_cast<std::int64_t>(50000 + 20 * problem_.horizon * rate);
    add(name, false, [&](int rung) {
      return solver.run(problem_.start, problem_.horizon, std::pow(10, -1 - 0.5 * rung), most);
    });
  }

  Problem<Generator> const& problem_;
  Spins like_;
  ladder::States reference_;
  std::vector<Ladder> ladders_;
};

void slab_fine(char const* name, double damping) {
  auto const lattice = Lattice::chain(100, 0.01);
  LandauLifshitz const generator(
      EffectiveField(Exchange(lattice, 1.0), UniaxialAnisotropy(1.0, {0, 0, 1}),
                     Zeeman{{0.05, 0.05, 0}}, SlabDemag({1, 0, 0})),
      damping);
  auto const start = start_of(lattice, [](double x, double, double) {
    return Vec3<double>{0.3 + 0.2 * std::cos(std::numbers::pi * x),
                        0.5 + 0.1 * std::cos(2 * std::numbers::pi * x), 0.8};
  });
  Problem problem{name, lattice, generator, exchange_bound(lattice, 1) + 2.1, damping, 0.5, start};
  Comparison<true, decltype(problem.generator)> comparison(problem);
  comparison.print();
}

void film(char const* name, std::int64_t n, double exchange, double anisotropy, double damping,
          double horizon) {
  auto const lattice = Lattice::square(n, n);
  LandauLifshitz const generator(
      EffectiveField(Exchange(lattice, exchange), UniaxialAnisotropy(anisotropy, {1, 0, 0}),
                     Zeeman{{0, 0, 0}}, SlabDemag({0, 0, 1})),
      damping);
  auto const start = start_of(lattice, [](double x, double y, double) {
    using std::numbers::pi;
    return Vec3<double>{0.3 + std::cos(pi * y), 0.2 + 0.5 * std::cos(pi * x),
                        0.1 + 0.4 * std::cos(pi * x) * std::cos(2 * pi * y)};
  });
  Problem problem{name,    lattice, generator, exchange_bound(lattice, exchange) + anisotropy + 1,
                  damping, horizon, start};
  Comparison<true, decltype(problem.generator)> comparison(problem);
  comparison.print();
}

void heisenberg(char const* name) {
  auto const lattice = Lattice::cubic(8, 8, 8, 1, Boundary::periodic);
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1.0)), 0);
  auto const start = start_of(lattice, [](double, double, double site) {
    auto const number = [&](int n) {
      double const far = 43758.5 * std::sin(site + n);
      return 2.4 * (far - std::rint(far));
    };
    return Vec3<double>{number(1), number(2), 1 + number(3)};
  });
  Problem problem{name, lattice, generator, exchange_bound(lattice, 1), 0, 8, start};
  Comparison<false, decltype(problem.generator)> comparison(problem);
  comparison.print();
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  if (!ladder::has_one_thread()) return 2;
  std::pair<char const*, std::function<void(char const*)>> const scenes[] = {
      {"slab_fine", [](auto name) { slab_fine(name, 0.05); }},
      {"slab_fine_damped", [](auto name) { slab_fine(name, 0.5); }},
      {"film", [](auto name) { film(name, 16, 2, 0.1, 0.1, 20); }},
      {"heisenberg", heisenberg},
      {"film_256", [](auto name) { film(name, 256, 32.3, 0, 0.05, 5); }},
  };
  for (auto const& [name, compare] : scenes) {
    bool wanted = argc == 1;
    for (int i = 1; i < argc; ++i) wanted |= std::strcmp(argv[i], name) == 0;
    if (wanted) compare(name);
  }
}
