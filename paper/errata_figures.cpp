// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "comparison.hpp"
#include "measures.hpp"
#include "slab.hpp"

#include <algorithm>

namespace cayspin::paper {
namespace {

void figure_rows(Comparison& comparison, std::string_view name, MethodChoice choice,
                 Slab const& slab, SlabPath const& reference) {
  std::vector<double> finest;
  for (double const sigma : {-10.0, 0.0, 10.0}) {
    choice.sigma = sigma;
    auto const convergence = converge(slab, choice, reference);
    comparison.row(fmt::format("{}, order of the finest pair of dt, sigma = {:g}", name, sigma),
                   not_a_number, convergence.order_of_finest_pair());
    finest.push_back(convergence.errors.front());
  }
  auto const [least, largest] = std::ranges::minmax(finest);
  comparison.row(fmt::format("{}, error at dt = 0.02, largest over least of these", name),
                 not_a_number, largest / least);
}

}  // namespace

void erratum_table_and_figures(Comparison& comparison) {
  comparison.begin(9, "Table 3, axisymmetric, F^RK2_dcor, dt = 10; figures 7 and 10",
                   "5054 10^-3; the order varies with sigma",
                   "(not recoverable); the order does not, the constant does");
  auto const bodies = draw_bodies({Law::Shape::nearly_spherical}, comparison.context.bodies,
                                  comparison.context.seed);
  auto const largest_possible = [](Body const& body) {
    auto const [least, most] = std::ranges::minmax(body.moments);
    return (1 / least - 1 / most) / 2;
  };
  comparison.row("energy error, mean; largest that any body of the law can have", 5.054,
                 quantile(of_each(bodies, largest_possible), 1));
  comparison.row("... ours at that place, mean", not_a_number,
                 mean(run_ensemble(bodies, heun_dcor, 10, 100).energy_errors));
  auto const reference = reference_run(strong_damping);
  figure_rows(comparison, "Heun", choose("heun", Generator::standard, Isotropy::constant),
              strong_damping, reference);
  figure_rows(comparison, "RKMK4", choose("rkmk4", Generator::standard, Isotropy::constant),
              strong_damping, reference);
}

}  // namespace cayspin::paper
