! SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
! cayspin/cayspin.h as a module. Texts end with c_null_char; `space` and `applied` may be c_null_ptr.
module cayspin
  use, intrinsic :: iso_c_binding
  implicit none

  enum, bind(c)
    enumerator :: cayspin_ok = 0, cayspin_wrong_usage, cayspin_wrong_scene, &
      cayspin_numbers_failed, cayspin_failed
  end enum
  enum, bind(c)
    enumerator :: cayspin_single = 4, cayspin_double = 8
  end enum

  type, bind(c) :: cayspin_array
    type(c_ptr) :: data
    integer(c_int) :: precision
    integer(c_int64_t) :: shape(4)    ! nz, ny, nx, 3
    integer(c_int64_t) :: strides(4)  ! counted in numbers, not in bytes
  end type

  type, bind(c) :: cayspin_minimum
    integer(c_int) :: converged           ! 1 or 0
    real(c_double) :: torque              ! max |m x H|
    real(c_double) :: energy              ! summed over sites
    integer(c_int64_t) :: evaluations     ! of the field over all sites
  end type

  interface
    function cayspin_last_error() bind(c) result(message)
      import c_ptr
      type(c_ptr) :: message
    end function

    function cayspin_open_file(path, precision, space, simulation) bind(c) result(status)
      import c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: precision
      type(c_ptr), value :: space
      type(c_ptr), intent(inout) :: simulation
      integer(c_int) :: status
    end function

    function cayspin_open_text(text, name, precision, space, simulation) bind(c) result(status)
      import c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: text(*), name(*)
      integer(c_int), value :: precision
      type(c_ptr), value :: space
      type(c_ptr), intent(inout) :: simulation
      integer(c_int) :: status
    end function

    function cayspin_step(simulation, count) bind(c) result(status)
      import c_int, c_int64_t, c_ptr
      type(c_ptr), value :: simulation
      integer(c_int64_t), value :: count
      integer(c_int) :: status
    end function

    function cayspin_run(simulation, output, overwrite) bind(c) result(status)
      import c_char, c_int, c_ptr
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(in) :: output(*)
      integer(c_int), value :: overwrite
      integer(c_int) :: status
    end function

    ! `applied`: c_loc of three numbers, or c_null_ptr.
    function cayspin_relax(simulation, torque, evaluations, applied, found) bind(c) result(status)
      import c_double, c_int, c_int64_t, c_ptr, cayspin_minimum
      type(c_ptr), value :: simulation
      real(c_double), value :: torque
      integer(c_int64_t), value :: evaluations
      type(c_ptr), value :: applied
      type(cayspin_minimum), intent(inout) :: found
      integer(c_int) :: status
    end function

    function cayspin_time(simulation, time) bind(c) result(status)
      import c_double, c_int, c_ptr
      type(c_ptr), value :: simulation
      real(c_double), intent(inout) :: time
      integer(c_int) :: status
    end function

    function cayspin_steps(simulation, steps) bind(c) result(status)
      import c_int, c_int64_t, c_ptr
      type(c_ptr), value :: simulation
      integer(c_int64_t), intent(inout) :: steps
      integer(c_int) :: status
    end function

    function cayspin_borrow_spins(simulation, spins) bind(c) result(status)
      import c_int, c_ptr, cayspin_array
      type(c_ptr), value :: simulation
      type(cayspin_array), intent(inout) :: spins
      integer(c_int) :: status
    end function

    function cayspin_borrow_field(simulation, field) bind(c) result(status)
      import c_int, c_ptr, cayspin_array
      type(c_ptr), value :: simulation
      type(cayspin_array), intent(inout) :: field
      integer(c_int) :: status
    end function

    function cayspin_set_spins(simulation, spins) bind(c) result(status)
      import c_int, c_ptr, cayspin_array
      type(c_ptr), value :: simulation
      type(cayspin_array), intent(in) :: spins
      integer(c_int) :: status
    end function

    function cayspin_energy(simulation, energy) bind(c) result(status)
      import c_double, c_int, c_ptr
      type(c_ptr), value :: simulation
      real(c_double), intent(inout) :: energy
      integer(c_int) :: status
    end function

    function cayspin_magnetization(simulation, magnetization) bind(c) result(status)
      import c_double, c_int, c_ptr
      type(c_ptr), value :: simulation
      real(c_double), intent(inout) :: magnetization(3)
      integer(c_int) :: status
    end function

    function cayspin_close(simulation) bind(c) result(status)
      import c_int, c_ptr
      type(c_ptr), value :: simulation
      integer(c_int) :: status
    end function

    ! Ensembles. `found`, `energies` and the second extent of `magnetizations`: one for each replica.
    function cayspin_ensemble_open_file(path, precision, space, ensemble) bind(c) result(status)
      import c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: precision
      type(c_ptr), value :: space
      type(c_ptr), intent(inout) :: ensemble
      integer(c_int) :: status
    end function

    function cayspin_ensemble_open_text(text, name, precision, space, ensemble) bind(c) &
      result(status)
      import c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: text(*), name(*)
      integer(c_int), value :: precision
      type(c_ptr), value :: space
      type(c_ptr), intent(inout) :: ensemble
      integer(c_int) :: status
    end function

    function cayspin_ensemble_replicas(ensemble, replicas) bind(c) result(status)
      import c_int, c_int64_t, c_ptr
      type(c_ptr), value :: ensemble
      integer(c_int64_t), intent(inout) :: replicas
      integer(c_int) :: status
    end function

    function cayspin_ensemble_step(ensemble, count) bind(c) result(status)
      import c_int, c_int64_t, c_ptr
      type(c_ptr), value :: ensemble
      integer(c_int64_t), value :: count
      integer(c_int) :: status
    end function

    function cayspin_ensemble_relax(ensemble, torque, evaluations, found) bind(c) result(status)
      import c_double, c_int, c_int64_t, c_ptr, cayspin_minimum
      type(c_ptr), value :: ensemble
      real(c_double), value :: torque
      integer(c_int64_t), value :: evaluations
      type(cayspin_minimum), intent(inout) :: found(*)
      integer(c_int) :: status
    end function

    function cayspin_ensemble_time(ensemble, time) bind(c) result(status)
      import c_double, c_int, c_ptr
      type(c_ptr), value :: ensemble
      real(c_double), intent(inout) :: time
      integer(c_int) :: status
    end function

    function cayspin_ensemble_steps(ensemble, steps) bind(c) result(status)
      import c_int, c_int64_t, c_ptr
      type(c_ptr), value :: ensemble
      integer(c_int64_t), intent(inout) :: steps
      integer(c_int) :: status
    end function

    ! `replica` counts from 0, as in C.
    function cayspin_ensemble_borrow_spins(ensemble, replica, spins) bind(c) result(status)
      import c_int, c_int64_t, c_ptr, cayspin_array
      type(c_ptr), value :: ensemble
      integer(c_int64_t), value :: replica
      type(cayspin_array), intent(inout) :: spins
      integer(c_int) :: status
    end function

    function cayspin_ensemble_energies(ensemble, energies) bind(c) result(status)
      import c_double, c_int, c_ptr
      type(c_ptr), value :: ensemble
      real(c_double), intent(inout) :: energies(*)
      integer(c_int) :: status
    end function

    function cayspin_ensemble_magnetizations(ensemble, magnetizations) bind(c) result(status)
      import c_double, c_int, c_ptr
      type(c_ptr), value :: ensemble
      real(c_double), intent(inout) :: magnetizations(3, *)
      integer(c_int) :: status
    end function

    function cayspin_ensemble_close(ensemble) bind(c) result(status)
      import c_int, c_ptr
      type(c_ptr), value :: ensemble
      integer(c_int) :: status
    end function
  end interface

contains

  ! cayspin_last_error as a text.
  function last_error() result(text)
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    type(c_ptr) :: message
    integer :: length
    interface
      function strlen(message) bind(c) result(length)
        import c_ptr, c_size_t
        type(c_ptr), value :: message
        integer(c_size_t) :: length
      end function
    end interface
    message = cayspin_last_error()
    length = int(strlen(message))
    call c_f_pointer(message, letters, [length])
    allocate (character(length) :: text)
    text = transfer(letters, text)
  end function
end module
