// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "context.hpp"
#include "simulation/command_line.hpp"
#include "simulation/kokkos_settings.hpp"

#include <algorithm>
#include <array>

namespace cayspin::paper {

using namespace simulation;

namespace {

struct Part {
  std::string_view name;
  void (*print)(Context const&);
};

constexpr auto parts = std::to_array<Part>({
    {"table1", table1},
    {"table2", table2},
    {"table3", table3},
    {"table4", table4},
    {"separatrix", separatrix},
    {"figures", figures},
    {"errata", errata},
});

struct Options {
  std::vector<std::string> parts = {"all"};
  std::int64_t bodies = 1000;
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> output;  // folder
  int threads = 1;
};

std::vector<std::string> names_of_parts() {
  std::vector<std::string> names;
  for (auto const& part : parts) names.emplace_back(part.name);
  names.emplace_back("all");
  return names;
}

int perform(int argc, char** argv) {
  Options options;
  CLI::App app("The tables, figures and errata of Lewis and Nigam 2002, beside the paper's",
               "cayspin reproduce");
  app.add_option("PART", options.parts, "What to reproduce (default: all)")
      ->check(CLI::IsMember(names_of_parts()));
  app.add_option("--bodies", options.bodies, "Random bodies per table (default: 1000)")
      ->check(CLI::Range(1, 10'000'000));
  app.add_option("--seed", options.seed, "Seed of the random bodies (default: 1)");
  app.add_option("--output", options.output, "Folder for the numbers, as CSV files")
      ->type_name("DIR");
  app.add_option("--threads", options.threads, "Threads (default: 1, the systems are small)")
      ->check(CLI::Range(1, 65536));
  if (auto const status = parse(app, argc, argv)) return *status;

  KokkosSession const kokkos(space_name<Kokkos::DefaultHostExecutionSpace>(), options.threads, {});
  auto const asked = [&](std::string_view name) {
    return std::ranges::find(options.parts, name) != options.parts.end();
  };
  Context context{options.bodies, options.seed, options.output};
  if (!context.folder && (asked("all") || asked("figures"))) context.folder = "reproduction";
  for (auto const& part : parts)
    if (asked("all") || asked(part.name)) part.print(context);
  return Status::done;
}

}  // namespace
}  // namespace cayspin::paper

int main(int argc, char** argv) {
  return cayspin::simulation::perform_and_report(cayspin::paper::perform, argc, argv);
}
