// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cayspin::program::test {

using Arguments = std::vector<std::string>;

/// Returns the elements of both lists in order.
Arguments joined(Arguments first, Arguments const& more);

/// Returns the texts, with "--set" before each.
template <class... Texts>
Arguments set(Texts const&... assignments) {
  Arguments all;
  for (std::string const& one : {std::string(assignments)...})
    all.insert(all.end(), {"--set", one});
  return all;
}

/// The program's default space, and another space with bitwise equal results. With the emulated
/// device there is only one space.
#if defined(CAYSPIN_HOST_DEVICE)
inline std::string const default_space = "host_device", another_space = "host_device";
#else
inline std::string const default_space = "openmp", another_space = "serial";
#endif

/// True if cayspin-reproduce is built. It computes on hosts, so it is not built with the emulated
/// device.
#if defined(CAYSPIN_HOST_DEVICE)
inline constexpr bool has_reproduce = false;
#else
inline constexpr bool has_reproduce = true;
#endif

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool address_sanitizer = true;
#else
inline constexpr bool address_sanitizer = false;
#endif

/// Result of a run of the program.
struct Outcome {
  int status = -1;  // 128 + signal if a signal ended it
  std::string output, errors;
  double peak_bytes = 0;  // largest resident memory
};

struct Dataset {
  std::vector<std::int64_t> extents;
  std::vector<double> values;
};

/// Limits and interrupts of a run; a limit of -1 is none.
struct Treatment {
  long file_limit = -1;                       // largest file, in bytes
  long memory_limit = -1;                     // bytes of address space
  long seconds_limit = -1;                    // of processor time
  double interrupt_after = 0;                 // seconds to SIGINT once interrupt_when exists
  std::filesystem::path interrupt_when = {};  // file to wait for; empty: no SIGINT
  bool interrupt_when_caught = false;         // or wait until the program catches SIGINT
  std::filesystem::path program = CAYSPIN_PROGRAM;
};

/// Each test has its own folder, which is the program's working directory and contains chain.toml
/// and spin.toml, the scenes below.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  /// Starts the program and waits for its end.
  Outcome start(Arguments const& arguments, Treatment const& treatment = {}) const;

  /// Starts the program. Expects this status, and one line on standard error, or nothing there if
  /// `status` is 0.
  Outcome expect_status(int status, Arguments const& arguments,
                        Treatment const& treatment = {}) const;
  /// Expects status 2, no standard output, and one line on standard error that contains `part`.
  void expect_refused(Arguments const& arguments, std::string const& part,
                      Treatment const& treatment = {}) const;
  /// Returns the standard output of the program. Expects success without output on standard error.
  std::string output_of(Arguments const& arguments) const;

  /// Starts the program without waiting; discards its output.
  pid_t begin(Arguments const& arguments,
              std::filesystem::path const& program = CAYSPIN_PROGRAM) const;
  /// Sends a signal, unless it is 0, and waits for the end. Returns a status like Outcome::status.
  static int end(pid_t process, int signal);

  /// Waits until is_so() returns true, for at most a minute. Returns false if it never did.
  static bool eventually(std::function<bool()> const& is_so);

  /// Writes a scene, and runs it with --quiet into a file in the folder.
  Outcome run_into(std::string const& file, std::string const& scene,
                   Arguments const& more = {}) const;
  /// Runs a scene into out.h5. Expects success without output on standard error.
  io::TrajectoryInfo run(std::string const& scene, Arguments const& more = {}) const;
  /// Runs a scene and returns its last spins. Warnings are allowed.
  std::vector<double> end_of(std::string const& scene, Arguments const& more = {}) const;

  /// Writes FOLDER/name; returns its path.
  std::filesystem::path write(std::string const& name, std::string const& text) const;
  std::filesystem::path in_folder(std::string const& name) const { return folder_ / name; }
  bool exists(std::string const& name) const { return std::filesystem::exists(in_folder(name)); }
  io::TrajectoryInfo info_of(std::string const& name) const {
    return io::read_info(in_folder(name));
  }
  /// Returns the contents of a file in the folder.
  std::string text_of(std::string const& name) const;

  /// Returns a dataset of a file in the folder.
  Dataset read_dataset(std::string const& name, std::string const& dataset) const;

  /// Returns the last frame of a file in the folder.
  std::vector<double> last_spins(std::string const& name) const;

  std::filesystem::path folder_;
};

/// Returns the largest distance between corresponding spins; infinity for different sizes or NaN.
double distance(std::vector<double> const& a, std::vector<double> const& b);

/// Expects exactly one line, which ends in a newline.
testing::AssertionResult is_one_line(std::string const& text);

/// Returns the second of two lines; expects the first to be a warning about integrator.dt.
std::string behind_warning(std::string const& errors);

testing::AssertionResult contains(std::string const& text, std::string const& part);
testing::AssertionResult contains_all(std::string const& text,
                                      std::vector<std::string> const& parts);

/// A short run of a damped chain with exchange, two anisotropies, an applied field and a slab's
/// demag.
std::string chain_scene();
/// A single spin that turns and falls towards z.
std::string macrospin_scene();
/// Free rigid bodies.
std::string bodies_scene();

}  // namespace cayspin::program::test
