// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

namespace cayspin::inline v0_2::io::test {

// Typed here, so that tests do not depend on the library's values.
inline constexpr double mu0 = 1.25663706127e-6, gamma = 1.760859e11, mu_B = 9.2740100657e-24,
                        meV = 1.602176634e-22, e = 1.602176634e-19, hbar = 1.054571817e-34,
                        boltzmann = 1.380649e-23;

}  // namespace cayspin::inline v0_2::io::test
