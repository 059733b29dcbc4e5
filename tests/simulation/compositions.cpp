// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Random compositions of terms, shapes, site-dependent numbers, methods and precisions, against the
// library's own composed field. CAYSPIN_COMPOSITIONS: their number.
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

/// The numbers of a scene; 0 for missing terms.
struct Numbers {
  Lattice lattice;
  double exchange = 0, interfacial = 0, bulk = 0, cubic = 0, moment = 1, gyromagnetic = 1;
  double cubic2 = 0, hexagonal = 0;
  double exchange_in_time = 0, anisotropy_in_time = 0, dmi_in_time = 0;  // a of 1 + a sin(5 t)
  double constant[2] = {}, damping_like = 0, field_like = 0, nonadiabaticity = 0, damping = 0;
  Vec3<double> axis[2] = {{0, 0, 1}, {0, 0, 1}}, axis_of_sites{0, 0, 1}, applied{0, 0, 0},
               velocity{0, 0, 0};
  std::vector<double> exchange_of_sites, constant_of_sites, occupied, frozen, damping_of_sites;
  std::vector<double> moment_of_sites, source_of_sites;  // source along x
  double source_along_y = 0, largest_moment = 1;
  std::vector<double> gyromagnetic_of_sites, damping_like_of_sites;
  double largest_gyromagnetic = 1, lambda = 1, along_x = 0;  // along_x i: of the polarization
  std::vector<Coupling> couplings, d2d;
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
  /// Returns a number with four digits, as typed.
  double number(double least, double most) { return std::round(1e4 * uniform(least, most)) / 1e4; }
  Vec3<double> vector(double size) {
    return {number(-size, size), number(-size, size), number(0.1 * size, size)};
  }
  static std::string text_of(Vec3<double> const& v) {
    return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", v.x, v.y, v.z);
  }
  /// Returns `a` + `b` i of each site, and its text.
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
    if (seed % 97 == 5) shape = {70, 50, 30};  // beyond the cores' caches: stages in sweeps
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
      numbers.moment = numbers.largest_moment = number(0.5, 2);
      numbers.gyromagnetic = number(0.5, 2);
      lattice_ += fmt::format("moments = [{}]\ngyromagnetic = [{}]\n", numbers.moment,
                              numbers.gyromagnetic);
    } else if (chance(0.25)) {
      double const slope = number(0, 0.1);
      numbers.moment = number(0.5, 1.5);
      numbers.moment_of_sites = of_sites(numbers.moment, slope);
      numbers.largest_moment = numbers.moment + 600 * slope;
      bool const has_holes = chance(0.3) && shape[0] > 2;
      for (std::size_t i = 1; has_holes && i < numbers.moment_of_sites.size();
           i += static_cast<std::size_t>(shape[0]))
        numbers.moment_of_sites[i] = 0;
      lattice_ += fmt::format("moments = '{}{:.4f} + {:.4f}*i'\n", has_holes ? "i == 1 ? 0 : " : "",
                              numbers.moment, slope);
    }
    if (numbers.gyromagnetic == 1 && chance(0.2)) {
      double const ratio = number(0.5, 2), slope = number(0, 0.01);
      numbers.gyromagnetic_of_sites = of_sites(ratio, slope);
      numbers.largest_gyromagnetic = ratio + 600 * slope;
      lattice_ += "gyromagnetic = " + text_of(ratio, slope) + "\n";
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
    } else if (chance(0.3)) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (numbers.lattice.shape[axis] == 1) continue;
        std::array<int, 3> offset{};
        std::array<double, 3> of_bond{};
        offset[axis] = 1;
        of_bond[axis] = (axis == 0 ? -D : D) / numbers.lattice.spacing[axis];
        numbers.d2d.push_back(Coupling::of({0, 0}, offset, 0, of_bond));
      }
      field_ += fmt::format("dmi = {{ d2d = {:.4f} }}\n", D);
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
      if (chance(0.4)) numbers.cubic2 = number(-3, 3);
      numbers.scale += std::abs(numbers.cubic2);
      axes +=
          fmt::format("{{ cubic = {:.4f}, axes = [[1, 0, 0], [0, 1, 0]]{} }}, ", numbers.cubic,
                      numbers.cubic2 == 0 ? std::string()
                                          : fmt::format(", constant2 = {:.4f}", numbers.cubic2));
    }
    if (chance(0.15)) {
      numbers.hexagonal = number(-0.1, 0.1);
      numbers.scale += 36 * std::abs(numbers.hexagonal);
      axes += fmt::format("{{ hexagonal = {:.4f}, axis = [0, 0, 1], in_plane = [0, 1, 0] }}, ",
                          numbers.hexagonal);
    }
    if (!axes.empty()) field_ += "anisotropy = [" + axes + "]\n";
    choose_factors(!axes.empty());
    if (chance(0.6)) {
      numbers.applied = vector(0.5);
      field_ += "applied = " + text_of(numbers.applied) + "\n";
    }
    numbers.scale = numbers.scale / numbers.moment + 1;
    if (chance(0.2)) {
      double const h = number(-0.5, 0.5), slope = number(-0.01, 0.01);
      numbers.source_of_sites = of_sites(h, slope);
      numbers.source_along_y = number(-0.5, 0.5);
      numbers.scale += 1 + 600 * std::abs(slope);
      field_ += fmt::format("sources = [{{ profile = [{}, {:.4f}, 0], time = 'cos(3*t)' }}]\n",
                            text_of(h, slope), numbers.source_along_y);
    }
    numbers.scale *= numbers.gyromagnetic * numbers.largest_gyromagnetic;
  }

  // Chooses how much the existing constants change in time.
  void choose_factors(bool has_axes) {
    if (!chance(0.25)) return;
    std::string factors;
    auto const choose = [&](bool there, char const* key, double& part) {
      if (!there || !chance(0.6)) return;
      part = number(-0.5, 0.5);
      factors += fmt::format("{} = '1 + {:.4f}*sin(5*t)', ", key, part);
    };
    choose(numbers.exchange != 0 || !numbers.exchange_of_sites.empty(), "exchange",
           numbers.exchange_in_time);
    choose(has_axes, "anisotropy", numbers.anisotropy_in_time);
    choose(field_.find("dmi") != field_.npos, "dmi", numbers.dmi_in_time);
    numbers.scale *= 1.5;
    if (factors.empty()) return;
    factors.resize(factors.size() - 2);  // the comma after the last one
    field_ += "in_time = { " + factors + " }\n";
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
    } else if (chance(0.15)) {
      double const a = number(-0.4, 0.4), slope = number(-0.001, 0.001);
      numbers.damping_like_of_sites = of_sites(a, slope);
      numbers.field_like = number(-0.4, 0.4);
      numbers.lambda = chance(0.7) ? number(1, 1.5) : 1;
      numbers.along_x = number(-0.1, 0.1);
      numbers.scale += 4;
      torques_ += fmt::format(
          "[torque.slonczewski]\ndamping_like = {{ profile = {}, time = 'cos(2*t)' }}\nfield_like = "
          "{:.4f}\nlambda = {:.4f}\npolarization = ['{:.4f}*i', 0.6, 0.8]\n",
          text_of(a, slope), numbers.field_like, numbers.lambda, numbers.along_x);
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

/// H = moment applied, E = -moment m.applied, site-dependent; `applied` of the sources turns with
/// cos(3 t).
struct AppliedToSites {
  ScalarField<double, Memory> moments, along_x;
  Vec3<double> applied;
  double along_y;

  struct Now {
    static constexpr int degree = 1;
    SiteArray<double, 1> moments, along_x;
    Vec3<double> applied;
    double along_y, factor;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      Value const x = Value(applied.x) + Value(factor) * stencil.site().load(along_x);
      return stencil.site().load(moments) *
             Vec3<Value>{x, Value(applied.y + factor * along_y), Value(applied.z)};
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      return typename Stencil::value_type(-1.0) * dot(stencil.center(), field(stencil));
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const&, Spins const&, double t) const {
    return {moments.array(), along_x.array(), applied, along_y, std::cos(3 * t)};
  }
};

/// Slonczewski's field, with site-dependent a times cos(2 t), and p along (x of sites, 0.6, 0.8).
struct CurrentToSites {
  ScalarField<double, Memory> damping_like, along_x;
  double field_like, lambda;

  struct Now {
    static constexpr bool is_conservative = false;
    SiteArray<double, 1> damping_like, along_x;
    double field_like, lambda, factor;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      using Value = typename Stencil::value_type;
      auto const& m = stencil.center();
      Vec3<Value> p{stencil.site().load(along_x), Value(0.6), Value(0.8)};
      p = Value(Value(1.0) / Kokkos::sqrt(dot(p, p))) * p;
      Value const cosine = dot(m, p), square(lambda * lambda), one(1.0);
      Value const efficiency = Value(2.0) * square / ((one + cosine) * square + (one - cosine));
      Value const a = Value(factor) * stencil.site().load(damping_like) * efficiency;
      return a * cross(m, p) + Value(field_like) * p;
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(Stencil const&) const {
      return typename Stencil::value_type(0.0);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const&, Spins const&, double t) const {
    return {damping_like.array(), along_x.array(), field_like, lambda, std::cos(2 * t)};
  }
};

/// H of a field times site-dependent numbers, with unchanged E.
template <class Field>
struct TimesNumbersOfSites {
  Field inner;
  ScalarField<double, Memory> numbers;

  struct Now {
    decltype(detail::prepare_term(std::declval<Field const&>(), Space(),
                                  std::declval<SpinField<double, Memory> const&>(), 0.0)) inner;
    SiteArray<double, 1> numbers;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      return stencil.site().load(numbers) * inner.field(stencil);
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      return inner.energy_density(stencil);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const& exec, Spins const& spins, double t) const {
    return {detail::prepare_term(inner, exec, spins, t), numbers.array()};
  }
};

/// The anisotropy of a crystal with axes z, or x and y, by its polynomials.
struct CrystalByHand {
  double cubic2, hexagonal;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& [x, y, z] = stencil.center();
    Value const a = x * x, b = y * y, c = z * z, two(-2 * cubic2), six(-6 * hexagonal);
    // Parts of (y - i x)^6.
    Value const of_x = x * (Value(10.0) * a * b - Value(5.0) * b * b - a * a),
                of_y = y * (b * b - Value(10.0) * a * b + Value(5.0) * a * a);
    return {two * x * b * c + six * of_x, two * y * c * a + six * of_y, two * z * a * b};
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& [x, y, z] = stencil.center();
    Value const a = x * x, b = y * y, c = z * z;
    return Value(cubic2) * a * b * c + Value(hexagonal) * (b * b * b - Value(15.0) * b * b * a +
                                                           Value(15.0) * b * a * a - a * a * a);
  }
};

/// H and E of a field times 1 + part sin(5 t).
template <class Field>
struct ChangesInTime {
  Field inner;
  double part;

  struct Now {
    decltype(detail::prepare_term(std::declval<Field const&>(), Space(),
                                  std::declval<SpinField<double, Memory> const&>(), 0.0)) inner;
    double factor;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
        Stencil const& stencil) const {
      return as_value<typename Stencil::value_type>(factor) * inner.field(stencil);
    }
    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
        Stencil const& stencil) const {
      return as_value<typename Stencil::value_type>(factor) * inner.energy_density(stencil);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const& exec, Spins const& spins, double t) const {
    return {detail::prepare_term(inner, exec, spins, t), 1 + part * std::sin(5 * t)};
  }
};

