// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Methods that divide by the length of a spin, in scenes with vacant sites. Runs are compared with
// those on a lattice of the remaining shape or, if one site of the cell has no spin, with those of
// a cell without that site.
#include "random_run.hpp"
#include "scenes_of_text.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace cayspin::simulation::test {
namespace {

constexpr std::int64_t steps_of_runs = 10;

bool divides_by_length(Variant const& variant) {
  auto const& method = *variant.method;
  return method.stiff || variant.in_chart || (method.is_baseline() && method.keeps_length);
}

/// `lattice` has the keys of [lattice].
io::Scene scene_with(Variant const& variant, std::string const& lattice, std::string const& field,
                     Precision precision) {
  MethodChoice choice{.method = variant.method};
  choice.compensated = variant.compensated;
  if (variant.in_chart) choice.generator = io::Generator::tangent;
  auto keys = choice.keys();
  for (auto& c : keys)
    if (c == ',') c = '\n';
  // Without damping, stiff methods solve their equation to round-off.
  return scene_of(fmt::format(
      "[system]\nkind = 'llg'\ndamping = {}\n[lattice]\n{}\n[field]\n{}\n[initial]\n"
      "expression = ['cos(0.7*i + 1.1*j)', 'sin(0.9*j - 0.4*i)', '0.4 + 0.3*k']\n"
      "[integrator]\n{}\ndt = 0.03\nsteps = {}\n{}",
      variant.method->stiff ? "0.0" : "0.1", lattice, field, keys, steps_of_runs,
      variant.method->adaptive
          ? (precision == Precision::double_precision ? "tolerance = 1e-6" : "tolerance = 1e-4")
          : ""));
}

TEST(Vacancies, LeaveTheMotionOfTheShapeAlone) {
  static constexpr char const* fields[] = {
      "exchange = 2.0\nanisotropy = { constant = 0.7, axis = [1, 2, 3] }\n"
      "applied = [0.3, -0.2, 0.5]\ndmi = { interfacial = 0.3, normal = [0, 0, 1] }\n"
      "slab_demag = { normal = [0, 0, 1], strength = 0.5 }",
      "couplings = [{ offset = [1, 0, 0], J = 1.3 }, { offset = [0, 1, 0], J = 0.8, "
      "D = [0, 0, 0.2] }, { offset = [0, 0, 1], J = 0.6 }, { offset = [1, 1, 0], J = 0.2 }]\n"
      "applied = [0.3, -0.2, 0.5]"};
  std::int64_t compared = 0;
  for (auto const& variant : variants()) {
    if (!divides_by_length(variant) || variant.isotropy != io::Isotropy::zero) continue;
    for (auto const precision : precisions)
      for (auto const* const field : fields) {
        SCOPED_TRACE(fmt::format("{}{}, {} precision\n{}", variant.method->word,
                                 variant.in_chart ? " in the chart" : "", to_string(precision),
                                 field));
        auto const spins_of_shape = [&](std::string const& lattice) {
          return end_of(scene_with(variant, lattice, field, precision), precision);
        };
        auto const alone = spins_of_shape("shape = [9, 6, 2]");
        auto const in_box =
            spins_of_shape("shape = [13, 8, 4]\noccupied = 'i < 9 && j < 6 && k < 2'");
        std::vector<double> within;
        for (std::int64_t site = 0; site < 13 * 8 * 4; ++site) {
          bool const holds = site % 13 < 9 && site / 13 % 8 < 6 && site / 104 < 2;
          for (std::int64_t c = 0; c < 3; ++c) {
            double const number = in_box[static_cast<std::size_t>(3 * site + c)];
            if (holds)
              within.push_back(number);
            else
              EXPECT_EQ(number, 0) << "site " << site;
          }
        }
        bool const by_tolerance = variant.method->adaptive;
        double const wanted = precision == Precision::double_precision ? 1e-6 : 1e-4;
        EXPECT_LT(largest_distance(within, alone),
                  by_tolerance ? wanted : 64 * steps_of_runs * epsilon(precision));
        ++compared;
      }
  }
  std::printf("    %lld scenes\n", static_cast<long long>(compared));
  EXPECT_GT(compared, 40);
}

/// Returns a film with moments of 10. Its noise is `hundredths` / 100 of the largest that a step
/// may have.
io::Scene film_of_moments(std::string const& lattice, std::string const& couplings,
                          int hundredths) {
  constexpr double damping = 0.5, dt = 0.02;
  return llg_scene(
      fmt::to_string(damping), "heun", steps_of_runs,
      fmt::format("[lattice]\nshape = [9, 6]\n{}\n[field]\ncouplings = [{}]\n"
                  "applied = [0.3, -0.2, 0.5]\nanisotropy = {{ constant = 3, axis = [1, 2, 3] }}\n"
                  "[thermal]\ntemperature = {}\nseed = 5\n"
                  "[initial]\nexpression = ['cos(0.7*i)', 'sin(0.9*j)', '0.4']\n",
                  lattice, couplings, 0.01 * hundredths * 10 / (damping * dt)));
}

// The constants of an empty site do not reduce the largest dt.
TEST(Vacancies, AMomentOfZeroIsNoSite) {
  std::string const bond = "{ offset = [1, 0, 0], J = 4, D = [0, 0, 1] }";
  auto const film = [&](int hundredths) {
    return film_of_moments("moments = [10]\ngyromagnetic = [1]", bond, hundredths);
  };
  auto const with_site = [&](int hundredths) {
    return film_of_moments(
        "basis = [[0, 0, 0], [0.5, 0.5, 0]]\nmoments = [10, 0]\ngyromagnetic = [1, 100]",
        bond + ", { between = [0, 1], J = 80 }, { between = [1, 1], offset = [0, 1, 0], J = 90 }",
        hundredths);
  };
  for (int const hundredths : {0, 1, 30, 99}) {
    auto const alone = make_plan(film(hundredths), Precision::double_precision),
               plan = make_plan(with_site(hundredths), Precision::double_precision);
    EXPECT_EQ(plan.stable_dt, alone.stable_dt);
    EXPECT_EQ(plan.turn, alone.turn);
    EXPECT_EQ(plan.noise_turn, alone.noise_turn);
    for (auto const precision : precisions) {
      SCOPED_TRACE(
          fmt::format("{} % of the most noise, {} precision", hundredths, to_string(precision)));
      auto const expected = end_of(film(hundredths), precision);
      auto const found = end_of(with_site(hundredths), precision);
      auto const spins = static_cast<std::ptrdiff_t>(expected.size());
      EXPECT_LT(largest_distance({found.begin(), found.begin() + spins}, expected),
                64 * steps_of_runs * epsilon(precision));
      for (auto number = found.begin() + spins; number != found.end(); ++number)
        EXPECT_EQ(*number, 0);
    }
  }
  constexpr char const* too_much = "integrator.dt: damping times temperature times dt";
  expect_refused([&] { return film(101); }, too_much);
  expect_refused([&] { return with_site(101); }, too_much);
}

}  // namespace
}  // namespace cayspin::simulation::test
