// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Scenes composed at random, terms x shapes x numbers of sites x methods x precisions, beside the
// library's own composed field. CAYSPIN_COMPOSITIONS: how many.
#include "io/method.hpp"
#include "scenes_of_text.hpp"

#include <cayspin/cayspin.hpp>

#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation::test {
namespace {

using Space = Kokkos::DefaultHostExecutionSpace;
using Memory = Space::memory_space;

/// The numbers of a scene; those of terms that it has not are 0.
struct Numbers {
  Lattice lattice;
  double exchange = 0, interfacial = 0, bulk = 0, cubic = 0, moment = 1, gyromagnetic = 1;
  double constant[2] = {}, damping_like = 0, field_like = 0, nonadiabaticity = 0, damping = 0;
  Vec3<double> axis[2] = {{0, 0, 1}, {0, 0, 1}}, axis_of_sites{0, 0, 1}, applied{0, 0, 0},
               velocity{0, 0, 0};
  std::vector<double> exchange_of_sites, constant_of_sites, occupied, frozen, damping_of_sites;
  std::vector<Coupling> couplings;
  double scale = 0;  // a bound on |H|
};

class Composition {
 public:
  explicit Composition(unsigned seed) : engine_(seed) {
    choose_lattice(seed);
    choose_bonds();
    choose_axes();
    choose_rest();
    text = fmt::format("{}[lattice]\n{}[field]\n{}{}[initial]\nrandom = {{ seed = {} }}\n", system_,
                       lattice_, field_, torques_, seed);
  }

  Numbers numbers;
  std::string text;  // all but [integrator]

  bool chance(double probability) { return uniform(0, 1) < probability; }
  template <class List>
  auto const& one_of(List const& list) {
    return list[engine_() % std::size(list)];
  }

 private:
  double uniform(double least, double most) { return least + (most - least) * engine_() * 0x1p-32; }
  /// With four digits, as they are typed.
  double number(double least, double most) { return std::round(1e4 * uniform(least, most)) / 1e4; }
  Vec3<double> vector(double size) {
    return {number(-size, size), number(-size, size), number(0.1 * size, size)};
  }
  static std::string text_of(Vec3<double> const& v) {
    return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", v.x, v.y, v.z);
  }
  /// `a` + `b` i of each site, and its text.
  std::vector<double> of_sites(double a, double b) const {
    std::vector<double> values(static_cast<std::size_t>(numbers.lattice.sites()));
    for (std::size_t site = 0; site < values.size(); ++site)
      values[site] =
          a + b * static_cast<double>(static_cast<std::int64_t>(site) % numbers.lattice.shape[0]);
    return values;
  }
  static std::string text_of(double a, double b) {
    return fmt::format("'{:.4f} + {:.4f}*i'", a, b);
  }

  void choose_lattice(unsigned seed) {
    static constexpr std::int64_t extents[] = {1, 2, 3, 5, 8, 16, 19};
    auto& shape = numbers.lattice.shape;
    shape = {one_of(extents), one_of(extents), one_of(extents)};
    if (chance(0.1)) shape = {one_of(std::to_array<std::int64_t>({256, 271, 600})), 3, 2};
    if (seed % 97 == 5) shape = {70, 50, 30};  // beyond the caches of cores: stages in sweeps
    if (shape[0] * shape[1] * shape[2] == 1) shape[0] = 7;
    auto const open = [&] { return chance(0.5); };
    for (auto& boundary : numbers.lattice.boundary)
      boundary = open() ? Boundary::open : Boundary::periodic;
    for (auto& spacing : numbers.lattice.spacing) spacing = chance(0.3) ? number(0.7, 1.3) : 1;
    auto const word = [&](std::size_t axis) {
      return numbers.lattice.boundary[axis] == Boundary::open ? "open" : "periodic";
    };
    lattice_ = fmt::format(
        "shape = [{}, {}, {}]\nspacing = [{}, {}, {}]\nboundary = ['{}', '{}', '{}']\n", shape[0],
        shape[1], shape[2], numbers.lattice.spacing[0], numbers.lattice.spacing[1],
        numbers.lattice.spacing[2], word(0), word(1), word(2));
    if (chance(0.3)) {
      numbers.moment = number(0.5, 2);
      numbers.gyromagnetic = number(0.5, 2);
      lattice_ += fmt::format("moments = [{}]\ngyromagnetic = [{}]\n", numbers.moment,
                              numbers.gyromagnetic);
    }
    if (chance(0.35)) {
      auto const at = number(0.1, 0.9);
      lattice_ += fmt::format("occupied = 'random(i+{0}*j+{1}*k, 3) > {2:.4f} || i == 0'\n",
                              shape[0], shape[0] * shape[1], at);
    }
    if (chance(0.2)) lattice_ += "frozen = 'j == 0'\n";
  }

