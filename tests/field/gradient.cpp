// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Terms with uniform coefficients: H = -dE/dm, and both H and E equal formulas written by hand.
#include "gradient.hpp"

#include "../support/mean_field.hpp"

namespace cayspin::test {
namespace {

template <class Backend>
class Terms : public GradientTest<Backend> {};
TYPED_TEST_SUITE(Terms, Backends, BackendName);

Vec3<double> turning(double t) { return {0.7 * std::cos(t), 0.7 * std::sin(t), 0.9}; }

TYPED_TEST(Terms, Exchange) {
  for (auto const& lattice : lattices)
    this->check("exchange", lattice, EffectiveField(Exchange(lattice, 1.3)),
                exchange_by_hand(lattice, 1.3));
}

TYPED_TEST(Terms, DzyaloshinskiiMoriya) {
  Vec3<double> const n{1, -2, 2};
  for (auto const& lattice : lattices) {
    this->check("interfacial DMI", lattice, InterfacialDmi(lattice, 0.7, n),
                dmi_by_hand(lattice, [&](Bond const& bond) {
                  return 0.7 / bond.spacing * cross(unit(n), bond.along);
                }));
    this->check(
        "bulk DMI", lattice, BulkDmi(lattice, 0.7),
        dmi_by_hand(lattice, [](Bond const& bond) { return -0.7 / bond.spacing * bond.along; }));
  }
}

TYPED_TEST(Terms, CubicAnisotropy) {
  auto const& lattice = lattices[0];
  this->check("any axes", lattice, CubicAnisotropy(1.3, {1, 2, 2}, {2, 1, -2}),
              cubic_by_hand(1.3, {1, 2, 2}, {2, 1, -2}));
  this->check("one coordinate", lattice, CubicAnisotropy(-0.9, {0, 0, 2}, {3, 4, 0}),
              cubic_by_hand(-0.9, {0, 0, 2}, {3, 4, 0}));
  for (auto const& [e1, e2] :
       {std::pair<Vec3<double>, Vec3<double>>{{2, 0, 0}, {0, 1, 0}}, {{0, -3, 0}, {0, 0, 1}}})
    this->check("along coordinates", lattice, CubicAnisotropy(1.3, e1, e2),
                cubic_by_hand(1.3, {1, 0, 0}, {0, 1, 0}));
}

TYPED_TEST(Terms, LocalTerms) {
  auto const& lattice = lattices[0];
  this->check("anisotropy", lattice, UniaxialAnisotropy(1.7, {1, -2, 2}),
              anisotropy_by_hand(1.7, {1, -2, 2}));
  // Axes along a coordinate have separate code for H.
  for (Vec3<double> const& axis : {Vec3<double>{2, 0, 0}, {0, -2, 0}, {0, 0, 2}})
    this->check("anisotropy along a coordinate", lattice, UniaxialAnisotropy(1.7, axis),
                anisotropy_by_hand(1.7, axis));
  this->check("a second anisotropy", lattice, UniaxialAnisotropy(-0.4, {0, 3, 1}),
              anisotropy_by_hand(-0.4, {0, 3, 1}));
  this->check("applied field", lattice, Zeeman{{0.3, -0.4, 5}}, zeeman_by_hand({0.3, -0.4, 5}));
  this->check("field in time", lattice, TimeDependentZeeman(turning), zeeman_by_hand(turning(2.5)),
              2.5);
  this->check("slab", lattice, SlabDemag({1, 2, -2}, 1.2), slab_by_hand({1, 2, -2}, 1.2));
}

TYPED_TEST(Terms, SlabOnTheHost) {
  using OnHost = HostField<typename TypeParam::Spins, SlabDemagOnHost>;
  for (auto const& lattice : lattices)
    this->check("slab on the host", lattice,
                EffectiveField(OnHost(lattice, SlabDemagOnHost({1, 2, -2}, 1.2))),
                slab_by_hand({1, 2, -2}, 1.2), 0, epsilon<typename TypeParam::Real>);
}

/// A host field that does not depend on the spins.
struct Given {
  static constexpr int degree = 1;
  template <class HostSpins>
  void operator()(HostSpins const&, HostSpins const& field, double t) const {
    using Real = typename HostSpins::value_type;
    auto const h = turning(t);
    for (std::int64_t site = 0; site < field.sites(); ++site)
      field.set(site, {static_cast<Real>(h.x), static_cast<Real>(h.y), static_cast<Real>(h.z)});
  }
};

TYPED_TEST(Terms, HostFieldThatDoesNotDependOnSpins) {
  using Spins = typename TypeParam::Spins;
  auto const h = turning(2.5);
  Vec3<double> const rounded{static_cast<typename TypeParam::Real>(h.x),
                             static_cast<typename TypeParam::Real>(h.y),
                             static_cast<typename TypeParam::Real>(h.z)};
  this->check("given", lattices[0], EffectiveField(HostField<Spins, Given>(lattices[0], Given())),
              zeeman_by_hand(rounded), 2.5);
}

ByHand mean_by_hand(Lattice const& lattice, double strength) {
  auto const mean = [=](std::vector<double> const& m) {
    Vec3<double> sum{0, 0, 0};
    for (std::int64_t site = 0; site < lattice.sites(); ++site) sum = sum + at(m, site);
    return (1 / static_cast<double>(lattice.sites())) * sum;
  };
  return {[=](auto const& m, std::int64_t) { return -strength * mean(m); },
          [=](auto const& m) {
            return 0.5 * strength * static_cast<double>(lattice.sites()) * dot(mean(m), mean(m));
          }};
}

TYPED_TEST(Terms, AllTogether) {
  auto const& lattice = lattices[1];
  EffectiveField const field(Exchange(lattice, 1.3), UniaxialAnisotropy(1.7, {1, -2, 2}),
                             UniaxialAnisotropy(-0.4, {0, 3, 1}), TimeDependentZeeman(turning),
                             MeanField(1.2));
  std::vector<ByHand> const parts{exchange_by_hand(lattice, 1.3),
                                  anisotropy_by_hand(1.7, {1, -2, 2}),
                                  anisotropy_by_hand(-0.4, {0, 3, 1}), zeeman_by_hand(turning(0.5)),
                                  mean_by_hand(lattice, 1.2)};
  this->check("sum of terms", lattice, field,
              {[&](auto const& m, std::int64_t site) {
                 Vec3<double> h{0, 0, 0};
                 for (auto const& part : parts) h = h + part.field(m, site);
                 return h;
               },
               [&](auto const& m) {
                 double sum = 0;
                 for (auto const& part : parts) sum += part.energy(m);
                 return sum;
               }},
              0.5);
}

}  // namespace
}  // namespace cayspin::test
