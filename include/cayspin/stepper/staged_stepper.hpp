// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stage/kernel.hpp>
#include <cayspin/stage/sweep.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

namespace cayspin::inline v0_2 {

/// Parameters of a run that determine a stepper's work memory.
struct PredictedRun {
  int threads = 1;
  bool by_time_only = true;  ///< the generator's needs_only_time (FieldTerm) is true
};

namespace detail {

/// Base class of steppers with Runge-Kutta stages, for constant or adaptive steps. On a host, a
/// step sweeps through a large field once, unless the generator needs all spins of a stage
/// beforehand (a nonlocal field). Otherwise each stage is a pass: one fused kernel over the field.
/// `Memory` holds the fields that passes need or the buffers of a sweep.
template <class Spins, class Tableau, class Update, class Isotropy, class Memory>
class StagedStepper : public StepperBase<Spins> {
 public:
  using typename StepperBase<Spins>::Real;
  static constexpr int ghosts = Tableau::stages;
  /// Number of fields, of three numbers per site, that passes need in addition to the spins.
  static constexpr int work_fields = Memory::fields_of_passes;

  /// Uses this path from now on instead of the automatic choice, and allocates its memory. Keeps
  /// the fields that a step leaves for the next one. If a later step cannot sweep, because its
  /// generator needs the spins of each stage, the stepper switches back to passes. Throws
  /// std::invalid_argument when the fields cannot be swept.
  void use(Path path) {
    if (path == Path::sweep) Sweeps::require(plan_.layout, this->label("::use"));
    path_ = path;
    if constexpr (Sweeps::possible) {
      if (path == Path::sweep) return memory_.allocate_buffers(name_, this->lattice_, plan_);
    }
    memory_.allocate_fields(name_, this->lattice_);
  }
  Path path() const { return path_; }

  /// Returns the bytes of work memory.
  std::size_t work_bytes() const { return memory_.bytes(); }
  /// Returns the predicted bytes of work memory.
  static std::size_t work_bytes(Lattice const& lattice, PredictedRun const& run) {
    auto const layout = RowLayout::of<Real>(lattice);
    if (!run.by_time_only || !Sweeps::sweeps_by_itself(layout, run.threads))
      return Memory::bytes_of_passes(layout);
    return Memory::bytes_of_sweep(layout, Sweeps::plan(layout, run.threads));
  }

 protected:
  using Sweeps = SweepChoice<Spins, Tableau, Update, work_fields>;
  static constexpr int stages = Tableau::stages;

  StagedStepper(std::string const& name, Spins const& like, Isotropy isotropy, Memory memory)
      : StepperBase<Spins>(name, like.lattice(), ghosts),
        isotropy_(checked_policy(isotropy)),
        memory_(std::move(memory)),
        name_(name),
        plan_(Sweeps::plan(like.layout(), DefaultExec().concurrency())) {
    use(Sweeps::sweeps_by_itself(like.layout(), DefaultExec().concurrency()) ? Path::sweep
                                                                             : Path::pass);
  }

  /// Runs all stages from the spins `start`, in one pass through the lattice.
  template <class Exec, class... Kernel>
  void sweep_through(Exec const& exec, Spins const& start,
                     std::tuple<Kernel...> const& kernels) const {
    SweepLoop<Tableau, Update, Real, Kernel...> loop{kernels, plan_,   start.array(), {},
                                                     {},      nullptr, nullptr};
    memory_.set(loop);
    for_each_task(exec, sweep_label_, plan_.tasks(), start.sites(), loop);
  }

  std::array<std::string, std::size_t{stages}> labels_ =
      this->template stage_labels<std::size_t{stages}>();
  Isotropy isotropy_;
  Memory memory_;

 private:
  using DefaultExec = typename Spins::memory_space::execution_space;

  std::string name_, sweep_label_ = this->label("::sweep");
  SweepPlan plan_;
  Path path_ = Path::pass;
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
