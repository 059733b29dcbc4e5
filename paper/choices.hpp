// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ensemble.hpp"

/// The maps F of the paper's Sec. 5, under the paper's names, as method choices of a scene.
namespace cayspin::paper {

using io::Generator, io::Isotropy;

/// Returns the method of this name with the given generator and isotropy; `sigma` is for
/// Isotropy::constant.
inline MethodChoice choose(std::string_view method, Generator generator = Generator::standard,
                           Isotropy isotropy = Isotropy::zero, double sigma = 0) {
  return {.method = io::find_method(method),
          .generator = generator,
          .isotropy = isotropy,
          .sigma = sigma};
}

inline MethodChoice const euler_def = choose("euler");
inline MethodChoice const euler_orth = choose("euler", Generator::orthogonal);
inline MethodChoice const euler_cor = choose("euler", Generator::standard, Isotropy::analytic);

inline MethodChoice const heun_def = choose("heun");
inline MethodChoice const heun_orth = choose("heun", Generator::orthogonal);
inline MethodChoice const heun_dcor = choose("heun", Generator::standard, Isotropy::energy);
inline MethodChoice const heun_ocor = choose("heun", Generator::orthogonal, Isotropy::energy);

inline MethodChoice const sy4_def = choose("series4");
inline MethodChoice const sy4_dcor = choose("series4", Generator::standard, Isotropy::energy);
inline MethodChoice const sy4_orth = choose("series4_paper", Generator::orthogonal);
inline MethodChoice const sy4_ocor =
    choose("series4_paper", Generator::orthogonal, Isotropy::energy);
inline MethodChoice const sy4_orth_direct = choose("series4", Generator::orthogonal);

inline MethodChoice const rkmk4_def = choose("rkmk4");
inline MethodChoice const rkmk4_orth = choose("rkmk4", Generator::orthogonal);
inline MethodChoice const rkmk4_printed_def = choose("rkmk4_as_printed");
inline MethodChoice const rkmk4_printed_orth = choose("rkmk4_as_printed", Generator::orthogonal);

}  // namespace cayspin::paper
