// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "figures.hpp"
#include "numbers_file.hpp"
#include "paragraph.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::paper {
namespace {

struct Sweep {
  std::string_view name;
  Slab slab;
  double largest_sigma;
};
constexpr Sweep weak{"weak field, [0, 1]", strong_damping, 10};
constexpr Sweep strong{"strong field, [0, 0.1]", strong_damping_strong_field, 40};

struct Curve {
  std::string_view name;
  MethodChoice choice;
};
Curve const curves[]{
    {"Heun, default", choose("heun", Generator::standard, Isotropy::constant)},
    {"Heun, orthogonal", choose("heun", Generator::orthogonal, Isotropy::constant)},
    {"RKMK4, default", choose("rkmk4", Generator::standard, Isotropy::constant)},
    {"RKMK4, orthogonal", choose("rkmk4", Generator::orthogonal, Isotropy::constant)},
    {"RKMK4 as printed, default",
     choose("rkmk4_as_printed", Generator::standard, Isotropy::constant)}};

}  // namespace

void figure_orders(Context const& context) {
  fmt::print(
      "\n  fig:7, fig:10: order in dt over sigma, the slab at damping 10; fitted over dt = 0.02 .. "
      "0.00125, and of the finest pair\n  {:<24} {:<27} {:>15} {:>15} {:>24}\n",
      "", "", "fitted", "finest pair", "error, largest/least");
  NumbersFile file(context.folder, "orders.csv",
                   "sweep,method,sigma,fitted_order,finest_order,error");
  for (auto const& [name, slab, largest_sigma] : {weak, strong}) {
    auto const reference = reference_run(slab);
    for (auto const& curve : curves) {
      std::vector<double> fitted, finest, errors;
      for (int i = -5; i <= 5; ++i) {
        auto choice = curve.choice;
        choice.sigma = i * largest_sigma / 5;
        auto const convergence = converge(slab, choice, reference);
        fitted.push_back(convergence.order());
        finest.push_back(convergence.order_of_finest_pair());
        errors.push_back(convergence.errors.front());
        file.row(name, curve.name, choice.sigma, fitted.back(), finest.back(), errors.back());
      }
      auto const [f0, f1] = std::ranges::minmax(fitted);
      auto const [p0, p1] = std::ranges::minmax(finest);
      auto const [e0, e1] = std::ranges::minmax(errors);
      fmt::print("  {:<24} {:<27} {:>7.2f} - {:<5.2f} {:>7.2f} - {:<5.2f} {:>16.2g}\n", name,
                 curve.name, f0, f1, p0, p1, e1 / e0);
    }
  }
  file.write();
  print_paragraph(
      "The paper: the order varies with sigma, for RKMK4 more than for Heun. Where dt is small "
      "enough it does not (weak field); the error does, by factors of hundreds and more. Fitted "
      "from steps that begin just below the stable one (strong field) it does, and most with the "
      "stages as printed.");
}

void figure_convergence(Context const& context) {
  fmt::print(
      "\n  fig:7b: RKMK4, sigma = 0: fitted order of the error in m_x of spin 37, and of the "
      "largest error; the paper: 5.6 and 4.03\n");
  NumbersFile file(context.folder, "convergence.csv", "case,method,dt,error,error_x");
  struct Case {
    std::string_view name;
    Slab slab;
    double coarsest;
  };
  for (auto const& [name, slab, coarsest] :
       {Case{"damping 10, weak field, [0, 1]", strong_damping, 0.02},
        Case{"damping 10, strong field, [0, 0.1]", strong_damping_strong_field, 0.02},
        Case{"damping 0.05, strong field, [0, 10]", full_to_10, 0.1}}) {
    auto const reference = reference_run(slab);
    for (auto const& [method, choice] :
         {Curve{"RKMK4", rkmk4_def}, Curve{"RKMK4 as printed", rkmk4_printed_def}}) {
      auto const convergence = converge(slab, choice, reference, coarsest);
      for (std::size_t i = 0; i < convergence.dts.size(); ++i)
        file.row(name, method, convergence.dts[i], convergence.errors[i],
                 convergence.first_component_errors[i]);
      fmt::print("  {:<36} {:<18} {:.2f} in m_x, {:.2f} in the norm\n", name, method,
                 convergence.order_of_first_component(), convergence.order());
    }
  }
  file.write();
  print_paragraph(
      "4.03 is found, 5.6 is not. At weak damping the leading error is one of the phase of the "
      "precession about x, which m_x does not see: there it falls faster for a while.");
}

void figure_norm(Context const& context) {
  fmt::print(
      "\n  fig:9: ln|m| of classical RK4 and of RKMK4 on [0, 1], dt = 0.01, strong field; the "
      "paper: a drift of the order of 1e-6\n");
  NumbersFile file(context.folder, "norm.csv", "method,damping,time,log_norm");
  for (double const damping : {0.05, 1.0, 2.0, 10.0}) {
    Slab slab = strong_damping_strong_field;
    slab.damping = damping;
    slab.end = 1;
    for (auto const& [method, choice] :
         {Curve{"RK4", choose("classical_rk4")}, Curve{"RKMK4", rkmk4_def}}) {
      auto const path = run_slab(slab, choice, 0.01, 100);
      double largest = 0;
      for (std::size_t i = 0; i < path.times.size(); ++i) {
        file.row(method, damping, path.times[i], path.logarithms[i]);
        largest = std::max(largest, std::abs(path.logarithms[i]));
      }
      fmt::print("  damping {:<5g} {:<6} largest |ln|m|| {:.2e}\n", damping, method, largest);
    }
  }
  file.write();
  print_paragraph(
      "RK4's drift goes with the damping, which the paper does not give here; RKMK4 has none "
      "beyond rounding.");
}

}  // namespace cayspin::paper
