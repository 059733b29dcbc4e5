/* SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception */
/* Runs a scene from C: takes 100 steps, reads the spins in place, and completes the run. */
#include <cayspin/cayspin.h>

#include <math.h>
#include <stdio.h>

static int failed(cayspin_status status) {
  if (status != CAYSPIN_OK) fprintf(stderr, "%s\n", cayspin_last_error());
  return status != CAYSPIN_OK;
}

static double mean_of_x(cayspin_array const* spins) {
  double const* numbers = spins->data; /* CAYSPIN_DOUBLE was asked for */
  double sum = 0;
  for (int64_t z = 0; z < spins->shape[0]; ++z)
    for (int64_t y = 0; y < spins->shape[1]; ++y)
      for (int64_t x = 0; x < spins->shape[2]; ++x)
        sum += numbers[z * spins->strides[0] + y * spins->strides[1] + x * spins->strides[2]];
  return sum / (double)(spins->shape[0] * spins->shape[1] * spins->shape[2]);
}

int main(int argc, char** argv) {
  cayspin_simulation* simulation = NULL;
  cayspin_array spins;
  double time, energy, m[3];
  int status = 1;
  if (argc != 3) {
    fprintf(stderr, "usage: %s SCENE.toml OUTPUT.h5\n", argv[0]);
    return 2;
  }
  if (failed(cayspin_open_file(argv[1], CAYSPIN_DOUBLE, NULL, &simulation))) return 1;
  if (!failed(cayspin_step(simulation, 100)) && !failed(cayspin_time(simulation, &time)) &&
      !failed(cayspin_energy(simulation, &energy)) &&
      !failed(cayspin_magnetization(simulation, m)) &&
      !failed(cayspin_borrow_spins(simulation, &spins))) {
    printf("t = %g: E = %.6f, mean m_x = %.6f\n", time, energy, m[0]);
    if (fabs(mean_of_x(&spins) - m[0]) < 1e-14 && !failed(cayspin_run(simulation, argv[2], 0)))
      status = 0;
  }
  cayspin_close(simulation);
  return status;
}
