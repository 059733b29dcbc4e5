// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

namespace cayspin::isotropy {

/// sigma from A' along the flow: xi = A_o + sigma m with sigma = (m.A) - <A', X> / |X|^2,
/// X = A x m. No differences: the derivative of the field is its linear part at X. For LieEuler,
/// and with the opposite sign for ImplicitLieEuler. Lewis and Nigam 2002, Sec. 4.1 and 4.2, with
/// the sign and the norm mended. Zero where X is.
struct Analytic {};

/// The same number as the geodesic curvature of the orbit times its speed,
/// sigma = k_g |X| = <m'', m x m'> / |m'|^2, m' = X: sigma as a partial connection form.
/// Lewis and Nigam 2002, Sec. 3.2.
struct Connection {};

}  // namespace cayspin::isotropy
