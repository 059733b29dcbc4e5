// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "figures.hpp"

#include "context.hpp"

#include <fmt/format.h>

namespace cayspin::program::reproduction {

void figures(Context const& context) {
  fmt::print("\nFigures, by the labels of the paper's source\n");
  figure_trajectories(context);
  figure_slab(context, weak_overdamped, "fig:1");
  figure_slab(context, strong_overdamped, "fig:2");
  figure_slab(context, full, "fig:4, fig:5");
  figure_orders(context);
  figure_convergence(context);
  figure_norm(context);
  fmt::print("\n  numbers in {0}; pictures: python3 python/plot_paper.py {0}\n",
             context.folder->string());
}

}  // namespace cayspin::program::reproduction
