// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "situation.hpp"

#include <limits>
#include <numbers>

namespace cayspin::extremes {
namespace {

using enum Fate;
using enum Against;

Section steps() {
  Section section{"Steps",
                  R"(
Each run has one spin in a field of 1 with damping 0.1, or one rigid body without damping. At dt
1e-12 and below, the error of a step is far below epsilon, and runs are exact. At dt 1e-3 runs are
bounded, except with `classical_*`. `run` warns if dt is above the stable dt. It also warns if a
spin may turn by more than 3 radians per step, or by 2 radians where no stable dt is known. With ab2
and the orthogonal generator, the energy rises already at dt 1, which stops the run.)",
                  {exact, bounded, warned, detected},
                  {exact, drifts, warned}};
  for (char const* dt : {"1e-300", "1e-12", "1e-3", "1", "1e8", "1e160", "1e300"}) {
    double const number = std::stod(dt);
    section.add(std::string("dt ") + dt, {.damping = 0.1, .dt = number},
                number < 1e-9 ? solution : nothing);
  }
  return section;
}

Section turns() {
  Section section{"Turns",
                  R"(
Each run has either one undamped spin, which turns by the angle at the head of the column in each
step, or one rigid body, which turns about as fast. The Cayley map cannot rotate by pi. For the
exponential, dexp^-1 has a pole at 2 pi. The square of 1e160 overflows, and an overflow stops the
run at its first step. `run` warns in all four columns. With the exponential and a constant A, runs
are exact for angles of up to 1e8; with some methods in single precision, only up to 2 pi.)",
                  {exact, warned},
                  {warned}};
  for (auto const& [name, turn] : {std::pair{"pi", std::numbers::pi},
                                   {"2 pi", 2 * std::numbers::pi},
                                   {"1e8", 1e8},
                                   {"1e160", 1e160}})
    section.add(name, {.field = 128 * turn}, solution);
  return section;
}

Section fields() {
  Section section{"Fields",
                  R"(
Each run has one spin with damping 0.1, or one rigid body. A spin without a field, or along the
field, stays at rest. On x86 and ARM processors, numbers below the smallest normal number (double
precision: 2.2e-308, single: 1.2e-38) count as zero. An overflow stops the run at its first step. If
a field is switched on within a step, the error of this step may be as large as dt |A|, whatever the
order of the method.)",
                  {exact, bounded, warned, refused, detected},
                  {exact, drifts, detected}};
  section.add("A = 0", {.field = 0, .damping = 0.1}, solution);
  section.add("A along m", {.damping = 0.1, .along_field = true}, solution);
  section.add_denormal();
  section.add("1e300, dt 1e-303", {.field = 1e300, .damping = 0.1, .dt = 1e-303}, nothing, 1);
  section.add("on within a step", {.damping = 0.1, .switched_on_at = 2.5 / 128});
  return section;
}

Section dampings() {
  Section section{"Damping",
                  R"(
Each run has one spin in a field of 1 with the damping that heads the column, or one rigid body,
which has no damping. At damping 1e-12 a method may add more energy than the damping removes. `run`
then warns, or stops when the energy rises by more than round-off. At damping 1e12 the dt of these
runs is far too large.)",
                  {bounded, warned, refused, detected},
                  {drifts, warned}};
  for (char const* damping : {"0", "1e-12", "1e12"})
    section.add(damping, {.damping = std::stod(damping)});
  return section;
}

Section starts() {
  Section section{"Starts",
                  R"(
The runs have damping 0.1 and dt 1e-3. The program normalises initial spins; in these runs a length
is made wrong after that. Errors of more than 64 epsilon are detected before the first step. An
error of one ulp stays, or the method removes it. With `classical_*` lengths are not checked.)",
                  {bounded, warned, detected},
                  {drifts}};
  Setting start{.damping = 0.1, .dt = 1e-3, .start_length = 1.001};
  section.add("1 + 1e-3", start, nothing, 0);
  auto in_single = start;
  start.start_length = 1 + std::numeric_limits<double>::epsilon();
  in_single.start_length = 1 + static_cast<double>(std::numeric_limits<float>::epsilon());
  section.situations.push_back({"1 + ulp", start, in_single, nothing, 0});
  return section;
}

