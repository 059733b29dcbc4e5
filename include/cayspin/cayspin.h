/* SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception */
/* Runs scenes from C, and from every language that can call C. All functions but cayspin_last_error
   and cayspin_version return a cayspin_status, and write results through their pointers only if it
   is CAYSPIN_OK. No function throws a C++ exception. Functions may be called from any thread: calls
   for the same simulation or ensemble wait for each other, and only one of all simulations and
   ensembles computes at a time. cayspin_time, cayspin_steps and their counterparts for ensembles do
   not wait, so they can report the progress of a run. Call cayspin_close and cayspin_ensemble_close
   only when no other call for that simulation or ensemble is in progress. No function starts a
   process. A damaged HDF5 file may crash HDF5, and the program with it; `cayspin check` reads the
   files of a scene in a separate process. */
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

/* The replicas of a scene with [ensemble], which run together. */
typedef struct cayspin_ensemble cayspin_ensemble;

/* In C++ as in C, the enumerations below can hold any int. */
#ifdef __cplusplus
#define CAYSPIN_AS_INT : int
#else
#define CAYSPIN_AS_INT
#endif

typedef enum cayspin_status CAYSPIN_AS_INT {
  CAYSPIN_OK = 0,
  CAYSPIN_WRONG_USAGE = 1,    /* a null pointer, or an argument that is not accepted */
  CAYSPIN_WRONG_SCENE = 2,    /* the scene, or a file that it names */
  CAYSPIN_NUMBERS_FAILED = 3, /* a failed check of the spins or the energy, or a failed method */
  CAYSPIN_FAILED = 4          /* any other failure, such as a file that cannot be written */
} cayspin_status;

typedef enum cayspin_precision CAYSPIN_AS_INT {
  CAYSPIN_SINGLE = 4,
  CAYSPIN_DOUBLE = 8
} cayspin_precision;

/* Vectors of all sites in host memory. With `data` cast to a pointer to float or double, component
   c of site (x, y, z) is
   data[z * strides[0] + y * strides[1] + x * strides[2] + c * strides[3]].
   In a crystal with n sites per cell, plane z = k * n + s holds site s of the cells with index k
   along z, and nz is n times the number of cells along z. */
typedef struct cayspin_array {
  void const* data;
  cayspin_precision precision;
  int64_t shape[4];   /* nz, ny, nx, 3 */
  int64_t strides[4]; /* in elements, not bytes */
} cayspin_array;

/* The result of cayspin_relax or, for one replica, of cayspin_ensemble_relax, in the units of the
   scene. */
typedef struct cayspin_minimum {
  int converged;       /* 1, or 0 if round-off or the limit on evaluations ended the search */
  double torque;       /* max |m x H| */
  double energy;       /* summed over sites */
  int64_t evaluations; /* evaluations of H at all sites */
} cayspin_minimum;

/* One line about the last call by this thread that failed; empty if none has failed. It is valid
   until the next call by this thread that fails. */
char const* cayspin_last_error(void);

/* The version, such as "0.2.0". */
char const* cayspin_version(void);

/* Opens a scene file. A scene without [integrator] can be relaxed, but takes no steps. `space` is
   the execution space: "openmp", "threads", "cuda", ...; "serial" for the host's space with one
   thread; or NULL for Kokkos' default. Starts Kokkos unless the program has done so. Returns
   CAYSPIN_WRONG_SCENE for a scene with [ensemble], which cayspin_ensemble_open_file opens. */
cayspin_status cayspin_open_file(char const* path, cayspin_precision precision, char const* space,
                                 cayspin_simulation** simulation);

/* Opens a scene given as text. Messages call the scene `name`, and relative paths in the text start
   from the folder of `name`. NULL stands for "scene". */
cayspin_status cayspin_open_text(char const* text, char const* name, cayspin_precision precision,
                                 char const* space, cayspin_simulation** simulation);

/* Takes `count` steps. After CAYSPIN_NUMBERS_FAILED the spins are those that failed a check or, if
   the method failed, those before the failing step (with adaptive methods up to 1000 steps
   earlier). Returns CAYSPIN_WRONG_SCENE for a dt that integrator.refuse_unstable refuses. */
cayspin_status cayspin_step(cayspin_simulation* simulation, int64_t count);

/* Takes steps to the scene's end, or until integrator.until_torque ends the run, and writes a file
   as `cayspin run` does: `output` or, if that is NULL, the scene's output.file. Fails if the file
   exists and `overwrite` is 0, if the scene reads it and, as cayspin_step does, for a dt that is
   refused. */
cayspin_status cayspin_run(cayspin_simulation* simulation, char const* output, int overwrite);

/* Moves the spins to an equilibrium, as `cayspin relax` does: until max |m x H| is below `torque`,
   or for about `evaluations` evaluations of the field. `applied`, three numbers, replaces the
   scene's field.applied unless it is NULL. H is evaluated at the current time. The time and the
   number of steps do not change. */
