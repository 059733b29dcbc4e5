// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ensemble.hpp"

/// The paper's names for the maps F of its Sec. 5, as choices of a scene.
namespace cayspin::program::reproduction {

using enum io::Method;
using io::Generator, io::Isotropy;

inline constexpr Choice euler_def{euler, Generator::standard, Isotropy::zero};
inline constexpr Choice euler_orth{euler, Generator::orthogonal, Isotropy::zero};
inline constexpr Choice euler_cor{euler, Generator::standard, Isotropy::analytic};

inline constexpr Choice heun_def{heun, Generator::standard, Isotropy::zero};
inline constexpr Choice heun_orth{heun, Generator::orthogonal, Isotropy::zero};
inline constexpr Choice heun_dcor{heun, Generator::standard, Isotropy::energy};
inline constexpr Choice heun_ocor{heun, Generator::orthogonal, Isotropy::energy};

inline constexpr Choice sy4_def{series4, Generator::standard, Isotropy::zero};
inline constexpr Choice sy4_dcor{series4, Generator::standard, Isotropy::energy};
inline constexpr Choice sy4_orth{series4_paper, Generator::orthogonal, Isotropy::zero};
inline constexpr Choice sy4_ocor{series4_paper, Generator::orthogonal, Isotropy::energy};
inline constexpr Choice sy4_orth_direct{series4, Generator::orthogonal, Isotropy::zero};

inline constexpr Choice rkmk4_def{rkmk4, Generator::standard, Isotropy::zero};
inline constexpr Choice rkmk4_orth{rkmk4, Generator::orthogonal, Isotropy::zero};
inline constexpr Choice rkmk4_printed_def{rkmk4_as_printed, Generator::standard, Isotropy::zero};
inline constexpr Choice rkmk4_printed_orth{rkmk4_as_printed, Generator::orthogonal, Isotropy::zero};

}  // namespace cayspin::program::reproduction
