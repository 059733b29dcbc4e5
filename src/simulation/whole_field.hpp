// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "demagnetization.hpp"
#include "host_solver.hpp"

#include <cayspin/field/host_field.hpp>
#include <cayspin/optional_members.hpp>

#include <utility>
#include <variant>

namespace cayspin::simulation {

template <class Spins>
struct SolverInPlace {
  static constexpr int degree = 2;
  FieldInPlace<Spins> field;

  template <class Exec>
  void operator()(Exec const& exec, Spins const& spins, Spins const& result, double) const {
    field(exec, spins, result);
  }
};

/// A scene's field that is computed of all spins at once: by the host, or where they are.
template <class Spins>
class WholeField {
 public:
  static constexpr int degree = 2;

  WholeField(Lattice const& lattice, HostSolver solver)
      : term_(HostField<Spins, HostSolver>(lattice, std::move(solver))) {}
  WholeField(Lattice const& lattice, FieldInPlace<Spins> field)
      : term_(HostField<Spins, SolverInPlace<Spins>>(lattice, {std::move(field)})) {}

  template <class Others>
  void check_spins(Others const& spins) const {
    std::visit([&](auto const& term) { term.check_spins(spins); }, term_);
  }
  template <class Exec, class Others>
  auto prepare(Exec const& exec, Others const& spins, double t) const {
    return std::visit([&](auto const& term) { return term.prepare(exec, spins, t); }, term_);
  }

 private:
  std::variant<HostField<Spins, HostSolver>, HostField<Spins, SolverInPlace<Spins>>> term_;
};

}  // namespace cayspin::simulation
