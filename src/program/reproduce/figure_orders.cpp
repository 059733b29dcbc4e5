// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "figures.hpp"
#include "numbers_file.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::program::reproduction {
namespace {

struct Sweep {
  std::string_view name;
  Slab slab;
  double largest_sigma;
};
constexpr Sweep sweeps[]{{"weak field, [0, 1]", strong_damping, 10},
                         {"strong field, [0, 0.1]", strong_damping_strong_field, 40}};

struct Curve {
  std::string_view name;
  Choice choice;
};
constexpr Curve curves[]{
    {"Heun, default", {heun, Generator::standard, Isotropy::constant}},
    {"Heun, orthogonal", {heun, Generator::orthogonal, Isotropy::constant}},
    {"RKMK4, default", {rkmk4, Generator::standard, Isotropy::constant}},
    {"RKMK4, orthogonal", {rkmk4, Generator::orthogonal, Isotropy::constant}},
    {"RKMK4 as printed, default", {rkmk4_as_printed, Generator::standard, Isotropy::constant}}};

}  // namespace

void figure_orders(Context const& context) {
  fmt::print(
      "\n  fig:7, fig:10: order in dt over sigma, the slab at damping 10; fitted over dt = 0.02 .. "
      "0.00125, and of the finest pair\n"
      "  {:<24} {:<27} {:>15} {:>15} {:>24}\n",
      "", "", "fitted", "finest pair", "error, largest/least");
  NumbersFile file(context.folder, "orders.csv",
                   "sweep,method,sigma,fitted_order,finest_order,error");
  for (auto const& [name, slab, largest_sigma] : sweeps) {
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
}

void figure_convergence(Context const& context) {
  fmt::print(
      "\n  fig:7b: RKMK4, sigma = 0, the slab at damping 10: error over dt; the paper: order 5.6 "
      "in "
      "m_x, 4.03 in the norm\n");
  NumbersFile file(context.folder, "convergence.csv", "sweep,method,dt,error,error_x");
  for (auto const& [name, slab, largest_sigma] : sweeps) {
    auto const reference = reference_run(slab);
    for (auto const& [method, choice] :
         {Curve{"RKMK4", rkmk4_def}, Curve{"RKMK4 as printed", rkmk4_printed_def}}) {
      auto const convergence = converge(slab, choice, reference);
      for (std::size_t i = 0; i < convergence.dts.size(); ++i)
        file.row(name, method, convergence.dts[i], convergence.errors[i],
                 convergence.first_component_errors[i]);
      fmt::print("  {:<24} {:<18} fitted order {:.2f} in m_x, {:.2f} in the norm\n", name, method,
                 convergence.order_of_first_component(), convergence.order());
    }
  }
  file.write();
}

void figure_norm(Context const& context) {
  fmt::print(
      "\n  fig:9: ln|m| of classical RK4 and of RKMK4 on [0, 1], dt = 0.01, strong field; the "
      "paper: "
      "a drift of the order of 1e-6\n");
  NumbersFile file(context.folder, "norm.csv", "method,damping,time,log_norm");
  for (double const damping : {0.05, 1.0, 2.0, 10.0}) {
    Slab slab = strong_damping_strong_field;
    slab.damping = damping;
    slab.end = 1;
    for (auto const& [method, choice] :
         {Curve{"RK4", {classical_rk4}}, Curve{"RKMK4", rkmk4_def}}) {
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
}

}  // namespace cayspin::program::reproduction
