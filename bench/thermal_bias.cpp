// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Bias of thermal averages due to steps of length dt: cayspin's noise before and after its steps,
// next to three schemes of other programs, reimplemented here. Prints one line per scheme, damping
// and dt: the error of <m_z> in a field of twice the temperature (Langevin), of <m_z^2> of a
// uniaxial spin with K of six times the temperature, and of <m.m'> of neighbours on a chain with
// J of three times the temperature (Fisher 1964). Each error is printed with its standard error.
//   bench_thermal_bias [sites] [time]
#include <cayspin/cayspin.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace {

using cayspin::Vec3;
using Vector = Vec3<double>;
using Vectors = std::vector<Vector>;
using Spins = cayspin::SpinField<double, Kokkos::HostSpace>;
using Exec = Kokkos::DefaultHostExecutionSpace;

/// A mean with its standard error, from equally long blocks of samples. Samples at the start that
/// do not fill a block are left out.
struct Estimate {
  double mean = 0, error = 0;
};
Estimate estimate(std::vector<double> const& samples) {
  constexpr std::size_t blocks = 16;
  std::size_t const length = samples.size() / blocks, first = samples.size() % blocks;
  std::array<double, blocks> block{};
  for (std::size_t i = first; i < samples.size(); ++i)
    block[(i - first) / length] += samples[i] / double(length);
  Estimate all;
  for (double const one : block) all.mean += one / blocks;
  for (double const one : block) all.error += (one - all.mean) * (one - all.mean);
  all.error = std::sqrt(all.error / (blocks * (blocks - 1)));
  return all;
}

struct Langevin {
  static constexpr char const* name = "Langevin";
  static constexpr double temperature = 0.5;
  static double exact() { return 1 / std::tanh(2.0) - 0.5; }
  static auto field(cayspin::Lattice const&) {
    return cayspin::EffectiveField(cayspin::Zeeman{{0, 0, 1}});
  }
  static Vector field(Vectors const&, std::size_t, Vector const&) { return {0, 0, 1}; }
  static double value(Vectors const& m, std::size_t i) { return m[i].z; }
};
struct Uniaxial {
  static constexpr char const* name = "uniaxial";
  static constexpr double temperature = 1.0 / 3;  // E = -m_z^2
  static double exact() {
    double weights = 0, squares = 0;
    for (int i = 0; i < 100000; ++i) {
      double const z = (i + 0.5) / 100000, weight = std::exp(3 * z * z);
      weights += weight;
      squares += weight * z * z;
    }
    return squares / weights;
  }
  static auto field(cayspin::Lattice const&) {
    return cayspin::EffectiveField(cayspin::UniaxialAnisotropy(2, {0, 0, 1}));
  }
  static Vector field(Vectors const&, std::size_t, Vector const& own) { return {0, 0, 2 * own.z}; }
  static double value(Vectors const& m, std::size_t i) { return m[i].z * m[i].z; }
};
struct Chain {
  static constexpr char const* name = "chain";
  static constexpr double temperature = 1.0 / 3;  // J = 1
  static double exact() { return 1 / std::tanh(3.0) - 1.0 / 3; }
  static auto field(cayspin::Lattice const& lattice) {
    return cayspin::EffectiveField(cayspin::Exchange(lattice, 1));
  }
  static Vector field(Vectors const& m, std::size_t i, Vector const&) {
    return m[i == 0 ? m.size() - 1 : i - 1] + m[i + 1 == m.size() ? 0 : i + 1];
  }
  static double value(Vectors const& m, std::size_t i) {
    return dot(m[i], m[i + 1 == m.size() ? 0 : i + 1]);
  }
};

template <class System>
double mean_of(Vectors const& m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.size(); ++i) sum += System::value(m, i);
  return sum / double(m.size());
}

