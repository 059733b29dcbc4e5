// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <stdexcept>

namespace cayspin::simulation {

/// Exit statuses of the program.
enum Status { done = 0, wrong_usage = 2, numbers_failed = 3, interrupted = 130 };

/// The numbers of a run failed: exit status 3. what() is one line.
class NumbersFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command line asks for what cannot be: exit status 2. what() is one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace cayspin::simulation
