// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_file.hpp"

namespace cayspin::inline v0_1::io::test {
namespace {

class WrongBodyScene : public testing::TestWithParam<WrongScene> {};

TEST_P(WrongBodyScene, IsRefusedInOneLine) { expect_refused(body_scene, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    RigidBody, WrongBodyScene,
    testing::Values(
        WrongScene{"damping", "inertia =", "damping = 0\ninertia =", ":3: system.damping",
                   "no meaning for kind = \"rigid_body\""},
        WrongScene{"precession", "inertia =", "precession = true\ninertia =",
                   ":3: system.precession", "no meaning"},
        WrongScene{"inertia_missing", "inertia = [1.0, 2.0, 3.0]", "",
                   ":1: system.inertia: is missing", "three principal moments"},
        WrongScene{"inertia_number", "[1.0, 2.0, 3.0]", "1.0",
                   ":3: system.inertia: 1.0 is a number", "symmetric 3x3"},
        WrongScene{"moment_zero", "[1.0, 2.0, 3.0]", "[1.0, 0, 3.0]", ":3: system.inertia[1]: 0",
                   "a number > 0"},
        WrongScene{"moment_negative", "[1.0, 2.0, 3.0]", "[1.0, 2, -3]",
                   ":3: system.inertia[2]: -3", "a number > 0"},
        WrongScene{"tensor_not_symmetric", "[1.0, 2.0, 3.0]", "[[1, 0.1, 0], [0, 2, 0], [0, 0, 3]]",
                   ":3: system.inertia", "not symmetric"},
        WrongScene{"tensor_indefinite", "[1.0, 2.0, 3.0]", "[[1, 2, 0], [2, 1, 0], [0, 0, 3]]",
                   ":3: system.inertia", "not positive definite"},
        WrongScene{"tensor_singular", "[1.0, 2.0, 3.0]", "[[1, 0, 0], [0, 0, 0], [0, 0, 3]]",
                   ":3: system.inertia", "not positive definite"},
        WrongScene{"tensor_row_short", "[1.0, 2.0, 3.0]", "[[1, 0], [0, 2, 0], [0, 0, 3]]",
                   ":3: system.inertia[0]: has 2 entries", "three numbers"},
        WrongScene{"inertia_key", "[1.0, 2.0, 3.0]", "{ fil = \"i.h5\" }",
                   ":3: system.inertia.fil: unknown key", "did you mean \"file\"?"},
        WrongScene{"inertia_file_empty", "[1.0, 2.0, 3.0]", "{ file = \"\" }",
                   ":3: system.inertia.file: the file name is empty", ""},
        WrongScene{"two_extents", "[5]", "[5, 2]", ":6: lattice.shape: has 2 entries", "[count]"},
        WrongScene{"spacing", "[5]", "[5]\nspacing = 1", ":7: lattice.spacing", "no meaning"},
        WrongScene{"boundary", "[5]", "[5]\nboundary = \"open\"", ":7: lattice.boundary",
                   "no meaning"},
        WrongScene{"field", "[initial]", "[field]\n\n[initial]", ":8: field", "no meaning"},
        WrongScene{"until_torque", "dt = 0.1", "dt = 0.1\nuntil_torque = 1e-6",
                   ":14: integrator.until_torque", "no torque"}),
    name_of);

}  // namespace
}  // namespace cayspin::inline v0_1::io::test
