// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <array>
#include <string>
#include <vector>

namespace cayspin::program::sweep {

/// Another process of this program, with other arguments. It ends when this process does.
class Child {
 public:
  /// `many`: others run at the same time, so that none binds its threads to cores.
  Child(std::vector<std::string> const& arguments, bool many);
  /// Kills it if it has not ended.
  ~Child();
  Child(Child const&) = delete;
  Child& operator=(Child const&) = delete;

  void add_to(std::vector<pollfd>& polled) const;
  /// Reads its output so far; does not wait.
  void read();
  /// Returns true once it has closed its streams, as it does at its end.
  bool has_ended() const { return streams_[0] < 0 && streams_[1] < 0; }
  /// Returns its exit status, or 128 + the signal that ended it.
  int wait();
  void send(int signal) const;

  /// Returns the share of steps done, from `run --report-progress`.
  double share() const { return share_; }
  /// Returns the last line of its standard error.
  std::string message() const;

 private:
  pid_t process_ = -1;
  std::array<int, 2> streams_{-1, -1};
  std::array<std::string, 2> texts_;
  double share_ = 0;
};

}  // namespace cayspin::program::sweep
