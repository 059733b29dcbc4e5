// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "wrong_scenes.hpp"

namespace cayspin::inline v0_2::io::test {
namespace {

// Faults that expect_refused() cannot type, such as text that is not TOML, or values of several
// lines.
TEST(WrongScene, ThatIsNoTomlOrHasNoSuchTable) {
  for (auto const& [typed, instead, begins, holds] : std::vector<std::array<std::string_view, 4>>{
           {"damping = 0.05", "damping = = 0.05", ":3: not TOML", "TOML 1.0"},
           {"damping = 0.05", "kind = \"llg\"", ":3: not TOML", "kind"},
           {"kind = \"llg\"", "kind = \"\xff\"", ":2: not TOML", ""},
           {"[system]", "[field.x]", ":1: system: is missing", "[system]"},
           {"[lattice]", "[[lattice]]", ":6: lattice: is an array", "a table"},
           {"every = 100", "\"a\\nb\" = 3", ":31: output.a?b: unknown key", ""},
           {"anisotropy = { constant = 1.0, axis = [0, 0, 2] }",
            "anisotropy = [\n{ constant = 1, axis = [0, 0, 1] },\n{ constant = 1, axis = [0, 0, 0] "
            "}]",
            ":15: field.anisotropy[1].axis", "zero vector"}}) {
    auto const message = refusal_of(replaced(llg_scene, typed, instead));
    EXPECT_TRUE(message.starts_with("scene.toml" + std::string(begins))) << message;
    expect_holds(message, holds);
  }
}

TEST(WrongScene, OfUnknownKeys) {
  expect_refused(llg_scene, R"(
outputs.file = 'slab.h5'; outputs.every = 100; output = | outputs: unknown key
  | did you mean "output"?
lattice.spacing =; lattice.spacng = [1.0, 0.5] | : unknown key
  | did you mean "spacing"?; accepted: shape, spacing, boundary
output.every =; output.colour = 3 | : unknown key; | file, every, scalars_every
)");
}

TEST(WrongScene, OfSystem) {
  expect_refused(llg_scene, R"(
system.kind = | : is missing | "llg", "rigid_body"
system.kind = 'll' | : "ll" is not known | did you mean "llg"?
system.kind = 3 | : 3 is an integer | "llg"
system.damping = | : is missing | >= 0, or values per site
system.damping = -0.05 | : -0.05 is negative | a number >= 0, or values per site
system.damping = nan | : nan is not finite
system.damping = inf | : inf is not finite
system.damping = true | : true is a boolean | a number >= 0
system.damping = 'big' | : expression "big" | a formula in x, y, z, i, j, k
system.precession = 1 | : 1 is an integer | true, false
system.precession =; system.inertia = [1, 2, 3] | : | no meaning
)");
}

TEST(WrongScene, OfLattice) {
  expect_refused(llg_scene, R"(
lattice.shape = | : is missing | [nx]
lattice.shape = 4 | : 4 is an integer | [nx]
lattice.shape = [] | : has 0 entries | [nx]
lattice.shape = [1, 1, 1, 1] | : has 4 entries
lattice.shape = [4, 0] | [1]: 0 is too small | >= 1
lattice.shape = [-4, 3] | [0]: -4 | >= 1
lattice.shape = [4.0, 3] | [0]: 4.0 is a number | a whole number
lattice.shape = [4, 536870912] | [1]: 536870912 is too large
  | accepted: a whole number from 1 to 536870911
lattice.shape = [3000000, 3000000, 3000000] | : | more sites
lattice.spacing = [0, 0.5] | [0]: 0 | > 0
lattice.spacing = -1 | : -1 is not positive | a number > 0
lattice.spacing = [1, 1, 1] | : has 3 entries | one per axis of lattice.shape (2)
lattice.boundary = ['open', 'periodc'] | [1]
  | did you mean "periodic"?; accepted: "open", "periodic"
lattice.boundary = true | : true | "periodic", or a list with one per axis of lattice.shape (2)
lattice.boundary = ['open', true] | [1]: true | ; accepted: "open", "periodic"
lattice.spacing = true | : true is a boolean | or a list with one per axis of lattice.shape (2)
lattice.moments = [1, 2] | : has 2 entries | 1 number >= 0, one for each site of the cell
)");
}

TEST(WrongScene, OfField) {
  expect_refused(llg_scene, R"(
field.exchange = nan | : nan | finite
field.anisotropy = { constant = 1.0, axis = [0, 0, 0] } | .axis: is a zero | three numbers
field.anisotropy = { constant = 1.0, axis = [0, 2] } | .axis: has 2
field.anisotropy = { constant = 1.0 } | .axis: is missing
field.anisotropy = { konstant = 1.0, axis = [0, 0, 2] } | .konstant | did you mean "constant"?
field.anisotropy = [1] | [0]: 1 is an integer | a table
field.applied = [0.05, 0] | : has 2 entries | three
field.applied = [0.05, '0.1*cos(x)', 0] | [1] | accepted: a formula in t
field.applied = [0.05, '0.1*cos(', 0] | [1] | expression "0.1*cos("
field.applied = [0.05, '1/t', 0] | [1] | not finite at t = 0; accepted: a formula that is finite
field.applied = [inf, 0, 0] | [0]: inf is not finite | a finite number
field.applied = [0.05, true, 0] | [1]: true | a string with an expression in t
field.slab_demag = { normal = [0, 0, 0], strength = 2 } | .normal: is a zero vector
field.slab_demag = { strength = 2 } | .normal: is missing
field.slab_demag = { normal = [1, 0, 0], average = 'layer' } | .average: unknown key
  | accepted: normal, strength, where, multirate
field.slab_demag = { normal = [1, 0, 0], where = 'gpu' } | .where: "gpu" | accepted: "host"
field.slab_demag = { normal = [1, 0, 0], multirate = true } | .multirate: | where = "host" beside it
field.slab_demag = { normal = [1, 0, 0], multirate = 'yes' } | .multirate: | true
field.slab_demag =; field.demag = 1 | : 1 is an integer | true, or { strength
field.slab_demag =; field.demag = { image = [1, 0, 0] } | .image: | periodic_images
field.slab_demag =; field.demag = { periodic_images = [1, -1, 0] } | .periodic_images[1]:
  | three numbers of images
field.slab_demag =; field.demag = { periodic_images = [1001, 0, 0] }
  | .periodic_images[0]: 1001 images are too many | 0 to 1000
field.mu0 =; field.demag = true | : | one of the two
field.mu0 = '1.5' | : '1.5' is a string | a finite number
)");
}

TEST(WrongScene, OfInitial) {
  expect_refused(llg_scene, R"(
initial.uniform = | initial: has 0 keys | exactly one of uniform, expression, random, file
initial.random = { seed = 1 } | initial: has 2 keys | exactly one of
initial.uniform = [0, 0, 0] | : is a zero vector
initial.uniform = [0, nan, 1] | [1]: nan | finite number
initial = { expression = ['1', 'x'] } | .expression: has 2 entries | three strings
initial = { expression = [1, 'x', 'y'] } | .expression[0]: 1 is an integer | three strings
initial = { expression = ['1', 't', 'y'] } | .expression[1] | a formula in x, y, z, i, j, k
initial = { random = {} } | .random.seed: is missing | a whole number
initial = { random = { seed = 1.5 } } | .random.seed: 1.5 | a whole number
initial = { random = { seed = -1 } } | .random.seed: -1 is too small | a whole number >= 0
initial = { file = '' } | .file: the file name is empty | HDF5 or OVF file
)");
}

TEST(WrongScene, OfIntegrator) {
  expect_refused(llg_scene, R"(
integrator.method = | : is missing | "euler", "implicit_euler"
integrator.method = 'rk4' | : "rk4" | here it is rkmk4 or projected_rk4; accepted: "euler", "implicit_euler"
integrator.isotropy = 'constant' | : "constant" has no value | { constant = sigma }
integrator.isotropy = { constant = inf } | .constant: inf is not finite
integrator.rotation = 'rodrigues' | : | accepted: "cayley", "exponential"
integrator.generator =; integrator.isotropy =; integrator.method = 'rkmk4_as_printed';
 integrator.rotation = 'exponential' | : | belongs to Cayley coordinates; accepted: "cayley"
integrator.method = 'classical_rk4' | integrator.generator | method "classical_rk4" does not take it
integrator.generator =; integrator.method = 'projected_heun' | integrator.isotropy
  | method "projected_heun" does not take it
integrator.generator =; integrator.isotropy =; integrator.method = 'classical_euler'
  | integrator.rotation | does not take it
integrator.dt = | : is missing | a number > 0
integrator.substeps = 0 | : 0 | a whole number >= 1
integrator.dt = 0 | : 0 is not positive | > 0
integrator.dt = -0.01 | : -0.01 | > 0
integrator.end = | : is missing | exactly one of end, steps
integrator.steps = 3 | integrator.end | exactly one of end, steps
integrator.end = -1 | : -1 is negative
integrator.end = 0.025 | : 0.025 | accepted: dt = 0.0125 or 0.008333333333333333
integrator.end = 0.004 | : 0.004 | accepted: dt = 0.004 or 0.002
integrator.end = 1e-12 | : 1e-12 is less than a step of dt = 0.01
  | accepted: a smaller dt
integrator.end = 1e300 | : | more than 2^53 steps
integrator.end =; integrator.steps = -1 | : -1 | >= 0
integrator.end =; integrator.steps = 3.0 | : 3.0 | a whole number
integrator.end =; integrator.steps = 9223372036854775807
  | : | more than 2^53 steps | nothing is accepted
integrator.end =; integrator.steps = 9007199254740993
  | : | more than 2^53 steps | nothing is accepted
integrator.end =; integrator.steps = 1000000000; integrator.dt = 1e300
  | : the last time is not finite | fewer steps
integrator.energy_guard = 'no' | : | true, false
integrator.until_torque = 0 | : | a number > 0
)");
}

TEST(WrongScene, OfOutput) {
  expect_refused(llg_scene, R"(
output.file = 5 | : 5 is an integer | HDF5 file
output.file = '' | : the file name is empty
output.every = 0 | : 0 is too small | >= 1
output.every = 1.5 | : 1.5 | a whole number of steps
output.every = { time = 0.0123 } | .time: | dt =
output.every = { time = 0 } | .time: is 0 | a time > 0
output.every = { steps = 3 } | .steps: unknown key | time
output.every = {} | .time: is missing | a time > 0
output.every =; output.scalars_every = -3 | : -3 | >= 1
output.every =; output.compression = 10 | : 10 is too large | 0 (none) to 9
output.every =; output.chunk = 0 | : 0 is too small | planes along z
output.every =; output.xdmf = 1 | : 1 | true, false
output.every =; output.sync = 'yes' | : 'yes' is a string | true, false
output.every = 2001-02-03 | : 2001-02-03 is a date or time
)");
}

TEST(WrongScene, OfRigidBodies) {
  expect_refused(body_scene, R"(
system.damping = 0 | : | no meaning for kind = "rigid_body"
system.precession = true | : | no meaning
system.inertia = | : is missing | three principal moments
system.inertia = 1.0 | : 1.0 is a number | symmetric 3x3
system.inertia = [1.0, 0, 3.0] | [1]: 0 | a number > 0
system.inertia = [1.0, 2, -3] | [2]: -3 | a number > 0
system.inertia = [[1, 0.1, 0], [0, 2, 0], [0, 0, 3]] | : | not symmetric
system.inertia = [[1, 2, 0], [2, 1, 0], [0, 0, 3]] | : | not positive definite
system.inertia = [[1, 0, 0], [0, 0, 0], [0, 0, 3]] | : | not positive definite
system.inertia = [[1, 0], [0, 2, 0], [0, 0, 3]] | [0]: has 2 entries | three numbers
system.inertia = { fil = 'i.h5' } | .fil: unknown key | did you mean "file"?
system.inertia = { file = '' } | .file: the file name is empty
lattice.shape = [5, 2] | : has 2 entries | [count]
lattice.spacing = 1 | : | no meaning
lattice.boundary = 'open' | : | no meaning
field = {} | : | no meaning
integrator.until_torque = 1e-6 | : | no torque
)");
}

TEST(SceneFile, ThatCannotBeReadIsNamed) {
  Folder const folder;
  auto const refused = [](std::filesystem::path const& path) {
    return refusal([&] { read_scene(path); });
  };
  std::string const accepted = "; accepted: a readable TOML file";
  auto const none = folder / "none.toml";
  EXPECT_EQ(refused(none),
            none.string() + ": cannot be read: No such file or directory" + accepted);
  EXPECT_EQ(refused(folder / ""), (folder / "").string() + ": is a folder" + accepted);
  EXPECT_EQ(refused("/dev/zero"), "/dev/zero: is larger than 16 MiB" + accepted);
  auto const empty = folder.write("");
  EXPECT_EQ(refused(empty), empty.string() + ":1: system: is missing; accepted: a table [system]");
}

TEST(SceneFile, ErrorFoundLaterPointsAtItsKey) {
  auto const scene = scene_of(llg_scene);
  auto const path = scene.path.string();
  EXPECT_EQ(scene_error(scene, "lattice.shape", "too large").what(),
            path + ":7: lattice.shape: too large");
  EXPECT_EQ(scene_error(scene, "lattice.shape[1]", "too large").what(),
            path + ":7: lattice.shape[1]: too large");
  EXPECT_STREQ(scene_error(scene, "output.scalars_every", "no").what(),
               (path + ":29: output.scalars_every: no").c_str());
  EXPECT_STREQ(scene_error(scene, "nowhere", "no").what(), (path + ":1: nowhere: no").c_str());
}

}  // namespace
}  // namespace cayspin::inline v0_2::io::test
