// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/run_output.hpp"

#include "files/file_beside.hpp"
#include "format.hpp"
#include "require.hpp"
#include "scalar_series.hpp"
#include "scalar_table.hpp"
#include "xdmf_file.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto longest_hold = std::chrono::milliseconds(500);
constexpr std::size_t most_samples = 512;
constexpr std::size_t most_parts = 8;

std::filesystem::path beside(std::filesystem::path path, char const* extension) {
  return path.replace_extension(extension);
}

void require_free_beside(std::filesystem::path const& path, char const* extension, bool overwrite) {
  auto const other = beside(path, extension);
  if (other == path)
    throw std::runtime_error(path.string() + ": the trajectory cannot end in " + extension +
                             ", which is the name of a file beside it");
  require_free(other, overwrite);
}

void require_spacing(std::array<double, 3> const& spacing) {
  for (double const along_axis : spacing)
    if (!std::isfinite(along_axis) || along_axis <= 0)
      throw std::invalid_argument("a spacing of the lattice is not a number above 0");
}

}  // namespace

class RunOutput::Implementation {
 public:
  Implementation(std::filesystem::path path, TrajectoryHeader const& header,
                 RunOutputOptions const& options)
      : single_(header.precision == single_precision) {
    if (options.xdmf) require_spacing(options.spacing);
    if (options.xdmf && header.cell_sites > 1 && options.positions.empty())
      throw std::invalid_argument("the sites of a crystal have no positions for its XDMF file");
    if (options.xdmf) require_free_beside(path, ".xdmf", options.overwrite);
    if (options.table) require_free_beside(path, ".txt", options.overwrite);
    file_.emplace(path, header, options.overwrite, options.storage, options.positions, [&] {
      if (options.xdmf)
        xdmf_.emplace(
            beside(path, ".xdmf"), path,
            XdmfGrid{header.shape, header.cell_sites, options.spacing, !options.positions.empty()},
            single_, options.overwrite);
      if (options.table)
        table_.emplace(beside(path, ".txt"), header.units.si, options.overwrite, header.more);
    });
    planes_ = header.shape[2];
    pieces_ = frame_pieces(header.shape, single_ ? sizeof(float) : sizeof(double), options.storage,
                           options.most_planes, header.cell_sites);
    for (auto& buffer : buffers_) {
      // Filled with zeros, so that the memory is really allocated before the run.
      buffer = std::make_unique<std::byte[]>(pieces_.bytes);
      free_.push_back(buffer.get());
    }
    thread_ = std::jthread([this](std::stop_token const& stop) { write_parts(stop); });
  }

  ~Implementation() {
    try {
      if (!ended_) end({}, false);
    } catch (std::exception const&) {  // writing failed; no later call can report it
    }
  }

