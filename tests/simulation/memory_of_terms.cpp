// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The memory that a plan expects of a field's terms is the memory that they allocate.
#include "../support/held_memory.hpp"
#include "scenes_of_text.hpp"
#include "simulation/plan.hpp"

#include <cayspin/row_layout.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cayspin::simulation::test {
namespace {

// Bytes of the arrays of terms that have been allocated and not freed.
std::map<void const*, std::int64_t> of_terms;

void allocate(Kokkos_Profiling_SpaceHandle, char const* label, void const* data,
              std::uint64_t bytes) {
  for (std::string_view const prefix :
       {"cayspin::FieldInPass", "cayspin::SiteDependentExchange", "cayspin::RunNoise"})
    if (std::string_view(label).starts_with(prefix))
      of_terms[data] = static_cast<std::int64_t>(bytes);
}

void deallocate(Kokkos_Profiling_SpaceHandle, char const*, void const* data, std::uint64_t) {
  of_terms.erase(data);
}

std::int64_t allocated_by(io::Scene const& scene, Precision precision) {
  namespace tools = Kokkos::Tools::Experimental;
  auto const before = tools::get_callbacks();
  of_terms.clear();
  tools::set_allocate_data_callback(allocate);
  tools::set_deallocate_data_callback(deallocate);
  auto const run = SceneRun::open(scene, {.precision = precision});
  tools::set_callbacks(before);
  std::int64_t sum = 0;
  for (auto const& [data, bytes] : of_terms) sum += bytes;
  return sum;
}

TEST(MemoryOfTerms, IsWhatTheTermsAllocate) {
  struct Case {
    char const *damping, *lattice, *field;
    int unused = 0;  // fields of scalars that the plan expects, and these scenes do not need
  };
  std::vector<Case> const cases{
      {"0.1", "", "sources = [{ profile = ['x', 0, 0], time = 'sin(t)' }]"},
      {"0.1", "",
       "sources = [{ profile = ['x', 0, 0], time = 'sin(t)' }, { profile = ['y', 0, 0] }, "
       "{ profile = [0, 'y', 0], time = 'sin(t)' }]"},
      {"0.1", "", "exchange = '1 + x'"},
      {"0.1", "boundary = 'periodic'", "exchange = '1 + x'\ndmi = { bulk = 'x' }"},
      {"0.1", "", "dmi = { interfacial = 'x', normal = ['x', 0, 1] }"},
      {"0.1", "", "anisotropy = { constant = 'x', axis = [0, 0, 1] }"},
      {"0.1", "", "anisotropy = { constant = 0.1, constant2 = 'y', axis = ['x', 0, 1] }"},
      {"0.1", "", "anisotropy = { cubic = 'x', axes = [[1, 0, 0], [0, 1, 0]] }"},
      {"'0.1 + x'", "", ""},
      {"0.1", "moments = '1 + x'", "exchange = 1"},
      {"0.1", "occupied = 'x < 0.7'", "exchange = 1"},
      {"0.1", "occupied = 'x < 0.7'", "exchange = '1 + y'"},
      {"0.1", "frozen = 'x < 0.1'", "exchange = 1"},
      {"0.1", "gyromagnetic = '1 + x'", "exchange = 1"},
      {"0.1", "regions = 'x < 0.5 ? 0 : 1'",
       "exchange = 1\ninterlayer = [{ between = [0, 1], J = 0.1 }]", 4},
      {"0.1", "regions = 'x < 0.5 ? 0 : 1'",
       "exchange = 1\nexchange_between = [{ between = [0, 1], factor = 0.5 }]"},
      {"0.1", "", "exchange = 1\n[thermal]\ntemperature = 'x'\nseed = 1"},
      {"'0.1 + x'", "", "exchange = 1\n[thermal]\ntemperature = 0.1\nseed = 1"},
      {"0.1", "moments = '1 + x'", "exchange = 1\n[thermal]\ntemperature = 0.1\nseed = 1"},
      {"0.1", "frozen = 'x < 0.1'", "exchange = 1\n[thermal]\ntemperature = 0.1\nseed = 1"},
  };
  for (auto const precision : precisions)
    for (auto const& one : cases) {
      SCOPED_TRACE(fmt::format("{} {} {}, {} precision", one.damping, one.lattice, one.field,
                               to_string(precision)));
      auto const scene = scene_of(fmt::format(
          "system = {{ kind = 'llg', damping = {} }}\n[lattice]\nshape = [40, 16, 8]\n{}\n"
          "[field]\n{}\n[initial]\nuniform = [0, 0, 1]\n"
          "[integrator]\nmethod = 'heun'\ndt = 0.01\nsteps = 1\n",
          one.damping, one.lattice, one.field));
      auto const plan = make_plan(scene, precision);
      auto const layout = precision == Precision::double_precision
                              ? RowLayout::of<double>(plan.lattice)
                              : RowLayout::of<float>(plan.lattice);
      auto const scalar = static_cast<std::int64_t>(layout.allocation(1)) *
                          (precision == Precision::double_precision ? 8 : 4);
      // Tables of the terms need less than half a field.
      auto const allocated = allocated_by(scene, precision);
      EXPECT_LE(allocated, plan.memory.field + scalar / 2);
      EXPECT_GE(allocated + one.unused * scalar, plan.memory.field);
    }
}

TEST(MemoryOfTerms, IsBesideThatOfTheEnergyControl) {
  for (auto const precision : precisions) {
    auto const work_of = [&](std::string const& control) {
      auto const scene = scene_of(
          "system = { kind = 'llg', damping = 0 }\nlattice = { shape = [40, 16, 8] }\n"
          "field = { exchange = 1 }\ninitial = { uniform = [0, 0, 1] }\n"
          "integrator = { method = 'rkmk4', dt = 0.01, steps = 1, energy_control = " +
          control + " }\n");
      cayspin::test::HeldMemory const held("cayspin::EnergyControl");
      auto const run = SceneRun::open(scene, {.precision = precision});
      return std::pair(static_cast<double>(make_plan(scene, precision).memory.work), held.most());
    };
    auto const [without, nothing] = work_of("false");
    auto const [with, held] = work_of("true");
    EXPECT_EQ(nothing, 0);
    EXPECT_GT(held, 0);
    EXPECT_EQ(with - without, held);
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
