// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The micromagnetic standard problem 4 of NIST's muMAG group: a film of permalloy rests in its S
// state, and two fields switch it. The field consists of exchange, the full demagnetising field and
// the applied field.
//   example_standard_problem_4              128 x 32 cells, beside mumax3
//   example_standard_problem_4 mumax3       the same with mumax3's approximation of the tensor
//   example_standard_problem_4 oommf        200 x 50 cells, beside OOMMF
//   example_standard_problem_4 multirate    200 x 50 cells, demagnetising field once per step
//   example_standard_problem_4 adaptive     like multirate, also with adaptive methods
//   example_standard_problem_4 multirate10  like multirate, over 10 ns
#include "multirate.hpp"
#include "problem.hpp"
#include "quadrature.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <type_traits>

namespace {

using Vector = StandardProblem4::Vector;

Vector const field_1{-24.6, 4.3, 0}, field_2{-35.5, -6.3, 0};

bool agree(char const* what, Vector const& m, Vector const& other, double limit) {
  double apart = 0;
  for (double const d : {m.x - other.x, m.y - other.y, m.z - other.z})
    apart = std::fmax(apart, std::abs(d));
  std::printf("%-16s %9.6f %9.6f %9.6f   theirs %9.6f %9.6f %9.6f   apart %.1e, limit %g\n", what,
              m.x, m.y, m.z, other.x, other.y, other.z, apart, limit);
  return apart < limit;
}

/// Compares with the values in test/standardproblem4.mx3 and standardproblem4b.mx3 of mumax3.
bool agrees_with_mumax3(cayspin::TensorOfCells& tensor, double limit_of_field_1) {
  StandardProblem4 problem(128, 32, tensor);
  bool fine =
      agree("at rest", problem.relax(1e-9), {0.9669684171676636, 0.1252732127904892, 0}, 1e-4);
  auto const first = problem.reverse(field_1, 2400), second = problem.reverse(field_2, 2400);
  fine &= agree("field 1, 1 ns", first.m,
                {-0.9846124053001404, 0.12604089081287384, 0.04327124357223511}, limit_of_field_1);
  fine &= agree("field 2, 1 ns", second.m,
                {-0.9692331552505493, -0.12039542198181152, -0.0053076110780239105}, 4e-3);
  std::printf("<m_x> is zero at %.5f ns (field 1) and %.5f ns (field 2)\n", first.crossing,
              second.crossing);
  return fine;
}

/// Compares with micromagnetics_examples/std4/oommf.txt of fidimag. OOMMF also uses Newell's
/// tensor.
bool agrees_with_oommf() {
  StandardProblem4 problem(200, 50);
  auto const rest = problem.relax(1e-6);
  auto const reversal = problem.reverse(field_1, 2800);
  std::printf("at rest          %9.6f %9.6f %9.6f\n", rest.x, rest.y, rest.z);
  constexpr double crossing = 0.138498;
  std::printf("<m_x> is zero at %.6f ns, theirs %.6f ns, limit 1e-4 ns\n", reversal.crossing,
              crossing);
  return agree("field 1, 1 ns", reversal.m,
               {-0.98450506442904406, 0.12744705994006725, 0.043152886054211331}, 1e-3) &&
         std::abs(reversal.crossing - crossing) < 1e-4;
}

/// Evaluates the demagnetising field once per step, and compares with rkmk4, which evaluates it in
/// each stage.
bool follows_with_a_multirate_field(bool with_adaptive_methods) {
  StandardProblem4 problem(200, 50);
  problem.relax(1e-6);
  MultirateProblem4 multirate(problem, field_1, 1);
  auto const converged = multirate.rkmk4(2800);
  report("rkmk4, 2800 steps", converged, converged, 1);
  bool fine = true;
  auto const tried = [&]<int Order>(std::integral_constant<int, Order>, int steps, int substeps,
                                    double limit) {
    char name[64];
    std::snprintf(name, sizeof name, "order %d, %d steps, %d substeps", Order, steps, substeps);
    auto const run = multirate.multirate<Order>(steps, substeps);
    fine &= report(name, run, converged, limit) && 10 * run.multirate < converged.multirate;
  };
  tried(std::integral_constant<int, 3>(), 900, 3, 1e-3);
  tried(std::integral_constant<int, 3>(), 700, 4, 2e-3);
  tried(std::integral_constant<int, 4>(), 900, 3, 2e-4);
  if (!with_adaptive_methods) return fine;
  constexpr double tolerance = 0.05;  // so loose that stability limits the steps
  report("bs3", multirate.adaptive<cayspin::tableau::BogackiShampine3>(tolerance), converged, 1);
  report("tsit5", multirate.adaptive<cayspin::tableau::Tsitouras5>(tolerance), converged, 1);
  report("dp5", multirate.adaptive<cayspin::tableau::DormandPrince5>(tolerance), converged, 1);
  return fine;
}

/// Checks that the energy never rises between samples during 10 ns, in which the film reaches
/// equilibrium.
bool falls_for_10_nanoseconds() {
  StandardProblem4 problem(200, 50);
  problem.relax(1e-6);
  MultirateProblem4 multirate(problem, field_1, 10);
  auto const run = multirate.multirate<3>(9000, 3);
  std::printf("energy falls by %.6g, rises by at most %.1e (round-off %.1e)\n", run.fall,
              run.largest_rise, run.round_off);
  return report("order 3, 9000 steps, 3 substeps", run, run, 1);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  char const* const beside = argc > 1 ? argv[1] : "";
  if (std::strcmp(beside, "oommf") == 0) return agrees_with_oommf() ? 0 : 1;
  if (std::strcmp(beside, "multirate") == 0) return follows_with_a_multirate_field(false) ? 0 : 1;
  if (std::strcmp(beside, "adaptive") == 0) return follows_with_a_multirate_field(true) ? 0 : 1;
  if (std::strcmp(beside, "multirate10") == 0) return falls_for_10_nanoseconds() ? 0 : 1;
  if (std::strcmp(beside, "mumax3") == 0)
    return agrees_with_mumax3(quadrature::tensor, 1e-3) ? 0 : 1;
  // The limit is for 1 ns in field 1, where m_y changes by 8e-3 in a picosecond.
  return agrees_with_mumax3(cayspin::demagnetizing_tensor, 6e-3) ? 0 : 1;
}
