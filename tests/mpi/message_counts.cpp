// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Messages of a step, counted by intercepting MPI: one for each face, and none between stages. On
// hosts, a large face across z (between planes) takes three, one for each component.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/mpi/domain.hpp>

#include <set>

namespace {
std::set<MPI_Request> sends;
int sent = 0;
}  // namespace

extern "C" int MPI_Send_init(void const* data, int count, MPI_Datatype type, int to, int tag,
                             MPI_Comm comm, MPI_Request* request) {
  int const result = PMPI_Send_init(data, count, type, to, tag, comm, request);
  sends.insert(*request);
  return result;
}
extern "C" int MPI_Recv_init(void* data, int count, MPI_Datatype type, int from, int tag,
                             MPI_Comm comm, MPI_Request* request) {
  int const result = PMPI_Recv_init(data, count, type, from, tag, comm, request);
  sends.erase(*request);  // MPI may reuse the handle of a freed send
  return result;
}
extern "C" int MPI_Startall(int count, MPI_Request* requests) {
  for (int i = 0; i < count; ++i) sent += sends.contains(requests[i]);
  return PMPI_Startall(count, requests);
}
extern "C" int MPI_Isend(void const* data, int count, MPI_Datatype type, int to, int tag,
                         MPI_Comm comm, MPI_Request* request) {
  ++sent;
  return PMPI_Isend(data, count, type, to, tag, comm, request);
}

namespace cayspin::test {
namespace {

template <class Stepper>
void expect_messages(Lattice const& lattice, mpi::Division const& division, int per_face) {
  SCOPED_TRACE(testing::Message() << division.y << " x " << division.z << " parts of "
                                  << lattice.shape[0] << " x " << lattice.shape[1]);
  mpi::Domain const domain(MPI_COMM_WORLD, lattice, Stepper::ghosts, division);
  int faces = 0;
  for (auto const& [before, after] : domain.local().ghosts) faces += (before > 0) + (after > 0);
  SpinField<double> spins("spins", domain.local());
  LandauLifshitz const generator(EffectiveField(Exchange(domain.local(), 0.4)), 0.1);
  Stepper stepper(spins);
  typename SpinField<double>::memory_space::execution_space const exec;
  for (int step = 0; step < 5; ++step) {
    sent = 0;
    stepper.step(exec, generator, spins, 0, 0.01);
    EXPECT_EQ(sent, faces * per_face) << "step " << step;
  }
}

TEST(Messages, AreOnePerFaceAndStep) {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  using Spins = SpinField<double>;
  for (auto const boundary : {Boundary::open, Boundary::periodic}) {
    auto const small = Lattice::cubic(5, 17, 18, 1, boundary);
    auto const large = Lattice::cubic(64, 24, 17, 1, boundary);
    for (mpi::Division const& division : {mpi::Division{1, ranks}, mpi::Division{ranks, 1}}) {
      expect_messages<Rkmk4<Spins>>(small, division, 1);
      expect_messages<LieHeun<Spins>>(small, division, 1);
      expect_messages<LieEuler<Spins>>(small, division, 1);
    }
    // Large faces are sent in place on hosts, packed on devices. A face between planes has no gaps
    // within a component, so its components are sent one by one.
    bool const on_host = cayspin::detail::is_host_execution<Kokkos::DefaultExecutionSpace>;
    expect_messages<Rkmk4<Spins>>(large, {1, ranks}, on_host ? 3 : 1);
    expect_messages<Rkmk4<Spins>>(large, {ranks, 1}, 1);
    if (ranks == 4) expect_messages<Rkmk4<Spins>>(small, {2, 2}, 1);
  }
}

}  // namespace
}  // namespace cayspin::test