  std::byte* frame(bool single) {
    if (single != single_)
      throw std::logic_error(path().string() + ": the frame's precision is not the file's");
    require_open();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !free_.empty() || error_; });
    rethrow();
    lent_ = true;
    return free_.front();
  }

  void write_piece() {
    if (next_plane_ + pieces_.planes >= planes_)
      throw std::logic_error(path().string() + ": write_piece for the last piece of a frame");
    hand_over_planes(pieces_.planes, std::nullopt);
  }

  void write_frame(Sample const& sample, FrameNumbers const& numbers) {
    if (next_plane_ + pieces_.planes < planes_)
      throw std::logic_error(path().string() + ": write_frame before the last piece of a frame");
    hand_over_planes(planes_ - next_plane_, Frame{sample, numbers});
  }

  void write_scalars(Sample const& sample, std::vector<double> more) {
    require_open();
    samples_.push_back({sample, std::move(more)});
    if (samples_.size() >= most_samples || Clock::now() - handed_over_ > longest_hold)
      hand_over_samples();
  }

  void end(RunCost const& cost, bool complete) {
    require_open();
    hand_over_samples();
    wait();
    ended_ = true;
    complete ? file_->finish(cost) : file_->close(cost);
    if (xdmf_) xdmf_->finish();
  }

  std::int64_t frames() {
    wait();
    return file_->frames();
  }

  std::filesystem::path const& path() const { return file_->path(); }

 private:
  // A Part is what the run hands over at once: samples, then planes of a frame, then the end of the
  // frame; or only some of these.
  struct Frame {
    Sample sample;
    FrameNumbers numbers;
  };
  struct Part {
    std::vector<ScalarTable::Line> samples = {};
    std::int64_t planes = 0;
    std::byte* spins = nullptr;
    std::optional<Frame> frame = {};
  };

  void hand_over_planes(std::int64_t planes, std::optional<Frame> const& frame) {
    require_open();
    if (!lent_)
      throw std::logic_error(path().string() + ": spins handed over without a frame() before");
    Part part{.samples = std::exchange(samples_, {}), .planes = planes, .frame = frame};
    std::unique_lock lock(mutex_);
    rethrow();
    lent_ = false;
    part.spins = free_.front();
    free_.pop_front();
    next_plane_ = frame ? 0 : next_plane_ + planes;
    hand_over(std::move(part), lock);
  }

  void require_open() const {
    if (ended_) throw std::logic_error(path().string() + ": the run has ended");
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

  void hand_over_samples() {
    if (samples_.empty()) return;
    std::unique_lock lock(mutex_);
    hand_over({.samples = std::exchange(samples_, {})}, lock);
  }

  void hand_over(Part part, std::unique_lock<std::mutex>& lock) {
    changed_.wait(lock, [&] { return parts_.size() < most_parts || error_; });
    rethrow();
    parts_.push_back(std::move(part));
    changed_.notify_all();
    handed_over_ = Clock::now();
  }

  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return (parts_.empty() && !writing_) || error_; });
    rethrow();
  }

  // Runs in the writer thread. Writes all parts, including those left when it is asked to stop, but
  // none after an error.
  void write_parts(std::stop_token const& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [&] { return !parts_.empty(); })) {
      auto const part = std::move(parts_.front());
      parts_.pop_front();
      writing_ = true;
      lock.unlock();
      std::exception_ptr error;
      try {
        write(part);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      writing_ = false;
      if (part.spins) free_.push_back(part.spins);
      error_ = error;
      changed_.notify_all();
      if (error_) return;
    }
  }

  void write(Part const& part) {
    for (auto const& [sample, more] : part.samples)
      file_->write_scalars(sample.step, sample.time, sample.scalars, more);
    if (table_) table_->append(part.samples);
    if (part.spins) file_->write_planes(part.planes, part.spins);
    if (!part.frame) return;
    auto const& [step, time, scalars] = part.frame->sample;
    file_->end_frame(step, time, scalars, part.frame->numbers);
    if (xdmf_) xdmf_->add_frame(time);
  }

  bool single_, ended_ = false;
  bool lent_ = false;  // frame() was called for the next frame or piece
  std::int64_t planes_ = 0, next_plane_ = 0;
  FramePieces pieces_;
  std::optional<TrajectoryFile> file_;
  std::optional<XdmfFile> xdmf_;
  std::optional<ScalarTable> table_;
  std::array<std::unique_ptr<std::byte[]>, 2> buffers_;
  std::vector<ScalarTable::Line> samples_;
  Clock::time_point handed_over_ = Clock::now();

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<std::byte*> free_;
  std::deque<Part> parts_;
  bool writing_ = false;
  std::exception_ptr error_;
  std::jthread thread_;  // last member: joined before what it uses is destroyed
};

RunOutput::RunOutput(std::filesystem::path path, TrajectoryHeader const& header,
                     RunOutputOptions const& options)
    : implementation_(std::make_unique<Implementation>(std::move(path), header, options)) {}

RunOutput::~RunOutput() = default;
RunOutput::RunOutput(RunOutput&&) noexcept = default;
RunOutput& RunOutput::operator=(RunOutput&&) noexcept = default;

template <class Real>
Real* RunOutput::frame() {
  return reinterpret_cast<Real*>(not_moved(implementation_).frame(std::is_same_v<Real, float>));
}
template float* RunOutput::frame<float>();
template double* RunOutput::frame<double>();

void RunOutput::write_piece() { not_moved(implementation_).write_piece(); }

void RunOutput::write_frame(std::int64_t step, double time, Scalars const& scalars,
                            FrameNumbers const& numbers) {
  not_moved(implementation_).write_frame({step, time, scalars}, numbers);
}

void RunOutput::write_scalars(std::int64_t step, double time, Scalars const& scalars,
                              std::vector<double> const& more) {
  not_moved(implementation_).write_scalars({step, time, scalars}, more);
}

void RunOutput::finish(RunCost const& cost) { not_moved(implementation_).end(cost, true); }
void RunOutput::close(RunCost const& cost) { not_moved(implementation_).end(cost, false); }
std::int64_t RunOutput::frames() { return not_moved(implementation_).frames(); }
std::filesystem::path const& RunOutput::path() const { return not_moved(implementation_).path(); }

}  // namespace cayspin::inline v0_2::io
