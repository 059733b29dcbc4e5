// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "figures.hpp"

#include "context.hpp"

#include <fmt/format.h>

namespace cayspin::paper {

void figures(Context const& context) {
  fmt::print("\nFigures, by the labels of the paper's source\n");
  figure_trajectories(context);
  figure_slab(context, weak_overdamped, "fig:1",
              "The paper: Euler at 0.0001 and geometric Euler at 0.01 nearly coincide, sigma = 10 "
              "turns further. So here; but on this slab Euler at 0.01 is as near, and it is the "
              "norm that it loses.");
  figure_slab(context, strong_overdamped, "fig:2",
              "As fig:1. The paper's |m| = 1.001183806 of Euler at 0.0001 belongs to a start that "
              "it does not name.");
  figure_slab(context, full, "fig:4, fig:5",
              "The paper: geometric Euler at 0.01 departs appreciably from Euler at 0.0001. So it "
              "does with the printed sign of sigma (errata, 2); with the right one they stay "
              "together. sigma = 10 was not chosen for being near.");
  figure_orders(context);
  figure_convergence(context);
  figure_norm(context);
  fmt::print("\n  numbers in {0}; pictures: python3 python/plot_paper.py {0}\n",
             context.folder->string());
}

}  // namespace cayspin::paper
