// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A code that has its own communicator and its own View, divided along z, and uses cayspin for the
// steps. The printed numbers are bitwise identical on any number of ranks.
#include <cayspin/cayspin.hpp>
#include <cayspin/mpi/domain.hpp>

#include <cmath>
#include <cstdio>

namespace {

/// Sets the initial state: a helix along z. `in_plane` is the number of sites of a plane, and
/// `first` is the first plane of the rank.
struct Helix {
  Kokkos::View<double* [3]> m;
  std::int64_t in_plane, first;

  KOKKOS_FUNCTION void operator()(std::int64_t site) const {
    double const angle = 0.2 * static_cast<double>(first + site / in_plane);
    m(site, 0) = Kokkos::cos(angle);
    m(site, 1) = Kokkos::sin(angle);
    m(site, 2) = 0;
  }
};

void run(MPI_Comm comm) {
  Kokkos::DefaultExecutionSpace const exec;
  auto const lattice = cayspin::Lattice::cubic(24, 16, 32);

  using Stepper = cayspin::Rkmk4<cayspin::SpinField<double>>;
  int ranks = 0;
  MPI_Comm_size(comm, &ranks);
  cayspin::mpi::Domain const domain(comm, lattice, Stepper::ghosts, {.y = 1, .z = ranks});
  auto const& local = domain.local();
  Kokkos::View<double* [3]> const mine("mine", local.sites());  // without ghosts
  std::int64_t const first = domain.begin()[2] + local.ghosts[2].before;
  Kokkos::parallel_for("helix", Kokkos::RangePolicy<>(exec, 0, local.sites()),
                       Helix{mine, lattice.shape[0] * lattice.shape[1], first});

  cayspin::SpinField<double> spins("spins", local);
  cayspin::copy(exec, mine, spins);
  cayspin::EffectiveField const field(cayspin::Exchange(local, 1),
                                      cayspin::UniaxialAnisotropy(0.2, {0, 0, 1}));
  cayspin::LandauLifshitz const generator(field, 0.1);
  Stepper stepper(spins);
  cayspin::integrate(exec, stepper, generator, spins, cayspin::Times{0, 0.1, 200});
  cayspin::copy(exec, spins, mine);

  // Every rank gets the sums over all ranks.
  double const energy = cayspin::energy(exec, field, spins).value;
  auto const m = cayspin::magnetization(exec, spins);
  if (domain.rank() == 0)
    std::printf("energy %.17g, mean m %.17g %.17g %.17g\n", energy, m.x, m.y, m.z);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  {
    Kokkos::ScopeGuard const kokkos(argc, argv);
    run(MPI_COMM_WORLD);
  }
  MPI_Finalize();
}
