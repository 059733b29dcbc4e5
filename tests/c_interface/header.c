/* SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception */
#include <cayspin/cayspin.h>

int c_interface_header(cayspin_simulation* simulation);
int c_interface_header(cayspin_simulation* simulation) {
  return cayspin_close(simulation) == CAYSPIN_OK;
}
