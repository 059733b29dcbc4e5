// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Values that [ensemble] varies are checked before a run.
#include "scene_file.hpp"

namespace cayspin::inline v0_2::io::test {
namespace {

std::string refusal_of_three(std::string const& vary) {
  return refusal_of(std::string(plain_scene) +
                    "[field]\nexchange = 1\napplied = [0, 0, 1]\n[ensemble]\nreplicas = 3\n" +
                    vary);
}

TEST(EnsembleOfAScene, WrongValuesBetweenTheFirstAndTheLastAreRefused) {
  for (auto const& [values, replica] :
       {std::pair{"[0.1, -0.1, 0.1]", "1"}, {"[-0.1, 0.1, 0.1]", "0"}, {"[0.1, 0.1, -0.1]", "2"}})
    expect_holds(refusal_of_three("vary.\"system.damping\" = " + std::string(values) + "\n"),
                 "ensemble.vary: in replica " + std::string(replica) +
                     ": system.damping: -0.1 is negative; accepted: a number >= 0");
  expect_holds(refusal_of_three("vary.\"field.applied.2\" = [0, 1, 2]\n"
                                "vary.\"thermal.temperature\" = [0, 1e9, 0]\n"),
               "ensemble.vary: in replica 1: integrator.dt: damping times temperature times dt is "
               "1e+06: ");
  EXPECT_EQ(refusal_of_three("vary.\"system.damping\" = [0.1, 0, 0.1]\n"), "accepted");
}

TEST(EnsembleOfAScene, APathWithoutQuotesIsRefused) {
  for (auto const& [typed, key] : {std::pair{"vary.field.applied.2 = [0, 1, 2]", "field"},
                                   {"vary.field.exchange = { from = 0, to = 1 }", "field"},
                                   {"vary.system.damping = [0, 1, 2]", "system"},
                                   {"vary.\"field.applied\".2 = [0, 1, 2]", "field.applied"}})
    expect_holds(refusal_of_three(std::string(typed) + "\n"),
                 "ensemble.vary." + std::string(key) +
                     ": is a table of other keys; accepted: the whole path of a key in quotes, as "
                     "in vary.\"field.applied.2\" = ");
}

TEST(EnsembleOfAScene, AKeyThatVariesTwiceIsRefused) {
  for (std::string const second :
       {"'field.applied.02'", "'field.\"applied\".2'", "'field . applied . 2'"})
    expect_holds(
        refusal_of_three("vary.\"field.applied.2\" = [1, 2, 3]\nvary." + second + " = [7, 8, 9]\n"),
        "is the key field.applied.2, which varies already; accepted: each key once");
  EXPECT_EQ(refusal_of_three("vary.\"field.applied.2\" = [1, 2, 3]\n"
                             "vary.\"field.applied.01\" = [7, 8, 9]\n"),
            "accepted");
}

TEST(EnsembleOfAScene, QuotesInAPathDoNotLetAFixedKeyVary) {
  expect_holds(refusal_of_three("vary.'material.\"Ms\"' = [1, 2, 3]\n"),
               "must be the same in all replicas; accepted: a number of [field]");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
