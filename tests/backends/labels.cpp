// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Events seen by profilers: the names of the library's kernels and allocations begin with
// "cayspin::", and a step does not allocate, copy or fence.
#include "../support/landau_lifshitz.hpp"

#include <cayspin/observer/turns_at_random.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace cayspin;
using namespace cayspin::test;

namespace {

namespace tools = Kokkos::Tools::Experimental;

struct Events {
  std::vector<std::string> kernels, allocations, fences, copies, regions;
  std::size_t allocated = 0;  // bytes
};
Events events;

void begin_kernel(char const* name, std::uint32_t, std::uint64_t*) {
  events.kernels.emplace_back(name);
}
void allocate(Kokkos_Profiling_SpaceHandle, char const* label, void const*, std::uint64_t bytes) {
  events.allocations.emplace_back(label);
  events.allocated += bytes;
}
void begin_fence(char const* name, std::uint32_t, std::uint64_t*) {
  std::string const fence = name;
  // Profiling tools fence, too; their fences are left out.
  if (!fence.starts_with("Kokkos::Tools::")) events.fences.push_back(fence);
}
void begin_copy(Kokkos_Profiling_SpaceHandle, char const* to, void const*,
                Kokkos_Profiling_SpaceHandle, char const*, void const*, std::uint64_t) {
  events.copies.emplace_back(to);
}
void push_region(char const* name) { events.regions.emplace_back(name); }

/// Returns the events of a call.
template <class Call>
Events events_of(Call const& call) {
  Kokkos::fence();
  events = {};
  auto const before = tools::get_callbacks();
  tools::set_begin_parallel_for_callback(begin_kernel);
  tools::set_begin_parallel_reduce_callback(begin_kernel);
  tools::set_begin_parallel_scan_callback(begin_kernel);
  tools::set_allocate_data_callback(allocate);
  tools::set_begin_fence_callback(begin_fence);
  tools::set_begin_deep_copy_callback(begin_copy);
  tools::set_push_region_callback(push_region);
  call();
  Events const seen = events;
  tools::set_callbacks(before);
  return seen;
}

void expect_prefix(std::vector<std::string> const& names) {
  for (auto const& name : names) EXPECT_TRUE(name.starts_with("cayspin::")) << name;
}

using Exec = Kokkos::DefaultExecutionSpace;
using Field = SpinField<double>;

Slab const slab{.lattice = Lattice::cubic(9, 7, 5),
                .exchange = 1,
                .anisotropy = 0.5,
                .demag = 1,
                .applied = {0.1, 0.2, 0.3},
                .damping = 0.1};

/// Expects each of ten steps to launch the kernels `stages` and do nothing else. An earlier step
/// has made any initial allocations.
template <class Stepper>
void expect_quiet_step(std::string const& name, std::vector<std::string> const& stages) {
  Exec const exec;
  Field spins("spins", slab.lattice);
  Stepper stepper(spins);
  auto const generator = slab.natural();
  stepper.step(exec, generator, spins, 0, 0.1);
  Events const seen = events_of([&] {
    for (int n = 0; n < 10; ++n) stepper.step(exec, generator, spins, n * 0.1, 0.1);
  });
  ASSERT_EQ(seen.kernels.size(), 10 * stages.size()) << name;
  EXPECT_EQ(stages.size(), static_cast<std::size_t>(Stepper::evaluations)) << name;
  for (std::size_t i = 0; i < seen.kernels.size(); ++i)
    EXPECT_EQ(seen.kernels[i], "cayspin::" + name + "::" + stages[i % stages.size()]);
  EXPECT_EQ(seen.regions, std::vector<std::string>(10, "cayspin::" + name));
  EXPECT_TRUE(seen.allocations.empty()) << seen.allocations[0];
  EXPECT_TRUE(seen.copies.empty()) << seen.copies[0];
  EXPECT_TRUE(seen.fences.empty()) << seen.fences[0];
}

TEST(Labels, AStepIsItsStagesAndNothingElse) {
  using namespace isotropy;
  expect_quiet_step<LieEuler<Field>>("LieEuler", {"stage_1"});
  expect_quiet_step<Rkmk4<Field>>("Rkmk4", {"stage_1", "stage_2", "stage_3", "stage_4"});
  expect_quiet_step<ProjectedHeun<Field>>("Projected2", {"stage_1", "stage_2"});
  expect_quiet_step<LieHeun<Field>>("LieHeun", {"stage_1", "stage_2"});
  expect_quiet_step<LieEuler<Field, FiniteDifference>>("LieEuler", {"predict", "correct"});
  expect_quiet_step<LieEuler<Field, FiniteDifferenceBackward>>("LieEuler", {"step"});
  expect_quiet_step<LieEuler<Field, Analytic>>("LieEuler", {"rates", "rotate"});
  expect_quiet_step<LieAdamsBashforth2<Field>>("LieAdamsBashforth2", {"step"});
  expect_quiet_step<Series4<Field>>("Series4",
                                    {"derivative_1", "derivative_2", "derivative_3", "rotate"});
}

TEST(Labels, Scalars) {
  Exec const exec;
  Field const spins("spins", slab.lattice);
  auto const generator = slab.natural();
  Events const seen = events_of([&] {
    energy(exec, generator, spins);
    norm_defect(exec, spins);
    magnetization(exec, spins);
    largest_rate(exec, generator, spins);
    sample(exec, generator, Step{}, spins, generator);
  });
  EXPECT_EQ(seen.kernels, (std::vector<std::string>{"cayspin::energy", "cayspin::norm_defect",
                                                    "cayspin::magnetization",
                                                    "cayspin::largest_rate", "cayspin::sample"}));
  if (detail::is_host_execution<Exec>) {
    EXPECT_TRUE(seen.allocations.empty());
  }
}

TEST(Labels, Integrate) {
  Exec const exec;
  Field spins("spins", slab.lattice);
  Rkmk4<Field> stepper(spins);
  std::vector<Sample> samples;
  Events const seen = events_of([&] {
    integrate(exec, stepper, slab.natural(), spins, {0, 0.1, 6},
              Every(3, Record(slab.field(), samples)));
  });
  EXPECT_EQ(samples.size(), 3u);
  // Six steps take one kernel for each of two batches, or one for each stage; each of the three
  // samples takes one.
  bool const batches = detail::runs_on_calling_thread<Exec>(spins.sites());
  EXPECT_EQ(seen.kernels.size(), (batches ? 2u : 6u * 4) + 3);
  expect_prefix(seen.kernels);
  expect_prefix(seen.allocations);
}

TEST(Labels, CopiesFromAndToTheHost) {
  Field const spins("spins", slab.lattice);
  Events const seen = events_of([&] { copy_from_host(copy_to_host(spins), spins); });
  EXPECT_EQ(seen.kernels, (std::vector<std::string>{"cayspin::copy", "cayspin::copy"}));
  expect_prefix(seen.allocations);
}

// A table may be in memory that both the host and kernels reach.
TEST(Labels, TablesOfNoiseAreFilledAfterAFence) {
  detail::TableOfTurns<double, Field::memory_space> table(1);
  Exec const exec;
  std::vector<std::string> before;
  events_of([&] {
    table.get(exec, 0.5, [&](auto const& numbers) {
      before = events.fences;
      numbers(0) = 1;
    });
  });
  EXPECT_GT(std::ranges::count(before, "cayspin::ThermalNoise: the turns before are done"), 0);
}

TEST(Labels, IterationsAndEnergies) {
  Exec const exec;
  Field spins("spins", slab.lattice);
  Slab undamped = slab;
  undamped.damping = 0;
  ImplicitLieEuler by_newton(spins, isotropy::Zero{}, Cayley{}, ImplicitOptions{8, 2, 30});
  EnergyControl control(spins, undamped.natural());
  Events seen = events_of([&] {
    for (std::int64_t number = 1; number <= 2; ++number) {
      by_newton.step(exec, undamped.natural(), spins, 0, 0.1);
      control(exec, Step{.number = number, .dt = 0.1}, spins);
    }
  });
  EXPECT_GT(seen.kernels.size(), 20u);
  std::erase(seen.kernels, "Kokkos::ViewFill-1D");  // memory set to 0
  expect_prefix(seen.kernels);
  expect_prefix(seen.allocations);
  EXPECT_EQ(seen.regions.front(), "cayspin::ImplicitLieEuler");
}

/// Expects a stepper to make `fields` allocations, labelled with its name, and their total size to
/// be the stepper's work_bytes().
template <class Stepper, class... Options>
void expect_work_memory(std::string const& name, std::size_t fields, Options const&... options) {
  Field const spins("spins", slab.lattice);
  std::size_t bytes = 0;
  Events const seen = events_of([&] {
    Stepper const stepper(spins, options...);
    bytes = stepper.work_bytes();
  });
  ASSERT_FALSE(seen.allocations.empty());
  for (auto const& label : seen.allocations)
    EXPECT_TRUE(label.starts_with("cayspin::" + name + "::")) << label;
  EXPECT_EQ(seen.allocations.size(), fields) << name;
  EXPECT_EQ(seen.allocated, bytes) << name;
}

TEST(Labels, WorkMemory) {
  using namespace isotropy;
  expect_work_memory<LieEuler<Field>>("LieEuler", 1);
  expect_work_memory<LieEuler<Field, FiniteDifference>>("LieEuler", 2);
  expect_work_memory<LieEuler<Field, Analytic>>("LieEuler", 2);
  expect_work_memory<LieHeun<Field>>("LieHeun", 2);
  expect_work_memory<LieAdamsBashforth2<Field>>("LieAdamsBashforth2", 2);
  expect_work_memory<ImplicitLieEuler<Field>>("ImplicitLieEuler", 2);
  expect_work_memory<ImplicitLieEuler<Field, Analytic>>("ImplicitLieEuler", 4);
  expect_work_memory<ImplicitMidpoint<Field>>("ImplicitMidpoint", 2);
  expect_work_memory<Rkmk4<Field>>("Rkmk4", 4);
  expect_work_memory<StereographicRungeKutta<Field, tableau::Heun>>("StereographicRungeKutta", 1);
  expect_work_memory<ProjectedRk4<Field>>("Projected4", 5);
  expect_work_memory<ProjectedRungeKutta<Field, tableau::Oscillatory74>>("Projected4", 6);
  expect_work_memory<Series4<Field>>("Series4", 1);
}

}  // namespace