Vectors vectors_of(Spins const& spins) {
  auto const numbers = copy_to_host(spins);
  Vectors m(numbers.size() / 3);
  for (std::size_t i = 0; i < m.size(); ++i)
    m[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  return m;
}

struct Run {
  std::int64_t sites;
  double time, damping, dt;

  std::int64_t steps() const { return std::llround(time / dt); }
  std::int64_t settled() const { return steps() / 5; }
  std::int64_t every() const { return std::max<std::int64_t>(1, std::llround(0.4 / dt)); }
};

template <class Stepper, class System>
Estimate ours(Run const& run) {
  using namespace cayspin;
  auto const lattice = Lattice::chain(run.sites, 1, Boundary::periodic);
  Spins spins("spins", lattice);
  std::vector<double> start(static_cast<std::size_t>(3 * run.sites), 0);
  for (std::size_t i = 2; i < start.size(); i += 3) start[i] = 1;
  copy_from_host(start, spins);
  LandauLifshitz const generator(System::field(lattice), run.damping);
  ThermalNoise<Spins> const noise(spins, run.damping,
                                  {.temperature = System::temperature, .seed = 1});
  Stepper stepper(spins);
  std::vector<double> samples;
  auto const look = [&](Exec const&, Step const& step, Spins const& now) {
    if (step.number >= run.settled() && step.number % run.every() == 0)
      samples.push_back(mean_of<System>(vectors_of(now)));
  };
  Times const times{0, run.dt, run.steps()};
  integrate(Exec(), stepper, generator, spins, times, noise.after_steps(times), look,
            noise.before_steps());
  return estimate(samples);
}

Vector normalized(Vector const& m) { return (1 / std::sqrt(dot(m, m))) * m; }
Vector by_cayley(Vector const& f, Vector const& m) {
  Vector const fm = cross(f, m);
  return m + (1 / (1 + dot(f, f) / 4)) * (fm + 0.5 * cross(f, fm));
}
Vector by_rotation(Vector const& f, Vector const& m) {
  double const angle = std::sqrt(dot(f, f));
  if (angle == 0) return m;
  Vector const e = (1 / angle) * f, em = cross(e, m);
  return m + std::sin(angle) * em + (1 - std::cos(angle)) * cross(e, em);
}

/// A scheme predicts spins by guess(a, m), where a = dt * A(m), then takes its step with the field
/// of the spins that `at` returns. In step(), `first` is dt * A(m), and `a` is dt * A of those
/// spins.
struct HeunAndRenormalise {
  static constexpr char const* name = "Heun, renormalised";
  static Vector guess(Vector const& a, Vector const& m) { return normalized(m + cross(a, m)); }
  static Vector at(Vector const&, Vector const& guess) { return guess; }
  static Vector step(Vector const& first, Vector const& a, Vector const& m, Vector const& guess) {
    return normalized(m + 0.5 * (cross(first, m) + cross(a, guess)));
  }
};
/// J. Mentink et al., J. Phys. Condens. Matter 22, 176001 (2010): SIB.
struct SemiImplicitB {
  static constexpr char const* name = "semi-implicit B";
  static Vector guess(Vector const& a, Vector const& m) { return by_cayley(a, m); }
  static Vector at(Vector const& m, Vector const& guess) { return 0.5 * (m + guess); }
  static Vector step(Vector const&, Vector const& a, Vector const& m, Vector const&) {
    return by_cayley(a, m);
  }
};
/// P. Depondt and F. Mertens, J. Phys. Condens. Matter 21, 336005 (2009).
struct DepondtMertens {
  static constexpr char const* name = "Depondt-Mertens";
  static Vector guess(Vector const& a, Vector const& m) { return by_rotation(a, m); }
  static Vector at(Vector const&, Vector const& guess) { return guess; }
  static Vector step(Vector const& first, Vector const& a, Vector const& m, Vector const&) {
    return by_rotation(0.5 * (first + a), m);
  }
};

template <class Scheme, class System>
Estimate theirs(Run const& run) {
  auto const sites = static_cast<std::size_t>(run.sites);
  double const lambda = run.damping;
  double const deviation =
      std::sqrt(2 * lambda * System::temperature / (1 + lambda * lambda) / run.dt);
  Vectors m(sites, {0, 0, 1}), noise(sites), first(sites), guess(sites), between(sites),
      next(sites);
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal(0, deviation);
  auto const rate = [&](Vectors const& of, std::size_t i) {
    Vector const h = System::field(of, i, of[i]) + noise[i];
    return run.dt * (h + lambda * cross(of[i], h));
  };
  std::vector<double> samples;
  for (std::int64_t step = 1; step <= run.steps(); ++step) {
    for (auto& b : noise) b = {normal(engine), normal(engine), normal(engine)};
    for (std::size_t i = 0; i < sites; ++i) {
      first[i] = rate(m, i);
      guess[i] = Scheme::guess(first[i], m[i]);
      between[i] = Scheme::at(m[i], guess[i]);
    }
    for (std::size_t i = 0; i < sites; ++i)
      next[i] = Scheme::step(first[i], rate(between, i), m[i], guess[i]);
    m.swap(next);
    if (step >= run.settled() && step % run.every() == 0) samples.push_back(mean_of<System>(m));
  }
  return estimate(samples);
}

template <class System>
using Scheme = Estimate (*)(Run const&);

void print_line(char const* name, int evaluations, Run const& run, Scheme<Langevin> langevin,
                Scheme<Uniaxial> uniaxial, Scheme<Chain> chain) {
  std::printf("%-20s %d %8.2f %6.2f", name, evaluations, run.damping, run.dt);
  auto const print = [](Estimate const& found, double exact) {
    std::printf("  %8.4f +- %.4f", found.mean - exact, found.error);
    std::fflush(stdout);
  };
  print(langevin(run), Langevin::exact());
  print(uniaxial(run), Uniaxial::exact());
  print(chain(run), Chain::exact());
  std::printf("\n");
}
template <class Stepper>
void print_ours(char const* name, Run const& run) {
  print_line(name, Stepper::evaluations, run, ours<Stepper, Langevin>, ours<Stepper, Uniaxial>,
             ours<Stepper, Chain>);
}
template <class Of>
void print_theirs(Run const& run) {
  print_line(Of::name, 2, run, theirs<Of, Langevin>, theirs<Of, Uniaxial>, theirs<Of, Chain>);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  std::int64_t const sites = argc > 1 ? std::atoll(argv[1]) : 4096;
  double const time = argc > 2 ? std::atof(argv[2]) : 400;
  std::printf("%-20s %s %8s %6s  %18s  %18s  %18s\n", "scheme", "e", "damping", "dt", "Langevin",
              "uniaxial", "chain");
  for (double const damping : {0.5, 0.1})
    for (double const dt : {0.1, 0.2, 0.4}) {
      Run const run{sites, time, damping, dt};
      print_theirs<HeunAndRenormalise>(run);
      print_theirs<SemiImplicitB>(run);
      print_theirs<DepondtMertens>(run);
      print_ours<cayspin::LieHeun<Spins>>("noise, heun", run);
      print_ours<cayspin::Rkmk4<Spins>>("noise, rkmk4", run);
      print_ours<cayspin::RedBlack2<Spins>>("noise, red_black2", run);
    }
}
