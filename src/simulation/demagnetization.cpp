// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "demagnetization.hpp"

#if defined(CAYSPIN_HAS_FFTW)
#include <cayspin/demagnetization/demagnetizing_field.hpp>
#endif

#include <stdexcept>

namespace cayspin::simulation {

#if defined(CAYSPIN_HAS_FFTW)
namespace {

DemagnetizationOptions options_of(io::Demagnetization const& demag, double mu0) {
  return {.strength = mu0 * demag.strength, .periodic_images = demag.periodic_images};
}

}  // namespace

template <class Real>
FieldOnHost<Real> demagnetization_on_host(io::Demagnetization const& demag, double mu0,
                                          Lattice const& lattice) {
  return [field = DemagnetizingField<Real>(lattice, options_of(demag, mu0))](
             auto const& spins, auto const& result) { field(spins, result, 0); };
}

template <class Real>
std::int64_t demagnetization_bytes(io::Demagnetization const& demag, Lattice const& lattice) {
  return DemagnetizingField<Real>::work_bytes(lattice, options_of(demag, 1));
}

void require_demagnetization(io::Scene const&) {}
#else
template <class Real>
FieldOnHost<Real> demagnetization_on_host(io::Demagnetization const&, double, Lattice const&) {
  throw std::logic_error("a demagnetising field without FFTW");  // require_demagnetization has said
}

template <class Real>
std::int64_t demagnetization_bytes(io::Demagnetization const&, Lattice const&) {
  return 0;
}

void require_demagnetization(io::Scene const& scene) {
  if (scene.field.demag)
    throw io::scene_error(scene, "field.demag",
                          "this cayspin was built without FFTW; accepted: no such key");
}
#endif

template FieldOnHost<double> demagnetization_on_host(io::Demagnetization const&, double,
                                                     Lattice const&);
template FieldOnHost<float> demagnetization_on_host(io::Demagnetization const&, double,
                                                    Lattice const&);
template std::int64_t demagnetization_bytes<double>(io::Demagnetization const&, Lattice const&);
template std::int64_t demagnetization_bytes<float>(io::Demagnetization const&, Lattice const&);

}  // namespace cayspin::simulation