  void choose_bonds() {
    double square = 0, first = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (numbers.lattice.shape[axis] == 1) continue;
      square += 4 / (numbers.lattice.spacing[axis] * numbers.lattice.spacing[axis]);
      first += 2 / numbers.lattice.spacing[axis];
    }
    if (double const A = number(0.2, 1.5); chance(0.2)) {
      double const slope = number(0, 0.05);
      numbers.exchange_of_sites = of_sites(A, slope);
      numbers.scale += square * (A + 600 * slope);
      field_ += "exchange = " + text_of(A, slope) + "\n";
    } else if (chance(0.8)) {
      numbers.exchange = A;
      numbers.scale += square * A;
      field_ += fmt::format("exchange = {:.4f}\n", A);
    }
    double const D = number(-0.5, 0.5);
    if (chance(0.25)) {
      numbers.bulk = D;
      field_ += fmt::format("dmi = {{ bulk = {:.4f} }}\n", D);
    } else if (chance(0.3)) {
      numbers.interfacial = D;
      field_ += fmt::format("dmi = {{ interfacial = {:.4f}, normal = [0, 0, 1] }}\n", D);
    }
    numbers.scale += first * std::abs(D);
    if (chance(0.2)) {
      double const J = number(-0.5, 0.5), B = chance(0.3) ? number(-0.2, 0.2) : 0;
      std::array<double, 3> const D_of_pair{0, 0, number(-0.3, 0.3)};
      std::array<int, 3> offset{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (numbers.lattice.shape[axis] > 3) offset[axis] = static_cast<int>(engine_() % 3) - 1;
      if (offset == std::array{0, 0, 0}) return;
      numbers.couplings.push_back(Coupling::of({0, 0}, offset, J, D_of_pair));
      numbers.couplings[0].biquadratic = B;
      numbers.scale += 2 * (std::abs(J) + 2 * std::abs(B) + std::abs(D_of_pair[2]));
      field_ += fmt::format(
          "couplings = [{{ offset = [{}, {}, {}], J = {:.4f}, D = [0, 0, {:.4f}], biquadratic = "
          "{:.4f} }}]\n",
          offset[0], offset[1], offset[2], J, D_of_pair[2], B);
    }
  }

  void choose_axes() {
    std::string axes;
    for (int i = 0; i < 2; ++i) {
      if (!chance(0.4)) continue;
      numbers.constant[i] = number(-1, 1);
      numbers.axis[i] = chance(0.5) ? Vec3<double>{0, 0, 1} : vector(1);
      numbers.scale += std::abs(numbers.constant[i]);
      axes += fmt::format("{{ constant = {:.4f}, axis = {} }}, ", numbers.constant[i],
                          text_of(numbers.axis[i]));
    }
    if (chance(0.3)) {
      double const K = number(-1, 1), slope = number(-0.02, 0.02);
      numbers.constant_of_sites = of_sites(K, slope);
      numbers.axis_of_sites = vector(1);
      numbers.scale += std::abs(K) + 600 * std::abs(slope);
      axes += fmt::format("{{ constant = {}, axis = {} }}, ", text_of(K, slope),
                          text_of(numbers.axis_of_sites));
    }
    if (chance(0.3)) {
      numbers.cubic = number(-1, 1);
      numbers.scale += 2 * std::abs(numbers.cubic);
      axes += fmt::format("{{ cubic = {:.4f}, axes = [[1, 0, 0], [0, 1, 0]] }}, ", numbers.cubic);
    }
    if (!axes.empty()) field_ += "anisotropy = [" + axes + "]\n";
    if (chance(0.6)) {
      numbers.applied = vector(0.5);
      field_ += "applied = " + text_of(numbers.applied) + "\n";
    }
    numbers.scale = (numbers.scale / numbers.moment + 1) * numbers.gyromagnetic;
  }

