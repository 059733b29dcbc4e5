// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "display.hpp"
#include "files/available_memory.hpp"
#include "grid.hpp"
#include "program/command.hpp"
#include "program/progress.hpp"
#include "session.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/plan.hpp"
#include "simulation/text.hpp"
#include "table.hpp"
#include "worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <deque>
#include <memory>
#include <thread>

namespace cayspin::program {
namespace {

using namespace sweep;
using Clock = std::chrono::steady_clock;

struct Job {
  std::int64_t run;
  std::unique_ptr<Worker> worker;
};

// Number of concurrent runs, and the threads of each.
struct Sharing {
  int jobs;
  std::optional<int> threads;
};

// Returns how many runs fit in memory. Throws UsageError if --jobs asks for more.
std::int64_t jobs_that_fit(SweepOptions const& options, Grid const& grid) {
  auto const fits =
      grid.largest > 0 ? io::available_memory() / grid.largest : io::available_memory();
  if (options.jobs && *options.jobs > fits)
    throw UsageError(fmt::format(
        "--jobs {}: each run takes {} of memory, and {} is available; "
        "accepted: at most {}",
        *options.jobs, bytes_text(grid.largest), bytes_text(io::available_memory()), fits));
  return fits;
}

Sharing share_machine(SweepOptions const& options, Grid const& grid, std::size_t open) {
  int const cores = grid.header.space == "serial" && expected_threads() == 1
                        ? static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))
                        : expected_threads();
  bool const on_host = is_on_host(grid.header.space);
  auto const fits = jobs_that_fit(options, grid);
  std::int64_t jobs = options.jobs.value_or(on_host ? cores / options.threads.value_or(1) : 1);
  jobs = std::clamp<std::int64_t>(std::min(jobs, fits), 1,
                                  static_cast<std::int64_t>(std::max<std::size_t>(open, 1)));
  Sharing sharing{static_cast<int>(jobs), options.threads};
  if (!sharing.threads && on_host)
    sharing.threads = grid.header.space == "serial" ? 1 : std::max(1, cores / sharing.jobs);
  return sharing;
}

std::vector<std::string> arguments_of(SweepOptions const& options, Grid const& grid,
                                      std::int64_t run, std::filesystem::path const& file,
                                      Sharing const& sharing) {
  std::vector<std::string> arguments{
      "run",         options.scene.string(), "--output",    file.string(),
      "--overwrite", "--report-progress",    "--precision", grid.header.precision,
      "--space",     grid.header.space};
  for (auto const& overrides : {options.overrides, grid.header.overrides(run)})
    for (auto const& override : overrides) arguments.insert(arguments.end(), {"--set", override});
  if (sharing.threads)
    arguments.insert(arguments.end(), {"--threads", std::to_string(*sharing.threads)});
  return arguments;
}

