// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "format.hpp"
#include "hdf5/attribute.hpp"

namespace cayspin::inline v0_2::io {

/// Reads the units of a file. Files without the attribute `units` are in reduced units.
inline Units read_units(RootAttributes const& attributes) {
  Units units;
  units.si = attributes.has("units") && attributes.read_word("units", si_units, reduced_units);
  if (units.si)
    for (auto const& [name, member] : unit_attributes) units.*member = attributes.read_real(name);
  return units;
}

}  // namespace cayspin::inline v0_2::io
