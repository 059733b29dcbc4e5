// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random scenes with many terms, vacancies, frozen sites and crystals. Compares the derivative of
// the energy, the torque and the lowest curvature with finite differences and a dense Hessian.
#include "../support/larger.hpp"
#include "io/scene.hpp"
#include "scenes_of_text.hpp"
#include "simulation/ranks.hpp"
#include "simulation/scene_field.hpp"
#include "simulation/scene_minimizer.hpp"

#include <cayspin/evaluate.hpp>
#include <cayspin/scalars.hpp>

#include <Eigen/Eigenvalues>

#include <array>
#include <cstdlib>
#include <random>
#include <set>

namespace cayspin::simulation::test {
namespace {

using Space = Kokkos::DefaultHostExecutionSpace;

constexpr auto head =
    "system = { kind = 'llg', damping = 0.1 }\n"
    "integrator = { method = 'rkmk4', dt = 0.1, steps = 0 }\n";

class RandomText {
 public:
  explicit RandomText(unsigned seed) : engine_(seed) {
    bool const is_crystal = chance(0.3);
    lattice(is_crystal);
    terms(is_crystal);
    text = fmt::format("{}[lattice]\n{}[field]\n{}[initial]\nrandom = {{ seed = {} }}\n", head,
                       lattice_, field_, seed);
  }
  std::string text;

 private:
  double uniform(double least, double most) { return least + (most - least) * engine_() * 0x1p-32; }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  int whole(int least, int most) {
    return least + static_cast<int>(engine_() % static_cast<unsigned>(most - least + 1));
  }
  std::string vector(double size = 1) {
    return fmt::format("[{:.6f}, {:.6f}, {:.6f}]", uniform(-size, size), uniform(-size, size),
                       uniform(-size, size));
  }
  std::string of_sites(double least, double most) {
    if (chance(0.7)) return fmt::format("{:.6f}", uniform(least, most));
    return fmt::format("'{:.6f} + {:.6f}*random(i+7*j+49*k{}, {})'", least, most - least, of_site_,
                       whole(0, 999));
  }

  void lattice(bool is_crystal) {
    if (is_crystal) {
      char const* const crystals[] = {"bcc", "hcp", "honeycomb", "kagome"};
      int const kind = whole(0, 3);
      of_site_ = "+343*s";
      set_shape(whole(1, 3), whole(1, 3), kind < 2 ? whole(1, 2) : 1);
      lattice_ += fmt::format("crystal = '{}'\n", crystals[kind]);
      sites_ = kind == 3 ? 3 : 2;
      if (chance(0.5)) {
        std::string moments;
        for (int i = 0; i < sites_; ++i) moments += fmt::format("{:.4f}, ", uniform(0.5, 2));
        lattice_ += "moments = [" + moments + "]\n";
      }
    } else {
      set_shape(whole(1, 6), whole(1, 4), whole(1, 2));
      if (chance(0.2)) lattice_ += fmt::format("moments = [{:.4f}]\n", uniform(0.5, 2));
    }
    bool const is_open = chance(0.4);
    auto const boundary = [&] { return is_open || chance(0.5) ? "'open'" : "'periodic'"; };
    is_open_ = is_open;
    lattice_ += fmt::format("boundary = [{}, {}, {}]\n", boundary(), boundary(), boundary());
    auto const some = [&](char const* key, double share) {
      lattice_ += fmt::format("{} = 'random(i+7*j+49*k{}, {}) < {} ? 1 : 0'\n", key, of_site_,
                              whole(0, 999), share);
    };
    if (chance(0.6)) some("occupied", uniform(0.4, 0.95));
    if (chance(0.3)) some("frozen", 0.2);
  }

  void set_shape(int nx, int ny, int nz) {
    lattice_ += fmt::format("shape = [{}, {}, {}]\n", nx, ny, nz);
    extents_ = {nx, ny};
  }

