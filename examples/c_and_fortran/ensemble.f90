! SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
! Runs the replicas of a scene with [ensemble] from Fortran: takes 100 steps, prints the energy and
! the mean spin of each replica, and compares the mean spins with the array of all spins.
program run_ensemble
  use cayspin
  use, intrinsic :: iso_fortran_env, only: error_unit
  implicit none
  character(4096) :: scene
  type(c_ptr) :: ensemble = c_null_ptr
  type(cayspin_array) :: first
  real(c_double), pointer :: spins(:, :, :)
  real(c_double), allocatable :: energies(:), m(:, :)
  integer(c_int64_t) :: replicas, replica, sites

  if (command_argument_count() /= 1) then
    write (error_unit, '(a)') 'usage: ensemble SCENE.toml'
    stop 2
  end if
  call get_command_argument(1, scene)
  call check(cayspin_ensemble_open_file(trim(scene)//c_null_char, int(cayspin_double, c_int), &
                                        c_null_ptr, ensemble))
  call check(cayspin_ensemble_replicas(ensemble, replicas))
  allocate (energies(replicas), m(3, replicas))

  call check(cayspin_ensemble_step(ensemble, 100_c_int64_t))
  call check(cayspin_ensemble_energies(ensemble, energies))
  call check(cayspin_ensemble_magnetizations(ensemble, m))
  print '(4es25.16e3)', (energies(replica), m(:, replica), replica=1, replicas)

  ! The spins of all replicas follow one another: (component, site, replica).
  call check(cayspin_ensemble_borrow_spins(ensemble, 0_c_int64_t, first))
  sites = product(first%shape(:3))
  call c_f_pointer(first%data, spins, [3_c_int64_t, sites, replicas])
  if (any(abs(sum(spins, 2)/real(sites, c_double) - m) > 1e-14_c_double)) stop 1
  deallocate (energies, m)  ! otherwise they would stay allocated until the program ends
  call check(cayspin_ensemble_close(ensemble))

contains

  subroutine check(status)
    integer(c_int), intent(in) :: status
    if (status == cayspin_ok) return
    write (error_unit, '(a)') last_error()
    stop 1
  end subroutine
end program
