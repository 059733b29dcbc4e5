// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// integrator.refuse_unstable turns a warning about dt into an error, and changes nothing else.
#include "program_test.hpp"

namespace cayspin::program::test {
namespace {

class RefuseUnstable : public ProgramTest {
 protected:
  Outcome run_with(std::string const& dt, std::string const& key) const {
    return run_into("out.h5", macrospin_scene(),
                    set("integrator={method=\"rkmk4\",steps=1,dt=" + dt + key + "}"));
  }
};

TEST_F(RefuseUnstable, TurnsTheWarningIntoAnError) {
  auto const warned = run_with("1e3", "");
  EXPECT_TRUE(contains(warned.errors, "warning: ")) << warned.errors;
  EXPECT_TRUE(exists("out.h5"));
  std::filesystem::remove(in_folder("out.h5"));

  auto const refused = run_with("1e3", ",refuse_unstable=true");
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(is_one_line(refused.errors));
  EXPECT_FALSE(contains(refused.errors, "warning: "));
  auto const reason = refused.errors.substr(refused.errors.find("integrator.dt: "));
  EXPECT_TRUE(contains(warned.errors, reason)) << refused.errors;
  EXPECT_FALSE(exists("out.h5"));
}

TEST_F(RefuseUnstable, TakesAStableStep) {
  auto const outcome = run_with("0.01", ",refuse_unstable=true");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
}

TEST_F(RefuseUnstable, WithoutItRunWarns) {
  for (auto const* method : {"ab2", "implicit_midpoint", "euler"}) {
    auto const outcome = run_into(
        "out.h5", macrospin_scene(),
        set(std::string("integrator={method='") + method + "',dt=3.0,steps=1,energy_guard=false}"));
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains_all(outcome.errors, {"warning: ", "integrator.dt"}));
  }
}

}  // namespace
}  // namespace cayspin::program::test
