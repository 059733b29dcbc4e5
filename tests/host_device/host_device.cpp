// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#define KOKKOS_IMPL_PUBLIC_INCLUDE
#include <Kokkos_Core.hpp>
#include <impl/Kokkos_ExecSpaceManager.hpp>
#include <impl/Kokkos_SharedAlloc_timpl.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <ostream>
#include <set>

KOKKOS_IMPL_HOST_INACCESSIBLE_SHARED_ALLOCATION_RECORD_EXPLICIT_INSTANTIATION(
    cayspin::test::HostDeviceMemory);

namespace cayspin::test {
namespace {

std::recursive_mutex& device_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// All of the device's memory: one range of addresses, accessible only to its kernels and copies.
class Arena {
 public:
  static Arena& the() {
    static Arena* const arena = new Arena;  // outlives every View of static duration
    return *arena;
  }

  void* take(std::size_t bytes) {
    std::lock_guard const lock(device_mutex());
    std::size_t const size = (bytes + page_ - 1) / page_ * page_ + page_;
    for (auto gap = gaps_.begin(); gap != gaps_.end(); ++gap) {
      auto const [begin, free] = *gap;
      if (free < size) continue;
      gaps_.erase(gap);
      if (free > size) gaps_[begin + size] = free - size;
      used_ = std::max(used_, begin + size);
      taken_[begin] = size;
      if (open_ > 0) protect(PROT_READ | PROT_WRITE);
      return base_ + begin;
    }
    return nullptr;
  }

  void give_back(void* address) {
    std::lock_guard const lock(device_mutex());
    auto const taken = taken_.find(static_cast<std::size_t>(static_cast<char*>(address) - base_));
    auto [begin, size] = *taken;
    taken_.erase(taken);
    // Memory read after it was freed must not have its old content.
    madvise(base_ + begin, size, MADV_DONTNEED);
    auto const after = gaps_.find(begin + size);
    if (after != gaps_.end()) {
      size += after->second;
      gaps_.erase(after);
    }
    auto before = gaps_.lower_bound(begin);
    if (before != gaps_.begin() && (--before)->first + before->second == begin)
      before->second += size;
    else
      gaps_[begin] = size;
  }

  bool is_open() const { return open_ > 0; }
  void open() {
    if (open_++ == 0) protect(PROT_READ | PROT_WRITE);
  }
  void close() {
    if (--open_ == 0) protect(PROT_NONE);
  }

 private:
  Arena() {
    std::size_t reserved = std::size_t{16} << 30;
    void* base = addresses(reserved);
    while (base == MAP_FAILED && reserved > page_) base = addresses(reserved /= 2);
    if (base == MAP_FAILED) fail("mmap");
    base_ = static_cast<char*>(base);
    gaps_[0] = reserved;
  }

  static void* addresses(std::size_t bytes) {
    return mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  }
  void protect(int how) {
    if (used_ > 0 && mprotect(base_, used_, how) != 0) fail("mprotect");
  }
  [[noreturn]] static void fail(char const* call) {
    std::perror(call);
    std::abort();
  }

  std::size_t const page_ = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  char* base_ = nullptr;
  std::size_t used_ = 0;
  std::atomic<int> open_ = 0;
  std::map<std::size_t, std::size_t> gaps_, taken_;  // start, bytes
};

}  // namespace

HostDeviceAccess::HostDeviceAccess() {
  device_mutex().lock();
  Arena::the().open();
}
HostDeviceAccess::~HostDeviceAccess() {
  Arena::the().close();
  device_mutex().unlock();
}

void require_kernel(char const* message) {
  if (!Arena::the().is_open()) Kokkos::abort(message);
}

void fill_with_nan(void* address, std::size_t bytes) {
  HostDeviceAccess const access;
  std::memset(address, 0xff, bytes);
}

void copy_now(void* to, void const* from, std::size_t bytes) {
  HostDeviceAccess const access;
  std::memcpy(to, from, bytes);
}

namespace {
struct Blocks {
  std::int64_t count, block;
  void const* body;
  void (*run)(void const*, std::int64_t, std::int64_t);

  void operator()(std::int64_t i) const { run(body, i * block, std::min(count, (i + 1) * block)); }
};
}  // namespace

void run_blocks(std::int64_t count, std::int64_t block, void const* body,
                void (*run)(void const*, std::int64_t, std::int64_t)) {
  if (count <= 2 * block) return run(body, 0, count);
  using Policy =
      Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, Kokkos::IndexType<std::int64_t>>;
  Blocks const blocks{count, block, body, run};
  // Unlike parallel_for, this reports no kernel to profilers: the blocks are a part of one.
  Kokkos::Impl::ParallelFor<Blocks, Policy>(blocks, Policy(0, (count + block - 1) / block))
      .execute();
}

class HostDeviceQueue {
 public:
  HostDeviceQueue() {
    std::lock_guard const lock(device_mutex());
    all().insert(this);
    static std::uint32_t count = 0;
    number = ++count;
  }
  ~HostDeviceQueue() {
    std::lock_guard const lock(device_mutex());
    run();
    all().erase(this);
  }
  HostDeviceQueue(HostDeviceQueue const&) = delete;
  HostDeviceQueue& operator=(HostDeviceQueue const&) = delete;