  void choose_rest() {
    if (chance(0.15)) {
      numbers.velocity = vector(0.5);
      numbers.nonadiabaticity = number(0, 0.2);
      numbers.scale += 3;
      torques_ += fmt::format("[torque.zhang_li]\nvelocity = {}\nnonadiabaticity = {:.4f}\n",
                              text_of(numbers.velocity), numbers.nonadiabaticity);
    }
    if (chance(0.15)) {
      numbers.damping_like = number(-0.4, 0.4);
      numbers.field_like = number(-0.4, 0.4);
      numbers.scale += 1;
      torques_ += fmt::format(
          "[torque.slonczewski]\ndamping_like = {:.4f}\nfield_like = {:.4f}\n"
          "polarization = [0, 0.6, 0.8]\n",
          numbers.damping_like, numbers.field_like);
    }
    if (chance(0.2)) {
      double const alpha = number(0, 0.3), slope = number(0, 0.001);
      numbers.damping_of_sites = of_sites(alpha, slope);
      system_ = "system = { kind = 'llg', damping = " + text_of(alpha, slope) + " }\n";
    } else {
      numbers.damping = chance(0.3) ? 0 : number(0.01, 0.4);
      system_ = fmt::format("system = {{ kind = 'llg', damping = {:.4f} }}\n", numbers.damping);
    }
  }

  std::mt19937 engine_;
  std::string lattice_, field_, system_, torques_;
};

template <class Real>
ScalarField<Real, Memory> field_of_sites(Lattice const& lattice, std::vector<double> numbers,
                                         double otherwise) {
  if (numbers.empty()) numbers.assign(static_cast<std::size_t>(lattice.sites()), otherwise);
  ScalarField<Real, Memory> field("numbers", lattice);
  copy_from_host(numbers, field);
  return field;
}

/// The library's composed field of all terms. `occupied`: 1 where there is a spin.
template <class Real>
auto library_field(Numbers const& n) {
  auto const& lattice = n.lattice;
  auto const occupation = field_of_sites<Real>(lattice, n.occupied, 1);
  CellMoments<Memory> const moments(lattice, {n.moment}, {n.gyromagnetic});
  EffectiveField const inside(
      Exchange(lattice, n.exchange),
      SiteDependentExchange<Real, Memory>(field_of_sites<Real>(lattice, n.exchange_of_sites, 0)),
      InterfacialDmi(lattice, n.interfacial), BulkDmi(lattice, n.bulk),
      UniaxialAnisotropy(n.constant[0], n.axis[0]), UniaxialAnisotropy(n.constant[1], n.axis[1]),
      SiteDependentUniaxialAnisotropy(field_of_sites<Real>(lattice, n.constant_of_sites, 0),
                                      n.axis_of_sites),
      CubicAnisotropy(n.cubic, {1, 0, 0}, {0, 1, 0}), ZeemanOfMoments(n.applied, moments));
  FieldOfMoments const of_moments(EffectiveField(FieldWithVacancies(inside, occupation),
                                                 PairCouplings<Memory>(lattice, n.couplings)),
                                  moments);
  EffectiveField const torques(ZhangLi(lattice, n.velocity, n.nonadiabaticity),
                               Slonczewski({.damping_like = n.damping_like,
                                            .field_like = n.field_like,
                                            .polarization = {0, 0.6, 0.8}}));
  return EffectiveField(of_moments, FieldWithVacancies(torques, occupation));
}

/// A generator whose frozen spins stay.
template <class Generator>
struct Held {
  Generator generator;
  ScalarField<double, Memory> moves;

