// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "plan.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {

struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
  Precision precision = Precision::double_precision;
};

struct RunOptions : SceneOptions {
  std::optional<std::filesystem::path> output, restart;
  std::optional<std::string> space;
  std::optional<int> threads, device;
  bool overwrite = false, quiet = false;
};

struct CheckOptions : SceneOptions {
  bool json = false;
};

struct TradeOptions : SceneOptions {
  std::optional<std::string> space;
  std::optional<int> threads;
  double seconds = 10;  // that a run may take
  bool json = false, advice = false;
};

struct AdviseOptions : SceneOptions {
  std::optional<std::string> space;
  std::optional<int> threads;
  double error = 0;
  std::optional<double> budget;  // seconds
};

struct ReproduceOptions {
  std::vector<std::string> parts = {"all"};
  std::int64_t bodies = 1000;
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> output;  // folder
  int threads = 1;
};

struct ExtremesOptions {
  bool json = false, longest = false;
};

/// What `reproduce` may be asked for.
std::vector<std::string> reproducible_parts();

/// The commands of the program. Each returns its exit status, or throws.
int run(RunOptions const& options);
int check(CheckOptions const& options);
int trade_off(TradeOptions const& options);
int advise_on(AdviseOptions const& options);
int methods();
int info(std::filesystem::path const& file);
int reproduce(ReproduceOptions const& options);
int extremes(ExtremesOptions const& options);

}  // namespace cayspin::program
