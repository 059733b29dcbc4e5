// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "figures.hpp"
#include "numbers_file.hpp"
#include "paragraph.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::paper {
namespace {

constexpr double between_looks = 0.05;

struct SlabCurve {
  std::string_view name;
  SlabPath path;
};

double largest_norm_defect(SlabPath const& path) {
  double largest = 0;
  for (double const logarithm : path.logarithms)
    largest = std::max(largest, std::abs(std::expm1(logarithm)));
  return largest;
}

}  // namespace

void figure_slab(Context const& context, Slab const& slab, std::string_view label,
                 std::string_view remark) {
  auto const [x, y, z] = slab.applied;
  auto const looks = static_cast<int>(std::lround(slab.end / between_looks));
  fmt::print("\n  {}: slab of 100 spins, applied ({:g}, {:g}, {:g}), {}damping {:g}, [0, {:g}]\n",
             label, x, y, z, slab.precession ? "" : "overdamped, ", slab.damping, slab.end);
  auto const reference = run_slab(slab, rkmk4_def, 0.0025, looks);
  SlabCurve const curves[]{
      {"Euler, dt = 0.0001", run_slab(slab, choose("classical_euler"), 0.0001, looks)},
      {"Euler, dt = 0.01", run_slab(slab, choose("classical_euler"), 0.01, looks)},
      {"geometric Euler, optimal sigma, dt = 0.01",
       run_slab(slab, choose("euler", Generator::standard, Isotropy::finite_difference_backward),
                0.01, looks)},
      {"geometric Euler, sigma = 10, dt = 0.01",
       run_slab(slab, choose("euler", Generator::orthogonal, Isotropy::constant, 10), 0.01,
                looks)}};
  NumbersFile file(context.folder, fmt::format("slab_{}.csv", slab.name),
                   "run,time,x,y,z,log_norm");
  auto const write = [&](std::string_view name, SlabPath const& path) {
    for (std::size_t i = 0; i < path.times.size(); ++i)
      file.row(name, path.times[i], path.spin[i].x, path.spin[i].y, path.spin[i].z,
               path.logarithms[i]);
  };
  write("accurate", reference);
  fmt::print("  {:<42} {:>22} {:>16}\n", "", "distance of a spin", "largest ||m| - 1|");
  for (auto const& [name, path] : curves) {
    fmt::print("  {:<42} {:>22.2e} {:>16.2e}\n", name, largest_distance(path, reference),
               largest_norm_defect(path));
    write(name, path);
  }
  file.write();

  auto const optimal = run_slab_with_sigma(slab, 1, 0.01, looks);
  auto const [least, most] = std::ranges::minmax(optimal.sigma);
  fmt::print("  the optimal sigma of this spin runs from {:.3g} to {:.3g}\n", least, most);
  NumbersFile sigma(context.folder, fmt::format("sigma_{}.csv", slab.name), "time,sigma");
  for (std::size_t i = 0; i < optimal.times.size(); ++i)
    sigma.row(optimal.times[i], optimal.sigma[i]);
  sigma.write();
  print_paragraph(remark);
}

}  // namespace cayspin::paper