  struct Now {
    decltype(detail::prepare_term(std::declval<Generator const&>(), Space(),
                                  std::declval<SpinField<double, Memory> const&>(), 0.0)) prepared;
    SiteArray<double, 1> moves;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
        Stencil const& stencil) const {
      return stencil.site().load(moves) * prepared(stencil);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const& exec, Spins const& spins, double t) const {
    return {detail::prepare_term(generator, exec, spins, t), moves.array()};
  }
};

template <class Field>
std::vector<double> end_by_library(Numbers const& n, Field const& field,
                                   std::vector<double> const& start, double time) {
  SpinField<double, Memory> spins("spins", n.lattice);
  copy_from_host(start, spins);
  auto damping = n.damping_of_sites;
  std::vector<double> moves(static_cast<std::size_t>(n.lattice.sites()), 1);
  if (damping.empty()) damping.assign(moves.size(), n.damping);
  for (std::size_t site = 0; site < moves.size(); ++site)
    if (!n.frozen.empty() && n.frozen[site] != 0) moves[site] = 0;
  LandauLifshitz const generator(field, field_of_sites<double>(n.lattice, damping, 0));
  Held<decltype(generator)> const held{generator, field_of_sites<double>(n.lattice, moves, 1)};
  Rkmk4<SpinField<double, Memory>> stepper(spins);
  constexpr int steps = 32;
  for (int step = 0; step < steps; ++step)
    stepper.step(Space(), held, spins, step * time / steps, time / steps);
  return copy_to_host(spins);
}

std::vector<double> numbers_of(std::vector<unsigned char> const& flags) {
  return {flags.begin(), flags.end()};
}

void expect_same(unsigned seed, std::map<std::string, int>& refused) {
  Composition composition(seed);
  auto& numbers = composition.numbers;
  auto const precision = composition.one_of(precisions);
  auto const* method = composition.one_of(io::methods());
  if (method->automatic) method = io::methods()[0];
  constexpr int steps = 4;
  double const h = 0.02, dt = h / numbers.scale;
  auto const text_with = [&](std::string_view word, std::string_view more) {
    return composition.text + fmt::format("[integrator]\nmethod = '{}'\ndt = {}\nsteps = {}\n{}\n",
                                          word, dt, steps, more);
  };
  static constexpr std::string_view options[] = {"isotropy = { constant = 0.3 }",
                                                 "isotropy = 'analytic'",
                                                 "isotropy = 'finite_difference_backward'",
                                                 "generator = 'tangent'",
                                                 "generator = 'orthogonal'",
                                                 "rotation = 'exponential'",
                                                 "compensated = true",
                                                 "energy_control = true",
                                                 "isotropy = 'finite_difference'"};
  std::string more = method->adaptive ? "tolerance = 1e-4\n" : "";
  if (composition.chance(0.4)) more += composition.one_of(options);
  auto text = text_with(method->word, more);
  std::optional<io::Scene> scene;
  try {
    scene = scene_of(text);
  } catch (io::SceneError const& error) {
    std::string const why = error.what();
    ++refused[why.substr(why.find(": ") + 2)];
    method = io::find_method("heun");
    text = text_with("heun", "");
    scene = scene_of(text);
  }
  SCOPED_TRACE(fmt::format("seed {}, {} precision\n{}", seed, to_string(precision), text));
  io::SiteBox const box{{0, 0, 0}, numbers.lattice.shape};
  numbers.occupied = numbers_of(io::occupied(*scene, box));
  numbers.frozen = numbers_of(io::frozen(*scene, box));

  auto const run = SceneRun::open(*scene, {.precision = precision});
  auto const start = spins_of(*run);
  auto const field = library_field<double>(numbers);
  {
    auto const found = packed<double>(run->field().vectors);
    SpinField<double, Memory> spins("spins", numbers.lattice), wanted("field", numbers.lattice);
    copy_from_host(start, spins);
    evaluate_field(Space(), field, spins, 0, wanted);
    auto const expected = copy_to_host(wanted);
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      bool const is_site = numbers.occupied.empty() || numbers.occupied[i / 3] != 0;
      bool const moves = numbers.frozen.empty() || numbers.frozen[i / 3] == 0;
      if (is_site) largest = std::max(largest, std::abs(found[i] - moves * expected[i]));
    }
    EXPECT_LT(largest, 64 * epsilon(precision) * numbers.scale);
  }
  if (!scene->field.torque.zhang_li && !scene->field.torque.slonczewski) {
    SpinField<double, Memory> spins("spins", numbers.lattice);
    copy_from_host(start, spins);
    EXPECT_NEAR(run->sample().energy.value, energy(Space(), field, spins, 0).value,
                64 * epsilon(precision) * numbers.scale * numbers.moment / numbers.gyromagnetic *
                    static_cast<double>(numbers.lattice.sites()));
  }
  run->advance(scene->integrator.steps);
  auto const expected = end_by_library(numbers, field, start, steps * dt);
  int const order = method->order;
  double const allowed = method->adaptive || method->stiff
                             ? 1e-4
                             : 8 * steps * std::pow(h, order + 1) + 64 * steps * epsilon(precision);
  EXPECT_LT(largest_distance(spins_of(*run), expected), allowed);
}

TEST(Compositions, AreTheComposedFieldOfTheLibrary) {
  end_of(
      llg_scene("0.1", "heun", 1, "lattice = { shape = [2] }\ninitial = { uniform = [0, 0, 1] }"));
  char const* const wanted = std::getenv("CAYSPIN_COMPOSITIONS");
  auto const count = static_cast<unsigned>(wanted ? std::atoi(wanted) : 200);
  std::map<std::string, int> refused;
  for (unsigned seed = 0; seed < count; ++seed) expect_same(seed, refused);
  for (auto const& [why, times] : refused) fmt::print("refused {} times: {}\n", times, why);
}

}  // namespace
}  // namespace cayspin::simulation::test
