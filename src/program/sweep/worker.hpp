// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::program::sweep {

/// Space and threads of the runs of a worker. If other workers run at the same time
/// (is_one_of_many), the worker does not bind its threads to cores.
struct WorkerOptions {
  std::string space;
  std::optional<int> threads;
  bool is_one_of_many = false;
};

/// Another process of this program, which performs one command after another: starting a process
/// for each command would take longer than a short run. The process ends when this one does.
class Worker {
 public:
  explicit Worker(WorkerOptions const& options);
  /// Kills the process if it has not ended.
  ~Worker();
  Worker(Worker const&) = delete;
  Worker& operator=(Worker const&) = delete;

  /// Starts a command with these arguments. No other command may be running.
  void begin(std::vector<std::string> const& arguments);
  void add_to(std::vector<pollfd>& polled) const;
  /// Reads the output so far, without waiting.
  void read();
  /// Returns true once the command has ended, also by a crash of the process.
  bool has_ended() const { return status_.has_value() || has_closed(); }
  /// Returns the exit status of the command, or 128 + the signal that ended the process.
  int status();
  /// Returns true if the process can perform another command, and false after a crash.
  bool can_go_on() const { return process_ > 0 && !has_closed(); }
  /// Sends a signal, after which no command can begin.
  void stop(int signal);

  /// Returns the fraction of the command's steps that are done, which `run --report-progress`
  /// reports.
  double share() const { return share_; }
  /// Returns the last line of the command's standard error.
  std::string message() const;

 private:
  bool has_closed() const { return streams_[0] < 0 && streams_[1] < 0; }
  void read(std::size_t which);
  void take_line(std::string_view line);

  pid_t process_ = -1;
  int requests_ = -1;
  std::array<int, 2> streams_{-1, -1};
  std::array<std::string, 2> texts_;
  std::optional<int> status_;
  double share_ = 0;
};

/// The first argument of a worker's process. The second is the space; the third is the number of
/// threads, or empty.
inline constexpr char worker_word[] = "--work";

/// Performs the commands that a Worker requests on standard input, in one session of Kokkos.
/// `perform`: performs a command, and returns its exit status.
int work(std::string const& space, std::string const& threads, int (*perform)(int, char**));

}  // namespace cayspin::program::sweep
