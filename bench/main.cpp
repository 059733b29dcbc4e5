// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "main.hpp"

#include "cayspin_git_commit.hpp"

#include <Kokkos_Core.hpp>
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#if defined(__linux__)
#include <unistd.h>
#endif

namespace {

void add_commit() {
  std::string const commit = CAYSPIN_GIT_COMMIT, dirty = "-dirty";
  bool const is_dirty = commit.ends_with(dirty);
  benchmark::AddCustomContext("git_commit", commit.substr(0, commit.find(dirty)));
  benchmark::AddCustomContext("git_dirty", is_dirty ? "yes" : "no");
}

void add_processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) {
      benchmark::AddCustomContext("processor", line.substr(line.find(':') + 2));
      break;
    }
#if defined(__linux__) && defined(_SC_LEVEL3_CACHE_SIZE)
  benchmark::AddCustomContext("l2_bytes", std::to_string(sysconf(_SC_LEVEL2_CACHE_SIZE)));
  benchmark::AddCustomContext("l3_bytes", std::to_string(sysconf(_SC_LEVEL3_CACHE_SIZE)));
#endif
}

void add_kokkos() {
  using Exec = Kokkos::DefaultExecutionSpace;
  std::ostringstream version, configuration;
  version << KOKKOS_VERSION / 10000 << '.' << KOKKOS_VERSION / 100 % 100 << '.'
          << KOKKOS_VERSION % 100;
  Kokkos::print_configuration(configuration);
  benchmark::AddCustomContext("kokkos_version", version.str());
  benchmark::AddCustomContext("execution_space", Exec::name());
  benchmark::AddCustomContext("threads", std::to_string(Exec().concurrency()));
  benchmark::AddCustomContext("kokkos_configuration", configuration.str());
}

void add_environment() {
  for (auto const* name : {"OMP_NUM_THREADS", "OMP_PROC_BIND", "OMP_PLACES", "OMP_WAIT_POLICY"}) {
    auto const* const value = std::getenv(name);
    benchmark::AddCustomContext(name, value == nullptr ? "" : value);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  register_benchmarks();
  // Defaults come first, so that the command line overrides them.
  std::vector<char*> arguments{argv[0]};
  std::string defaults[] = {"--benchmark_repetitions=5", "--benchmark_min_time=0.05",
                            "--benchmark_enable_random_interleaving=true",
                            "--benchmark_display_aggregates_only=true"};
  for (auto& option : defaults) arguments.push_back(option.data());
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  add_commit();
  add_processor();
  add_kokkos();
  add_environment();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::ClearRegisteredBenchmarks();  // frees their memory before Kokkos is finalised
  return 0;
}
