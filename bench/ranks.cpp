// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step on the ranks that mpiexec starts, and what the exchange of ghosts
// takes of them: one line per method. Usage: bench_ranks NX NY NZ [apart]; compare_ranks.py starts
// it. "apart": each rank has such a lattice to itself.
#include "scene.hpp"

#include <cayspin/mpi/domain.hpp>
#include <cayspin/stepper/methods.hpp>

#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using Spins = cayspin::SpinField<double>;

/// A part that measures what another one does.
class Measured final : public cayspin::Part {
 public:
  explicit Measured(cayspin::Part const& of) : of_(of) {}
  cayspin::Lattice const& whole() const override { return of_.whole(); }
  std::array<std::int64_t, 3> begin() const override { return of_.begin(); }
  void sum(std::span<std::int64_t> words) const override { of_.sum(words); }
  void maximum(std::span<std::int64_t> words) const override { of_.maximum(words); }
  void update_ghosts(std::span<cayspin::FieldNumbers const> fields) const override {
    double const begin = MPI_Wtime();
    of_.update_ghosts(fields);
    seconds += MPI_Wtime() - begin;
    ++exchanges;
  }
  mutable double seconds = 0;
  mutable int exchanges = 0;

 private:
  cayspin::Part const& of_;
};

template <class Stepper>
void measure(char const* name, cayspin::Lattice const& lattice, bool apart) {
  constexpr int steps = 4, least_repetitions = 5;
  Kokkos::DefaultExecutionSpace const exec;
  cayspin::mpi::Domain const domain(apart ? MPI_COMM_SELF : MPI_COMM_WORLD, lattice,
                                    Stepper::ghosts);
  Measured const measured(domain);
  auto local = domain.local();
  local.part = &measured;
  auto spins = scene::random<Spins>(local);
  auto const generator = scene::Default::generator(local);
  Stepper stepper(spins);
  double best = 1e300, exchange = 0, total = 0;
  for (int repetition = 0; repetition < least_repetitions || total < 1; ++repetition) {
    measured.seconds = 0;
    measured.exchanges = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    double const begin = MPI_Wtime();
    for (int step = 0; step < steps; ++step) stepper.step(exec, generator, spins, 0, scene::dt);
    exec.fence();
    double seconds = MPI_Wtime() - begin;
    MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    total += seconds;
    double waited = measured.seconds;
    MPI_Allreduce(MPI_IN_PLACE, &waited, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
    if (seconds < best) best = seconds, exchange = waited;
  }
  int rank = 0, ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (rank != 0) return;
  auto const sites = static_cast<double>(lattice.sites() * (apart ? ranks : 1));
  std::printf("%s: %.4f ns, exchange %.4f, exchanges %d\n", name, best / steps / sites * 1e9,
              exchange / best, measured.exchanges / steps);
}

}  // namespace

int main(int argc, char** argv) {
  bool const apart = argc == 5 && std::string(argv[4]) == "apart";
  if (argc != 4 && !apart) return 2;
  MPI_Init(&argc, &argv);
  {
    Kokkos::ScopeGuard const kokkos(argc, argv);
    auto const lattice =
        cayspin::Lattice::cubic(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]));
    measure<cayspin::LieHeun<Spins>>("Heun", lattice, apart);
    measure<cayspin::Rkmk4<Spins>>("RKMK4", lattice, apart);
    measure<cayspin::StereographicRungeKutta<Spins, cayspin::tableau::Classical4>>("RK4 tangent",
                                                                                   lattice, apart);
  }
  MPI_Finalize();
}