Section lattices() {
  Section section{"Lattices",
                  R"(
The runs have uniform spins with exchange 1 in a field of 1, damping 0.1 and dt 1e-3. In this table
"exact" means that each spin agrees to 8 epsilon with the spin of a lattice of one site. Runs of
`red_black2` and `red_black4` are exact only on some lattices. A lattice that does not fit into
memory is refused.)",
                  {exact, refused},
                  {exact, refused}};
  using Shape = std::array<std::int64_t, 3>;
  for (auto const& [name, shape] : {std::pair{"1", Shape{1, 1, 1}},
                                    {"2", {2, 1, 1}},
                                    {"13", {13, 1, 1}},
                                    {"7 x 5 x 3", {7, 5, 3}},
                                    {"1 x 1 x 11", {1, 1, 11}},
                                    {"3e8 x 3e6", {300'000'000, 3'000'000, 1}}})
    section.add(name, {.damping = 0.1, .dt = 1e-3, .shape = shape}, one_spin);
  return section;
}

Section faults() {
  Setting few{.damping = 0.1, .dt = 1e-3, .steps = 20, .shape = {64, 1, 1}, .fault_at = 3};
  Setting many = few;
  many.shape = {5000, 1, 1};
  Section section{"Faults",
                  R"(
In lattices of 64 and of 5000 spins, one spin becomes NaN after step 3. The runs have damping 0.1
and would otherwise take 20 steps of 1e-3. `run` stops at the next step (with more than 4096 sites,
within ten steps), and writes no frame after the NaN.)",
                  {detected},
                  {detected}};
  section.add("64 spins", few, nothing, 4);
  section.add("5000 spins", many, nothing, 13);
  return section;
}

Section drift() {
  Section section{"Drift",
                  R"(
Each run has one spin without damping, and takes 5000 steps. In the last column,
`Every(100, Normalize{})` takes a Newton step towards |m| = 1 every 100 steps. Except with
`classical_*`, | |m| - 1 | then stays below some 400 epsilon, whatever the number of steps.)",
                  {bounded, warned},
                  {drifts, warned}};
  section.add("without Newton steps", {.steps = 5000});
  section.add("with Newton steps", {.steps = 5000, .normalized = 100});
  return section;
}

}  // namespace

void Section::add_denormal() {
  auto const below = [](double least) { return Setting{.field = least / 16, .damping = 0.1}; };
  situations.push_back({"denormal", below(std::numeric_limits<double>::min()),
                        below(std::numeric_limits<float>::min()), solution});
}

std::string to_string(Fate fate) {
  constexpr char const* words[] = {"exact", "bounded", "warned", "drifts", "refused", "detected"};
  return words[static_cast<std::size_t>(fate)];
}

std::vector<Section> sections() {
  return {steps(), turns(), fields(), dampings(), starts(), lattices(), faults(), drift()};
}

Section longest_runs() {
  constexpr std::int64_t steps = 100'000'000;
  Section section{"1e8 steps",
                  R"(
Each run has one spin in a field of 1 without damping, and uses rkmk4 with dt 0.37 and either
rotation. Round-off accumulates, because all steps are alike: | |m| - 1 | grows by some 0.01 epsilon
per step, to 3e-10 in double precision. In single precision it reaches 0.01 after some 7e6 steps,
and the run stops. With a Newton step every 1000 steps, | |m| - 1 | stays below some 10 epsilon.)",
                  {bounded, detected}};
  section.add("without Newton steps", {.dt = 0.37, .steps = steps}, nothing, steps);
  section.add("with Newton steps", {.dt = 0.37, .steps = steps, .normalized = 1000}, nothing,
              steps);
  return section;
}

}  // namespace cayspin::extremes