/// The library's composed field of all terms. `occupied`: 1 where there is a spin.
template <class Real>
auto library_field(Numbers const& n) {
  auto const& lattice = n.lattice;
  auto const occupation = field_of_sites<Real>(lattice, n.occupied, 1);
  auto per_moment = n.moment_of_sites;
  for (double& number : per_moment) number = number == 0 ? 0 : n.gyromagnetic / number;
  auto const moments = field_of_sites<Real>(lattice, n.moment_of_sites, n.moment);
  EffectiveField const exchange(
      Exchange(lattice, n.exchange),
      SiteDependentExchange<Real, Memory>(field_of_sites<Real>(lattice, n.exchange_of_sites, 0)));
  EffectiveField const dmi(InterfacialDmi(lattice, n.interfacial), BulkDmi(lattice, n.bulk));
  EffectiveField const anisotropy(
      UniaxialAnisotropy(n.constant[0], n.axis[0]), UniaxialAnisotropy(n.constant[1], n.axis[1]),
      SiteDependentUniaxialAnisotropy(field_of_sites<Real>(lattice, n.constant_of_sites, 0),
                                      n.axis_of_sites),
      CubicAnisotropy(n.cubic, {1, 0, 0}, {0, 1, 0}), CrystalByHand{n.cubic2, n.hexagonal});
  EffectiveField const inside(
      ChangesInTime{exchange, n.exchange_in_time}, ChangesInTime{dmi, n.dmi_in_time},
      ChangesInTime{anisotropy, n.anisotropy_in_time},
      AppliedToSites{moments, field_of_sites<Real>(lattice, n.source_of_sites, 0), n.applied,
                     n.source_along_y});
  EffectiveField const gradient(
      FieldWithVacancies(inside, occupation), PairCouplings<Memory>(lattice, n.couplings),
      ChangesInTime{PairCouplings<Memory>(lattice, n.d2d), n.dmi_in_time});
  TimesNumbersOfSites const of_moments{
      gradient, field_of_sites<Real>(lattice, per_moment, n.gyromagnetic / n.moment)};
  bool const is_of_sites = !n.damping_like_of_sites.empty();
  std::vector<double> along_x(static_cast<std::size_t>(lattice.sites()));
  for (std::size_t site = 0; site < along_x.size(); ++site)
    along_x[site] =
        n.along_x * static_cast<double>(static_cast<std::int64_t>(site) % lattice.shape[0]);
  EffectiveField const torques(
      ZhangLi(lattice, n.velocity, n.nonadiabaticity),
      Slonczewski({.damping_like = n.damping_like,
                   .field_like = is_of_sites ? 0 : n.field_like,
                   .polarization = {0, 0.6, 0.8}}),
      CurrentToSites{field_of_sites<Real>(lattice, n.damping_like_of_sites, 0),
                     field_of_sites<Real>(lattice, along_x, 0), is_of_sites ? n.field_like : 0,
                     n.lambda});
  // Gyromagnetic ratios do not multiply the torques.
  auto per_ratio = n.gyromagnetic_of_sites;
  for (double& ratio : per_ratio) ratio = 1 / ratio;
  TimesNumbersOfSites const of_ratios{FieldWithVacancies(torques, occupation),
                                      field_of_sites<Real>(lattice, per_ratio, 1)};
  return EffectiveField(of_moments, of_ratios);
}

/// A generator whose frozen spins do not move.
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
    if (!n.frozen.empty() && n.frozen[site] != 0)
      moves[site] = 0;
    else if (!n.gyromagnetic_of_sites.empty())
      moves[site] = n.gyromagnetic_of_sites[site];
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
                64 * epsilon(precision) * numbers.scale * numbers.largest_moment /
                    numbers.gyromagnetic * static_cast<double>(numbers.lattice.sites()));
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