  void terms(bool is_crystal) {
    double const strength = std::pow(10, uniform(-1, 1));
    if (!is_crystal) {
      if (chance(0.7)) field_ += "exchange = " + of_sites(0.5 * strength, strength) + "\n";
      if (chance(0.5))
        field_ += chance(0.5) ? fmt::format("dmi = {{ interfacial = {}, normal = {} }}\n",
                                            of_sites(0, 0.7 * strength), vector())
                              : "dmi = { bulk = " + of_sites(0, 0.7 * strength) + " }\n";
      if (is_open_ && chance(0.3)) field_ += "demag = true\n";
    } else if (chance(0.4)) {
      field_ += fmt::format("dipoles = {{ strength = {:.4f} }}\n", strength);
    }
    if (chance(0.4) && field_.find("demag") == std::string::npos &&
        field_.find("dipoles") == std::string::npos)
      field_ += fmt::format("slab_demag = {{ normal = [0, 0, 1], strength = {:.4f}{} }}\n",
                            uniform(0, 1), !is_crystal && chance(0.3) ? ", where = 'host'" : "");
    std::string axes;
    if (chance(0.7))
      axes += fmt::format("{{ constant = {}, axis = {} }}, ", of_sites(-1, 1), vector());
    if (chance(0.4))
      axes += fmt::format("{{ cubic = {:.4f}, axes = [[1, 2, 0], [0, 0, 1]] }}, ", uniform(-1, 1));
    if (!axes.empty()) field_ += "anisotropy = [" + axes + "]\n";
    if (chance(0.5)) couplings(strength);
    if (chance(0.8)) field_ += "applied = " + vector(chance(0.5) ? 0.1 : 2) + "\n";
  }

  void couplings(double strength) {
    std::string list;
    std::set<std::array<int, 4>> bonds;
    for (int i = whole(1, 3); i > 0; --i) {
      // Scenes refuse couplings that leave the lattice from every cell, couplings of a site with
      // itself, and duplicates.
      int const x = extents_[0] > 1 ? 1 : 0, y = extents_[1] > 1 ? i - 2 : 0;
      int const from = whole(0, sites_ - 1), to = whole(0, sites_ - 1);
      if (x == 0 && y == 0 && from == to) continue;
      bool const is_reversed = x == 0 && (y < 0 || (y == 0 && from > to));
      bool const is_new = is_reversed ? bonds.insert({to, from, x, -y}).second
                                      : bonds.insert({from, to, x, y}).second;
      if (!is_new) continue;
      list += fmt::format("{{ between = [{}, {}], offset = [{}, {}, 0]", from, to, x, y);
      switch (whole(0, 2)) {
        case 0:
          list += fmt::format(", J = {:.4f}, D = {}", uniform(-strength, strength),
                              vector(0.5 * strength));
          break;
        case 1:
          list += fmt::format(", tensor = [{}, {}, {}]", vector(strength), vector(strength),
                              vector(strength));
          break;
        default:
          list += fmt::format(", J = {:.4f}, biquadratic = {:.4f}", uniform(-strength, strength),
                              uniform(-strength, strength));
      }
      list += " }, ";
    }
    if (!list.empty()) field_ += "couplings = [" + list + "]\n";
  }

  std::mt19937 engine_;
  std::string lattice_, field_, of_site_;
  std::array<int, 2> extents_{};
  int sites_ = 1;
  bool is_open_ = true;
};

/// Fixture that initialises Kokkos, by opening a run.
class Equilibria : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    end_of(scene_of(std::string(head) +
                    "lattice = { shape = [1] }\ninitial = { uniform = [0, 0, 1] }\n"));
  }
};

/// A scene in double precision, at given spins.
class Reference {
  using Spins = SpinField<double, Space::memory_space>;

 public:
  Reference(io::Scene const& scene, Lattice const& lattice, std::vector<double> m)
      : field_(field_of<Spins>(scene, lattice, false).made_for(FieldFor::energy)),
        spins_("spins", lattice),
        result_("field", lattice),
        m_(std::move(m)),
        h_(field_at(m_)) {
    auto const frozen = io::frozen(scene, own_sites(lattice));
    for (Eigen::Index site = 0; site < lattice.sites(); ++site)
      if (vector(m_, site).norm() > 0.5 &&
          (frozen.empty() || !frozen[static_cast<std::size_t>(site)]))
        mobile_.push_back(site);
  }

  std::size_t mobile() const { return mobile_.size(); }
  double torque() const {
    double largest = 0;
    for (auto const site : mobile_)
      largest = cayspin::test::larger(largest, vector(m_, site).cross(vector(h_, site)).norm());
    return largest;
  }
  double largest_field() const {
    double largest = 1e-6;
    for (double const h : h_) largest = cayspin::test::larger(largest, std::abs(h));
    return largest;
  }

