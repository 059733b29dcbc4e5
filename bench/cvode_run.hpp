// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ladder.hpp"
#include "sundials_spins.hpp"

#include <cayspin/solver/measured_exchange.hpp>
#include <cayspin/solver/spin_wave_solver.hpp>

#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <complex>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// Integrates the equation of a generator by CVODE.
namespace by_sundials {

struct CvodeOptions {
  int method = CV_BDF;  // or CV_ADAMS, with fixed-point iteration
  int max_order = 5;
  bool preconditioned = false;
};

/// The preconditioner (1 + b K)^-1 as in StiffGauss, normal to the spins. K is the exchange
/// operator, and b = gamma * (damping - i * precession), where gamma is given by CVODE, and damping
/// and precession are measured.
class SpinWavePreconditioner {
  using Solver = cayspin::detail::SpinWaveSolver<double, Kokkos::HostSpace>;

 public:
  explicit SpinWavePreconditioner(cayspin::Lattice const& lattice)
      : spins_("bench::preconditioner::spins", lattice),
        right_("bench::preconditioner::right", lattice),
        solution_("bench::preconditioner::solution", lattice) {}

  /// Measures exchange, damping and precession of the generator; returns the number of evaluations.
  template <class Generator>
  int measure(Generator const& generator) {
    int const evaluations =
        exchange_.measure(exec_, "cayspin::bench::measure", generator, right_, 0);
    solver_ = Solver("bench", spins_.lattice(), exchange_.couplings);
    return evaluations;
  }
  void at(SpinVectors const& vectors, N_Vector y) { vectors.read(y, spins_); }

  void solve(SpinVectors const& vectors, N_Vector right, N_Vector to, double gamma) {
    auto const from = vectors.input(right);
    cayspin::detail::for_each_site<double>(exec_, across_label_, spins_.layout(),
                                           Across{from, spins_.array(), right_.output(false)});
    std::complex<double> const b(gamma * exchange_.damping, -gamma * exchange_.precession);
    solver_.solve(exec_, b, right_, spins_, solution_);
    cayspin::detail::for_each_site<double>(
        exec_, turn_label_, spins_.layout(),
        Turn{solution_.array(), from, spins_.array(), vectors.output(to)});
    vectors.finish(to);
  }

 private:
  struct Across {
    SiteArray right, spins;
    OutputArray output;
    template <class Site>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
      auto const m = site.load(spins), r = site.load(right);
      site.store(r - dot(m, r) * m, output);
    }
  };
  /// Functor that stores the part of v' + m x v'' normal to the spin m plus the part of the
  /// right-hand side along m. v' and v'' are the real and the imaginary part of the solution.
  struct Turn {
    cayspin::SiteArray<double, 6> solution;
    SiteArray right, spins;
    OutputArray output;
    template <class Site>
    KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
      using Vector = cayspin::Vec3<typename Site::value_type>;
      auto const part = [&](int c) {
        return Vector{site.load(solution, c), site.load(solution, c + 1),
                      site.load(solution, c + 2)};
      };
      auto const m = site.load(spins), r = site.load(right);
      auto const v = part(0) + cross(m, part(3));
      site.store(v + dot(m, r - v) * m, output);
    }
  };

  Exec exec_;
  Spins spins_, right_;
  Solver::Solution solution_;
  Solver solver_;
  cayspin::detail::MeasuredExchange exchange_;
  std::string across_label_ = "cayspin::bench::across", turn_label_ = "cayspin::bench::turn";
};

/// Runs CVODE from `start` to the horizon and stores states at equal intervals of time. If CVODE
/// fails or takes more than `most` evaluations, the later states are missing.
template <class Generator>
class Cvode {
 public:
  using Right = RightSide<Generator>;

  Cvode(cayspin::Lattice const& lattice, Generator const& generator, CvodeOptions const& options)
      : right_(lattice, generator), options_(options), preconditioner_(lattice) {}

  ladder::Run run(std::vector<double> const& start, double horizon, double tolerance,
                  std::int64_t most) {
    right_.evaluations = 0;
    right_.most = most;
    Spins spins("bench::start", right_.vectors.lattice());
    cayspin::copy_from_host(start, spins);
    auto const y = right_.vectors.make(context_);
    right_.vectors.write(spins, y.get());
    void* cvode = CVodeCreate(options_.method, context_);
    require(cvode != nullptr, "CVodeCreate");
    CVodeSetErrFile(cvode, nullptr);
    require(CVodeInit(cvode, rate, 0, y.get()) == 0, "CVodeInit");
    require(CVodeSStolerances(cvode, tolerance, tolerance) == 0, "CVodeSStolerances");
    CVodeSetUserData(cvode, this);
    CVodeSetMaxNumSteps(cvode, 100000000);
    CVodeSetMaxOrd(cvode, options_.max_order);
    SUNNonlinearSolver iteration = nullptr;
    SUNLinearSolver krylov = nullptr;
    if (options_.method == CV_ADAMS) {
      iteration = SUNNonlinSol_FixedPoint(y.get(), 0, context_);
      require(CVodeSetNonlinearSolver(cvode, iteration) == 0, "CVodeSetNonlinearSolver");
    } else {
      int const side = options_.preconditioned ? SUN_PREC_LEFT : SUN_PREC_NONE;
      krylov = SUNLinSol_SPGMR(y.get(), side, 0, context_);
      require(CVodeSetLinearSolver(cvode, krylov, nullptr) == 0, "CVodeSetLinearSolver");
      if (options_.preconditioned) CVodeSetPreconditioner(cvode, set_up, solve);
    }
    ladder::Run run;
    Exec const exec;
    ladder::Clock clock;
    if (options_.preconditioned) right_.evaluations += preconditioner_.measure(right_.generator());
    for (int look = 1; look <= ladder::looks; ++look) {
      double reached = 0;
      int const flag = CVode(cvode, horizon * look / ladder::looks, y.get(), &reached, CV_NORMAL);
      exec.fence("cayspin::bench: looked at");
      run.seconds += clock.seconds();
      if (flag < 0) break;
      right_.vectors.read(y.get(), spins);
      run.states.push_back(cayspin::copy_to_host(spins));
      clock.reset();
    }
    run.evaluations = right_.evaluations;
    CVodeFree(&cvode);
    if (iteration) SUNNonlinSolFree(iteration);
    if (krylov) SUNLinSolFree(krylov);
    return run;
  }

 private:
  static Cvode& self(void* data) { return *static_cast<Cvode*>(data); }
  static int rate(double t, N_Vector y, N_Vector to, void* data) {
    auto& right = self(data).right_;
    if (right.evaluations > right.most) return -1;
    right(t, y, to);
    return 0;
  }
  static int set_up(double, N_Vector y, N_Vector, int, int* renewed, double, void* data) {
    self(data).preconditioner_.at(self(data).right_.vectors, y);
    *renewed = 1;
    return 0;
  }
  static int solve(double, N_Vector, N_Vector, N_Vector right, N_Vector to, double gamma, double,
                   int, void* data) {
    self(data).preconditioner_.solve(self(data).right_.vectors, right, to, gamma);
    return 0;
  }

  sundials::Context context_;
  Right right_;
  CvodeOptions options_;
  SpinWavePreconditioner preconditioner_;
};

}  // namespace by_sundials
