// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "progress.hpp"
#include "simulation/plan.hpp"
#include "simulation/ranks.hpp"

#include <cayspin/io/ovf.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

using namespace simulation;

struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;
};

struct RunOptions : SceneOptions {
  Precision precision = Precision::double_precision;
  std::optional<std::filesystem::path> output, restart;
  std::optional<std::string> space, ranks;  // ranks: "y,z"
  std::optional<int> threads, device;
  bool overwrite = false;
  Listener listener = Listener::user;
};

struct SweepOptions : SceneOptions {
  std::vector<std::string> over;  // key.path=VALUE,VALUE,...
  std::filesystem::path output;
  Precision precision = Precision::double_precision;
  std::optional<std::string> space;
  std::optional<int> jobs, threads;  // runs at a time; threads of each
  bool overwrite = false, quiet = false;
};

struct RelaxOptions : SceneOptions {
  Precision precision = Precision::double_precision;
  std::optional<std::filesystem::path> output;
  std::optional<std::string> space;
  std::optional<int> threads, device;
  double torque = 1e-6;
  std::int64_t evaluations = 100000;  // at each field
  bool keep_saddles = false, overwrite = false, quiet = false;
};

struct WatchOptions {
  std::filesystem::path file;
  bool once = false;
};

struct CheckOptions : SceneOptions {
  Precision precision = Precision::double_precision;
  std::optional<std::string> ranks;  // "y,z"
  bool json = false;
};

struct NewOptions {
  std::string kind;
  std::optional<std::filesystem::path> output;
  bool overwrite = false;
};

/// Of commands that try methods, in both precisions or in one.
struct TryOptions : SceneOptions {
  std::optional<Precision> precision;
  std::optional<std::string> space;
  std::optional<int> threads;
  bool quiet = false;
};

struct TradeOptions : TryOptions {
  double seconds = 10;  // that a run may take
  bool json = false, advice = false;
};

struct AdviseOptions : TryOptions {
  double error = 0;
  std::optional<double> budget;  // seconds
  bool json = false;
};

struct ExportOptions {
  std::filesystem::path file, folder;
  std::optional<io::OvfFormat> format;  // default: the one that keeps the bits of /spins
  std::string frames = "last";          // or "all", or a number counted from 0
  bool overwrite = false;
};

/// What a scene models, in words: headings and lines.
std::vector<std::pair<std::string, std::string>> describe(io::Scene const& scene);

/// Reduced units, or what one of them is in SI.
std::string describe_units(io::Units const& units);

/// "rkmk4, orthogonal generator, sigma = 0.7, cayley rotation"
std::string describe_method(io::Scene const& scene);

/// Where a scene is written to: `output`, or its own file. Throws io::SceneError for neither.
std::filesystem::path output_file(io::Scene const& scene,
                                  std::optional<std::filesystem::path> const& output);

/// The commands of the program. Each returns its exit status, or throws.
int run(RunOptions const& options, Ranks& ranks);
int relax(RelaxOptions const& options);
int sweep_over(SweepOptions const& options);
int watch(WatchOptions const& options);
int check(CheckOptions const& options);
int write_new(NewOptions const& options);
std::string names_of_new_scenes();  // "film, chain, ..."
int trade_off(TradeOptions const& options);
int advise_on(AdviseOptions const& options);
int methods();
int info(std::filesystem::path const& file);
int export_ovf(ExportOptions const& options);

/// Becomes the program of this name that lies beside this one, with the arguments after the
/// command. Throws UsageError when it cannot.
[[noreturn]] void become_sibling(std::string const& name, char** argv);

/// The same for a Python script of this name in share/cayspin/python, beside the folder of this
/// program.
[[noreturn]] void become_script(std::string const& name, char** argv);

}  // namespace cayspin::program