  /// Returns the error of H: the derivative of the energy along a random turn of all mobile spins,
  /// by finite differences, minus the derivative that follows from H.
  double error_of_derivative(unsigned seed) const {
    std::mt19937 engine(seed);
    auto v = std::vector<double>(m_.size());
    double expected = 0;
    for (auto const site : mobile_) {
      Eigen::Vector3d const any(engine() * 0x1p-31 - 1, engine() * 0x1p-31 - 1,
                                engine() * 0x1p-31 - 1);
      Eigen::Vector3d const m = vector(m_, site), t = any - any.dot(m) * m;
      for (int c = 0; c < 3; ++c) v[static_cast<std::size_t>(3 * site + c)] = t[c];
      expected -= t.dot(vector(h_, site));
    }
    auto const energy_at = [&](double s) {
      copy_from_host(added(m_, s, v), spins_);
      return energy(exec_, field_, spins_).value;
    };
    double const h = 1e-2;
    return (8 * (energy_at(h) - energy_at(-h)) - (energy_at(2 * h) - energy_at(-2 * h))) /
               (12 * h) -
           expected;
  }

  /// Returns the eigenvalues of the dense Hessian on the tangent planes of the mobile spins, least
  /// first.
  Eigen::VectorXd curvatures() const {
    auto const count = static_cast<Eigen::Index>(2 * mobile_.size());
    Eigen::MatrixXd hessian(count, count);
    double const h = 0.02;
    for (Eigen::Index i = 0; i < count; ++i) {
      std::vector<double> v(m_.size());
      Eigen::Vector3d const t = tangent(i);
      for (int c = 0; c < 3; ++c)
        v[static_cast<std::size_t>(3 * mobile_[static_cast<std::size_t>(i / 2)] + c)] = t[c];
      auto const a = field_at(added(m_, h, v)), b = field_at(added(m_, -h, v)),
                 c = field_at(added(m_, 2 * h, v)), d = field_at(added(m_, -2 * h, v));
      for (Eigen::Index j = 0; j < count; ++j) {
        auto const site = mobile_[static_cast<std::size_t>(j / 2)];
        Eigen::Vector3d const near = vector(a, site) - vector(b, site),
                              far = vector(c, site) - vector(d, site);
        hessian(j, i) = -tangent(j).dot(8 * near - far) / (12 * h);
      }
      auto const site = mobile_[static_cast<std::size_t>(i / 2)];
      hessian(i, i) += vector(m_, site).dot(vector(h_, site));
    }
    Eigen::MatrixXd const symmetric = 0.5 * (hessian + hessian.transpose());
    EXPECT_LT((hessian - symmetric).cwiseAbs().maxCoeff(), 1e-9 * largest_field() + 1e-12);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
        .eigenvalues();
  }

