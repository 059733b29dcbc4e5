// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Ranks of a program with MPI, started by a launcher such as mpiexec.
#include "launched_ranks.hpp"
#include "simulation/message.hpp"
#include "simulation/one_rank.hpp"
#include "simulation/parts.hpp"
#include "simulation/text.hpp"
#include "simulation/threads_of_rank.hpp"

#include <cayspin/mpi/domain.hpp>

#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <thread>
#include <type_traits>
#include <vector>

namespace cayspin::program {

using namespace simulation;

namespace {

/// An MPI datatype, freed at the end of the scope.
class Type {
 public:
  explicit Type(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  /// Describes the sites of a box within a lattice of this shape.
  Type(io::SiteBox const& box, std::array<std::int64_t, 3> const& shape, Type const& site) {
    std::array<int, 3> sizes{}, extents{}, begins{};  // the slowest axis first
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sizes[2 - axis] = static_cast<int>(shape[axis]);
      begins[2 - axis] = static_cast<int>(box.begin[axis]);
      extents[2 - axis] = static_cast<int>(box.extent[axis]);
    }
    MPI_Type_create_subarray(3, sizes.data(), extents.data(), begins.data(), MPI_ORDER_C,
                             site.type_, &type_);
    MPI_Type_commit(&type_);
  }
  Type(Type const&) = delete;
  Type& operator=(Type const&) = delete;
  ~Type() { MPI_Type_free(&type_); }

  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads_);
    use(MPI_COMM_WORLD);
  }
  MpiRanks(MpiRanks const&) = delete;
  MpiRanks& operator=(MpiRanks const&) = delete;
  ~MpiRanks() override {
    wait_for_all();
    if (comm_ != MPI_COMM_WORLD) MPI_Comm_free(&comm_);
    MPI_Finalize();
  }

  int count() const override { return count_; }
  int rank() const override { return rank_; }
  int on_this_machine() const override { return on_this_machine_; }
  int on_these_cores() const override { return on_these_cores_; }

  std::array<int, 2> division(cayspin::Lattice const& lattice, mpi::Depth const& depth,
                              std::optional<std::string> const& asked) const override {
    if (!asked) return most_parts(lattice, depth);
    auto const chosen = read_parts(*asked, lattice, depth);
    if (std::int64_t{chosen[0]} * chosen[1] > count_)
      throw UsageError(fmt::format("--ranks {}: accepted: at most {} in all, one for each rank",
                                   *asked, counted(count_, "part")));
    return chosen;
  }

  PartOfRank divide(cayspin::Lattice const& lattice, mpi::Depth const& depth,
                    std::array<int, 2> const& numbers) override {
    int const parts = numbers[0] * numbers[1];
    bool const has_part = rank_ < parts;
    keep_first(parts, "a part needs at least " + mpi::to_text(depth));
    if (!has_part || parts == 1) return {.local = lattice, .none = !has_part};
    auto const domain = std::make_shared<mpi::Domain>(
        comm_, lattice, depth, mpi::Division{.y = numbers[0], .z = numbers[1]});
    auto const box = own_sites(domain->local());
    boxes_.resize(is_first() ? static_cast<std::size_t>(count_) : 0);
    MPI_Gather(&box, sizeof box, MPI_BYTE, boxes_.data(), sizeof box, MPI_BYTE, 0, comm_);
    return {domain->local(), domain};
  }

  bool keep_first(std::int64_t most, std::string const& why) override {
    if (most >= count_) return true;
    auto const kept = static_cast<int>(most);
    bool const is_kept = rank_ < kept;
    MPI_Comm those = MPI_COMM_NULL;
    MPI_Comm_split(comm_, is_kept ? 0 : 1, rank_, &those);
    if (is_first())
      print_message("warning: {} of {} ranks {} nothing to do: {}\n", count_ - kept, count_,
                    count_ - kept == 1 ? "has" : "have", why);
    use(those);
    return is_kept;
  }

  std::array<bool, 2> any(std::array<bool, 2> wanted) const override {
    std::array<int, 2> both{wanted[0], wanted[1]};
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(MPI_IN_PLACE, both.data(), 2, MPI_INT, MPI_MAX, comm_, &request);
    wait(request);
    return {both[0] != 0, both[1] != 0};
  }

  std::int64_t lowest(std::int64_t number) const override {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(MPI_IN_PLACE, &number, 1, MPI_INT64_T, MPI_MIN, comm_, &request);
    wait(request);
    return number;
  }

  void tell(std::string& text) const override {
    auto size = static_cast<std::int64_t>(text.size());
    MPI_Bcast(&size, 1, MPI_INT64_T, 0, comm_);
    text.resize(static_cast<std::size_t>(size));
    MPI_Bcast(text.data(), static_cast<int>(size), MPI_CHAR, 0, comm_);
  }

