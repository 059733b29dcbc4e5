// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "energy_table.hpp"

namespace cayspin::paper {

void table4(Context const& context) {
  EnergyTable table(
      context, "table4",
      "Table 4. Largest energy error over [0, 100], fourth order; the paper: mean of ten bodies");
  std::vector<double> const dts{10, 1, 0.1};
  table.add({"triaxial",
             {Law::Shape::triaxial},
             100,
             dts,
             {{"F^sy4_def", sy4_def, {5.72e-3, 3.62e-6, 3.56e-10}},
              {"F^sy4_orth", sy4_orth, {3.37e-2, 2.72e-7, 7.45e-12}},
              {"F^sy4_dcor", sy4_dcor, {6.06e-3, 1.55e-6, 3.61e-10}},
              {"F^sy4_ocor", sy4_ocor, {1.90e-2, 1.68e-7, 1.70e-12}},
              {"F^RK4_def", rkmk4_def, {6.07e-2, 2.15e-5, 2.97e-10}},
              {"F^RK4_orth", rkmk4_orth, {3.59e-3, 1.46e-7, 3.06e-12}}}});
  table.add({"axisymmetric",
             {Law::Shape::nearly_spherical},
             100,
             dts,
             {{"F^sy4_def", sy4_def, {2.47e-4, 2.06e-8, 2.12e-13}},
              {"F^sy4_orth", sy4_orth, {1.24e-7, 1.26e-12, 0}},
              {"F^sy4_dcor", sy4_dcor, {2.47e-4, 2.06e-8, 2.12e-13}},
              {"F^sy4_ocor", sy4_ocor, {1.24e-7, 1.26e-12, 0}},
              {"F^RK4_def", rkmk4_def, {7.45e-4, 3.20e-7, 3.47e-12}},
              {"F^RK4_orth", rkmk4_orth, {4.41e-8, 4.47e-13, 3.22e-16}}}});
  table.note(
      "Not explained: the paper's F^sy4_def and F^sy4_dcor lie below the ranges at dt = 10 and 1, "
      "and have orders 4.01 and 3.63 from there to 0.1, where F^RK4_def of the same bodies has "
      "ours. Its F^sy4_dcor keeps the error of F^sy4_def at dt = 0.1, as if the correction, which "
      "it does not print, did not act there; ours removes the h^4 part and leaves order 4.98 in "
      "every set of ten. F^RK4 has the orders of the corrected stages (errata, 6), and F^sy4_orth "
      "is the printed form (errata, 7). For an axisymmetric body the corrections vanish, here as "
      "there.");
  table.close();
}

}  // namespace cayspin::paper
