// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/relax.hpp"
#include "wrong_scenes.hpp"

namespace cayspin::inline v0_2::io::test {
namespace {

std::string const two_site_scene =
    replaced(plain_scene, "[4, 3, 2]", "[4, 3, 2]\nbasis = [[0, 0, 0], [0.5, 0.5, 0.5]]") +
    "[field]\ncouplings = [{ between = [0, 1], J = 1 }]\n";

TEST(WrongCrystal, OfLattice) {
  expect_refused(two_site_scene, R"(
lattice.basis =; lattice.cell = [[1, 0, 0], [0, 1, 0]] | : has 2 entries
  | three vectors of three numbers
lattice.basis =; lattice.cell = 2 | : 2 is an integer | that span a volume
lattice.basis =; lattice.cell = [[1, 0, 0], [0, inf, 0], [0, 0, 1]] | [1][1]: inf is not finite
lattice.basis =; lattice.cell = [[1, 0, 0], [0, 1, 0], [1, 1, 0]] | : the vectors span no volume
  | three vectors
lattice.basis =; lattice.cell = [[1, 0, 0], [0, 1, 0], [0, 0, 0]] | : the vectors span no volume
  | three vectors
lattice.basis =; lattice.cell = [[1, 0, 0], [0, 1, 0], [1, 1, 1e-13]] | : the vectors span no volume
  | three vectors
lattice.basis = [] | : has 0 entries | an array of sites
lattice.basis = 'bcc' | : 'bcc' is a string | an array of sites
lattice.basis = [0, 0, 0] | [0]: 0 is an integer | three numbers
lattice.basis = [[0, 0, 0], [0.5, 0.5]] | [1]: has 2 entries | three numbers
lattice.basis = [[0, 0, 0], [0.5, 0, 0], [0, 0, 0]] | [2]: is at the same place as site 0
  | sites at places of their own
lattice.basis = [[0.5, 0, 0.9999999], [0.2, 0, 0], [-0.5, 3, 0]]
  | [2]: is at the same place as site 0
  | places
lattice.basis =; lattice.crystal = 'fc' | : "fc" is not known, did you mean "fcc"?
  | "bcc", "fcc", "hcp", "honeycomb", "kagome", "pyrochlore"
lattice.basis =; lattice.crystal = 3 | : 3 is an integer | "bcc"
lattice.crystal = 'bcc' | lattice.basis: stands beside lattice.crystal | no such key
lattice.basis =; lattice.crystal = 'bcc'; lattice.cell = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
  | : stands beside lattice.crystal | no such key
lattice.moments = [1] | : has 1 entries | 2 numbers >= 0
lattice.moments = [1, -1] | [1]: -1 is negative | a number >= 0
lattice.moments = true | : true is a boolean | a number >= 0
lattice.gyromagnetic = -1 | : -1 is not positive | a number > 0
lattice.gyromagnetic = [1, nan] | [1]: nan is not finite
lattice.occupied = true | : true is a boolean
  | an expression in x, y, z, i, j, k, s, { file = "NAME.h5" }, { image = "NAME.png" } or { regions = [v0, v1, ..] }
lattice.occupied = 't < 1' | : expression "t < 1" | a formula in x, y, z, i, j, k, s
lattice.frozen = 'i ==' | : expression "i ==" | a formula in
lattice.frozen = 'i = 0' | : expression "i = 0" | assignment
lattice.basis =; field =; lattice.frozen = 's == 0' | : expression "s == 0"
  | a formula in x, y, z, i, j, k
lattice.shape = [1, 1, 400000000] | : more sites than memory can address, with 2 in a cell
  | a smaller shape
lattice.basis =; lattice.bases = [[0, 0, 0], [0.5, 0.5, 0.5]] | : unknown key
  | did you mean "basis"?; accepted: shape, spacing, boundary, crystal
)");
}

TEST(WrongCrystal, OfCouplings) {
  expect_refused(two_site_scene, R"(
field.couplings = 1 | : 1 is an integer
  | an array of tables { between, offset, J, D, tensor, biquadratic }
field.couplings = [] | : has 0 entries | an array
field.couplings = [1] | [0]: 1 is an integer | a table
field.couplings = [{ between = [0, 1], j = 1 }] | [0].j: unknown key
  | between, offset, J, D, tensor, biquadratic
field.couplings = [{ between = [0, 1] }] | [0]: has no strength | J, D, tensor or biquadratic
field.couplings = [{ between = [0], J = 1 }] | [0].between: has 1 entries
  | two sites of the cell, 0 to 1
field.couplings = [{ between = [0, 2], J = 1 }] | [0].between[1]: the cell has no site 2 | 0 to 1
field.couplings = [{ between = [-1, 1], J = 1 }] | [0].between[0]: -1 is too small | 0 to 1
field.couplings = [{ between = [0, 1.0], J = 1 }] | [0].between[1]: 1.0 is a number | 0 to 1
field.couplings = [{ between = [0, 1], J = 1, offset = [1, 0] }] | [0].offset: has 2 entries
  | three whole numbers
field.couplings = [{ between = [0, 1], J = 1, offset = [1, 0, 0.5] }]
  | [0].offset[2]: 0.5 is a number | three whole numbers
field.couplings = [{ between = [0, 1], J = 1, offset = [1, -9223372036854775808, 0] }]
  | [0].offset[1]: -9223372036854775808 is too large | three whole numbers
field.couplings = [{ between = [1, 1], J = 1 }] | [0]: couples a site to itself | another site
field.couplings = [{ J = 1 }] | [0]: couples a site to itself | an offset
field.couplings = [{ between = [0, 1], J = '1' }] | [0].J: '1' is a string | a finite number
field.couplings = [{ between = [0, 1], J = -inf }] | [0].J: -inf is not finite | a finite number
field.couplings = [{ between = [0, 1], D = [1, 2] }] | [0].D: has 2 entries | three numbers
field.couplings = [{ between = [0, 1], tensor = [[1, 2, 3]] }] | [0].tensor: has 1 entries
  | three rows
field.couplings = [{ between = [0, 1], tensor = [[1, 2, 3], [4, 5], [6, 7, 8]] }]
  | [0].tensor[1]: has 2 entries | three numbers
field.couplings = [{ between = [0, 1], tensor = [[1, 2, 3], [4, 5, nan], [6, 7, 8]] }]
  | [0].tensor[1][2]: nan is not finite
field.couplings = [{ between = [0, 1], J = 1, tensor = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }]
  | [0].J: stands beside a tensor | no such key
field.couplings = [{ between = [0, 1], D = [0, 0, 1], tensor = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }]
  | [0].D: stands beside a tensor | no such key
field.couplings = [{ between = [0, 1], biquadratic = true }] | [0].biquadratic: true is a boolean
  | a finite number
field.couplings = [{ between = [0, 1], offset = [1, 2, 0], J = 1 },
 { between = [1, 0], offset = [-1, -2, 0], J = 1 }]
  | [1]: is the same bond as field.couplings[0], from its other end; | each bond once
field.couplings = {} | : has no bonds | shells
field.couplings = { both_directions = true, shells = [1] } | .both_directions: belongs to pairs
field.couplings = { pairs = [{ J = 1 }], file = 'a.ucf' } | : has a file and other bonds
field.couplings = { pairs = [{ offset = [1, 0, 0], J = 1 }], both_directions = 1 } | .both_directions: 1
field.couplings = { pairs = [{ offset = [1, 0, 0], J = 1 }], both_directions = true }
  | .pairs[0]: is not written from its other end | each bond from both ends
field.couplings = { pairs = [{ offset = [1, 0, 0], J = 1 }, { offset = [-1, 0, 0], J = 2 }], both_directions = true }
  | .pairs[0]: differs from field.couplings.pairs[1]
field.couplings = { pairs = [{ offset = [1, 0, 0], J = 1 }, { offset = [-1, 0, 0], J = 1 }] }
  | .pairs[1]: is the same bond as field.couplings.pairs[0], from its other end | both_directions
field.couplings = { shells = [1], file = 'a.ucf' } | : has a file and other bonds | { file = "NAME.ucf" }
field.couplings = { shell = [1] } | .shell: unknown key | did you mean "shells"?
field.couplings = { shells = 1 } | .shells: 1 is an integer | the J of pairs at the first
field.couplings = { shells = [] } | .shells: has 0 entries | the J of pairs at the first
field.couplings = { shells = [1, nan] } | .shells[1]: nan is not finite
field.couplings = { shells = [1], scale = 2 } | .scale: belongs to a file | no such key
field.couplings = { file = 3 } | .file: 3 is an integer | the name of a unit-cell file of Vampire
field.couplings = { file = '' } | .file: the file name is empty | unit-cell file
field.couplings = { file = 'a.ucf', scale = inf } | .scale: inf is not finite
)");
}

TEST(WrongCrystal, OfTerms) {
  expect_refused(two_site_scene, R"(
field.anisotropy = { constant = 1, axis = [0, 0, 1], site = 2 } | .site: the cell has no site 2
  | a site of the cell, 0 to 1
field.anisotropy = [{ constant = 1, axis = [0, 0, 1], site = -1 }] | [0].site: -1 is too small
  | 0 to 1
field.anisotropy = { cubicc = 1 } | .cubicc: unknown key | did you mean "cubic"?
field.anisotropy = { cubic = 1 } | .axes: is missing | two vectors at right angles
field.anisotropy = { cubic = 1, axis = [0, 0, 1] } | .axis: belongs to a uniaxial anisotropy
  | no such key
field.anisotropy = { cubic = 1, constant = 1, axes = [[1, 0, 0], [0, 1, 0]] }
  | .constant: belongs to a uniaxial anisotropy | no such key
field.anisotropy = { constant = 1, axes = [[1, 0, 0], [0, 1, 0]] }
  | .axes: belongs to a cubic anisotropy | no such key
field.anisotropy = { cubic = true, axes = [[1, 0, 0], [0, 1, 0]] } | .cubic: true is a boolean
  | a finite number
field.anisotropy = { cubic = 1, constant2 = 'q', axes = [[1, 0, 0], [0, 1, 0]] }
  | .constant2: expression | a formula in x, y, z
field.anisotropy = { cubic = 1, in_plane = [1, 0, 0], axes = [[1, 0, 0], [0, 1, 0]] }
  | .in_plane: belongs to a hexagonal anisotropy | no such key
field.anisotropy = { hexagonal = 1, cubic = 1, axes = [[1, 0, 0], [0, 1, 0]] }
  | .hexagonal: belongs to a hexagonal anisotropy | no such key
field.anisotropy = { hexagonal = 1, axes = [[1, 0, 0], [0, 1, 0]] }
  | .axes: belongs to a cubic anisotropy | no such key
field.anisotropy = { hexagonal = 1, constant2 = 1 } | .constant2: belongs to a uniaxial anisotropy
  | no such key
field.anisotropy = { hexagonal = 1, axis = [0, 0, 1] } | .in_plane: is missing
  | a vector at right angles with axis
field.anisotropy = { hexagonal = 1, in_plane = [0, 0, 1] } | .axis: is missing | three numbers
field.anisotropy = { hexagonal = 1, axis = [0, 0, 1], in_plane = [1, 0, 1] }
  | .in_plane: the axes are not at right angles, by 0.707 | two vectors at right angles
field.anisotropy = { constant = 1, axis = [0, 0, 1], in_plane = [1, 0, 0] }
  | .in_plane: belongs to a hexagonal anisotropy | no such key
field.dmi = { d2d = 1, bulk = 1 } | : is of D2d and of another symmetry | { d2d = D }
field.dmi = { d2d = 1, normal = [0, 0, 1] } | : is of D2d and of another symmetry | { d2d = D }
field.dmi = { d2d = true } | .d2d: true is a boolean | an expression
field.anisotropy = { cubic = 1, axes = [[1, 0, 0], [1, 1, 0]] }
  | .axes: the axes are not at right angles | two vectors at right angles
field.anisotropy = { cubic = 1, axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] } | .axes: has 3 entries
  | two vectors
field.anisotropy = { cubic = 1, axes = [[1, 0, 0], [0, 0, 0]] } | .axes[1]: is a zero vector
field.dmi = 1 | : 1 is an integer | { interfacial = D, normal = [x, y, z] }, { bulk = D }
field.dmi = { interfacial = 1 } | .normal: is missing | three numbers
field.dmi = { interfacial = 1, normal = [0, 0, 0] } | .normal: is a zero vector | three numbers
field.dmi = { bulkk = 1 } | .bulkk: unknown key | interfacial, normal, bulk
field.dmi = { bulk = 1, interfacial = 1, normal = [0, 0, 1] } | : has keys of an interface and of the bulk
  | { bulk = D }
field.dmi = { bulk = inf } | .bulk: inf is not finite
field.exchange = 1 | : needs one site in a cell | field.couplings with J
field.dmi = { interfacial = 1, normal = [0, 0, 1] } | : needs one site in a cell
  | field.couplings with D
field.dmi = { bulk = 1 } | : needs one site in a cell | field.couplings with D
lattice.basis =; lattice.cell = [[1, 0, 0], [0.5, 1, 0], [0, 0, 1]]; field = { exchange = 1 }
  | .exchange: needs a cell with edges along x, y and z of the lengths | field.couplings with J
field.dipoles = 1 | : 1 is an integer | true, or { strength, periodic_images, demagnetizing_factors
field.demag = 1 | : 1 is an integer | true, or { strength, periodic_images, demagnetizing_factors
field.dipoles = { images = [1, 0, 0] } | .images: unknown key | periodic_images
field.dipoles = { periodic_images = [1, -1, 0] } | .periodic_images[1]: -1 is too small | 0 to 1000
field.dipoles = { strength = nan } | .strength: nan is not finite
field.dipoles = { demagnetizing_factors = [0, 0, 1] }
  | .demagnetizing_factors: applies only to a lattice that is periodic along x, y and z
  | no such key
field.dipoles = { demagnetizing_factors = [0, 0, 2] } | .demagnetizing_factors[2]: 2 | 0 to 1
field.dipoles = { demagnetizing_factors = [0, 1] } | .demagnetizing_factors: has 2 entries
)");
}

TEST(WrongCrystal, OfTorque) {
  expect_refused(two_site_scene, R"(
torque = {} | : is empty | zhang_li, slonczewski
torque.zhangli = {} | : unknown key | did you mean "zhang_li"?
torque.zhang_li = 1 | : 1 is an integer | a table
torque.zhang_li = {} | .velocity: is missing | three numbers or expressions in t
torque.zhang_li = { velocity = [1, 2] } | .velocity: has 2 entries | three numbers
torque.zhang_li = { velocity = [1, 'x', 2] } | .velocity[1]: expression "x" | a formula in t
torque.zhang_li = { velocity = [1, 0, 0], nonadiabaticity = nan }
  | .nonadiabaticity: nan is not finite
torque.zhang_li = { velocity = [1, 0, 0] } | : needs one site in a cell | slonczewski
torque.slonczewski = { polarization = [1, 0, 0] } | : has no strength | damping_like, field_like
torque.slonczewski = { field_like = 1 } | .polarization: is missing | three numbers
torque.slonczewski = { field_like = 1, polarization = [0, 0, 0] } | .polarization: is a zero vector
torque.slonczewski = { damping_like = [1], polarization = [1, 0, 0] } | .damping_like: is an array
  | an expression in t
torque.slonczewski = { damping_like = '1/t', polarization = [1, 0, 0] }
  | .damping_like: expression "1/t" | not finite at t = 0
torque.slonczewski = { damping_like = 1, polarization = [1, 0, 0] };
 integrator.energy_control = true | : | accepted:
torque.slonczewski = { damping_like = 1, polarization = [1, 0, 0] }; integrator.until_torque = 1 | :
  | no such key
)");
}

TEST(WrongCrystal, OfABondTypedTwiceIsNamedByItsLine) {
  EXPECT_TRUE(refusal_of(replaced(two_site_scene, "[{ between = [0, 1], J = 1 }]",
                                  "[{ between = [0, 1], J = 1 },\n"
                                  "{ between = [1, 1], offset = [1, 0, 0], J = 1 },\n"
                                  "{ between = [0, 1], offset = [0, 0, 0], D = [1, 0, 0] }]"))
                  .starts_with("scene.toml:16: field.couplings[2]: is the same bond as "
                               "field.couplings[0]; accepted: each bond once"));
}

// A scene to relax has the same refusals with and without an integrator.
TEST(WrongCrystal, ToRelaxIsRefused) {
  Folder const folder;
  auto const without =
      replaced(two_site_scene, "[integrator]\nmethod = \"rkmk4\"\ndt = 0.01\nsteps = 10\n", "");
  for (auto const& text : {two_site_scene, without}) {
    auto const refused = [&](std::vector<std::string> const& overrides) {
      return refusal([&] { read_scene_to_relax(folder.write(text), overrides); });
    };
    EXPECT_EQ(refused({}), "accepted");
    // Torques are accepted here for cayspin modes; relax and path refuse them later.
    EXPECT_EQ(refused({"torque={slonczewski={field_like=1,polarization=[0,0,1]}}"}), "accepted");
    expect_holds(refused({"field.exchange=1"}), ": field.exchange: needs one site in a cell");
  }
}

TEST(WrongCrystal, BodiesHaveNoSites) {
  for (std::string const key :
       {"crystal='bcc'", "cell=[[1,0,0],[0,1,0],[0,0,1]]", "basis=[[0,0,0]]", "moments=1",
        "gyromagnetic=1", "occupied='1'", "frozen='0'"})
    expect_holds(refusal_of(body_scene, {"lattice={shape=[5]," + key + "}"}),
                 "has no meaning for independent rigid bodies");
  expect_holds(refusal_of(body_scene, {"torque={slonczewski={field_like=1,polarization=[0,0,1]}}"}),
               "has no meaning for kind = \"rigid_body\"");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
