// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/run_output.hpp"
#include "io/scene.hpp"
#include "simulation/ranks.hpp"
#include "simulation/run_files.hpp"

#include <cayspin/observer/record.hpp>
#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::program {

using namespace simulation;

/// Writer of a run's frames and samples. Only the first rank has the file.
template <class Real, class Space>
class RunWriter {
  using Spins = SpinField<Real, typename Space::memory_space>;
  using Memory = typename Space::memory_space;
  using Frame = Kokkos::View<Real* [3], Kokkos::LayoutRight, Memory>;
  using HostFrame = Kokkos::View<Real* [3], Kokkos::LayoutRight, Kokkos::HostSpace,
                                 Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  static constexpr bool on_host = std::is_same_v<Memory, Kokkos::HostSpace>;

 public:
  using OpenFile = std::function<io::RunOutput()>;

  /// `open_file` is called on the first rank at the first write, when all memory of the run has
  /// been allocated. `sites`: the number of sites of this rank's part.
  RunWriter(io::Scene const& scene, std::int64_t sites, OpenFile open_file, Ranks& ranks)
      : ranks_(ranks),
        output_(scene.output),
        cell_sites_(std::ssize(scene.lattice.basis)),
        open_file_(std::move(open_file)),
        frame_("cayspin::frame", on_host ? 0 : static_cast<std::size_t>(sites)),
        part_("cayspin::part_of_frame", ranks.many() ? static_cast<std::size_t>(sites) : 0) {}

  /// Writes a sample if `more` is given, and a frame if `frame` is true. `scene`: the scene of the
  /// stage, which gives the frame's stage and the units. `shift`: the cells by which the lattice
  /// has moved. `more`: the values of the sample that are not in its scalars.
  void write(Space const& exec, io::Scene const& scene, Sample const& now, Spins const& spins,
             std::int64_t shift, bool frame, std::optional<std::vector<double>> const& more) {
    auto const scalar_values = as_scalars(now, scene.units);
    double const time = now.time * scene.units.time;
    Real* const room = ranks_.together([&]() -> Real* {
      if (!ranks_.is_first()) return nullptr;
      if (!file_) file_.emplace(open_file_());
      if (more) file_->write_scalars(now.step, time, scalar_values, *more);
      return frame ? file_->template frame<Real>() : nullptr;
    });
    if (!frame) return;
    Real* const own = ranks_.many() ? part_.data() : room;
    copy_spins(exec, spins, own);
    if (ranks_.many()) gather_pieces(spins.lattice(), own, room);
    ranks_.together([&] {
      if (file_)
        file_->write_frame(now.step, time, scalar_values,
                           {.shift = shift, .stage = scene.begin.stage});
    });
    last_frame_ = now;
    last_units_ = scene.units;
  }

  std::optional<io::RunOutput>& file() { return file_; }
  /// Returns the step, time and scalars of the last frame written, if any.
  std::optional<Sample> const& last_frame() const { return last_frame_; }
  io::Units const& last_units() const { return last_units_; }
  /// Waits until queued data are written. Until then, another thread uses HDF5.
  void wait() {
    ranks_.together([&] {
      if (file_) file_->frames();
    });
  }

 private:
  void copy_spins(Space const& exec, Spins const& spins, Real* to) const {
    HostFrame const host(to, static_cast<std::size_t>(spins.sites()));
    if constexpr (on_host) {
      copy(exec, spins, host);
    } else {
      copy(exec, spins, frame_);
      Kokkos::deep_copy(exec, host, frame_);
    }
    exec.fence("cayspin::RunWriter: frame copied");
  }

  // Gathers the frame piece by piece, and writes all pieces but the last, which stays in the file's
  // buffer for write_frame().
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
  io::Output output_;
  std::int64_t cell_sites_;
  OpenFile open_file_;
  std::optional<io::RunOutput> file_;
  Frame frame_;  // the frame on a device, before its copy to the host; empty on a host
  // The frame on this rank's part, to be sent to the first rank.
  Kokkos::View<Real* [3], Kokkos::LayoutRight, Kokkos::HostSpace> part_;
  std::optional<Sample> last_frame_;
  io::Units last_units_;
};

}  // namespace cayspin::program
