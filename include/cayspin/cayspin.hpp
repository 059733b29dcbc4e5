// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

// scene -> lattice + field -> generator -> stepper (rotation, isotropy) -> observer -> files
#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/exchange.hpp>
#include <cayspin/field/host_field.hpp>
#include <cayspin/field/layer_averaged_slab_demag.hpp>
#include <cayspin/field/slab_demag.hpp>
#include <cayspin/field/slab_demag_on_host.hpp>
#include <cayspin/field/uniaxial_anisotropy.hpp>
#include <cayspin/field/zeeman.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/integrate.hpp>
#include <cayspin/isotropy/analytic.hpp>
#include <cayspin/isotropy/constant.hpp>
#include <cayspin/isotropy/energy.hpp>
#include <cayspin/isotropy/finite_difference.hpp>
#include <cayspin/isotropy/zero.hpp>
#include <cayspin/lattice/lattice.hpp>
#include <cayspin/observer/record.hpp>
#include <cayspin/observer/scalars.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/rotation/exponential.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stability.hpp>
#include <cayspin/stepper/classical.hpp>
#include <cayspin/stepper/lie_adams_bashforth2.hpp>
#include <cayspin/stepper/lie_euler.hpp>
#include <cayspin/stepper/lie_heun.hpp>
#include <cayspin/stepper/rkmk.hpp>
#include <cayspin/stepper/rkmk4.hpp>
#include <cayspin/vec3.hpp>
