// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <utility>
#include <vector>

// Runs methods from coarse to fine steps, as `cayspin trade` does, and finds how much they cost at
// given errors.
namespace ladder {

using Spins = cayspin::SpinField<double, Kokkos::HostSpace>;
using States = std::vector<std::vector<double>>;  // one (sites, 3) array per sample

inline constexpr int looks = 4;

/// Returns unit vectors along f(x, y, number), where x = (index + 1/2) / extent, y likewise, and
/// `number` differs from site to site.
template <class Function>
std::vector<double> start_of(cayspin::Lattice const& lattice, Function const& f) {
  std::vector<double> spins;
  auto const& [nx, ny, nz] = lattice.shape;
  auto const place = [](std::int64_t i, std::int64_t n) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  };
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i) {
        cayspin::Vec3<double> const m =
            f(place(i, nx), place(j, ny), 12.9 * i + 78.2 * j + 37.7 * k);
        double const length = std::sqrt(dot(m, m));
        for (double const c : {m.x, m.y, m.z}) spins.push_back(c / length);
      }
  return spins;
}

/// Returns true if Kokkos has only one thread, as all reported times require; otherwise prints a
/// message.
inline bool has_one_thread() {
  if (Kokkos::DefaultHostExecutionSpace().concurrency() == 1) return true;
  std::fprintf(stderr, "set OMP_NUM_THREADS=1: seconds are those of one thread\n");
  return false;
}

/// Clock of the processor time of this process.
class Clock {
 public:
  Clock() { reset(); }
  void reset() { clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin_); }
  double seconds() const {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec - begin_.tv_sec) +
           1e-9 * static_cast<double>(now.tv_nsec - begin_.tv_nsec);
  }

 private:
  timespec begin_;
};

/// One run of any method.
struct Run {
  States states;
  double seconds = 0;            // spent in steps
  std::int64_t evaluations = 0;  // evaluations of the right-hand side
  std::int64_t multirate = 0;    // evaluations of an expensive field
  std::int64_t steps = 0;
};

struct Rung {
  double error, seconds, evaluations, multirate, steps;
};

struct Ladder {
  std::string name;
  bool is_own = true;  // true: a method of cayspin
  std::vector<Rung> rungs = {};
};

/// Returns the largest distance of any spin from the reference at any sample. The spins of `run`
/// are first divided by their lengths. Returns infinity if samples are missing or not finite.
inline double distance(States const& run, States const& reference) {
  double largest = 0;
  if (run.size() != reference.size()) return std::numeric_limits<double>::infinity();
  for (std::size_t look = 0; look < run.size(); ++look)
    for (std::size_t i = 0; i < run[look].size(); i += 3) {
      auto const* const m = &run[look][i];
      auto const* const r = &reference[look][i];
      double const length = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
      double const apart =
          std::hypot(m[0] / length - r[0], m[1] / length - r[1], m[2] / length - r[2]);
      if (!std::isfinite(apart)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, apart);
    }
  return largest;
}

/// Returns the smallest `amount` (seconds, for example) with which a ladder reaches an error,
/// interpolated logarithmically between rungs; infinity if no rung reaches the error.
inline double amount_to(Ladder const& ladder, double error, double Rung::*amount) {
  double best = std::numeric_limits<double>::infinity();
  Rung const* before = nullptr;
  for (auto const& rung : ladder.rungs) {
    if (rung.error <= error) {
      best = std::min(best, rung.*amount);
      if (before && before->error > error && std::isfinite(before->error)) {
        double const share = std::log(before->error / error) / std::log(before->error / rung.error);
        best = std::min(best, before->*amount * std::pow(rung.*amount / before->*amount, share));
      }
    }
    before = &rung;
  }
  return best;
}

struct Limits {
  double least_error = 3e-7, seconds = 4;
  int rungs = 24;
};

/// Calls run(rung) for rung 0, the coarsest, and so on. Keeps the rungs with an error below 0.5 and
/// repeats them: the shortest of up to 100 runs counts, or of 2 or 3 if they are long. Stops at the
/// limits, or when small errors no longer decrease.
template <class RunOnce>
Ladder climb(std::string name, bool is_own, States const& reference, Limits const& limits,
             RunOnce const& run) {
  Ladder ladder{std::move(name), is_own};
  double best = std::numeric_limits<double>::infinity();
  int worse = 0;
  for (int i = 0; i < limits.rungs; ++i) {
    Run one = run(i);
    double const error = distance(one.states, reference);
    double shortest = one.seconds, all = one.seconds;
    bool const is_useful = error < 0.5;
    if (is_useful) {
      for (int n = 1; n < 100 && (n < 3 || all < 0.3) && (n < 2 || all < 2); ++n) {
        double const seconds = run(i).seconds;
        all += seconds;
        shortest = std::min(shortest, seconds);
      }
      ladder.rungs.push_back({error, shortest, static_cast<double>(one.evaluations),
                              static_cast<double>(one.multirate), static_cast<double>(one.steps)});
    }
    worse = error < 0.9 * best ? 0 : worse + 1;
    best = std::min(best, error);
    bool const is_long = is_useful && shortest > limits.seconds;
    if (error < limits.least_error || is_long || (worse > 2 && best < 1e-4)) break;
  }
  return ladder;
}

/// Takes `steps` steps of a cayspin stepper, up to the time `horizon`. `steps` must be a multiple
/// of `looks`.
template <class Stepper, class Generator>
Run take_steps(Stepper& stepper, Generator const& generator, cayspin::Lattice const& lattice,
               std::vector<double> const& start, double horizon, std::int64_t steps) {
  Run run;
  Kokkos::DefaultHostExecutionSpace const exec;
  Spins spins("bench::spins", lattice);
  cayspin::copy_from_host(start, spins);
  Clock clock;
  auto const look = [&](auto const&, cayspin::Step const& step, auto const& now) {
    if (step.number > 0) {
      run.seconds += clock.seconds();  // integrate() has fenced
      run.states.push_back(cayspin::copy_to_host(now));
    }
    clock.reset();
  };
  auto const summary = cayspin::integrate(exec, stepper, generator, spins,
                                          {0, horizon / static_cast<double>(steps), steps},
                                          cayspin::Every(steps / looks, look));
  run.evaluations = summary.evaluations;
  run.steps = steps;
  return run;
}

inline std::int64_t with_looks(double steps) {
  return looks * std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(steps / looks)));
}

/// Returns the number of steps of a rung: `fewest` for rung 0, 1.5 times as many for each further
/// rung, rounded up to a multiple of `looks`.
inline std::int64_t steps_of(int rung, double fewest) {
  return with_looks(fewest * std::pow(1.5, rung));
}

inline void print(std::vector<Ladder> const& ladders, std::vector<double> const& errors) {
  std::vector<double> best;
  for (double const error : errors) {
    double least = std::numeric_limits<double>::infinity();
    for (auto const& one : ladders)
      if (one.is_own) least = std::min(least, amount_to(one, error, &Rung::seconds));
    best.push_back(least);
  }
  std::printf("%-34s", "ms (evaluations) times the best");
  for (double const error : errors) std::printf(" | %-26.0e", error);
  std::printf("\n");
  for (auto const& one : ladders) {
    std::printf("%-34s", one.name.c_str());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      double const seconds = amount_to(one, errors[i], &Rung::seconds);
      if (std::isfinite(seconds))
        std::printf(" | %9.4g (%7.0f) %6.2f", 1e3 * seconds,
                    amount_to(one, errors[i], &Rung::evaluations), seconds / best[i]);
      else
        std::printf(" | %26s", "-");
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace ladder
