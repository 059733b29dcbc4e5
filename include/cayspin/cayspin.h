/* SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception */
/* Scenes from C, and from all that calls C. Every function returns a cayspin_status. It changes
   what its pointers point to only when that is CAYSPIN_OK. No C++ exception leaves a function.
   Calls from several threads take turns, but for cayspin_time and cayspin_steps: they do not wait,
   and say how far a run is. Calls on several simulations take turns step by step, and those that
   read and write files take turns in HDF5. No other call on a simulation may be under way when
   cayspin_close is called. No function starts a process. A damaged HDF5 file may crash HDF5, and
   with it the program: `cayspin check` reads the files of a scene in a process of its own. */
#ifndef CAYSPIN_CAYSPIN_H
#define CAYSPIN_CAYSPIN_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* A run of a scene: its spins, its method and the time. */
typedef struct cayspin_simulation cayspin_simulation;

/* Any number is a value of these types, in C++ as in C. */
#ifdef __cplusplus
#define CAYSPIN_AS_INT : int
#else
#define CAYSPIN_AS_INT
#endif

typedef enum cayspin_status CAYSPIN_AS_INT {
  CAYSPIN_OK = 0,
  CAYSPIN_WRONG_USAGE = 1,    /* a null pointer, or an argument that is not accepted */
  CAYSPIN_WRONG_SCENE = 2,    /* the scene, or a file that it names */
  CAYSPIN_NUMBERS_FAILED = 3, /* non-finite spins, or an energy that rises and must not */
  CAYSPIN_FAILED = 4          /* memory, a file that cannot be written, anything else */
} cayspin_status;

typedef enum cayspin_precision CAYSPIN_AS_INT {
  CAYSPIN_SINGLE = 4,
  CAYSPIN_DOUBLE = 8
} cayspin_precision;

/* Vectors of all sites in host memory, float or double: component c of site (x, y, z) is number
   z strides[0] + y strides[1] + x strides[2] + c strides[3] after `data`. Of a crystal with n sites
   in a cell, plane z = k n + s has site s of the cells k, and nz is cells times n. */
typedef struct cayspin_array {
  void const* data;
  cayspin_precision precision;
  int64_t shape[4];   /* nz, ny, nx, 3 */
  int64_t strides[4]; /* in numbers, not bytes */
} cayspin_array;

/* A state that cayspin_relax has found, in the units of the scene. */
typedef struct cayspin_minimum {
  int converged;       /* 1; 0 where round-off or the limit on evaluations ended the search */
  double torque;       /* max |m x H| */
  double energy;       /* summed over sites */
  int64_t evaluations; /* of the field over all sites */
} cayspin_minimum;

/* One line about the last call of this thread that failed: empty before the first one. It is valid
   until the next call that fails. */
char const* cayspin_last_error(void);

/* Such as "0.2.0". */
char const* cayspin_version(void);

/* Opens a scene file; one without [integrator] is only for cayspin_relax. `space`: openmp, threads,
   cuda, ..., "serial" for the host's with one thread, or NULL for Kokkos' default. Starts Kokkos
   unless the program has. */
cayspin_status cayspin_open_file(char const* path, cayspin_precision precision, char const* space,
                                 cayspin_simulation** simulation);

/* The same for a scene's text. Messages call it `name`, and its files lie in the folder of `name`.
   NULL: "scene". */
cayspin_status cayspin_open_text(char const* text, char const* name, cayspin_precision precision,
                                 char const* space, cayspin_simulation** simulation);

/* Takes `count` steps. After CAYSPIN_NUMBERS_FAILED the spins are those before the failing step. */
cayspin_status cayspin_step(cayspin_simulation* simulation, int64_t count);

/* Takes steps to the scene's end, and writes the file as `cayspin run` does: `output`, or where
   that is NULL the scene's output.file. A file that exists is an error unless `overwrite`. */
cayspin_status cayspin_run(cayspin_simulation* simulation, char const* output, int overwrite);

/* Moves the spins to an equilibrium, as `cayspin relax` does: until max |m x H| is below `torque`,
   or for so many `evaluations` of the field. `applied`, three numbers, takes the place of the
   scene's field.applied; NULL: H is that at the time now. Time and steps stay as they are. */
cayspin_status cayspin_relax(cayspin_simulation* simulation, double torque, int64_t evaluations,
                             double const* applied, cayspin_minimum* found);

/* In the units of the scene: reduced, or seconds. */
cayspin_status cayspin_time(cayspin_simulation const* simulation, double* time);
cayspin_status cayspin_steps(cayspin_simulation const* simulation, int64_t* steps);

/* The spins where they are: no copy on a host, one on a device. Valid until the next call of
   cayspin_step, cayspin_run, cayspin_relax, cayspin_set_spins or cayspin_close. */
cayspin_status cayspin_borrow_spins(cayspin_simulation* simulation, cayspin_array* spins);

/* H of every site now, in the units of the scene. Valid until the next call of this function or of
   cayspin_close. */
cayspin_status cayspin_borrow_field(cayspin_simulation* simulation, cayspin_array* field);

/* Copies spins in, normalised, of either precision. Methods that remember steps begin again. */
cayspin_status cayspin_set_spins(cayspin_simulation* simulation, cayspin_array const* spins);

/* Summed over sites; in reduced units, or in joules for a scene in SI. */
cayspin_status cayspin_energy(cayspin_simulation* simulation, double* energy);

/* The mean of the spins, weighted by the moments of sites where the scene has them. */
cayspin_status cayspin_magnetization(cayspin_simulation* simulation, double magnetization[3]);

/* Ends a simulation; NULL does nothing. */
cayspin_status cayspin_close(cayspin_simulation* simulation);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
