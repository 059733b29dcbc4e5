// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scene_file.hpp"

#include <cayspin/io/relax.hpp>

namespace cayspin::inline v0_1::io::test {
namespace {

// Of two sites in a cell.
constexpr std::string_view crystal_scene = R"toml([system]
kind = "llg"
damping = 0.1

[lattice]
shape = [4, 3, 2]
basis = [[0, 0, 0], [0.5, 0.5, 0.5]]

[field]
couplings = [{ between = [0, 1], J = 1 }]

[initial]
uniform = [0, 0, 1]

[integrator]
method = "rkmk4"
dt = 0.01
steps = 10
)toml";

class WrongCrystal : public testing::TestWithParam<WrongScene> {};
TEST_P(WrongCrystal, IsRefusedInOneLine) { expect_refused(crystal_scene, GetParam()); }

constexpr char const* basis = "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]";
constexpr char const* both_sites = "[[0, 0, 0], [0.5, 0.5, 0.5]]";

INSTANTIATE_TEST_SUITE_P(
    Lattice, WrongCrystal,
    testing::Values(
        WrongScene{"cell_count", basis, "cell = [[1, 0, 0], [0, 1, 0]]",
                   ":7: lattice.cell: has 2 entries", "three vectors of three numbers"},
        WrongScene{"cell_type", basis, "cell = 2", ":7: lattice.cell: 2 is an integer",
                   "that span a volume"},
        WrongScene{"cell_number", basis, "cell = [[1, 0, 0], [0, inf, 0], [0, 0, 1]]",
                   ":7: lattice.cell[1][1]: inf is not finite", ""},
        WrongScene{"cell_flat", basis, "cell = [[1, 0, 0], [0, 1, 0], [1, 1, 0]]",
                   ":7: lattice.cell: the vectors span no volume", "three vectors"},
        WrongScene{"cell_of_a_zero_vector", basis, "cell = [[1, 0, 0], [0, 1, 0], [0, 0, 0]]",
                   ":7: lattice.cell: the vectors span no volume", "three vectors"},
        WrongScene{"cell_nearly_flat", basis, "cell = [[1, 0, 0], [0, 1, 0], [1, 1, 1e-13]]",
                   ":7: lattice.cell: the vectors span no volume", "three vectors"},
        WrongScene{"basis_empty", both_sites, "[]", ":7: lattice.basis: has 0 entries",
                   "an array of sites"},
        WrongScene{"basis_type", both_sites, "\"bcc\"", ":7: lattice.basis: 'bcc' is a string",
                   "an array of sites"},
        WrongScene{"basis_of_numbers", both_sites, "[0, 0, 0]",
                   ":7: lattice.basis[0]: 0 is an integer", "three numbers"},
        WrongScene{"basis_short", both_sites, "[[0, 0, 0], [0.5, 0.5]]",
                   ":7: lattice.basis[1]: has 2 entries", "three numbers"},
        WrongScene{"basis_twice", both_sites, "[[0, 0, 0], [0.5, 0, 0], [0, 0, 0]]",
                   ":7: lattice.basis[2]: is the place of site 0, too",
                   "sites at places of their own"},
        WrongScene{"basis_twice_in_other_cells", both_sites,
                   "[[0.5, 0, 0.9999999], [0.2, 0, 0], [-0.5, 3, 0]]",
                   ":7: lattice.basis[2]: is the place of site 0, too", "places"},
        WrongScene{"crystal_unknown", basis, "crystal = \"fc\"",
                   ":7: lattice.crystal: \"fc\" is not known, did you mean \"fcc\"?",
                   "\"bcc\", \"fcc\", \"hcp\", \"honeycomb\", \"kagome\", \"pyrochlore\""},
        WrongScene{"crystal_type", basis, "crystal = 3", ":7: lattice.crystal: 3 is an integer",
                   "\"bcc\""},
        WrongScene{"crystal_and_basis", basis,
                   "crystal = \"bcc\"\nbasis = [[0, 0, 0], [0.5, 0.5, 0.5]]",
                   ":8: lattice.basis: stands beside lattice.crystal", "no such key"},
        WrongScene{"crystal_and_cell", basis,
                   "crystal = \"bcc\"\ncell = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
                   ":8: lattice.cell: stands beside lattice.crystal", "no such key"},
        WrongScene{"moments_count", basis, "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\nmoments = [1]",
                   ":8: lattice.moments: has 1 entries", "2 numbers > 0"},
        WrongScene{"moments_zero", basis, "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\nmoments = [1, 0]",
                   ":8: lattice.moments[1]: 0 is not positive", "a number > 0"},
        WrongScene{"moments_type", basis, "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\nmoments = \"1\"",
                   ":8: lattice.moments: '1' is a string", "a number > 0"},
        WrongScene{"gyromagnetic_negative", basis,
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\ngyromagnetic = -1",
                   ":8: lattice.gyromagnetic: -1 is not positive", "a number > 0"},
        WrongScene{"gyromagnetic_nan", basis,
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\ngyromagnetic = [1, nan]",
                   ":8: lattice.gyromagnetic[1]: nan is not finite", ""},
        WrongScene{"occupied_type", basis, "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\noccupied = true",
                   ":8: lattice.occupied: true is a boolean",
                   "an expression in x, y, z, i, j, k, s, or { file = \"NAME.h5\" }"},
        WrongScene{"occupied_variable", basis,
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\noccupied = \"t < 1\"",
                   ":8: lattice.occupied: expression \"t < 1\"",
                   "a formula in x, y, z, i, j, k, s"},
        WrongScene{"frozen_syntax", basis,
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\nfrozen = \"i ==\"",
                   ":8: lattice.frozen: expression \"i ==\"", "a formula in"},
        WrongScene{"frozen_assigns", basis,
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\nfrozen = \"i = 0\"",
                   ":8: lattice.frozen: expression \"i = 0\"", "assignment"},
        WrongScene{"no_site_variable_on_a_plain_lattice",
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\n\n[field]\ncouplings = [{ between = [0, "
                   "1], J = 1 }]",
                   "frozen = \"s == 0\"", ":7: lattice.frozen: expression \"s == 0\"",
                   "a formula in x, y, z, i, j, k"},
        WrongScene{"planes_beyond_the_index", "[4, 3, 2]", "[1, 1, 400000000]",
                   ":6: lattice.shape: more sites than memory can address, with 2 in a cell",
                   "a smaller shape"},
        WrongScene{"key_of_lattice", "basis =", "bases =", ":7: lattice.bases: unknown key",
                   "did you mean \"basis\"?; accepted: shape, spacing, boundary, crystal"}),
    name_of);

constexpr char const* list = "[{ between = [0, 1], J = 1 }]";

INSTANTIATE_TEST_SUITE_P(
    Couplings, WrongCrystal,
    testing::Values(
        WrongScene{"type", list, "1", ":10: field.couplings: 1 is an integer",
                   "an array of tables { between, offset, J, D, tensor, biquadratic }"},
        WrongScene{"empty", list, "[]", ":10: field.couplings: has 0 entries", "an array"},
        WrongScene{"of_numbers", list, "[1]", ":10: field.couplings[0]: 1 is an integer",
                   "a table"},
        WrongScene{"unknown_key", "J = 1", "j = 1", ":10: field.couplings[0].j: unknown key",
                   "between, offset, J, D, tensor, biquadratic"},
        WrongScene{"no_strength", ", J = 1", "", ":10: field.couplings[0]: has no strength",
                   "J, D, tensor or biquadratic"},
        WrongScene{"between_one", "[0, 1], J", "[0], J",
                   ":10: field.couplings[0].between: has 1 entries",
                   "two sites of the cell, 0 to 1"},
        WrongScene{"between_no_site", "[0, 1], J", "[0, 2], J",
                   ":10: field.couplings[0].between[1]: the cell has no site 2", "0 to 1"},
        WrongScene{"between_negative", "[0, 1], J", "[-1, 1], J",
                   ":10: field.couplings[0].between[0]: -1 is too small", "0 to 1"},
        WrongScene{"between_real", "[0, 1], J", "[0, 1.0], J",
                   ":10: field.couplings[0].between[1]: 1.0 is a number", "0 to 1"},
        WrongScene{"offset_short", "J = 1", "J = 1, offset = [1, 0]",
                   ":10: field.couplings[0].offset: has 2 entries", "three whole numbers"},
        WrongScene{"offset_real", "J = 1", "J = 1, offset = [1, 0, 0.5]",
                   ":10: field.couplings[0].offset[2]: 0.5 is a number", "three whole numbers"},
        WrongScene{"offset_far", "J = 1", "J = 1, offset = [1, -9223372036854775808, 0]",
                   ":10: field.couplings[0].offset[1]: -9223372036854775808 is too large",
                   "three whole numbers"},
        WrongScene{"with_itself", "[0, 1], J", "[1, 1], J",
                   ":10: field.couplings[0]: couples a site to itself", "another site"},
        WrongScene{"with_itself_by_default", "between = [0, 1], J", "J",
                   ":10: field.couplings[0]: couples a site to itself", "an offset"},
        WrongScene{"J_type", "J = 1", "J = \"1\"", ":10: field.couplings[0].J: '1' is a string",
                   "a finite number"},
        WrongScene{"J_infinite", "J = 1", "J = -inf",
                   ":10: field.couplings[0].J: -inf is not finite", "a finite number"},
        WrongScene{"D_short", "J = 1", "D = [1, 2]", ":10: field.couplings[0].D: has 2 entries",
                   "three numbers"},
        WrongScene{"tensor_rows", "J = 1", "tensor = [[1, 2, 3]]",
                   ":10: field.couplings[0].tensor: has 1 entries", "three rows"},
        WrongScene{"tensor_columns", "J = 1", "tensor = [[1, 2, 3], [4, 5], [6, 7, 8]]",
                   ":10: field.couplings[0].tensor[1]: has 2 entries", "three numbers"},
        WrongScene{"tensor_number", "J = 1", "tensor = [[1, 2, 3], [4, 5, nan], [6, 7, 8]]",
                   ":10: field.couplings[0].tensor[1][2]: nan is not finite", ""},
        WrongScene{"tensor_and_J", "J = 1", "J = 1, tensor = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
                   ":10: field.couplings[0].J: stands beside a tensor", "no such key"},
        WrongScene{"tensor_and_D", "J = 1",
                   "D = [0, 0, 1], tensor = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
                   ":10: field.couplings[0].D: stands beside a tensor", "no such key"},
        WrongScene{"biquadratic_type", "J = 1", "biquadratic = true",
                   ":10: field.couplings[0].biquadratic: true is a boolean", "a finite number"},
        WrongScene{"twice", list,
                   "[\n{ between = [0, 1], J = 1 },\n{ between = [1, 1], offset = [1, 0, 0], J = 1 "
                   "},\n{ between = [0, 1], offset = [0, 0, 0], D = [1, 0, 0] }]",
                   ":13: field.couplings[2]: is the bond of field.couplings[0];", "each bond once"},
        WrongScene{"twice_reversed", list,
                   "[{ between = [0, 1], offset = [1, 2, 0], J = 1 }, { between = [1, 0], offset = "
                   "[-1, -2, 0], J = 1 }]",
                   ":10: field.couplings[1]: is the bond of field.couplings[0], reversed;",
                   "each bond once"},
        WrongScene{"table_empty", list, "{}", ":10: field.couplings: has no bonds", "shells"},
        WrongScene{"table_of_both", list, "{ shells = [1], file = \"a.ucf\" }",
                   ":10: field.couplings: has shells and a file", "{ file = \"NAME.ucf\" }"},
        WrongScene{"table_key", list, "{ shell = [1] }", ":10: field.couplings.shell: unknown key",
                   "did you mean \"shells\"?"},
        WrongScene{"shells_number", list, "{ shells = 1 }",
                   ":10: field.couplings.shells: 1 is an integer", "the J of pairs at the first"},
        WrongScene{"shells_empty", list, "{ shells = [] }",
                   ":10: field.couplings.shells: has 0 entries", "the J of pairs at the first"},
        WrongScene{"shells_nan", list, "{ shells = [1, nan] }",
                   ":10: field.couplings.shells[1]: nan is not finite", ""},
        WrongScene{"shells_scale", list, "{ shells = [1], scale = 2 }",
                   ":10: field.couplings.scale: belongs to a file", "no such key"},
        WrongScene{"file_type", list, "{ file = 3 }", ":10: field.couplings.file: 3 is an integer",
                   "the name of a unit-cell file of Vampire"},
        WrongScene{"file_empty", list, "{ file = \"\" }",
                   ":10: field.couplings.file: the file name is empty", "unit-cell file"},
        WrongScene{"file_scale", list, "{ file = \"a.ucf\", scale = inf }",
                   ":10: field.couplings.scale: inf is not finite", ""}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Terms, WrongCrystal,
    testing::Values(
        WrongScene{"site_of_anisotropy", "[field]",
                   "[field]\nanisotropy = { constant = 1, axis = [0, 0, 1], site = 2 }",
                   ":10: field.anisotropy.site: the cell has no site 2",
                   "a site of the cell, 0 to 1"},
        WrongScene{"negative_site", "[field]",
                   "[field]\nanisotropy = [{ constant = 1, axis = [0, 0, 1], site = -1 }]",
                   ":10: field.anisotropy[0].site: -1 is too small", "0 to 1"},
        WrongScene{"anisotropy_key", "[field]", "[field]\nanisotropy = { cubicc = 1 }",
                   ":10: field.anisotropy.cubicc: unknown key", "did you mean \"cubic\"?"},
        WrongScene{"cubic_without_axes", "[field]", "[field]\nanisotropy = { cubic = 1 }",
                   ":10: field.anisotropy.axes: is missing", "two vectors at right angles"},
        WrongScene{"cubic_with_axis", "[field]",
                   "[field]\nanisotropy = { cubic = 1, axis = [0, 0, 1] }",
                   ":10: field.anisotropy.axis: belongs to a uniaxial one", "no such key"},
        WrongScene{
            "cubic_and_constant", "[field]",
            "[field]\nanisotropy = { cubic = 1, constant = 1, axes = [[1, 0, 0], [0, 1, 0]] }",
            ":10: field.anisotropy.constant: belongs to a uniaxial one", "no such key"},
        WrongScene{"uniaxial_with_axes", "[field]",
                   "[field]\nanisotropy = { constant = 1, axes = [[1, 0, 0], [0, 1, 0]] }",
                   ":10: field.anisotropy.axes: belongs to a cubic one", "no such key"},
        WrongScene{"cubic_type", "[field]",
                   "[field]\nanisotropy = { cubic = \"1\", axes = [[1, 0, 0], [0, 1, 0]] }",
                   ":10: field.anisotropy.cubic: '1' is a string", "a finite number"},
        WrongScene{"oblique_axes", "[field]",
                   "[field]\nanisotropy = { cubic = 1, axes = [[1, 0, 0], [1, 1, 0]] }",
                   ":10: field.anisotropy.axes: the axes are not at right angles",
                   "two vectors at right angles"},
        WrongScene{"three_axes", "[field]",
                   "[field]\nanisotropy = { cubic = 1, axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
                   ":10: field.anisotropy.axes: has 3 entries", "two vectors"},
        WrongScene{"zero_axis", "[field]",
                   "[field]\nanisotropy = { cubic = 1, axes = [[1, 0, 0], [0, 0, 0]] }",
                   ":10: field.anisotropy.axes[1]: is a zero vector", ""},
        WrongScene{"dmi_type", "[field]", "[field]\ndmi = 1", ":10: field.dmi: 1 is an integer",
                   "{ interfacial = D, normal = [x, y, z] } or { bulk = D }"},
        WrongScene{"dmi_key", "[field]", "[field]\ndmi = { bulkk = 1 }",
                   ":10: field.dmi.bulkk: unknown key", "interfacial, normal, bulk"},
        WrongScene{"dmi_of_both", "[field]",
                   "[field]\ndmi = { bulk = 1, interfacial = 1, normal = [0, 0, 1] }",
                   ":10: field.dmi: is of an interface and of the bulk", "{ bulk = D }"},
        WrongScene{"dmi_infinite", "[field]", "[field]\ndmi = { bulk = inf }",
                   ":10: field.dmi.bulk: inf is not finite", ""},
        WrongScene{"exchange_in_a_crystal", "[field]", "[field]\nexchange = 1",
                   ":10: field.exchange: needs one site in a cell", "field.couplings with J"},
        WrongScene{"dmi_in_a_crystal", "[field]",
                   "[field]\ndmi = { interfacial = 1, normal = [0, 0, 1] }",
                   ":10: field.dmi: needs one site in a cell", "field.couplings with D"},
        WrongScene{"bulk_dmi_in_a_crystal", "[field]", "[field]\ndmi = { bulk = 1 }",
                   ":10: field.dmi: needs one site in a cell", "field.couplings with D"},
        WrongScene{"layers_in_a_crystal", "[field]",
                   "[field]\nslab_demag = { normal = [0, 0, 1], average = \"layer\" }",
                   ":10: field.slab_demag.average: needs one site in a cell", "no such key"},
        WrongScene{"exchange_in_an_oblique_cell",
                   "basis = [[0, 0, 0], [0.5, 0.5, 0.5]]\n\n[field]\ncouplings = [{ between = [0, "
                   "1], J = 1 }]",
                   "cell = [[1, 0, 0], [0.5, 1, 0], [0, 0, 1]]\n[field]\nexchange = 1",
                   ":9: field.exchange: needs a cell along the axes", "field.couplings with J"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Torque, WrongCrystal,
    testing::Values(
        WrongScene{"empty", "[initial]", "[torque]\n[initial]", ":12: torque: is empty",
                   "zhang_li, slonczewski"},
        WrongScene{"key", "[initial]", "[torque]\nzhangli = {}\n[initial]",
                   ":13: torque.zhangli: unknown key", "did you mean \"zhang_li\"?"},
        WrongScene{"type", "[initial]", "[torque]\nzhang_li = 1\n[initial]",
                   ":13: torque.zhang_li: 1 is an integer", "a table"},
        WrongScene{"velocity_missing", "[initial]", "[torque]\nzhang_li = {}\n[initial]",
                   ":13: torque.zhang_li.velocity: is missing",
                   "three numbers or expressions in t"},
        WrongScene{"velocity_short", "[initial]",
                   "[torque]\nzhang_li = { velocity = [1, 2] }\n[initial]",
                   ":13: torque.zhang_li.velocity: has 2 entries", "three numbers"},
        WrongScene{"velocity_variable", "[initial]",
                   "[torque]\nzhang_li = { velocity = [1, \"x\", 2] }\n[initial]",
                   ":13: torque.zhang_li.velocity[1]: expression \"x\"", "a formula in t"},
        WrongScene{
            "nonadiabaticity", "[initial]",
            "[torque]\nzhang_li = { velocity = [1, 0, 0], nonadiabaticity = nan }\n[initial]",
            ":13: torque.zhang_li.nonadiabaticity: nan is not finite", ""},
        WrongScene{"zhang_li_in_a_crystal", "[initial]",
                   "[torque]\nzhang_li = { velocity = [1, 0, 0] }\n[initial]",
                   ":13: torque.zhang_li: needs one site in a cell", "slonczewski"},
        WrongScene{"slonczewski_without_strength", "[initial]",
                   "[torque]\nslonczewski = { polarization = [1, 0, 0] }\n[initial]",
                   ":13: torque.slonczewski: has no strength", "damping_like, field_like"},
        WrongScene{"polarization_missing", "[initial]",
                   "[torque]\nslonczewski = { field_like = 1 }\n[initial]",
                   ":13: torque.slonczewski.polarization: is missing", "three numbers"},
        WrongScene{
            "polarization_zero", "[initial]",
            "[torque]\nslonczewski = { field_like = 1, polarization = [0, 0, 0] }\n[initial]",
            ":13: torque.slonczewski.polarization: is a zero vector", ""},
        WrongScene{"strength_type", "[initial]",
                   "[torque]\nslonczewski = { damping_like = [1], polarization = [1, 0, 0] "
                   "}\n[initial]",
                   ":13: torque.slonczewski.damping_like: is an array", "an expression in t"},
        WrongScene{"strength_infinite", "[initial]",
                   "[torque]\nslonczewski = { damping_like = \"1/t\", polarization = [1, 0, 0] "
                   "}\n[initial]",
                   ":13: torque.slonczewski.damping_like: expression \"1/t\"",
                   "not finite at t = 0"},
        WrongScene{"energy_control", "steps = 10\n",
                   "steps = 10\nenergy_control = true\n[torque]\nslonczewski = { damping_like = 1, "
                   "polarization = [1, 0, 0] }\n",
                   ":19: integrator.energy_control: ", "accepted: "},
        WrongScene{"until_torque", "steps = 10\n",
                   "steps = 10\nuntil_torque = 1\n[torque]\nslonczewski = { damping_like = 1, "
                   "polarization = [1, 0, 0] }\n",
                   ":19: integrator.until_torque: ", "no such key"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Methods, WrongCrystal,
    testing::Values(
        WrongScene{"by_colour", "\"rkmk4\"", "\"red_black2\"",
                   ":16: integrator.method: \"red_black2\" needs a field of the neighbours alone",
                   "\"rkmk4\""},
        WrongScene{"series", "\"rkmk4\"", "\"series4\"",
                   ":16: integrator.method: \"series4\" differentiates the field", "\"rkmk4\""},
        WrongScene{"analytic", "\"rkmk4\"", "\"euler\"\nisotropy = \"analytic\"",
                   ":17: integrator.isotropy: \"analytic\" does not go with", "\"zero\""},
        WrongScene{"energy", "\"rkmk4\"", "\"rkmk4\"\nisotropy = \"energy\"",
                   ":17: integrator.isotropy: \"energy\" does not go with", "\"zero\""},
        WrongScene{"energy_control", "\"rkmk4\"", "\"rkmk4\"\nenergy_control = true",
                   ":17: integrator.energy_control: does not go with", "no such key"}),
    name_of);

// What a scene to relax refuses, with and without an integrator.
TEST(WrongCrystal, ToRelaxIsRefused) {
  Folder const folder;
  auto const without =
      replaced(crystal_scene, "[integrator]\nmethod = \"rkmk4\"\ndt = 0.01\nsteps = 10\n", "");
  for (auto const& text : {std::string(crystal_scene), without}) {
    EXPECT_NO_THROW(read_scene_to_relax(folder.write(text)));
    auto const refused = [&](std::string const& override) -> std::string {
      try {
        read_scene_to_relax(folder.write(text), {override});
        return "accepted";
      } catch (SceneError const& error) {
        return error.what();
      }
    };
    EXPECT_NE(refused("torque={slonczewski={field_like=1,polarization=[0,0,1]}}")
                  .find(": torque: moves spins for ever, and a state of rest needs an energy that "
                        "falls; accepted: no such table"),
              std::string::npos);
    EXPECT_NE(refused("field.exchange=1").find(": field.exchange: needs one site in a cell"),
              std::string::npos);
  }
}

TEST(WrongCrystal, BodiesHaveNoSites) {
  for (std::string const key :
       {"crystal='bcc'", "cell=[[1,0,0],[0,1,0],[0,0,1]]", "basis=[[0,0,0]]", "moments=1",
        "gyromagnetic=1", "occupied='1'", "frozen='0'"})
    try {
      parse_scene(std::string(body_scene), "body.toml", {"lattice={shape=[5]," + key + "}"});
      ADD_FAILURE() << key << " was accepted";
    } catch (SceneError const& error) {
      EXPECT_NE(std::string(error.what()).find("has no meaning for independent rigid bodies"),
                std::string::npos)
          << error.what();
    }
  EXPECT_THROW(parse_scene(std::string(body_scene), "body.toml",
                           {"torque={slonczewski={field_like=1,polarization=[0,0,1]}}"}),
               SceneError);
}

}  // namespace
}  // namespace cayspin::inline v0_1::io::test
