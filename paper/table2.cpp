// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "energy_table.hpp"

namespace cayspin::paper {

void table2(Context const& context) {
  EnergyTable table(context, "table2",
                    "Table 2. Largest energy error over [0, 100], geometric Euler; the paper: mean "
                    "of ten bodies");
  std::vector<double> const dts{10, 1, 0.1, 0.01};
  table.add({"triaxial",
             {Law::Shape::triaxial},
             100,
             dts,
             {{"F^Eul_def", euler_def, {9.04e-2, 8.52e-2, 9.06e-3, 7.09e-4}},
              {"F^Eul_orth", euler_orth, {1.81e-2, 8.54e-3, 1.44e-3, 1.62e-4}},
              {"F^Eul_cor", euler_cor, {4.56e-3, 3.68e-5, 3.55e-7, 3.57e-9}}}});
  table.add({"axisymmetric",
             {Law::Shape::nearly_spherical},
             100,
             dts,
             {{"F^Eul_def", euler_def, {7.66e-3, 1.79e-3, 2.51e-4, 2.96e-5}},
              {"F^Eul_orth", euler_orth, {8.37e-4, 1.13e-4, 1.17e-5, 1.18e-6}},
              {"F^Eul_cor", euler_cor, {0, 0, 0, 0}}}});
  table.note(
      "The paper does not say how it drew its bodies. Errors go with powers of 1/I, so the laws "
      "here are chosen to give errors of its size: with moments in [1, 3] most of its figures lie "
      "below the ranges. Its axisymmetric ones can only have been close to spheres: F^Eul_orth "
      "goes with the cube of the difference of the moments.");
  table.close();
}

void separatrix(Context const& context) {
  EnergyTable table(context, "separatrix",
                    "Separatrix (Sec. 5). Largest energy error over [0, 500], geometric Euler; the "
                    "paper: mean of ten bodies");
  table.add({"triaxial",
             {Law::Shape::separatrix},
             500,
             {1, 0.1, 0.01},
             {{"F^Eul_def", euler_def, {9.72e-2, 3.89e-2, 1.94e-3}},
              {"F^Eul_orth", euler_orth, {0, 0, 0}},
              {"F^Eul_cor", euler_cor, {0, 0, 0}}}});
  table.note("The paper: exactly captured by F^Eul_orth and F^Eul_cor; here 0 stands for that.");
  table.close();
}

}  // namespace cayspin::paper
