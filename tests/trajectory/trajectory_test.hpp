// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/file_bytes.hpp"
#include "io/trajectory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

using cayspin::test::bytes_of;
using cayspin::test::overwrite;
using cayspin::test::read_bytes;
using cayspin::test::write_bytes;

/// A separate folder for each test, removed afterwards. Child processes of the test use it, too,
/// even if they run the test program from its start.
class TrajectoryTest : public testing::Test {
 protected:
  TrajectoryTest() {
    auto const* test = testing::UnitTest::GetInstance()->current_test_info();
    auto const own = std::filesystem::path(testing::TempDir()) /
                     ("cayspin_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    ::setenv(variable, own.c_str(), 0);
    folder_ = std::getenv(variable);
    std::filesystem::create_directories(folder_);
  }
  ~TrajectoryTest() override {
    std::filesystem::remove_all(folder_);
    ::unsetenv(variable);
  }

  std::filesystem::path folder_;

 private:
  static constexpr char const* variable = "CAYSPIN_TEST_FOLDER";
};

inline TrajectoryHeader small_header(std::string const& precision = "double") {
  TrajectoryHeader header;
  header.scene_text = "[system]\nkind = \"llg\"  # \u03bb\n";
  header.cayspin_version = "1.2.3";
  header.git_commit = "0123abc";
  header.kokkos_version = "4.7.0";
  header.space = "openmp";
  header.threads = 2;
  header.precision = precision;
  header.shape = {4, 3, 2};
  return header;
}

/// Returns distinct numbers, which differ from those of other frames by more than rounding.
template <class Real>
std::vector<Real> numbered_spins(TrajectoryHeader const& header, int frame) {
  std::vector<Real> spins(3 * header.shape[0] * header.shape[1] * header.shape[2]);
  for (std::size_t i = 0; i < spins.size(); ++i)
    spins[i] = Real(1) / Real(3 + i) + Real(frame) / Real(7);
  return spins;
}

inline Scalars numbered_scalars(int frame) {
  return {-1.5 - frame, 1e-15 * frame, {0.1 * frame, 0.2, 0.3}};
}

inline TrajectoryFile write_frames(std::filesystem::path const& path, int frames,
                                   TrajectoryStorage const& storage = {}, bool overwrite = false) {
  auto const header = small_header();
  TrajectoryFile file(path, header, overwrite, storage);
  for (int frame = 0; frame < frames; ++frame) {
    file.write_scalars(10 * frame, 0.1 * frame, numbered_scalars(frame));
    file.write_frame(10 * frame, 0.1 * frame, numbered_scalars(frame),
                     numbered_spins<double>(header, frame).data());
  }
  return file;
}

/// Returns the message of the std::runtime_error that `call` throws, which must be one line that
/// names `path`; anything else fails the test.
template <class Call>
std::string error_line(std::filesystem::path const& path, Call const& call) {
  try {
    call();
  } catch (std::runtime_error const& error) {
    std::string const message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
    return message;
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

/// Ends a child process of a test: with status 3 and the message on standard error if `call` throws
/// std::runtime_error, otherwise with 0.
template <class Call>
[[noreturn]] void exit_after(Call const& call) {
  try {
    call();
    std::exit(0);
  } catch (std::runtime_error const& error) {
    std::cerr << error.what() << std::flush;
    std::exit(3);
  }
}

inline testing::AssertionResult contains(std::string const& text, std::string const& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << text << "\" lacks \"" << part << '"';
}

}  // namespace cayspin::inline v0_2::io