 private:
  static Eigen::Vector3d vector(std::vector<double> const& numbers, Eigen::Index site) {
    return Eigen::Map<Eigen::Vector3d const>(numbers.data() + 3 * site);
  }
  static std::vector<double> added(std::vector<double> m, double s, std::vector<double> const& v) {
    for (std::size_t i = 0; i < m.size(); ++i) m[i] += s * v[i];
    return m;
  }
  std::vector<double> field_at(std::vector<double> const& m) const {
    copy_from_host(m, spins_);
    evaluate_field(exec_, field_, spins_, 0, result_);
    auto const numbers = copy_to_host(result_);
    return {numbers.begin(), numbers.end()};
  }
  Eigen::Vector3d tangent(Eigen::Index i) const {
    Eigen::Vector3d const m = vector(m_, mobile_[static_cast<std::size_t>(i / 2)]);
    Eigen::Vector3d const other =
        std::abs(m.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    Eigen::Vector3d const first = m.cross(other).normalized();
    return i % 2 == 0 ? first : Eigen::Vector3d(m.cross(first));
  }

  Space exec_;
  SceneField<Spins> field_;
  Spins spins_, result_;
  std::vector<double> m_, h_;
  std::vector<Eigen::Index> mobile_;
};

/// Returns false if no spin moves or feels a field, so that there is nothing to compare.
template <class Real>
bool expect_right_equilibria(unsigned seed) {
  constexpr bool is_double = sizeof(Real) == sizeof(double);
  using Spins = SpinField<Real, Space::memory_space>;
  RandomText const random(seed);
  SCOPED_TRACE(fmt::format("seed {}, {} bytes\n{}", seed, sizeof(Real), random.text));
  auto const scene = scene_of(random.text);
  auto const lattice = make_plan_to_relax(scene, is_double ? Precision::double_precision
                                                           : Precision::single_precision)
                           .lattice;
  Spins spins("spins", lattice);
  copy_from_host(io::initial_spins(scene), spins);
  auto const numbers = [&] {
    auto const all = copy_to_host(spins);
    return std::vector<double>(all.begin(), all.end());
  };
  auto const field = field_of<Spins>(scene, lattice, false).made_for(FieldFor::energy);
  SceneMinimizer<Real, Space> minimizer(spins);

  // The first search below accepts any torque, so it ends at the start.
  Reference const start(scene, lattice, numbers());
  if (start.mobile() == 0) return false;
  auto const eigenvalues = start.curvatures();
  double const largest = eigenvalues.cwiseAbs().maxCoeff();
  if (largest == 0) return false;
  auto const before = numbers();
  // Derivatives of fields that are not affine have an accuracy of epsilon^(2/3).
  constexpr double part = is_double ? 1e-6 : 2e-3;
  double const allowed = part * (largest + 1e-3);
  auto const at_start =
      minimizer.minimize(Space(), scene, field, spins, {.torque = 1e9, .lowest_curvature = true});
  EXPECT_EQ(numbers(), before);
  EXPECT_NEAR(at_start.torque, start.torque(),
              64 * epsilon(is_double ? Precision::double_precision : Precision::single_precision) *
                  (start.largest_field() + largest));
  EXPECT_NEAR(at_start.curvature, eigenvalues[0], allowed);
  EXPECT_LT(std::abs(start.error_of_derivative(seed)),
            1e-6 * start.largest_field() * static_cast<double>(start.mobile()));

  double const torque = (is_double ? 1e-8 : 1e-3) * (largest + start.largest_field());
  auto const found = minimizer.minimize(Space(), scene, field, spins,
                                        {.torque = torque, .lowest_curvature = true});
  EXPECT_EQ(to_string(found.end), "converged");
  if (found.end != MinimizeEnd::converged) return true;
  Reference const end(scene, lattice, numbers());
  auto const curvatures = end.curvatures();
  double const most = curvatures.cwiseAbs().maxCoeff() + end.largest_field();
  EXPECT_GT(curvatures[0], -2 * torque - 1e-6 * most);
  EXPECT_NEAR(found.curvature, curvatures[0], part * most);
  return true;
}

TEST_F(Equilibria, HaveTheCurvatureOfADenseHessian) {
  char const* const wanted = std::getenv("CAYSPIN_EQUILIBRIA");
  auto const scenes = static_cast<unsigned>(wanted ? std::atoi(wanted) : 60);
  unsigned compared = 0;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    if (expect_right_equilibria<double>(seed)) ++compared;
    if (expect_right_equilibria<float>(seed)) ++compared;
  }
  EXPECT_GT(compared, scenes);  // of twice as many
}

struct Small {
  char const* name;
  std::string text;
  double energy;
};

// Vacant sites have no curvature and no field, whatever vector they have.
TEST_F(Equilibria, WithVacanciesAreFound) {
  std::string const pair =
      "lattice = { shape = [3], occupied = 'i > 0' }\n"
      "[field]\ncouplings = [{ offset = [1, 0, 0], J = 1.0 }]\napplied = [0, 0, 1]\n"
      "[initial]\nuniform = [0, 0, 1]\n";
  std::string const saddle =
      "lattice = { shape = [3], occupied = 'i > 0' }\n"
      "[field]\ncouplings = [{ offset = [1, 0, 0], J = 1.0 }]\n"
      "anisotropy = { constant = 0.1, axis = [0, 0, 1] }\n[initial]\nuniform = [1, 0, 0]\n";
  std::string const chain =
      "lattice = { shape = [4], occupied = 'i < 2 ? 1 : 0' }\n"
      "[field]\nanisotropy = { constant = 1.0, axis = [0, 0, 1] }\n"
      "[initial]\nuniform = [0, 0, 1]\n";
  for (auto const& [name, text, energy] :
       {Small{"pair", pair, -3}, {"saddle", saddle, -1.1}, {"chain", chain, -1}}) {
    SCOPED_TRACE(name);
    using Spins = SpinField<double, Space::memory_space>;
    auto const scene = scene_of(head + text);
    auto const lattice = make_plan_to_relax(scene, Precision::double_precision).lattice;
    Spins spins("spins", lattice);
    copy_from_host(io::initial_spins(scene), spins);
    SceneMinimizer<double, Space> minimizer(spins);
    auto const found = minimizer.minimize(
        Space(), scene, field_of<Spins>(scene, lattice, false).made_for(FieldFor::energy), spins,
        {});
    EXPECT_EQ(to_string(found.end), "converged");
    EXPECT_NEAR(found.energy.value, energy, 1e-10);
    EXPECT_GT(found.curvature, 0.05);
    auto const numbers = copy_to_host(spins);
    EXPECT_EQ(std::abs(numbers[0]) + std::abs(numbers[1]) + std::abs(numbers[2]),
              name == std::string("chain") ? 1 : 0);
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
