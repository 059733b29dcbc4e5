// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <nanobind/nanobind.h>

namespace cayspin::python {

/// Defines EnsembleRun in the module.
void define_ensemble(nanobind::module_& module);

}  // namespace cayspin::python
