// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "own_field_beside.hpp"

#include "demagnetization.hpp"
#include "ranks.hpp"
#include "scene_run.hpp"

#include <cayspin/field/slab_demag_on_host.hpp>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace cayspin::simulation {

namespace {

template <class Real>
FieldOnHost<Real> beside_own(io::Field const& field, Lattice const& lattice) {
  if (field.demag) return demagnetization_on_host<Real>(*field.demag, field.mu0, lattice);
  auto const& [x, y, z] = field.slab_demag->normal;
  return [slab = SlabDemagOnHost({x, y, z}, field.mu0 * field.slab_demag->strength)](
             auto const& spins, auto const& result) { slab(spins, result, 0); };
}

template <class Real>
class Sum {
  using HostSpins = SpinField<Real, Kokkos::HostSpace>;

 public:
  Sum(decltype(io::OwnField::nonlocal) own, FieldOnHost<Real> other, std::vector<double> moments,
      Lattice const& lattice)
      : own_(std::move(own)),
        other_(std::move(other)),
        moments_(std::move(moments)),
        sources_("OwnField::sources", lattice),
        field_("OwnField::field", lattice) {}

  void operator()(io::HostVectors const& spins, io::HostVectors const& field, double t) const {
    own_(spins, field, t);
    auto sources = packed<Real>(spins);
    for (std::size_t i = 0; i < sources.size() && !moments_.empty(); ++i)
      sources[i] *= static_cast<Real>(moments_[i / 3]);
    copy_from_host(sources, sources_);
    other_(sources_, field_);
    auto const others = copy_to_host(field_);
    auto const& [nz, ny, nx] = field.shape;
    auto const& strides = field.strides;
    auto other = others.begin();
    for (std::int64_t k = 0; k < nz; ++k)
      for (std::int64_t j = 0; j < ny; ++j)
        for (std::int64_t i = 0; i < nx; ++i)
          for (std::int64_t c = 0; c < 3; ++c)
            static_cast<Real*>(
                field.data)[k * strides[0] + j * strides[1] + i * strides[2] + c * strides[3]] +=
                *other++;
  }

 private:
  decltype(io::OwnField::nonlocal) own_;
  FieldOnHost<Real> other_;
  std::vector<double> moments_;  // empty: all are 1
  HostSpins sources_, field_;
};

}  // namespace

template <class Real>
io::Field with_joined_own_field(io::Scene const& scene, io::Field field, Lattice const& lattice) {
  bool const on_host =
      field.slab_demag && (field.slab_demag->on_host || field.slab_demag->multirate);
  if (!field.own.nonlocal || (!field.demag && !on_host)) return field;
  auto const box = own_sites(lattice);
  auto moments = field.demag && field.demag->dipoles ? io::all_moments(scene, box)
                                                     : io::moments_of_sites(scene, box);
  field.own.nonlocal = Sum<Real>(std::move(field.own.nonlocal), beside_own<Real>(field, lattice),
                                 std::move(moments), lattice);
  if (field.demag)
    field.demag.reset();
  else
    field.slab_demag.reset();
  return field;
}

template io::Field with_joined_own_field<double>(io::Scene const&, io::Field, Lattice const&);
template io::Field with_joined_own_field<float>(io::Scene const&, io::Field, Lattice const&);

}  // namespace cayspin::simulation