// Stops the runs in progress. Their files are not needed, because interrupted runs start again.
void stop(std::vector<Job>& jobs) {
  for (auto const& job : jobs) job.worker->stop(SIGTERM);
  auto const deadline = Clock::now() + std::chrono::seconds(2);
  for (auto const& job : jobs)
    while (!job.worker->has_ended() && Clock::now() < deadline) {
      job.worker->read();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  jobs.clear();
}

// Performs all runs that are still to do. Returns false if interrupted.
bool run_all(SweepOptions const& options, Grid const& grid, Session& session) {
  auto const list = session.open_runs();
  std::deque<std::int64_t> open(list.begin(), list.end());
  auto const sharing = share_machine(options, grid, open.size());
  Display display(grid, list, options.quiet);
  WorkerOptions const of_workers{grid.header.space, sharing.threads, sharing.jobs > 1};
  std::vector<std::unique_ptr<Worker>> idle;
  std::vector<Job> jobs;
  auto const running = [&] {
    std::vector<Running> now;
    for (auto const& job : jobs) now.push_back({job.run, job.worker->share()});
    return now;
  };
  auto const begin_runs = [&] {
    while (!open.empty() && jobs.size() < static_cast<std::size_t>(sharing.jobs)) {
      auto const run = open.front();
      open.pop_front();
      if (idle.empty()) idle.push_back(std::make_unique<Worker>(of_workers));
      jobs.push_back({run, std::move(idle.back())});
      idle.pop_back();
      jobs.back().worker->begin(arguments_of(options, grid, run, session.run_file(run), sharing));
    }
  };
  while (!open.empty() || !jobs.empty()) {
    begin_runs();
    display.show(running());
    std::vector<pollfd> polled;
    for (auto const& job : jobs) job.worker->add_to(polled);
    ::poll(polled.data(), polled.size(), 200);
    for (auto const& job : jobs) job.worker->read();
    if (interrupt_requested()) {
      display.clear();
      stop(jobs);
      session.write();
      return false;
    }
    for (std::size_t i = 0; i < jobs.size();) {
      if (!jobs[i].worker->has_ended()) {
        ++i;
        continue;
      }
      auto job = std::move(jobs[i]);
      jobs.erase(jobs.begin() + static_cast<std::ptrdiff_t>(i));
      auto const status = job.worker->status();
      auto const message = job.worker->message();
      if (job.worker->can_go_on()) idle.push_back(std::move(job.worker));
      begin_runs();  // so that the worker need not wait until the results are taken
      session.take(job.run, status, message);
      display.ended(job.run, session.run(job.run), running());
    }
  }
  display.clear();
  return true;
}

int close_sweep(SweepOptions const& options, Session const& session, double seconds) {
  auto const& info = session.info();
  auto const count = [&](auto const& is) { return std::ranges::count_if(info.runs, is); };
  auto const failed = count([](auto const& run) { return run.status == Status::numbers_failed; });
  auto const stuck = std::ssize(info.runs) - failed -
                     count([](auto const& run) { return run.status == Status::done; });
  if (!options.quiet) {
    print_table(info);
    fmt::print("{}: {} in {}\n", options.output.string(), counted(std::ssize(info.runs), "run"),
               duration_text(seconds));
    std::fflush(stdout);
  }
  if (failed + stuck == 0) return Status::done;
  auto const first =
      std::ranges::find_if(info.runs, [](auto const& run) { return run.status != Status::done; });
  auto const number = first - info.runs.begin();
  auto const message =
      fmt::format("{}: {} of {} failed; run {}, {}: {}", options.output.string(), failed + stuck,
                  counted(std::ssize(info.runs), "run"), io::swept_run_name(number),
                  values_text(info.header, number),
                  first->message.empty() ? fmt::format("it ended with status {}", first->status)
                                         : first->message);
  if (failed > 0) throw NumbersFailed(message);
  throw std::runtime_error(message);
}

int sweep_over(SweepOptions const& options) {
  auto const begin = Clock::now();
  auto const grid = make_grid(options);
  jobs_that_fit(options, grid);  // before an existing file is replaced
  catch_signals();
  Session session(options.output, grid, options.overwrite);
  if (run_all(options, grid, session) && session.close())
    return close_sweep(options, session,
                       std::chrono::duration<double>(Clock::now() - begin).count());
  auto const open = session.open_runs().size();
  print_message("{}: interrupted with {} of {} to do; the same command{} continues it\n",
                options.output.string(), open, counted(std::ssize(session.info().runs), "run"),
                options.overwrite ? " without --overwrite" : "");
  return Status::interrupted;
}

}  // namespace

Command add_sweep(CLI::App& program) {
  auto const options = std::make_shared<SweepOptions>();
  auto* const command = program.add_subcommand(
      "sweep", "Run a scene with all combinations of some keys' values, into one file (HDF5)");
  add_scene_options(*command, *options);
  command
      ->add_option("--over", options->over,
                   "A key and its values: key.path=VALUE,VALUE,..., TOML values")
      ->required()
      ->allow_extra_args(false)
      ->type_name("KEY=VALUES");
  command->add_option("-o,--output", options->output, "The file of all runs")->required();
  command->add_option("--jobs", options->jobs, "Runs at a time")->check(CLI::Range(1, 65536));
  add_space_options(*command, *options);
  command->add_flag("--overwrite", options->overwrite,
                    "Start again where the file has a sweep, or replace another file");
  command->add_flag("--quiet", options->quiet, "No progress and no table");
  return {command, [options](Ranks&) { return sweep_over(*options); }};
}

}  // namespace cayspin::program
