// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../plan.hpp"

#include <string>

namespace cayspin::program::trade {

/// A scene of method "auto" with the method that is advised for its error, in one precision; any
/// other scene as it is. Inside a KokkosSession. Throws NumbersFailed when nothing gets there.
io::Scene with_method(io::Scene const& scene, std::string const& space, Precision precision);

}  // namespace cayspin::program::trade
