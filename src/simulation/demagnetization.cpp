// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "demagnetization.hpp"

#include "space.hpp"

#if defined(CAYSPIN_HAS_FFTW)
#include "interactions_file.hpp"

#include <cayspin/demagnetization/demagnetizing_field.hpp>
#include <cayspin/demagnetization/dipolar_field.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#endif

#include <algorithm>
#include <stdexcept>
#include <string>

namespace cayspin::simulation {

#if defined(CAYSPIN_HAS_FFTW)
namespace {

/// Returns a description of everything that the tensors depend on. It identifies the tensors in a
/// cache file.
std::string text_of(Lattice const& lattice, DemagnetizationOptions const& options) {
  // If the longest edge of a cell is more than 1000 times the shortest one, the description has a
  // version number, because cache files from older versions of the program hold other values.
  auto const [shortest, longest] = std::ranges::minmax(lattice.spacing);
  return fmt::format("cells {}, spacing {:a}, images {}, strength {:a}{}",
                     fmt::join(lattice.shape, " "), fmt::join(lattice.spacing, " "),
                     fmt::join(options.periodic_images, " "), options.strength,
                     longest > 1000 * shortest ? ", version 2" : "");
}

DemagnetizationOptions options_of(io::Demagnetization const& demag, double mu0,
                                  Lattice const& lattice) {
  DemagnetizationOptions options{.strength = mu0 * demag.strength,
                                 .periodic_images = demag.periodic_images};
  if (!demag.cache.empty())
    options.kept = [file = InteractionsFile(demag.cache, text_of(lattice, options))](
                       auto const& compute) { return file.read_or(compute); };
  return options;
}

DipolarOptions options_of_dipoles(io::Demagnetization const& demag, double mu0) {
  return {mu0 * demag.strength, demag.periodic_images, demag.demagnetizing_factors};
}

}  // namespace

template <class Real>
FieldOnHost<Real> demagnetization_on_host(io::Demagnetization const& demag, double mu0,
                                          Lattice const& lattice) {
  if (demag.dipoles)
    return [field = DipolarField<Real>(lattice, *demag.dipoles, options_of_dipoles(demag, mu0))](
               auto const& spins, auto const& result) { field(spins, result, 0); };
  return [field = DemagnetizingField<Real>(lattice, options_of(demag, mu0, lattice))](
             auto const& spins, auto const& result) { field(spins, result, 0); };
}

template <class Spins>
FieldInPlace<Spins> demagnetization_in_place(io::Demagnetization const& demag, double mu0,
                                             Lattice const& lattice) {
  using Memory = typename Spins::memory_space;
  using Exec = typename Memory::execution_space;
  if (lattice.part != nullptr || demag.dipoles) return {};
  if constexpr (cayspin::detail::DeviceTransforms<Exec>::exist)
    return [field = DemagnetizingField<typename Spins::value_type, Memory>(
                lattice, options_of(demag, mu0, lattice))](Exec const& exec, Spins const& spins,
                                                           Spins const& result) {
      field(exec, spins, result, 0);
    };
  else
    return {};
}

template <class Real>
std::int64_t demagnetization_bytes(io::Demagnetization const& demag, Lattice const& lattice) {
  if (demag.dipoles)
    return DipolarField<Real>::work_bytes(lattice, *demag.dipoles, options_of_dipoles(demag, 1));
  return DemagnetizingField<Real>::work_bytes(lattice, options_of(demag, 1, lattice));
}

void require_demagnetization(io::Scene const&) {}
#else
template <class Real>
FieldOnHost<Real> demagnetization_on_host(io::Demagnetization const&, double, Lattice const&) {
  // Never reached: require_demagnetization refuses the scene.
  throw std::logic_error("a demagnetising field without FFTW");
}

template <class Spins>
FieldInPlace<Spins> demagnetization_in_place(io::Demagnetization const&, double, Lattice const&) {
  return {};
}

template <class Real>
std::int64_t demagnetization_bytes(io::Demagnetization const&, Lattice const&) {
  return 0;
}

void require_demagnetization(io::Scene const& scene) {
  if (scene.field.demag)
    throw io::scene_error(scene, "field." + scene.field.demag->key,
                          "this cayspin was built without FFTW; accepted: no such key");
}
#endif

#define CAYSPIN_DEMAGNETIZATION_IN_PLACE(Space, Real)                                        \
  template FieldInPlace<SpinField<Real, Space::memory_space>>                                \
  demagnetization_in_place<SpinField<Real, Space::memory_space>>(io::Demagnetization const&, \
                                                                 double, Lattice const&);
CAYSPIN_ON_DEVICE(CAYSPIN_DEMAGNETIZATION_IN_PLACE, double)
CAYSPIN_ON_DEVICE(CAYSPIN_DEMAGNETIZATION_IN_PLACE, float)

template FieldOnHost<double> demagnetization_on_host(io::Demagnetization const&, double,
                                                     Lattice const&);
template FieldOnHost<float> demagnetization_on_host(io::Demagnetization const&, double,
                                                    Lattice const&);
template std::int64_t demagnetization_bytes<double>(io::Demagnetization const&, Lattice const&);
template std::int64_t demagnetization_bytes<float>(io::Demagnetization const&, Lattice const&);

}  // namespace cayspin::simulation
