// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes with a demagnetising field write equal files on several ranks and on one.
#include "on_ranks.hpp"

#include <tuple>
#include <utility>

namespace cayspin::program::test {
namespace {

Arguments with(Arguments const& one, Arguments const& other) {
  Arguments all = one;
  all.insert(all.end(), other.begin(), other.end());
  return all;
}

std::string const once_a_step = "method = \"rkmk4\"\nsubsteps = 2";
std::string const each_stage = "method = \"heun\"";
std::string const adaptive = "method = \"tsit5\"\ntolerance = 1e-5";

class DemagnetizedOnRanks : public OnRanks {
 protected:
  std::string scene_of(std::string const& integrator) const {
    return write("scene.toml", film("[7, 15, 21]", integrator));
  }
  static Arguments demag_of(std::string const& integrator) {
    bool const is_multirate = integrator == once_a_step;
    return {"--set",
            fmt::format("field.demag={{strength=0.8,periodic_images=[0,1,0],multirate={}}}",
                        is_multirate)};
  }
};

TEST_F(DemagnetizedOnRanks, WriteTheSameFile) {
  for (auto const& integrator : {once_a_step, each_stage, adaptive})
    for (std::string const precision : {"double", "single"}) {
      auto const scene = scene_of(integrator);
      auto const same = with(demag_of(integrator), {"--precision", precision});
      ASSERT_EQ(start(run_of(scene, "one.h5", same)).status, 0);
      for (auto const& [ranks, threads, cut] :
           {std::tuple{1, "2", "1,1"}, std::tuple{2, "1", "2,1"}, std::tuple{3, "1", "1,3"}}) {
        SCOPED_TRACE(fmt::format("{}, {}, {} ranks", integrator, precision, ranks));
        auto const outcome = start_on(
            ranks, run_of(scene, "many.h5", with(same, {"--ranks", cut, "--threads", threads})));
        ASSERT_EQ(outcome.status, 0) << outcome.errors;
        expect_same("one.h5", "many.h5");
      }
    }
}

TEST_F(DemagnetizedOnRanks, GoOnFromFilesOfOtherRanks) {
  for (auto const& integrator : {once_a_step, each_stage}) {
    SCOPED_TRACE(integrator);
    auto const scene = scene_of(integrator);
    auto const demag = demag_of(integrator);
    ASSERT_EQ(start(run_of(scene, "one.h5", demag)).status, 0);
    std::string before;
    for (auto const& [ranks, steps] : {std::pair{3, 10}, std::pair{2, 20}, std::pair{1, 30}}) {
      auto more = with(demag, {"--set", fmt::format("integrator.steps={}", steps)});
      if (!before.empty()) more = with(more, {"--restart", before});
      before = fmt::format("until_{}.h5", steps);
      auto const outcome = start_on(ranks, run_of(scene, before, more));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
    }
    EXPECT_EQ(last_spins(before), last_spins("one.h5"));
  }
}

}  // namespace
}  // namespace cayspin::program::test