cayspin_status cayspin_relax(cayspin_simulation* simulation, double torque, int64_t evaluations,
                             double const* applied, cayspin_minimum* found);

/* The time that the run has reached, in reduced units or, for a scene in SI, in seconds; and how
   many steps the run has taken. */
cayspin_status cayspin_time(cayspin_simulation const* simulation, double* time);
cayspin_status cayspin_steps(cayspin_simulation const* simulation, int64_t* steps);

/* The spins. If the run is on a host, `data` points to the memory of the run itself, otherwise to a
   copy in host memory. Valid until the next call of cayspin_step, cayspin_run, cayspin_relax,
   cayspin_set_spins or cayspin_close. */
cayspin_status cayspin_borrow_spins(cayspin_simulation* simulation, cayspin_array* spins);

/* H at every site at the current time, in the units of the scene, in host memory. Valid until the
   next call of this function or of cayspin_close. */
cayspin_status cayspin_borrow_field(cayspin_simulation* simulation, cayspin_array* field);

/* Replaces the spins of the run by copies of these, normalised; either precision is accepted.
   Methods that remember steps start afresh. */
cayspin_status cayspin_set_spins(cayspin_simulation* simulation, cayspin_array const* spins);

/* The energy, summed over sites, in reduced units, or in joules for a scene in SI. */
cayspin_status cayspin_energy(cayspin_simulation* simulation, double* energy);

/* The mean of the spins, weighted by the moments of the sites if the scene has any. */
cayspin_status cayspin_magnetization(cayspin_simulation* simulation, double magnetization[3]);

/* Ends a simulation and frees its memory. Does nothing if it is NULL. */
cayspin_status cayspin_close(cayspin_simulation* simulation);

/* Open a scene with [ensemble], as cayspin_open_file and cayspin_open_text open one without it, for
   which these return CAYSPIN_WRONG_SCENE. The results of replica r, counted from 0, are
   bit-identical to those of a simulation of the scene without [ensemble], with the values and seeds
   of this replica. If one replica fails, calls return CAYSPIN_NUMBERS_FAILED, and the message has
   its number. */
cayspin_status cayspin_ensemble_open_file(char const* path, cayspin_precision precision,
                                          char const* space, cayspin_ensemble** ensemble);
cayspin_status cayspin_ensemble_open_text(char const* text, char const* name,
                                          cayspin_precision precision, char const* space,
                                          cayspin_ensemble** ensemble);

/* The number of replicas. Does not wait for other calls. */
cayspin_status cayspin_ensemble_replicas(cayspin_ensemble const* ensemble, int64_t* replicas);

/* Takes `count` steps in every replica; integrator.until_torque does not end them. After
   CAYSPIN_NUMBERS_FAILED some replicas may be ahead of others. In later calls they wait until all
   are at the same step. Returns CAYSPIN_WRONG_SCENE for a dt that integrator.refuse_unstable
   refuses. */
cayspin_status cayspin_ensemble_step(cayspin_ensemble* ensemble, int64_t count);

/* Moves each replica to an equilibrium of its own, as cayspin_relax does without `applied`. `found`
   is an array of the caller: one result for each replica. If one replica fails, others may have
   moved. */
cayspin_status cayspin_ensemble_relax(cayspin_ensemble* ensemble, double torque,
                                      int64_t evaluations, cayspin_minimum* found);

/* The time that all replicas have reached, in reduced units or, for a scene in SI, in seconds; and
   how many steps all have taken. */
cayspin_status cayspin_ensemble_time(cayspin_ensemble const* ensemble, double* time);
cayspin_status cayspin_ensemble_steps(cayspin_ensemble const* ensemble, int64_t* steps);

/* The spins of one replica, counted from 0. They are part of a copy in host memory, which belongs
   to the ensemble and has the spins of all replicas one after the other: `data` of replica 0 is
   also a packed array (replica, nz, ny, nx, 3). Valid until the next call of
   cayspin_ensemble_step, cayspin_ensemble_relax or cayspin_ensemble_close. */
cayspin_status cayspin_ensemble_borrow_spins(cayspin_ensemble* ensemble, int64_t replica,
                                             cayspin_array* spins);

/* The energy of each replica, summed over its sites, in the units of cayspin_energy. `energies` is
   an array of the caller: one number for each replica. */
cayspin_status cayspin_ensemble_energies(cayspin_ensemble* ensemble, double* energies);

/* The mean of the spins of each replica, as cayspin_magnetization gives it. `magnetizations` is an
   array of the caller: three numbers for each replica. Component c of replica r is
   magnetizations[3 * r + c]. */
cayspin_status cayspin_ensemble_magnetizations(cayspin_ensemble* ensemble, double* magnetizations);

/* Ends an ensemble and frees its memory. Does nothing if it is NULL. */
cayspin_status cayspin_ensemble_close(cayspin_ensemble* ensemble);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
