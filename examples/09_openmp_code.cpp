// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Uses the arrays of another code, whose OpenMP loops work on plain arrays. Unmanaged Views, which
// allocate nothing, give access to the arrays. A write head moves along a track. The other code
// computes the field of the head and reads the bits; cayspin integrates the motion of the spins.
// Values are copied when one code hands over to the other, not in each step.
#include <cayspin/cayspin.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

// The other code: site (x, y) has the components array[3 * (x + length * y) + component].
constexpr int length = 96, width = 12, bits = 6, bit_length = length / bits;
constexpr std::array<int, bits> message{1, 0, 0, 1, 0, 1};

void write_field_of_head(double at, double strength, std::vector<double>& field) {
#pragma omp parallel for
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < length; ++x) {
      double const u = (x + 0.5 - at) / (0.4 * bit_length);
      field[3 * static_cast<std::size_t>(x + length * y) + 2] = strength * std::exp(-u * u * u * u);
    }
}

int bits_right(std::vector<double> const& m) {
  int right = 0;
#pragma omp parallel for reduction(+ : right)
  for (int bit = 0; bit < bits; ++bit) {
    double sum = 0;
    for (int y = 0; y < width; ++y)
      for (int x = bit * bit_length; x < (bit + 1) * bit_length; ++x)
        sum += m[3 * static_cast<std::size_t>(x + length * y) + 2];
    right += std::abs(sum) > 0.5 * bit_length * width && (sum > 0) == (message[bit] == 1);
  }
  return right;
}

// The part that uses cayspin.
using Exec = Kokkos::DefaultHostExecutionSpace;
using Field = cayspin::SiteField<double, 3, Kokkos::HostSpace>;
using Theirs = Kokkos::View<double* [3], Kokkos::LayoutRight, Kokkos::HostSpace,
                            Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

/// A site-dependent field.
struct FieldOfSites {
  static constexpr int degree = 1;  // H does not depend on the spins
  static constexpr bool is_local = true;
  Field::array_type array;

  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    return stencil.site().load(array);
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    return -dot(stencil.center(), stencil.site().load(array));
  }
};

int main(int argc, char** argv) {
  Kokkos::ScopeGuard kokkos(argc, argv);
  Exec const exec;
  auto const track = cayspin::Lattice::square(length, width);
  auto const sites = static_cast<std::size_t>(track.sites());
  std::vector<double> my_m(3 * sites), my_field(3 * sites);
  for (std::size_t site = 0; site < sites; ++site) my_m[3 * site + 2] = 1;
  Theirs const m(my_m.data(), sites), field(my_field.data(), sites);

  cayspin::SpinField<double, Kokkos::HostSpace> spins("spins", track);
  Field const of_head("field_of_head", track);
  cayspin::copy(exec, m, spins);
  cayspin::LandauLifshitz const generator(
      cayspin::EffectiveField(cayspin::Exchange(track, 0.5),
                              cayspin::UniaxialAnisotropy(1.0, {0.1, 0, 1}),
                              FieldOfSites{of_head.array()}),
      0.3);
  cayspin::Rkmk4 stepper(spins);
  for (int bit = 0; bit < bits; ++bit)
    for (int move = 0; move < 8; ++move) {
      double const at = (bit + 0.3 + 0.05 * move) * bit_length;
      write_field_of_head(at, message[static_cast<std::size_t>(bit)] ? 2 : -2, my_field);
      cayspin::copy(exec, field, of_head);
      cayspin::integrate(exec, stepper, generator, spins, {.begin = 0, .dt = 0.1, .steps = 100});
    }
  cayspin::copy(exec, spins, m);
  exec.fence();  // copy() does not wait until the copy is complete
  std::printf("%d of %d bits are right\n", bits_right(my_m), bits);
  return bits_right(my_m) == bits ? 0 : 1;
}
