// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <exception>
#include <stdexcept>

namespace cayspin::simulation {

/// Exit statuses of the program.
enum Status { done = 0, wrong_usage = 2, numbers_failed = 3, interrupted = 130 };

/// The numbers of a run or of a search became invalid: exit status 3. what() is one line.
class NumbersFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command line, a file that it names, or an argument of a call is invalid: exit status 2.
/// what() is one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown on all other ranks when one rank fails. The failed rank reports the error. `status`: the
/// exit status of the rank that failed.
struct OtherRankFailed : std::runtime_error {
  explicit OtherRankFailed(int status_of_it)
      : std::runtime_error("another rank failed"), status(status_of_it) {}
  int status;
};

/// Returns the exit status for an exception.
inline int status_of(std::exception_ptr const& error) {
  try {
    std::rethrow_exception(error);
  } catch (NumbersFailed const&) {
    return Status::numbers_failed;
  } catch (OtherRankFailed const& other) {
    return other.status;
  } catch (...) {
    return Status::wrong_usage;
  }
}

}  // namespace cayspin::simulation
