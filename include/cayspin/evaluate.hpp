// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/field/field_of_sites.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

template <class Generator, class Real>
struct GeneratorOfSites {
  Generator generator;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    site.store(evaluate(generator, Stencil<Site, Real>(site, spins)), output);
  }
};

template <class Spins, class Output>
void require_other_field(char const* output_of, Spins const& spins, Output const& output) {
  require_lattice(output_of, output.lattice(), spins.lattice());
  if (output.allocation().data() == spins.allocation().data())
    throw std::invalid_argument(std::string(output_of) + ": must not be the spins themselves");
}

}  // namespace detail

/// Writes H of every site at time t into `output`. `field`: an EffectiveField or a field term. Does
/// not wait. Throws std::invalid_argument when the field or the output was made for another lattice
/// than that of the spins, or when the output shares memory with the spins.
template <class Exec, class Field, class Real, class MemorySpace>
void evaluate_field(Exec const& exec, Field const& field, SpinField<Real, MemorySpace> const& spins,
                    double t, SiteField<Real, 3, MemorySpace> const& output) {
  detail::check_access<Exec, MemorySpace>();
  detail::require_other_field("cayspin::evaluate_field's output", spins, output);
  auto prepared = detail::prepare_term(field, exec, spins, t);
  detail::for_each_site<Real>(exec, "cayspin::evaluate_field", spins.layout(),
                              detail::FieldOfSites<decltype(prepared), Real>{
                                  std::move(prepared), spins.array(), output.output(false)});
}

/// Writes the A of m' = A x m at every site, at time t, into `output`; otherwise like
/// evaluate_field.
template <class Exec, class Generator, class Real, class MemorySpace>
void evaluate_generator(Exec const& exec, Generator const& generator,
                        SpinField<Real, MemorySpace> const& spins, double t,
                        SiteField<Real, 3, MemorySpace> const& output) {
  detail::check_access<Exec, MemorySpace>();
  detail::require_other_field("cayspin::evaluate_generator's output", spins, output);
  auto prepared = detail::prepare_term(generator, exec, spins, t);
  detail::for_each_site<Real>(exec, "cayspin::evaluate_generator", spins.layout(),
                              detail::GeneratorOfSites<decltype(prepared), Real>{
                                  std::move(prepared), spins.array(), output.output(false)});
}

}  // namespace cayspin::inline v0_2
