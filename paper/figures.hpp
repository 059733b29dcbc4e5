// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "context.hpp"
#include "slab.hpp"

/// Each function writes the numbers of one or more figures of the paper to CSV files, and prints a
/// summary.
namespace cayspin::paper {

void figure_trajectories(Context const& context);
void figure_slab(Context const& context, Slab const& slab, std::string_view label,
                 std::string_view remark);
void figure_orders(Context const& context);
void figure_convergence(Context const& context);
void figure_norm(Context const& context);

}  // namespace cayspin::paper
