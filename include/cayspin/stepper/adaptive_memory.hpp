// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stage/arrays.hpp>
#include <cayspin/stage/sweep.hpp>
#include <cayspin/stepper/adaptive_stage.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Work memory of an adaptive step, and the state that it leaves for the next step. The field
/// `level` is allocated only for Path::pass, and the buffers only for Path::sweep.
template <class Spins, class Tableau>
struct AdaptiveMemory {
  using Real = typename Spins::value_type;
  static constexpr int stages = Tableau::stages;
  static constexpr int fields_of_passes = stages + 4, fields_of_sweep = stages + 3;

  Spins begin, end, level, first, last;  // first, last: generator A at the spins begin and end
  std::array<Spins, std::size_t{stages - 1}> increments;
  ScalarField<Real, typename Spins::memory_space> square;  // squared error of each spin

  AdaptiveMemory(std::string const& name, Lattice const& lattice)
      : begin(name + "::begin", lattice),
        end(name + "::end", lattice),
        first(name + "::first_generator", lattice),
        last(name + "::last_generator", lattice),
        increments(numbered_fields<Spins, std::size_t{stages - 1}>(name + "::increment", lattice)),
        square(name + "::squared_error", lattice) {}

  void allocate_fields(std::string const& name, Lattice const& lattice) {
    level = Spins(name + "::level", lattice);
    buffers_ = {};
    streaming_ = exceeds_caches<DefaultExec>(begin.bytes() + bytes());
  }
  void allocate_buffers(std::string const& name, Lattice const&, SweepPlan const& plan) {
    level = {};
    buffers_ = Buffers("cayspin::" + name, plan);
    std::size_t const in_use = 4 * begin.bytes() + square.bytes() + buffers_.bytes();
    streaming_ = in_use > std::min(last_level_cache_bytes(), usual_cache_bytes);
  }

  std::size_t bytes() const {
    return fields_of_sweep * begin.bytes() + level.bytes() + square.bytes() + buffers_.bytes();
  }
  static std::size_t bytes_of_passes(RowLayout const& layout) {
    return (fields_of_passes * layout.allocation(3) + layout.allocation(1)) * sizeof(Real);
  }
  static std::size_t bytes_of_sweep(RowLayout const& layout, SweepPlan const& plan) {
    return (fields_of_sweep * layout.allocation(3) + layout.allocation(1)) * sizeof(Real) +
           Buffers::bytes(plan);
  }

  void exchange_begin_and_end() {
    swap(begin, end);
    swap(first, last);
  }

  template <class Visit>
  void visit(Visit const& visit) const {
    visit("begin", begin);
    visit("end", end);
    visit("last_generator", last);
    for (std::size_t i = 0; i < increments.size(); ++i)
      visit("increment_" + std::to_string(i + 1), increments[i]);
  }

  /// Returns the field with the spins at which stage `stage` evaluates the generator if Path::pass
  /// is used: `begin` for the first stage, `end` for the last one, and `end` and `level` in turn
  /// for the others.
  Spins const& level_of(int stage) const {
    if (stage == 0) return begin;
    return (stages - 1 - stage) % 2 == 0 ? end : level;
  }

  /// Returns the fields that the stage described by Flow reads and writes if Path::pass is used.
  template <class Flow>
  StageArrays<WholeFields<Real>, stages> arrays() const {
    StageArrays<WholeFields<Real>, stages> arrays;
    find_arrays<Flow>(FieldsOfStep{*this}, arrays);
    return arrays;
  }

  EndOutputs<Tableau, Real> outputs_of_pass() const {
    return {last.output(streaming_), square.output(false)};
  }
  EndOutputs<Tableau, Real> outputs_of_sweep(bool with_increments) const {
    EndOutputs<Tableau, Real> outputs{last.output(streaming_), square.output(false), true,
                                      with_increments};
    for (std::size_t i = 0; i < increments.size(); ++i)
      outputs.increments[i] = increments[i].output(streaming_);
    return outputs;
  }
  StepIncrements<Tableau, Real> all_increments() const {
    StepIncrements<Tableau, Real> all;
    for (std::size_t i = 0; i < increments.size(); ++i) all.array[i] = increments[i].array();
    return all;
  }

  template <class Loop>
  void set(Loop& loop) const {
    loop.next = end.output(streaming_);
    buffers_.set(loop);
  }

 private:
  using DefaultExec = typename Spins::memory_space::execution_space;
  using Buffers = SweepBuffers<Real, typename Spins::memory_space>;

  struct FieldsOfStep {
    AdaptiveMemory const& memory;

    auto start() const { return memory.begin.array(); }
    template <int Stage>
    auto level() const {
      return memory.level_of(Stage).array();
    }
    template <int Stage>
    auto increment() const {
      return memory.increments[Stage].array();
    }
    template <int Stage>
    auto new_increment() const {
      return memory.increments[Stage].output(memory.streaming_);
    }
    template <int Stage>
    auto next() const {
      return memory.level_of(std::min(Stage + 1, stages - 1)).output(memory.streaming_);
    }
  };

  Buffers buffers_;
  bool streaming_ = false;
};

}  // namespace cayspin::inline v0_2::detail
