// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// Runs the registered benchmarks interleaved and prints the median of one counter per case,
/// with the ratio to a yardstick of the same run: of speeds, above 1 where faster than the
/// yardstick, or of costs, above 1 where dearer. Cases are named PRECISION/NAME/SIZE.
class MedianTable : public benchmark::ConsoleReporter {
 public:
  enum class Ratio { speed, cost };

  MedianTable(std::string counter, std::vector<std::pair<std::string, std::string>> yardsticks,
              Ratio ratio = Ratio::speed)
      : counter_(std::move(counter)), yardsticks_(std::move(yardsticks)), ratio_(ratio) {}

  int run(int argc, char** argv) {
    // Defaults in front, so that the command line wins.
    std::vector<char*> arguments{argv[0]};
    std::string defaults[] = {"--benchmark_repetitions=9", "--benchmark_min_time=0.15",
                              "--benchmark_enable_random_interleaving=true"};
    for (auto& option : defaults) arguments.push_back(option.data());
    arguments.insert(arguments.end(), argv + 1, argv + argc);
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    print_context();
    benchmark::RunSpecifiedBenchmarks(this);
    print();
    return 0;
  }

  bool ReportContext(Context const&) override { return true; }

  void ReportRuns(std::vector<Run> const& runs) override {
    for (auto const& run : runs) {
      auto const found = run.counters.find(counter_);
      if (run.run_type == Run::RT_Iteration && found != run.counters.end())
        values_[run.run_name.function_name + "/" + run.run_name.args].push_back(found->second);
    }
  }

 private:
  static void print_context() {
    std::cout << "Kokkos " << KOKKOS_VERSION / 10000 << "." << KOKKOS_VERSION / 100 % 100 << "."
              << KOKKOS_VERSION % 100 << ", " << Kokkos::DefaultExecutionSpace::name() << ", "
              << Kokkos::DefaultExecutionSpace().concurrency() << " threads\n";
  }

  static double median(std::vector<double> values) {
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  void print() const {
    std::printf("%-38s %14s %10s %10s %8s\n", "median over repetitions", counter_.c_str(), "lowest",
                "highest", "ratio");
    for (auto const& [name, values] : values_) {
      std::printf("%-38s %14.3f %10.3f %10.3f", name.c_str(), median(values),
                  *std::min_element(values.begin(), values.end()),
                  *std::max_element(values.begin(), values.end()));
      for (auto const& [method, yardstick] : yardsticks_) {
        auto const at = name.find("/" + method + "/");
        if (at == std::string::npos) continue;
        std::string other = name;
        other.replace(at + 1, method.size(), yardstick);
        auto const found = values_.find(other);
        if (found == values_.end()) continue;
        double const speed = median(found->second) / median(values);
        std::printf(" %8.2f  of %s", ratio_ == Ratio::speed ? speed : 1 / speed, yardstick.c_str());
      }
      std::printf("\n");
    }
  }

  std::string counter_;
  std::vector<std::pair<std::string, std::string>> yardsticks_;
  Ratio ratio_;
  std::map<std::string, std::vector<double>> values_;
};
