// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compiles examples/ranks as with -DCAYSPIN_MPI_DEVICE_MEMORY=ON: messages do not pass through the
// host.
#define CAYSPIN_MPI_DEVICE_MEMORY
#include "../../examples/ranks/main.cpp"
