// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choices.hpp"
#include "figures.hpp"
#include "numbers_file.hpp"

namespace cayspin::paper {
namespace {

constexpr int paths = 8;

class WritePaths : public HostObserver {
 public:
  WritePaths(NumbersFile& file, std::string_view body, std::string_view update)
      : file_(file), body_(body), update_(update) {}
  bool due(Step const&) const override { return true; }
  Next operator()(HostSpace const&, Step const& step, HostSpins const& spins) override {
    for (std::int64_t i = 0; i < spins.sites(); ++i) {
      auto const m = spins.get(i);
      file_.row(body_, update_, static_cast<double>(i), step.time, m.x, m.y, m.z);
    }
    return Next::proceed;
  }

 private:
  NumbersFile& file_;
  std::string_view body_, update_;
};

}  // namespace

void figure_trajectories(Context const& context) {
  NumbersFile file(context.folder, "trajectories.csv", "body,update,path,time,x,y,z");
  auto const starts = draw_bodies({Law::Shape::triaxial}, paths, context.seed);
  struct Kind {
    std::string_view name;
    std::array<double, 3> moments;
  };
  for (auto const& [name, moments] :
       {Kind{"triaxial", {0.6, 1, 1.4}}, Kind{"axisymmetric", {1, 1, 0.6}}}) {
    std::vector<Body> bodies;
    for (auto const& drawn : starts) bodies.push_back(principal_body(moments, drawn.start));
    fmt::print("\n  traj_plots: {} paths on [0, 200], dt = 0.1, {} body ({:g}, {:g}, {:g})\n",
               paths, name, moments[0], moments[1], moments[2]);
    for (auto const& [update, choice] : {std::pair("F^Eul_def", euler_def),
                                         {"F^Eul_orth", euler_orth},
                                         {"F^Eul_cor", euler_cor}}) {
      WritePaths watch(file, name, update);
      run_bodies(bodies, choice, 0.1, 200, watch);
    }
  }
  file.write();
}

}  // namespace cayspin::paper
