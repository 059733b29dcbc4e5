// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "small_matrices.hpp"

namespace cayspin::inline v0_2::detail {

template struct Pencil<double>;
template Eigen::VectorXcd eigenvalues_of_product(Eigen::MatrixXd const&, Eigen::MatrixXcd const&);

}  // namespace cayspin::inline v0_2::detail
