// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "session.hpp"

#include "hdf5/reading_trial.hpp"
#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "program/progress.hpp"
#include "simulation/failure.hpp"
#include "simulation/message.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace cayspin::program::sweep {
namespace {

namespace fs = std::filesystem;

bool has_ended(io::SweptRun const& run) {
  return run.status == Status::done || run.status == Status::numbers_failed;
}

// Returns the values of a key for a message, the first and the last ones of many.
std::string some_values(std::vector<std::string> const& values) {
  if (values.size() <= 10) return fmt::format("{}", fmt::join(values, ","));
  return fmt::format("{},..,{} ({} values)", fmt::join(values.begin(), values.begin() + 3, ","),
                     values.back(), values.size());
}

// Describes the sweep in the file, `before`, by what differs from this sweep, `now`. Returns an
// empty text if they are equal.
std::string difference(io::SweepHeader const& now, io::SweepHeader const& before) {
  auto const are_equal = [](io::SweptKey const& a, io::SweptKey const& b) {
    return a.key == b.key && a.values == b.values;
  };
  if (!std::ranges::equal(now.keys, before.keys, are_equal)) {
    std::string keys;
    for (auto const& key : before.keys)
      keys += fmt::format("{}{}={}", keys.empty() ? "" : " ", key.key, some_values(key.values));
    return fmt::format("over {}", keys);
  }
  if (now.precision != before.precision) return fmt::format("in {} precision", before.precision);
  if (now.space != before.space) return fmt::format("in the space {}", before.space);
  if (now.scene_text != before.scene_text) return "of another scene";
  return {};
}

}  // namespace

Session::Session(fs::path file, Grid const& grid, bool overwrite)
    : file_(std::move(file)), folder_(io::sweep_folder(file_)), grid_(grid), copies_(file_) {
  info_.header = grid.header;
  info_.runs.resize(grid.texts.size());
  auto const parent = file_.has_parent_path() ? file_.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(parent, error))
    throw UsageError(
        fmt::format("--output {}: the folder {} does not exist", file_.string(), parent.string()));
  bool const exists = fs::exists(file_, error);
  if (exists && !overwrite) require_same_sweep();
  if (exists && overwrite) require_replaceable();
  lock_folder();
  try {
    if (!exists && !overwrite) require_no_runs();
    open(!exists || overwrite);
  } catch (...) {
    release();
    throw;
  }
}

void Session::open(bool is_new) {
  if (!is_new) {
    // Reads the file again, because another process may have completed the sweep meanwhile.
    auto const before = io::read_sweep(file_);
    info_.runs = before.runs;
    info_.complete = before.complete;
    info_.one_file = before.one_file;
    if (info_.one_file) return;
  }
  if (is_new)
    for (auto const& entry : fs::directory_iterator(folder_))
      if (auto const kind = entry.path().extension();
          kind == ".h5" || kind == ".partial" || kind == ".trial")
        fs::remove(entry.path());
  for (std::int64_t number = 0; number < info_.header.runs(); ++number) {
    auto& run = info_.runs[index(number)];
    io::SweptRun found;
    bool const is_whole = read_run(number, found);
    if (run.has_file && !found.has_file) {
      run = {};  // the file is missing or damaged, so the run is repeated
    } else if (is_whole && run.status != Status::numbers_failed) {
      found.message = run.message;
      run = found;
    }
  }
  write();
  copies_.remove_left();
}

void Session::require_same_sweep() const {
  if (!io::is_sweep(file_))
    throw UsageError(
        fmt::format("--output {}: it exists and is not the file of a sweep; accepted: another "
                    "file, or --overwrite",
                    file_.string()));
  auto const other = difference(info_.header, io::read_sweep(file_).header);
  if (other.empty()) return;
  throw UsageError(
      fmt::format("--output {}: it has a sweep {}; accepted: the same command, another file, or "
                  "--overwrite",
                  file_.string(), other));
}

void Session::require_replaceable() const {
  if (!fs::is_regular_file(file_))
    throw UsageError(fmt::format("--output {}: it is not a regular file", file_.string()));
  if (::access(file_.c_str(), W_OK) != 0)
    throw UsageError(fmt::format("--output {}: {}", file_.string(), std::strerror(errno)));
  if (io::is_being_written(file_) == true)
    throw UsageError(fmt::format("--output {}: another program is writing it", file_.string()));
}

