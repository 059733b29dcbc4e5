// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Kernels on the device of host_device.hpp: each waits in the queue of its instance. Kernels do not
// instantiate Kokkos' loops for host threads, so that they compile fast.
#pragma once

#include "host_device.hpp"

namespace cayspin::test {

template <class Functor, class Tag, class Index>
struct LoopOverRange {
  Functor functor;
  std::int64_t begin;

  static void run(void const* body, std::int64_t from, std::int64_t to) {
    auto const& [functor, begin] = *static_cast<LoopOverRange const*>(body);
    for (std::int64_t i = begin + from; i < begin + to; ++i) call(functor, i);
  }
  template <class... Value>
  static void call(Functor const& functor, std::int64_t i, Value&... value) {
    if constexpr (std::is_void_v<Tag>)
      functor(static_cast<Index>(i), value...);
    else
      functor(Tag{}, static_cast<Index>(i), value...);
  }
};

/// Reduction of each block by itself, so that sums do not depend on the number of threads.
template <class FunctorReducer, class Tag, class Index>
struct ReductionOfBlocks {
  using Functor = typename FunctorReducer::functor_type;
  using Value = typename FunctorReducer::reducer_type::value_type;
  static_assert(!std::is_array_v<Value> && !std::is_pointer_v<Value>);
  static constexpr std::int64_t block = 256;
  FunctorReducer const& functor;
  std::int64_t begin, count;
  std::vector<Value>& parts;

  static void run(void const* body, std::int64_t from, std::int64_t to) {
    auto const& [functor, begin, count, parts] = *static_cast<ReductionOfBlocks const*>(body);
    for (std::int64_t part = from; part < to; ++part) {
      Value& value = parts[static_cast<std::size_t>(part)];
      functor.get_reducer().init(&value);
      std::int64_t const end = std::min(count, (part + 1) * block);
      for (std::int64_t i = part * block; i < end; ++i)
        LoopOverRange<Functor, Tag, Index>::call(functor.get_functor(), begin + i, value);
    }
  }
};

}  // namespace cayspin::test

namespace Kokkos::Impl {

template <class Functor, class... Traits>
class ParallelFor<Functor, RangePolicy<Traits...>, cayspin::test::HostDevice> {
 public:
  using Policy = RangePolicy<Traits...>;
  ParallelFor(Functor const& functor, Policy const& policy) : functor_(functor), policy_(policy) {}

  void execute() const {
    using Loop = cayspin::test::LoopOverRange<Functor, typename Policy::work_tag,
                                              typename Policy::member_type>;
    std::int64_t const begin = policy_.begin(), count = policy_.end() - begin;
    policy_.space().enqueue([loop = Loop{functor_, begin}, count] {
      cayspin::test::run_blocks(count, 1024, &loop, Loop::run);
    });
  }

 private:
  Functor const functor_;
  Policy const policy_;
};

template <class Functor, class... Traits>
class ParallelFor<Functor, MDRangePolicy<Traits...>, cayspin::test::HostDevice> {
 public:
  using Policy = MDRangePolicy<Traits...>;
  using Tiles = HostIterateTile<Policy, Functor, typename Policy::work_tag, void>;
  ParallelFor(Functor const& functor, Policy const& policy)
      : exec_(policy.space()), tiles_(policy, functor) {}

  void execute() const {
    exec_.enqueue([tiles = tiles_] {
      cayspin::test::run_blocks(static_cast<std::int64_t>(tiles.m_rp.m_num_tiles), 16, &tiles, run);
    });
  }
  template <class AnyPolicy, class AnyFunctor>
  static int max_tile_size_product(AnyPolicy const&, AnyFunctor const&) {
    return 1024;
  }

 private:
  static void run(void const* tiles, std::int64_t begin, std::int64_t end) {
    for (std::int64_t tile = begin; tile < end; ++tile)
      (*static_cast<Tiles const*>(tiles))(static_cast<typename Policy::index_type>(tile));
  }
  cayspin::test::HostDevice const exec_;
  Tiles const tiles_;
};

/// A reduction whose result is in host memory, as it is in every reduction to a number. execute()
/// returns once the result is there.
template <class FunctorReducer, class... Traits>
class ParallelReduce<FunctorReducer, RangePolicy<Traits...>, cayspin::test::HostDevice> {
 public:
  using Policy = RangePolicy<Traits...>;
  template <class View>
  ParallelReduce(FunctorReducer const& functor, Policy const& policy, View const& result)
      : functor_(functor), policy_(policy), result_(result.data()) {
    static_assert(std::is_same_v<typename View::memory_space, HostSpace>);
  }

  void execute() const {
    policy_.space().enqueue([this] { reduce(); });
    policy_.space().fence("HostDevice: after a reduction");
  }

 private:
  void reduce() const {
    using Blocks = cayspin::test::ReductionOfBlocks<FunctorReducer, typename Policy::work_tag,
                                                    typename Policy::member_type>;
    std::int64_t const begin = policy_.begin(), count = policy_.end() - begin;
    std::int64_t const parts = (count + Blocks::block - 1) / Blocks::block;
    std::vector<typename Blocks::Value> values(static_cast<std::size_t>(parts));
    Blocks const blocks{functor_, begin, count, values};
    cayspin::test::run_blocks(parts, 4, &blocks, Blocks::run);
    functor_.get_reducer().init(result_);
    for (auto const& value : values) functor_.get_reducer().join(result_, &value);
    functor_.get_reducer().final(result_);
  }

  FunctorReducer const functor_;
  Policy const policy_;
  typename FunctorReducer::reducer_type::pointer_type const result_;
};

}  // namespace Kokkos::Impl
