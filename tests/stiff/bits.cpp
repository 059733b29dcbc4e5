// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Stiff steps are bitwise identical on Serial and on the threaded space.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/stepper/adaptive_stiff_gauss.hpp>

namespace cayspin::test {
namespace {

template <class Of>
Of made_like(typename Of::spins_type const& spins) {
  if constexpr (AdaptiveStepper<Of>)
    return Of(spins, {.tolerance = 0.1});
  else
    return Of(spins);
}

template <class Exec, class Stepper>
auto end_of(Lattice const& lattice, Exec const& exec) {
  using Field = typename Stepper::spins_type;
  auto const numbers = random_directions(lattice.sites(), 11);
  std::vector<double> start(numbers);
  for (std::size_t i = 2; i < start.size(); i += 3) start[i] += 4;
  for (std::size_t i = 0; i < start.size(); i += 3) {
    double const length = std::hypot(start[i], start[i + 1], start[i + 2]);
    for (std::size_t c = i; c < i + 3; ++c) start[c] /= length;
  }
  Field spins = spins_of<Field>(lattice, start);
  LandauLifshitz const generator(
      EffectiveField(Exchange(lattice, 20), UniaxialAnisotropy(1, {1, 2, 2}), Zeeman({0, 1, 0})),
      0.1);
  Stepper stepper = made_like<Stepper>(spins);
  for (int n = 0; n < 4; ++n) stepper.step(exec, generator, spins, 0.005 * n, 0.005);
  return copy_to_host(spins);
}

template <class Real>
class StiffBits : public ::testing::Test {};
TYPED_TEST_SUITE(StiffBits, Precisions, PrecisionName);

#if defined(KOKKOS_ENABLE_SERIAL) && defined(KOKKOS_ENABLE_OPENMP)
TYPED_TEST(StiffBits, AreTheSameOnSerialAndOpenMP) {
  using Field = SpinField<TypeParam, Kokkos::HostSpace>;
  for (Lattice const& lattice :
       {Lattice::chain(3000), Lattice::square(53, 41, 1, Boundary::periodic),
        Lattice::square(130, 131)}) {
    EXPECT_EQ((end_of<Kokkos::Serial, StiffGauss2<Field>>(lattice, {})),
              (end_of<Kokkos::OpenMP, StiffGauss2<Field>>(lattice, {})));
    EXPECT_EQ((end_of<Kokkos::Serial, StiffGauss4<Field>>(lattice, {})),
              (end_of<Kokkos::OpenMP, StiffGauss4<Field>>(lattice, {})));
    EXPECT_EQ((end_of<Kokkos::Serial, AdaptiveStiffGauss2<Field>>(lattice, {})),
              (end_of<Kokkos::OpenMP, AdaptiveStiffGauss2<Field>>(lattice, {})));
  }
}
#endif

}  // namespace
}  // namespace cayspin::test