  void push(std::function<void()> task) {
    std::lock_guard const lock(device_mutex());
    if (tasks_.size() == most) run(most / 2);
    tasks_.push_back(std::move(task));
  }
  void run() { run(tasks_.size()); }
  static void run_all() {
    std::lock_guard const lock(device_mutex());
    for (HostDeviceQueue* const queue : all()) queue->run();
    release();
  }
  /// Frees memory once no queued work may use it, so that destroying a View is not a fence, except
  /// once for every 256 MiB that are freed.
  static void free_later(void* address, std::size_t bytes) {
    std::lock_guard const lock(device_mutex());
    to_free().push_back(address);
    static std::size_t freed = 0;
    if ((freed += bytes) > most_unfreed) {
      freed = 0;
      run_all();
    }
    release();
  }
  static std::shared_ptr<HostDeviceQueue> const& shared() {
    static auto const& queue = *new auto(std::make_shared<HostDeviceQueue>());
    return queue;
  }

  std::uint32_t number;

 private:
  static constexpr std::size_t most = 1024, most_unfreed = std::size_t{1} << 28;

  void run(std::size_t count) {
    if (count == 0) return;
    HostDeviceAccess const access;
    for (; count > 0; --count, tasks_.pop_front()) tasks_.front()();
    release();
  }
  static void release() {
    for (HostDeviceQueue const* const queue : all())
      if (!queue->tasks_.empty()) return;
    for (void* const address : to_free()) Arena::the().give_back(address);
    to_free().clear();
  }
  static std::vector<void*>& to_free() {
    static auto& addresses = *new std::vector<void*>;
    return addresses;
  }
  static std::set<HostDeviceQueue*>& all() {
    static auto& queues = *new std::set<HostDeviceQueue*>;
    return queues;
  }
  std::deque<std::function<void()>> tasks_;
};

void* HostDeviceMemory::allocate(char const* label, std::size_t bytes,
                                 std::size_t logical_bytes) const {
  void* const address = Arena::the().take(bytes);
  if (address == nullptr) Kokkos::Impl::throw_bad_alloc(name(), bytes, label);
  fill_with_nan(address, bytes);
  if (Kokkos::Profiling::profileLibraryLoaded())
    Kokkos::Profiling::allocateData(Kokkos::Tools::make_space_handle(name()), label, address,
                                    logical_bytes > 0 ? logical_bytes : bytes);
  return address;
}

void HostDeviceMemory::deallocate(char const* label, void* address, std::size_t bytes,
                                  std::size_t logical_bytes) const {
  if (address == nullptr) return;
  if (Kokkos::Profiling::profileLibraryLoaded())
    Kokkos::Profiling::deallocateData(Kokkos::Tools::make_space_handle(name()), label, address,
                                      logical_bytes > 0 ? logical_bytes : bytes);
  HostDeviceQueue::free_later(address, bytes);
}

HostDevice::HostDevice() : queue_(HostDeviceQueue::shared()) {}
HostDevice HostDevice::with_own_queue() { return HostDevice(std::make_shared<HostDeviceQueue>()); }

void HostDevice::enqueue(std::function<void()> task) const { queue_->push(std::move(task)); }

void HostDevice::fence(std::string const& name) const {
  Kokkos::Tools::Experimental::Impl::profile_fence_event<HostDevice>(
      name, Kokkos::Tools::Experimental::Impl::DirectFenceIDHandle{queue_->number}, [&] {
        std::lock_guard const lock(device_mutex());
        queue_->run();
      });
}

void HostDevice::impl_static_fence(std::string const& name) {
  Kokkos::Tools::Experimental::Impl::profile_fence_event<HostDevice>(
      name, Kokkos::Tools::Experimental::SpecialSynchronizationCases::GlobalDeviceSynchronization,
      [] { HostDeviceQueue::run_all(); });
}

namespace {
bool initialized = false;
}
void HostDevice::impl_initialize(Kokkos::InitializationSettings const&) { initialized = true; }
bool HostDevice::impl_is_initialized() { return initialized; }
void HostDevice::impl_finalize() {
  HostDeviceQueue::run_all();
  initialized = false;
}

int HostDevice::concurrency() const { return Kokkos::DefaultHostExecutionSpace().concurrency(); }

std::uint32_t HostDevice::impl_instance_id() const noexcept { return queue_->number; }

void HostDevice::print_configuration(std::ostream& out, bool) const {
  out << "A device made of the host's threads, for tests\n";
}

}  // namespace cayspin::test

namespace Kokkos::Impl {
// The number 900 makes Kokkos initialise the device after the host's spaces, whose threads the
// device uses.
int const host_device_registered =
    initialize_space_factory<cayspin::test::HostDevice>("900_HostDevice");
}  // namespace Kokkos::Impl
