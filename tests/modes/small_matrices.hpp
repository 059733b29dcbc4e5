// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/modes/pencil.hpp>

// Eigen's solvers take seconds to compile, so small_matrices.cpp compiles them for all tests.
namespace cayspin::inline v0_2::detail {

extern template struct Pencil<double>;
extern template Eigen::VectorXcd eigenvalues_of_product(Eigen::MatrixXd const&,
                                                        Eigen::MatrixXcd const&);

}  // namespace cayspin::inline v0_2::detail
