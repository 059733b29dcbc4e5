// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/sweep.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <tuple>

namespace cayspin::inline v0_2::detail {

/// Work memory of a Runge-Kutta step: fields for passes, or the buffers of a sweep. It also has the
/// fields that a step leaves for the next one, which survive a switch between passes and sweeps.
template <class Spins, class Tableau, class Update>
class StageMemory {
 public:
  using Real = typename Spins::value_type;
  static constexpr int stages = Tableau::stages;
  static constexpr int fields_of_passes = work_fields<Tableau, Update>();

  StageMemory(std::string const& name, Lattice const& lattice) {
    if constexpr (carried_fields<Update>() > 0)
      for (std::size_t i = 0; i < carried_.size(); ++i)
        carried_[i] = Carried(name + "::" + Update::carried[i], lattice);
  }

  void allocate_fields(std::string const& name, Lattice const& lattice) {
    free_work_memory();
    levels_ = numbered_fields<Spins, std::size_t{level_count}>(name + "::level", lattice);
    if constexpr (keeps_sum<Tableau, Update>) {
      sum_ = Spins(name + "::sum", lattice);
      Spins const last_increment(name + "::increment", lattice);
      for (std::size_t i = 0; i + 1 < increments_.size(); ++i) increments_[i] = last_increment;
    } else {
      for (int i = 0; i + 1 < stages; ++i)
        if (detail::stores_increment<Tableau, Update>(i))
          increments_[static_cast<std::size_t>(i)] =
              Spins(name + "::increment_" + std::to_string(i + 1), lattice);
    }
    if constexpr (on_host) streaming_ = levels_[0].bytes() + bytes() > last_level_cache_bytes();
  }

  void allocate_buffers(std::string const& name, Lattice const& lattice, SweepPlan const& plan) {
    free_work_memory();
    levels_[0] = Spins(name + "::next", lattice);
    buffers_ = Buffers("cayspin::" + name, plan);
    // A sweep reads its output only in the next step. By then other processes may have replaced
    // most of a shared cache, so at most usual_cache_bytes of it count here.
    streaming_ =
        levels_[0].bytes() + bytes() > std::min(last_level_cache_bytes(), usual_cache_bytes);
  }

  std::size_t bytes() const {
    std::size_t sum = sum_.bytes() + buffers_.bytes();
    for (auto const& field : carried_) sum += field.bytes();
    for (auto const& level : levels_) sum += level.bytes();
    constexpr std::size_t distinct = keeps_sum<Tableau, Update> ? 1 : stages;
    for (std::size_t i = 0; i < distinct; ++i) sum += increments_[i].bytes();
    return sum;
  }

  static std::size_t bytes_of_passes(RowLayout const& layout) {
    return fields_of_passes * layout.allocation(3) * sizeof(Real);
  }
  static std::size_t bytes_of_sweep(RowLayout const& layout, SweepPlan const& plan) {
    std::size_t const fields = 1 + carried_fields<Update>();
    return fields * layout.allocation(3) * sizeof(Real) + Buffers::bytes(plan);
  }

  /// Zeroes the fields left by the previous step.
  void forget(std::string const& label) {
    fence_all_instances<DefaultExec>("cayspin::StageMemory::forget");
    DefaultExec const exec;
    for (auto const& field : carried_) Kokkos::deep_copy(exec, field.allocation(), Real(0));
    exec.fence(label);
  }

  /// Calls visit(name, field) for the fields left by the previous step.
  template <class Visit>
  void visit_carried(Visit const& visit) const {
    for (std::size_t i = 0; i < carried_.size(); ++i) visit(Update::carried[i], carried_[i]);
  }

  /// Calls action(field..) with the fields left by the previous step.
  template <class Action>
  void with_carried(Action const& action) const {
    std::apply(action, carried_);
  }

  /// Returns the field to which a step that does not work in place writes the spins at its end.
  Spins& end() { return levels_[0]; }

  /// Returns the spins at which stage `Stage` evaluates the generator.
  template <int Stage>
  Spins const& level(Spins const& spins) const {
    return Stage == 0 ? spins : levels_[(Stage + level_count - 1) % level_count];
  }

  /// Returns the fields of one stage of a step from `spins`.
  template <class Flow>
  StageArrays<WholeFields<Real>, stages> arrays(Spins const& spins) const {
    StageArrays<WholeFields<Real>, stages> arrays;
    find_arrays<Flow>(FieldsOfStep{*this, spins}, arrays);
    return arrays;
  }

  template <class Loop>
  void set(Loop& loop) const {
    loop.next = levels_[0].output(streaming_);
    for (std::size_t i = 0; i < carried_.size(); ++i) loop.carried[i] = carried_[i].array();
    buffers_.set(loop);
  }

 private:
  static constexpr int level_count = level_fields<Tableau, Update>();
  using DefaultExec = typename Spins::memory_space::execution_space;
  using Buffers = SweepBuffers<Real, typename Spins::memory_space>;
  using Carried = SiteField<Real, 3, typename Spins::memory_space>;
  static constexpr bool on_host = is_host_execution<DefaultExec>;

  /// Locates the arrays of a stage in fields. Stores bypass the caches if the fields exceed them.
  struct FieldsOfStep {
    StageMemory const& memory;
    Spins const& first;

    auto start() const { return first.array(); }
    template <int Stage>
    auto level() const {
      return memory.level<Stage>(first).array();
    }
    template <int Stage>
    auto spins() const {
      return memory.levels_[Stage - 1].array();
    }
    template <int Stage>
    auto increment() const {
      return memory.increments_[Stage].array();
    }
    template <int Stage>
    auto new_increment() const {
      bool const read_again = keeps_sum<Tableau, Update> && Stage > 0;
      return memory.increments_[Stage].output(memory.streaming_ && !read_again);
    }
    template <int>
    auto sum_before() const {
      return memory.sum_.array();
    }
    template <int>
    auto sum() const {
      return memory.sum_.output(memory.streaming_);
    }
    template <int Stage>
    auto next() const {
      constexpr bool in_place = Stage + 1 == stages && stages > 1;
      Spins const& field = in_place ? first : memory.levels_[Stage % level_count];
      return field.output(memory.streaming_ && !in_place);
    }
    auto carried_before(std::size_t i) const { return memory.carried_[i].array(); }
    auto carried(std::size_t i) const { return memory.carried_[i].output(false); }
  };

  // Frees all memory except the fields that a step leaves for the next.
  void free_work_memory() {
    levels_ = {};
    increments_ = {};
    sum_ = {};
    buffers_ = {};
    streaming_ = false;
  }

  std::array<Spins, std::size_t{level_count}> levels_;  // a sweep uses only the first
  std::array<Spins, std::size_t{stages}> increments_;   // all the same field if keeps_sum
  Spins sum_;
  std::array<Carried, carried_fields<Update>()> carried_;
  Buffers buffers_;
  bool streaming_ = false;
};

}  // namespace cayspin::inline v0_2::detail
