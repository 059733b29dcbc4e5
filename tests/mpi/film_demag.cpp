// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising field of examples/ranks, computed by FFTs over all ranks, compared with that of
// DemagnetizingField on one rank.
#include "../../examples/ranks/film_demagnetising_field.hpp"
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/demagnetization/demagnetizing_field.hpp>

namespace cayspin::test {
namespace {

using FilmSpins = SpinField<double, Kokkos::HostSpace>;

TEST(FilmDemagnetisingField, IsThatOfOneRank) {
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (Lattice const& film : {Lattice{.shape = {7, 13, 1}, .spacing = {2, 1.5, 1}},
                              Lattice{.shape = {16, 8, 1}}, Lattice{.shape = {1, 5, 1}}}) {
    mpi::Domain const domain(MPI_COMM_WORLD, film, 1, {.y = ranks, .z = 1});
    auto const& local = domain.local();
    auto const m = random_directions(film.sites(), 3);
    auto const first =
        static_cast<std::size_t>(3 * film.shape[0] * (domain.begin()[1] + local.ghosts[1].before));
    auto const own = static_cast<std::size_t>(3 * local.sites());
    std::vector<double> const part(m.begin() + static_cast<std::ptrdiff_t>(first),
                                   m.begin() + static_cast<std::ptrdiff_t>(first + own));
    FilmSpins const whole_spins = spins_of<FilmSpins>(film, m), whole_field("field", film);
    FilmSpins const spins = spins_of<FilmSpins>(local, part), field("field", local);
    DemagnetizingField<double> const of_one_rank(film);
    of_one_rank(whole_spins, whole_field, 0);
    FilmDemagnetisingField const of_all(domain, demagnetizing_tensor);
    for (int again = 0; again < 2; ++again) of_all(spins, field, 0);
    auto const expected = copy_to_host(whole_field), found = copy_to_host(field);
    for (std::size_t i = 0; i < own; ++i) EXPECT_NEAR(found[i], expected[first + i], 1e-14) << i;
  }
  EXPECT_THROW(FilmDemagnetisingField(
                   mpi::Domain(MPI_COMM_WORLD, Lattice::cubic(4, 8, 2), 1, {.y = ranks, .z = 1}),
                   demagnetizing_tensor),
               std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