// A new sweep would remove the runs of an earlier one whose file was moved or deleted.
void Session::require_no_runs() const {
  for (auto const& entry : fs::directory_iterator(folder_))
    if (entry.path().extension() == ".h5")
      throw UsageError(fmt::format(
          "--output {}: {} has the runs of a sweep whose file is not there; accepted: "
          "that file in its place, another file, or --overwrite, which deletes the runs",
          file_.string(), folder_.string()));
}

Session::~Session() { release(); }

// Releases the lock, and removes the folder if it is empty.
void Session::release() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(folder_, ignored);
  ::close(std::exchange(lock_, -1));
}

fs::path Session::run_file(std::int64_t number) const { return io::swept_run_file(file_, number); }

void Session::lock_folder() {
  std::error_code error;
  fs::create_directory(folder_, error);
  if (error)
    throw UsageError(
        fmt::format("{}: cannot create the folder: {}", folder_.string(), error.message()));
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  int const reason = errno;
  if (lock_ >= 0 && reason == EWOULDBLOCK)
    throw UsageError(fmt::format("--output {}: another sweep is writing it", file_.string()));
  print_message(
      "warning: {}: the folder cannot be locked ({}); another sweep with this --output would "
      "not be noticed\n",
      folder_.string(), std::strerror(reason));
}

std::vector<std::int64_t> Session::open_runs() const {
  std::vector<std::int64_t> open;
  for (std::int64_t number = 0; number < info_.header.runs(); ++number)
    if (!has_ended(run(number))) open.push_back(number);
  return open;
}

bool Session::is_finished() const { return std::ranges::all_of(info_.runs, has_ended); }

// Reads the last frame of a run's own file into `run`, even if the run failed. Returns true if the
// file is complete and belongs to this sweep.
bool Session::read_run(std::int64_t number, io::SweptRun& run) const {
  auto const path = run_file(number);
  if (!fs::exists(path)) return false;
  try {
    auto const file = io::read_info(path);
    if (file.header.scene_text != grid_.texts[index(number)] ||
        file.header.precision != info_.header.precision ||
        file.header.space != info_.header.space || file.frames == 0)
      return false;
    auto const last = static_cast<std::size_t>(file.frames) - 1;
    run.step = file.frame_steps[last];
    run.time = file.frame_times[last];
    run.scalars = file.frame_scalars[last];
    run.cost = file.cost;
    run.has_file = true;
    if (file.complete) run.status = Status::done;
    return file.complete;
  } catch (std::runtime_error const&) {
    return false;
  }
}

void Session::take(std::int64_t number, std::int64_t status, std::string const& message) {
  io::SweptRun taken;
  bool const whole = [&] {
    if (status != Status::done) return read_run(number, taken);
    // Reads the file directly, not first in a child process: a worker has just written it.
    io::WithoutTrial const scope;
    return read_run(number, taken);
  }();
  taken.status = status;
  taken.is_new = whole;
  // In the message, replaces the name of the run's own file by its group in the sweep's file.
  auto const name = run_file(number).string();
  taken.message = message;
  if (auto const place = message.find(name); place != message.npos)
    taken.message.replace(place, name.size(),
                          fmt::format("{}:/runs/{}", file_.string(), io::swept_run_name(number)));
  if (status == Status::done && !whole) {
    taken.status = Status::wrong_usage;
    taken.message =
        "the run's file does not hold a complete run of the scene with which the sweep began: the "
        "scene file has changed since";
  }
  info_.runs[index(number)] = taken;
  if (taken.status == Status::done) copies_.add(number);
  // A successful run need not be recorded at once: if the record is lost, its complete file is
  // found again.
  if (status != Status::done ||
      std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1))
    write();
}

void Session::write() {
  io::write_sweep(file_, info_);
  written_ = std::chrono::steady_clock::now();
}

bool Session::close() {
  if (!info_.one_file) {
    info_.complete = info_.one_file = is_finished();
    auto const go_on = [] { return !interrupt_requested(); };
    if (!io::write_sweep(file_, info_, go_on, info_.one_file ? &copies_ : nullptr)) return false;
  }
  if (info_.one_file && lock_ >= 0) remove_folder();
  return true;
}

void Session::remove_folder() {
  std::error_code ignored;
  for (std::int64_t number = 0; number < info_.header.runs(); ++number) {
    auto const file = run_file(number);
    for (auto const& written : {file, io::checkpoint_beside(file)}) {
      fs::remove(written, ignored);
      fs::remove(written.string() + ".partial", ignored);
    }
    fs::remove(file.string() + ".trial", ignored);  // left by a kill while the run was copied
  }
  release();
}

}  // namespace cayspin::program::sweep
