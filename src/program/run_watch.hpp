// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/run_output.hpp"
#include "io/scene.hpp"
#include "progress.hpp"
#include "simulation/checkpoint_schedule.hpp"
#include "simulation/ranks.hpp"
#include "simulation/run_files.hpp"
#include "simulation/running_scene.hpp"

#include <cayspin/observer/record.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <type_traits>

namespace cayspin::program {

using namespace simulation;

/// The looks at a run: frames and scalars into the file, the ends before the end, the progress. Of
/// several ranks all look at the same steps, and the first has the file.
template <class Real, class Space>
class Watch : public RunObserver<Space, SpinField<Real, typename Space::memory_space>> {
  using Spins = SpinField<Real, typename Space::memory_space>;
  using Memory = typename Space::memory_space;
  using Frame = Kokkos::View<Real* [3], Kokkos::LayoutRight, Memory>;
  using HostFrame = Kokkos::View<Real* [3], Kokkos::LayoutRight, Kokkos::HostSpace,
                                 Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  static constexpr bool on_host = std::is_same_v<Memory, Kokkos::HostSpace>;

 public:
  using OpenFile = std::function<io::RunOutput()>;
  using StoreCheckpoint = std::function<void(Step const&)>;

  /// `open_file` is called at the first look, when all memory of the run has been allocated.
  Watch(io::Scene const& scene, RunningScene<Real, Space>& run, OpenFile open_file,
        Listener listener, Ranks& ranks)
      : ranks_(ranks),
        run_(run),
        first_(run.times.first),
        output_(scene.output),
        cell_sites_(std::ssize(scene.lattice.basis)),
        units_(scene.units),
        open_file_(std::move(open_file)),
        checkpoints_(scene.output.checkpoint_every, first_),
        progress_(first_, scene.integrator.steps, io::sites(scene), !scene.integrator.tolerance,
                  listener),
        frame_("cayspin::frame", on_host ? 0 : static_cast<std::size_t>(run.spins.sites())),
        part_("cayspin::part_of_frame",
              ranks.many() ? static_cast<std::size_t>(run.spins.sites()) : 0) {}

  /// What stores a checkpoint, before the run begins.
  void store_checkpoints_by(StoreCheckpoint store) { store_checkpoint_ = std::move(store); }

  bool due(Step const& step) const override {
    return due_on_all(step) || (!ranks_.many() && (progress_.due(step) || checkpoints_.due(step) ||
                                                   interrupt_requested()));
  }

  Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
    if (progress_.due(step)) progress_.show(step);
    auto const [interrupt, stored] = ranks_.any({interrupt_requested(), checkpoints_.due(step)});
    bool const recorded = frame_due(step) || scalars_due(step) || interrupt;
    if (!recorded && !stored && !run_.guard().due(step)) return Next::proceed;

    auto const found = run_.look(exec, step, spins, true, step.last);
    failure_ = found.failure;
    if (failure_) return Next::stop;
    bool const at_rest = found.at_rest && step.number > first_;
    at_saddle_ = found.at_saddle && step.last;
    bool const ends = interrupt || at_rest;
    interrupted_ = interrupt && !at_rest && !step.last;
    if (recorded || ends)
      write(exec, found.sample, spins, frame_due(step) || ends, scalars_due(step) || ends);
    if (ends) return Next::stop;
    if (stored) {
      // HDF5 is the writer's until it has written.
      ranks_.together([&] {
        if (file_) file_->frames();
      });
      store_checkpoint_(step);
      checkpoints_.wait();
    }
    return Next::proceed;
  }

  /// Why the run failed, if it did.
  std::optional<std::string> const& failure() const { return failure_; }
  bool interrupted() const { return interrupted_; }
  /// Ended without torque, but where the energy has a direction down.
  bool at_saddle() const { return at_saddle_; }
  Sample const& last_frame() const { return last_frame_; }
  std::optional<io::RunOutput>& file() { return file_; }
  Progress& progress() { return progress_; }

 private:
  bool at(Step const& step, std::int64_t every) const {
    return step.last || step.number == first_ || step.number % every == 0;
  }
  bool frame_due(Step const& step) const { return at(step, output_.every); }
  bool scalars_due(Step const& step) const { return at(step, output_.scalars_every); }
  bool due_on_all(Step const& step) const {
    return run_.guard().due(step) || frame_due(step) || scalars_due(step) ||
           (checkpoints_.is_by_steps() && checkpoints_.due(step));
  }

  void write(Space const& exec, Sample const& now, Spins const& spins, bool frame, bool scalars) {
    auto const scalar_values = as_scalars(now, units_);
    double const time = now.time * units_.time;
    Real* const room = ranks_.together([&]() -> Real* {
      if (!ranks_.is_first()) return nullptr;
      if (!file_) file_.emplace(open_file_());
      if (scalars) file_->write_scalars(now.step, time, scalar_values);
      return frame ? file_->template frame<Real>() : nullptr;
    });
    if (!frame) return;
    Real* const own = ranks_.many() ? part_.data() : room;
    copy_spins(exec, spins, own);
    if (ranks_.many()) gather_pieces(spins.lattice(), own, room);
    ranks_.together([&] {
      if (file_) file_->write_frame(now.step, time, scalar_values);
    });
    last_frame_ = now;
  }

  void copy_spins(Space const& exec, Spins const& spins, Real* to) const {
    HostFrame const host(to, static_cast<std::size_t>(spins.sites()));
    if constexpr (on_host) {
      copy(exec, spins, host);
    } else {
      copy(exec, spins, frame_);
      Kokkos::deep_copy(exec, host, frame_);
    }
    exec.fence("cayspin::Watch: frame copied");
  }

  // Writes all but the last piece of the frame, and leaves that one in its room.
  void gather_pieces(Lattice const& local, Real const* own, Real* room) {
    auto const& shape = whole(local).shape;
    io::TrajectoryStorage const storage{output_.compression, output_.chunk};
    auto const at_once =
        io::frame_pieces(shape, sizeof(Real), storage, ranks_.planes_at_once(local), cell_sites_)
            .planes;
    for (std::int64_t first = 0;; first += at_once) {
      auto const planes = std::min(at_once, shape[2] - first);
      ranks_.gather(local, 3 * sizeof(Real), first, planes, own, room);
      if (first + planes == shape[2]) return;
      room = ranks_.together([&]() -> Real* {
        if (!file_) return nullptr;
        file_->write_piece();
        return file_->template frame<Real>();
      });
    }
  }

  Ranks& ranks_;
  RunningScene<Real, Space>& run_;
  std::int64_t first_;  // the step after which the run begins
  io::Output output_;
  std::int64_t cell_sites_;
  io::Units units_;
  OpenFile open_file_;
  StoreCheckpoint store_checkpoint_;
  CheckpointSchedule checkpoints_;
  std::optional<io::RunOutput> file_;
  Progress progress_;
  Frame frame_;  // on its way from a device
  Kokkos::View<Real* [3], Kokkos::LayoutRight, Kokkos::HostSpace> part_;  // on its way to the first
  Sample last_frame_;
  std::optional<std::string> failure_;
  bool interrupted_ = false, at_saddle_ = false;
};

}  // namespace cayspin::program
