! SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
! Runs the scene of a chain from Fortran: takes some steps, reads the spins in place, completes the
! run, and sets the spins to an array of the caller.
program simulate
  use cayspin
  use, intrinsic :: iso_fortran_env, only: error_unit
  implicit none
  character(4096) :: scene, output
  type(c_ptr) :: simulation = c_null_ptr
  type(cayspin_array) :: spins
  real(c_double), pointer :: numbers(:)
  real(c_double), target, allocatable :: mine(:, :)
  real(c_double) :: time, energy, m(3), total
  integer(c_int64_t) :: nx

  if (command_argument_count() /= 2) then
    write (error_unit, '(a)') 'usage: simulate SCENE.toml OUTPUT.h5'
    stop 2
  end if
  call get_command_argument(1, scene)
  call get_command_argument(2, output)
  call check(cayspin_open_file(trim(scene)//c_null_char, int(cayspin_double, c_int), c_null_ptr, &
                               simulation))

  call check(cayspin_step(simulation, 100_c_int64_t))
  call check(cayspin_time(simulation, time))
  call check(cayspin_energy(simulation, energy))
  call check(cayspin_magnetization(simulation, m))
  print '(a, f0.3, a, f0.6, a, f0.6)', 't = ', time, ': E = ', energy, ', mean m_x = ', m(1)

  call check(cayspin_borrow_spins(simulation, spins))
  nx = spins%shape(3)  ! a chain
  call c_f_pointer(spins%data, numbers, [nx*spins%strides(3)])
  total = sum(numbers(::spins%strides(3)))
  if (abs(total/real(nx, c_double) - m(1)) > 1e-14_c_double) stop 1
  call check(cayspin_run(simulation, trim(output)//c_null_char, 0_c_int))

  ! The caller's array: the components of a spin are adjacent, then x varies fastest. Spins may have
  ! any length.
  allocate (mine(3, nx))
  mine(1, :) = 2
  mine(2:, :) = 0
  spins%data = c_loc(mine)
  spins%strides = [3*nx, 3*nx, 3_c_int64_t, 1_c_int64_t]
  call check(cayspin_set_spins(simulation, spins))
  call check(cayspin_magnetization(simulation, m))
  if (any(abs(m - [1.0_c_double, 0.0_c_double, 0.0_c_double]) > 0)) stop 1
  deallocate (mine)  ! otherwise it would stay allocated until the program ends
  call check(cayspin_close(simulation))

contains

  subroutine check(status)
    integer(c_int), intent(in) :: status
    if (status == cayspin_ok) return
    write (error_unit, '(a)') last_error()
    stop 1
  end subroutine
end program
