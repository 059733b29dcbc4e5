// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>

namespace cayspin::inline v0_2::detail {

/// A term made for one lattice, constant in time. Prepared: the kernel version, made from the
/// lattice and the term's parameters.
template <class Prepared>
class TermOnLattice : public Prepared, public PreparedOnce {
 public:
  template <class Spins>
  void check_spins(Spins const& spins) const {
    require_lattice(name_, lattice_, spins.lattice());
  }
  template <class Exec, class Spins>
  Prepared prepare(Exec const&, Spins const&, double) const {
    return *this;
  }

 protected:
  template <class... Numbers>
  TermOnLattice(char const* name, Lattice const& lattice, Numbers const&... numbers)
      : Prepared(lattice, numbers...), name_(name), lattice_(lattice) {
    lattice.validate();
  }

 private:
  char const* name_;  // for messages
  Lattice lattice_;
};

}  // namespace cayspin::inline v0_2::detail
