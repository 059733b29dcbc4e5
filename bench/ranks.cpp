// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step on the ranks that mpiexec starts, and the part of the time spent
// exchanging ghosts, measured by Kokkos' regions: one line per method. Usage: bench_ranks NX NY NZ
// [MODE]; compare_ranks.py and model_ranks.py start it. Mode "apart": each rank has a lattice of
// this size to itself; "in_step": the same, and ranks wait for each other after each step;
// "passes": like "apart", but each stage is a pass over memory, as exchanges between stages would
// need.
#include "scene.hpp"

#include <cayspin/mpi/domain.hpp>
#include <cayspin/stepper/methods.hpp>

#include <mpi.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using Spins = cayspin::SpinField<double>;

/// Seconds spent on exchanges of ghosts, and their number.
struct Exchange {
  double seconds = 0, begin = 0;
  int count = 0;
  bool inside = false;
} exchange;

void enter(char const* region) {
  exchange.inside = std::string(region) == "cayspin::mpi::update_ghosts";
  exchange.begin = MPI_Wtime();
}
void leave() {
  if (!exchange.inside) return;
  exchange.seconds += MPI_Wtime() - exchange.begin;
  exchange.inside = false;
  ++exchange.count;
}

double of_all(double value, MPI_Op operation) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, operation, MPI_COMM_WORLD);
  return value;
}

// A barrier, which waits in the same way as an exchange of ghosts.
void wait_for_all() {
  std::array<MPI_Request, 1> request;
  MPI_Ibarrier(MPI_COMM_WORLD, request.data());
  cayspin::mpi::detail::wait_for(request);
}

template <class Stepper>
void measure(char const* name, cayspin::Lattice const& lattice, std::string const& mode) {
  bool const apart = !mode.empty(), in_step = mode == "in_step";
  constexpr int steps = 4, least_repetitions = 5;
  Kokkos::DefaultExecutionSpace const exec;
  cayspin::mpi::Domain const domain(apart ? MPI_COMM_SELF : MPI_COMM_WORLD, lattice,
                                    Stepper::ghosts);
  auto spins = scene::random<Spins>(domain.local());
  auto const generator = scene::Default::generator(domain.local());
  Stepper stepper(spins);
  if (mode == "passes") stepper.use(cayspin::Path::pass);
  double best = 1e300, exchanging = 0, total = 0;
  int exchanges = 0;
  for (int repetition = 0; repetition < least_repetitions || total < 1; ++repetition) {
    exchange = {};
    MPI_Barrier(MPI_COMM_WORLD);
    double const begin = MPI_Wtime();
    for (int step = 0; step < steps; ++step) {
      stepper.step(exec, generator, spins, 0, scene::dt);
      if (in_step) wait_for_all();
    }
    exec.fence();
    double const seconds = of_all(MPI_Wtime() - begin, MPI_MAX);
    double const waited = of_all(exchange.seconds, MPI_MIN);  // of the rank that waited least
    total += seconds;
    if (seconds < best) best = seconds, exchanging = waited, exchanges = exchange.count;
  }
  int rank = 0, ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (rank != 0) return;
  auto const sites = static_cast<double>(lattice.sites() * (apart ? ranks : 1));
  std::printf("%s: %.4f ns, exchange %.4f, exchanges %d, stages %d\n", name,
              best / steps / sites * 1e9, exchanging / best, exchanges / steps, Stepper::ghosts);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) return 2;
  std::string const mode = argc == 5 ? argv[4] : "";
  MPI_Init(&argc, &argv);
  {
    Kokkos::ScopeGuard const kokkos(argc, argv);
    Kokkos::Tools::Experimental::set_push_region_callback(enter);
    Kokkos::Tools::Experimental::set_pop_region_callback(leave);
    auto const lattice =
        cayspin::Lattice::cubic(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]));
    measure<cayspin::LieHeun<Spins>>("Heun", lattice, mode);
    measure<cayspin::Rkmk4<Spins>>("RKMK4", lattice, mode);
    measure<cayspin::StereographicRungeKutta<Spins, cayspin::tableau::Classical4>>("RK4 tangent",
                                                                                   lattice, mode);
  }
  MPI_Finalize();
}
