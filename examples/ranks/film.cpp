// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A permalloy film with a user-written demagnetising field, computed by FFTs that are shared by all
// ranks. The printed numbers are bitwise identical on any number of ranks.
#include "film_demagnetising_field.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/mpi/domain.hpp>

#include <cstdio>

namespace {

using Spins = cayspin::SpinField<double>;

void run(MPI_Comm comm) {
  Kokkos::DefaultExecutionSpace const exec;
  // Lengths are in nm, fields in Ms; the exchange is that of A = 13 pJ/m and Ms = 800 kA/m.
  cayspin::Lattice const film{.shape = {50, 24, 1}, .spacing = {5, 5, 3}};
  double const exchange = 2 * 13e-12 / (1.25663706212e-6 * 800e3 * 800e3) * 1e18;

  using Stepper = cayspin::Rkmk4<Spins>;
  int ranks = 0;
  MPI_Comm_size(comm, &ranks);
  cayspin::mpi::Domain const domain(comm, film, Stepper::ghosts, {.y = ranks, .z = 1});
  auto const& local = domain.local();
  Spins spins("spins", local);
  cayspin::HostField<Spins, FilmDemagnetisingField> const demag(
      spins, FilmDemagnetisingField(domain, cayspin::demagnetizing_tensor));
  cayspin::EffectiveField const field(cayspin::Exchange(local, exchange), demag,
                                      cayspin::Zeeman{{0.05, 0.02, 0}});
  cayspin::LandauLifshitz const generator(field, 0.5);
  Stepper stepper(spins);
  cayspin::integrate(exec, stepper, generator, spins, cayspin::Times{0, 0.1, 300});

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
