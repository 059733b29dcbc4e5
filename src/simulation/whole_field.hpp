// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "demagnetization.hpp"
#include "io/own_field.hpp"

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/field/host_field.hpp>
#include <cayspin/field/slab_demag_on_host.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>

#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

namespace cayspin::simulation {

/// Returns the vectors of a field in host memory, without a copy.
template <class HostSpins>
io::HostVectors host_vectors(HostSpins const& spins) {
  auto const array = spins.array();
  auto const& layout = spins.layout();
  return {array.data,
          std::is_same_v<typename HostSpins::value_type, double>,
          {layout.nz, layout.ny, layout.nx},
          {layout.plane, layout.pitch, 1, array.stride}};
}

/// A scene's field that is computed on the host: that of slab_demag, of demag or dipoles, or a
/// program's own.
class HostSolver {
 public:
  static constexpr int degree = 2;
  using Own = decltype(io::OwnField::nonlocal);

  explicit HostSolver(SlabDemagOnHost slab) : solver_(std::move(slab)) {}
  explicit HostSolver(Own own) : solver_(std::move(own)) {}
  template <class Real>
  explicit HostSolver(FieldOnHost<Real> field) : solver_(std::move(field)) {}

  template <class HostSpins>
  void operator()(HostSpins const& spins, HostSpins const& field, double t) const {
    if (auto const* own = std::get_if<Own>(&solver_))
      (*own)(host_vectors(spins), host_vectors(field), t);
    else if (auto const* found = std::get_if<FieldOnHost<typename HostSpins::value_type>>(&solver_))
      (*found)(spins, field);
    else
      std::get<SlabDemagOnHost>(solver_)(spins, field, t);
  }

 private:
  std::variant<SlabDemagOnHost, Own, FieldOnHost<double>, FieldOnHost<float>> solver_;
};

/// A field that is computed in the memory space of the spins.
template <class Spins>
struct SolverInPlace {
  static constexpr int degree = 2;
  FieldInPlace<Spins> field;

  template <class Exec>
  void operator()(Exec const& exec, Spins const& spins, Spins const& result, double) const {
    field(exec, spins, result);
  }
};

template <class Real>
struct TimesMoments {
  cayspin::SiteArray<Real, 3> spins;
  cayspin::SiteArray<Real, 1> moments;
  cayspin::OutputArray<Real, 3> sources;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    site.store(site.load(moments) * site.load(spins), sources);
  }
};

/// A scene's field that is computed from all spins at once, on the host or in the memory space of
/// the spins.
template <class Spins>
class WholeField {
  using Real = typename Spins::value_type;

 public:
  static constexpr int degree = 2;
  using Moments = std::optional<ScalarField<Real, typename Spins::memory_space>>;

  /// `moments`: of the sites, by which the spins are multiplied; without them all are 1.
  WholeField(Lattice const& lattice, HostSolver solver, Moments moments = {})
      : term_(HostField<Spins, HostSolver>(lattice, std::move(solver))),
        moments_(std::move(moments)) {
    make_sources(lattice);
  }
  WholeField(Lattice const& lattice, FieldInPlace<Spins> field, Moments moments = {})
      : term_(HostField<Spins, SolverInPlace<Spins>>(lattice, {std::move(field)})),
        moments_(std::move(moments)) {
    make_sources(lattice);
  }

  template <class Others>
  void check_spins(Others const& spins) const {
    std::visit([&](auto const& term) { term.check_spins(spins); }, term_);
  }
  template <class Exec, class Others>
  auto prepare(Exec const& exec, Others const& spins, double t) const {
    if (moments_) {
      TimesMoments<Real> const kernel{spins.array(), moments_->array(), sources_->output(false)};
      cayspin::detail::for_each_site<Real>(exec, "cayspin::WholeField::sources", spins.layout(),
                                           kernel, spins.layout().own);
    }
    auto const& sources = moments_ ? *sources_ : spins;
    return std::visit([&](auto const& term) { return term.prepare(exec, sources, t); }, term_);
  }

 private:
  void make_sources(Lattice const& lattice) {
    if (moments_) sources_.emplace("WholeField::sources", lattice);
  }

  std::variant<HostField<Spins, HostSolver>, HostField<Spins, SolverInPlace<Spins>>> term_;
  Moments moments_;
  std::optional<Spins> sources_;
};

}  // namespace cayspin::simulation
