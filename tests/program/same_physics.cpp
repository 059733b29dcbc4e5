// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Different forms of one scene must give one trajectory.
#include "../scene/hdf5_file.hpp"
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

class SamePhysics : public ProgramTest {
 protected:
  std::vector<double> spins(std::string const& scene, Arguments const& arguments) const {
    run(scene, arguments);
    return read_dataset("out.h5", "/spins").values;
  }
};

// Kernels over few sites run on one thread, so the lattice is large.
TEST_F(SamePhysics, SpacesAndThreadsGiveTheSameBits) {
  for (std::string const precision : {"double", "single"}) {
    auto const large = joined(set("lattice.shape=[50,31,7]"), {"--precision", precision});
    auto const serial = spins(chain_scene(), joined(large, {"--space", another_space}));
    for (std::string const threads : {"1", "2", "3"})
      EXPECT_EQ(spins(chain_scene(), joined(large, {"--threads", threads})), serial);
  }
}

TEST_F(SamePhysics, SingleFollowsDouble) {
  auto const both =
      distance(spins(chain_scene(), {}), spins(chain_scene(), {"--precision", "single"}));
  EXPECT_LT(both, 1e-5);
  EXPECT_GT(both, 1e-8);
}

TEST_F(SamePhysics, HostDemagIsTheDeviceOne) {
  for (std::string const axis : {"[1,0,0]", "[0,1,0]", "[0,0,1]"}) {
    auto const demag = "field.slab_demag={normal=" + axis;
    EXPECT_LT(distance(spins(chain_scene(), set(demag + "}")),
                       spins(chain_scene(), set(demag + ",where='host'}"))),
              1e-13)
        << demag;
  }
}

TEST_F(SamePhysics, ExpressionInTimeThatIsConstantIsTheConstant) {
  auto const expression = "field.applied=['0.3+0*t','-0.2','0.1']";
  EXPECT_EQ(spins(chain_scene(), set(expression)), spins(chain_scene(), {}));
}

TEST_F(SamePhysics, Mu0MultipliesAppliedAndDemag) {
  auto const scaled = spins(chain_scene(), set("field.mu0=2.0"));
  auto const spelled = spins(chain_scene(), set("field.applied=[0.6,-0.4,0.2]",
                                                "field.slab_demag={normal=[1,0,0],strength=2.0}"));
  EXPECT_LT(distance(scaled, spelled), 1e-14);
}

TEST_F(SamePhysics, StartFromFileGoesOn) {
  auto const whole = spins(chain_scene(), set("integrator.steps=20"));
  run(chain_scene(), set("integrator.steps=10"));
  std::filesystem::rename(in_folder("out.h5"), in_folder("half.h5"));
  auto const second = spins(chain_scene(), set("integrator.steps=10", "initial={file='half.h5'}"));
  std::vector<double> const end(whole.end() - 180, whole.end());
  EXPECT_LT(distance({second.end() - 180, second.end()}, end), 1e-14);
}

// The exact solution without damping: m turns about H by the angle |H| * t, right-handed.
TEST_F(SamePhysics, PrecessionIsRightHanded) {
  auto const m = spins(macrospin_scene(), set("system.damping=0", "initial.uniform=[1,0,0]",
                                              "integrator={method='rkmk4',dt=0.01,end=1.0}"));
  EXPECT_NEAR(m[3], std::cos(1.0), 1e-9);
  EXPECT_NEAR(m[4], std::sin(1.0), 1e-9);
}

TEST_F(SamePhysics, InertiaFromFileIsTheInertia) {
  std::vector<double> tensors;
  for (int body = 0; body < 5; ++body)
    tensors.insert(tensors.end(), {1, 0, 0, 0, 2, 0, 0, 0, body == 4 ? 2.5 : 3.0});
  io::test::write_dataset(in_folder("inertia.h5"), "/inertia", {5, 3, 3}, tensors);
  auto const one = spins(bodies_scene(), {});
  auto const each = spins(bodies_scene(), set("system.inertia={file='inertia.h5'}"));
  ASSERT_EQ(each.size(), 30u);
  EXPECT_LT(distance({one.begin(), one.end() - 3}, {each.begin(), each.end() - 3}), 1e-15);
  EXPECT_GT(distance({one.end() - 3, one.end()}, {each.end() - 3, each.end()}), 1e-3);
  auto const info = info_of("out.h5");
  EXPECT_NEAR(info.frame_scalars[0].energy, info.frame_scalars[1].energy, 1e-6);
}

}  // namespace
}  // namespace cayspin::program::test