  void gather(cayspin::Lattice const& local, std::size_t bytes_of_site, std::int64_t first,
              std::int64_t planes, void const* own, void* gathered) const override {
    Type const site(bytes_of_site);
    auto const box = own_sites(local), sent = io::in_planes(box, first, planes);
    auto const of_plane = box.extent[0] * box.extent[1];
    auto const before = (first + sent.begin[2] - box.begin[2]) * of_plane;
    auto const sites = static_cast<int>(sent.extent[2] * of_plane);
    MPI_Request request = MPI_REQUEST_NULL;
    if (sites > 0)
      MPI_Isend(
          static_cast<std::byte const*>(own) + static_cast<std::size_t>(before) * bytes_of_site,
          sites, site.get(), 0, 0, comm_, &request);
    auto shape = whole(local).shape;
    shape[2] = planes;
    for (std::size_t rank = 0; rank < boxes_.size(); ++rank) {
      auto const part = io::in_planes(boxes_[rank], first, planes);
      if (part.extent[2] == 0) continue;
      Type const there(part, shape, site);
      MPI_Recv(gathered, 1, there.get(), static_cast<int>(rank), 0, comm_, MPI_STATUS_IGNORE);
    }
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  }

  std::vector<std::byte> gather(std::vector<std::byte> own) const override {
    auto const size = static_cast<std::int64_t>(own.size());
    std::vector<std::int64_t> sizes(is_first() ? static_cast<std::size_t>(count_) : 0);
    MPI_Gather(&size, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, 0, comm_);
    if (!is_first()) {
      for_each_message(size, [&](std::int64_t begin, int bytes) {
        MPI_Send(own.data() + begin, bytes, MPI_BYTE, 0, 0, comm_);
      });
      return {};
    }
    own.resize(
        static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), std::int64_t{0})));
    std::int64_t at = size;
    for (int rank = 1; rank < count_; ++rank)
      for_each_message(sizes[static_cast<std::size_t>(rank)], [&](std::int64_t, int bytes) {
        MPI_Recv(own.data() + at, bytes, MPI_BYTE, rank, 0, comm_, MPI_STATUS_IGNORE);
        at += bytes;
      });
    return own;
  }

  void leave_by(int status) override {
    if (!many()) return;
    // The message has been printed, and MPI would add another.
    static_cast<void>(std::freopen("/dev/null", "w", stderr));
    MPI_Abort(MPI_COMM_WORLD, status);
  }

 private:
  /// Calls send(begin, bytes) for the pieces of a message that is too long for MPI's int.
  template <class Send>
  static void for_each_message(std::int64_t size, Send const& send) {
    constexpr std::int64_t most = 1 << 30;
    for (std::int64_t begin = 0; begin < size; begin += most)
      send(begin, static_cast<int>(std::min(most, size - begin)));
  }

  void use(MPI_Comm comm) {
    comm_ = comm;
    MPI_Comm_size(comm, &count_);
    MPI_Comm_rank(comm, &rank_);
    count_neighbours();
  }

  void count_neighbours() {
    static_assert(std::is_trivially_copyable_v<Cores>);
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &on_this_machine_);
    std::vector<Cores> cores(static_cast<std::size_t>(on_this_machine_));
    MPI_Allgather(&cores_, sizeof cores_, MPI_BYTE, cores.data(), sizeof cores_, MPI_BYTE, here);
    int rank = 0;
    MPI_Comm_rank(here, &rank);
    MPI_Comm_free(&here);
    on_these_cores_ = sharing_cores(cores, static_cast<std::size_t>(rank));
  }

  std::array<int, 2> most_parts(cayspin::Lattice const& lattice, mpi::Depth const& depth) const {
    for (int parts = count_; parts > 1; --parts) {
      try {
        auto const [y, z] = mpi::divide(lattice, depth, parts);
        return {y, z};
      } catch (std::invalid_argument const&) {  // the lattice has no such division
      }
    }
    return {1, 1};
  }

  static void wait(MPI_Request& request) { mpi::detail::wait_for({&request, 1}); }

  /// Waits for all ranks, without occupying a core that other ranks still need.
  static void wait_for_all() {
    MPI_Request all = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &all);
    for (int done = 0; !done;) {
      MPI_Test(&all, &done, MPI_STATUS_IGNORE);
      if (!done) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  MPI_Comm comm_ = MPI_COMM_NULL;
  Cores const cores_ = cores_of_process();  // before OpenMP binds the main thread to one of them
  std::vector<io::SiteBox> boxes_;          // the boxes of all parts, on the first rank
  int threads_ = 0, count_ = 0, rank_ = 0, on_this_machine_ = 1, on_these_cores_ = 1;
};

/// Environment variables set by launchers. python/cayspin/processes.py has the same list.
constexpr std::array launch_variables{"PMI_RANK", "PMI_SIZE", "PMIX_RANK", "OMPI_COMM_WORLD_SIZE"};

}  // namespace

std::unique_ptr<Ranks> launched_ranks() {
  if (std::ranges::any_of(launch_variables, [](char const* name) { return std::getenv(name); }))
    return std::make_unique<MpiRanks>();
  return std::make_unique<OneRank>();
}

void start_others_alone() {
  for (char const* name : launch_variables) ::unsetenv(name);
}

}  // namespace cayspin::program
