// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble.hpp"
#include "io/field.hpp"
#include "io/follow.hpp"
#include "io/initial_state.hpp"
#include "io/method.hpp"
#include "io/site_box.hpp"
#include "io/stage.hpp"
#include "io/units.hpp"
#include "io/words.hpp"

#include <cayspin/crystal.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// A scene file as plain data. docs/reference/scene.md describes every key.
namespace cayspin::inline v0_2::io {

/// Error in a scene. what() is one line: `FILE:LINE: key: what is wrong; accepted: ...`, or `--set
/// key=value: key: ...` when an override is to blame.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using PrincipalMoments = Triple;
using InertiaTensor = std::array<double, 9>;  ///< symmetric 3x3, row by row
/// An inertia tensor for each body, from an HDF5 file.
struct InertiaFile {
  std::filesystem::path path;  ///< dataset /inertia (count, 3, 3)
};

/// The table [system].
struct System {
  SystemKind kind = SystemKind::llg;
  double damping = 0;             ///< llg: lambda >= 0
  SiteNumbers dampings;           ///< llg: instead of it, which then is 0
  bool gilbert_of_sites = false;  ///< torques are divided by 1 + damping^2
  bool precession = true;         ///< llg: false is the overdamped A = lambda m x H
  std::variant<PrincipalMoments, InertiaTensor, InertiaFile> inertia;  ///< rigid_body
};

/// The table [lattice].
struct Lattice {
  /// nx, ny, nz; for rigid bodies count, 1, 1. For a crystal nz is cells times sites of a cell:
  /// plane k * basis.size() + s has the sites s of the cells k.
  std::array<std::int64_t, 3> shape = {1, 1, 1};
  Triple spacing = {1, 1, 1};
  std::array<BoundaryKind, 3> boundary = {};
  std::array<Triple, 3> cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< in units of spacing
  std::vector<Triple> basis = {{0, 0, 0}};    ///< in fractions of the cell's vectors
  std::vector<double> moments, gyromagnetic;  ///< one for each site of the cell; empty: all 1
  SiteNumbers moments_of_sites;               ///< instead of moments; 0: no spin
  SiteNumbers gyromagnetic_of_sites;          ///< instead of gyromagnetic
  SiteNumbers occupied, frozen;  ///< true where not 0; default: all occupied, none frozen
  SiteNumbers regions;           ///< whole numbers, starting at 0
  std::optional<Follow> follow;
};

/// All spins along one direction.
struct UniformStart {
  Triple direction = {};  ///< unit vector
};
/// A start by expressions, normalised per spin.
struct ExpressionStart {
  std::array<std::string, 3> components;  ///< in x, y, z, i, j, k
};
/// Random spins, distributed uniformly on the sphere.
struct RandomStart {
  std::int64_t seed = 0;
};
/// A start from the last frame of an HDF5 file, or from an OVF file, normalised per spin.
struct FileStart {
  std::filesystem::path path;  ///< dataset /spins, or OVF 2.0
};
/// A start that a program passes with the text of its scene, normalised per spin.
struct GivenStart {
  GivenNumbers spins;  ///< sites x 3, x fastest
};
using Initial =
    std::variant<UniformStart, ExpressionStart, RandomStart, FileStart, GivenStart, InitialState>;

/// Data that a program passes with the text of its scene.
struct Given {
  GivenNumbers spins;                                        ///< for initial.given = true
  std::map<std::string, GivenNumbers, std::less<>> numbers;  ///< for keys with { given = true }
};

/// The table [integrator]: method, coordinates and steps.
struct Integrator {
  Method const* method = nullptr;
  Generator generator = Generator::standard;
  Isotropy isotropy = Isotropy::zero;
  double sigma = 0;  ///< isotropy constant, added to A along m
  double isotropy_cap = std::numeric_limits<double>::infinity();  ///< bound on |dt sigma|
  Rotation rotation = Rotation::cayley;
  double dt = 0;              ///< of adaptive methods: interval between observations of the spins
  std::int64_t steps = 0;     ///< computed from `end` when the scene gives that
  std::int64_t substeps = 1;  ///< of the method in each step, for an expensive field
  std::optional<double> tolerance;  ///< only of adaptive methods
  std::optional<double> error;      ///< of method "auto": target that its choice must meet
  double min_dt = 0,
         max_dt =
             std::numeric_limits<double>::infinity();  ///< of an adaptive method's internal steps
  bool compensated = false;      ///< adds the rounding error of the spins to the next step
  bool energy_guard = true;      ///< stops a run whose energy rises although it can only fall
  bool energy_control = false;   ///< holds the energy of a run without damping
  bool refuse_unstable = false;  ///< a dt that `run` would warn of is an error
  std::optional<double> until_torque;

  static constexpr auto keys() {
    return std::to_array<Key<Integrator>>(
        {{"method"},
         {"generator"},
         {"isotropy"},
         {"isotropy_cap"},
         {"rotation"},
         {"dt"},
         {"end"},
         {"steps"},
         {"substeps", &Integrator::substeps, {"a whole number >= 1", 1}},
         {"tolerance"},
         {"min_dt", &Integrator::min_dt, not_negative},
         {"max_dt", &Integrator::max_dt, positive},
         {"error"},
         {"compensated", &Integrator::compensated},
         {"energy_guard", &Integrator::energy_guard},
         {"energy_control", &Integrator::energy_control},
         {"refuse_unstable", &Integrator::refuse_unstable},
         {"until_torque", &Integrator::until_torque, positive}});
  }
};

/// The table [thermal]. kB T over the energy of a site is temperature * in_time(t) * of_sites.
struct Thermal {
  double temperature = 0;          ///< >= 0
  AppliedComponent in_time = 1.0;  ///< an expression in t, or 1
  SiteNumbers of_sites;            ///< empty: 1
  std::int64_t seed = 0;

  static constexpr auto keys() {
    return std::to_array<Key<Thermal>>(
        {{"temperature"}, {"seed", &Thermal::seed, {"a whole number >= 0", 0}}});
  }
};

/// How often a run stores FILE.checkpoint.h5, from which it can continue with the same bits: after
/// so many steps, or after so many seconds. Never if both are 0.
struct CheckpointPeriod {
  double seconds = 600;
  std::int64_t steps = 0;

  bool is_never() const { return seconds == 0 && steps == 0; }
};

/// The table [output].
struct Output {
  std::optional<std::filesystem::path> file;  ///< as typed: relative to the working directory
  std::int64_t every = 1;                     ///< steps between frames, >= 1; default: steps
  std::int64_t scalars_every = 1;  ///< steps between scalar samples, >= 1; default: every
  int compression = 0;             ///< of /spins: 0 (none) to 9
  std::int64_t chunk = 0;          ///< planes along z in a chunk of /spins; 0: all
  bool xdmf = false;               ///< FILE.xdmf for viewers
  bool table = false;              ///< FILE.txt with the scalar samples
  bool sync = false;               ///< a power cut loses at most the frame being written
  bool regions = false;            ///< magnetization and energy of each region, in each sample
  bool terms = false;              ///< the energy of each term, in each sample
  CheckpointPeriod checkpoint_every;

  static constexpr auto keys() {
    return std::to_array<Key<Output>>(
        {{"file"},
         {"every"},
         {"scalars_every"},
         {"compression", &Output::compression, {"a level from 0 (none) to 9", 0, 9}},
         {"chunk", &Output::chunk, {"a whole number of planes along z >= 1", 1}},
         {"checkpoint_every"},
         {"xdmf", &Output::xdmf},
         {"table", &Output::table},
         {"sync", &Output::sync},
         {"regions", &Output::regions},
         {"terms", &Output::terms}});
  }
};

/// The table [material] of a scene in SI, as typed. System, Lattice and Field have its values in
/// reduced units.
struct Material {
  bool atomistic = false;  ///< mu_s, J and K instead of Ms, A and Ku
  double moment =
      0;  ///< Ms, A/m, or mu_s, J/T, of the first site; if site-dependent, the one that counts as 1
  std::vector<double> moments;        ///< J/T, one for each site of the cell; empty: all equal
  std::optional<double> exchange;     ///< A, J/m, or J of a bond, J
  std::optional<double> anisotropy;   ///< Ku, J/m^3, or K of a site, J
  std::optional<double> anisotropy2;  ///< Ku2, J/m^3, or K2 of a site, J
  std::optional<double> dmi;          ///< D, J/m^2, or D of a bond, J, of an interface
  std::optional<double> bulk_dmi;     ///< D of the bulk
  std::optional<double> d2d_dmi;      ///< D of a crystal of symmetry D2d
  SiteNumbers moment_factors, exchange_factors, anisotropy_factors, anisotropy2_factors,
      dmi_factors, alpha_factors, gamma_factors;  ///< in SI
  SiteVectors axes, normals;                      ///< instead of one axis, one normal
  Triple axis = {}, normal = {};                  ///< unit vectors
  double alpha = 0;
  bool gilbert = true;  ///< Gilbert's equation, or that of Landau and Lifshitz
  double gamma = 0;     ///< rad/(s T); if site-dependent, the one that counts as 1
};

struct Stage;

/// A scene: one member for each table, and the place of each key. All numbers except those of
/// Material are in reduced units, even if the scene is typed in SI.
struct Scene {
  Units units;
  std::optional<Material> material;  ///< with units = "SI"
  std::optional<std::array<AppliedComponent, 3>>
      applied_in_tesla;  ///< field.applied as typed, with t in s: with units = "SI"
  Torque torque_in_si;   ///< with velocities in m/s, strengths in T and t in s: with units = "SI"
  System system;
  Lattice lattice;
  Field field;
  Initial initial;
  Integrator integrator;
  std::optional<Thermal> thermal;
  Output output;
  Ensemble ensemble;
  std::string text;            ///< the TOML text; re-serialised when an override changed it
  std::filesystem::path path;  ///< the scene file, or the name of a text without one
  Given given;
  std::map<std::string, std::string, std::less<>>
      places;                 ///< key -> "FILE:LINE" or "--set key=value"
  StageBegin begin;           ///< for a scene that is a stage of a run
  std::vector<Stage> stages;  ///< those after the scene's own tables
};

/// Options of a stage that searches for an equilibrium, like `cayspin relax`.
struct StageRelax {
  double torque = 1e-6;  ///< bound on max |m x H|, in the units of the scene
  std::int64_t evaluations = 100000;
  bool keep_saddles = false;

  static constexpr auto keys() {
    return std::to_array<Key<StageRelax>>(
        {{"torque", &StageRelax::torque, positive},
         {"evaluations", &StageRelax::evaluations, {"a whole number >= 1", 1}},
         {"keep_saddles", &StageRelax::keep_saddles}});
  }
};

/// A table [[stage]]: the scene with all keys changed that this stage and earlier ones change.
struct Stage {
  std::string name;                 ///< or empty
  std::optional<StageRelax> relax;  ///< if set, the stage takes no steps
  Scene scene;                      ///< without nested stages
};

/// Reads and validates a scene. Each override is "key.path=VALUE" with a TOML value, applied in
/// order. Of the files that the scene names, it opens only a unit-cell file that defines the cell;
/// check_files, initial_spins, couplings and inertia open the others. Throws SceneError.
Scene read_scene(std::filesystem::path const& path, std::vector<std::string> const& overrides = {},
                 Given given = {});

/// Parses a text in memory, such as that of a trajectory file. Messages call it `name`; its files
/// are relative to the folder of `name`.
Scene parse_scene(std::string text, std::filesystem::path const& name,
                  std::vector<std::string> const& overrides = {}, Given given = {});

/// Returns a scene with more overrides, and its text with them. Later errors name the keys of
/// `scene`, where its author finds them. Throws SceneError.
Scene with_overrides(Scene const& scene, std::vector<std::string> const& overrides);

/// Returns a table of a scene's text as the override "NAME={...}" for another scene.
std::string as_override(std::string const& scene_text, std::string const& name);

/// Refuses contradictory combinations of method, generator, isotropy, rotation, system, lattice and
/// field, like read_scene. Throws SceneError.
void check_combination(Scene const& scene);

/// Returns a one-line error for a key found wrong after reading, such as a shape that does not fit
/// in memory: "FILE:LINE: key: message".
SceneError scene_error(Scene const& scene, std::string_view key, std::string_view message);

/// Returns the number of spins, or of rigid bodies.
std::int64_t sites(Scene const& scene);

/// Opens every file that the scene reads and checks the types and shapes of datasets, not their
/// values. Throws SceneError.
void check_files(Scene const& scene);

/// Returns the start on the host, sites x 3 normalised in double: component c of site (i, j, k) is
/// at ((k*ny + j)*nx + i)*3 + c. Throws SceneError naming the site of a zero or non-finite spin.
std::vector<double> initial_spins(Scene const& scene);

/// Returns the start of only these sites, in the same order. An OVF file is read completely.
std::vector<double> initial_spins(Scene const& scene, SiteBox const& box);

/// Returns the bonds of a scene, each once: the typed ones, or those of its unit-cell file. Throws
/// SceneError.
std::vector<Coupling> couplings(Scene const& scene);

/// Return 1 for the sites that hold a spin, and for the sites whose spin does not move, in the
/// order of initial_spins; empty if all are occupied, or none is frozen. Throw SceneError.
std::vector<unsigned char> occupied(Scene const& scene, SiteBox const& box);
std::vector<unsigned char> frozen(Scene const& scene, SiteBox const& box);

/// Returns the moment of each site, 0 where there is no spin; empty if lattice.moments gives them.
/// Throws SceneError for a negative one.
std::vector<double> moments_of_sites(Scene const& scene, SiteBox const& box);

/// Returns the moment of each site, also if lattice.moments gives them, 0 where there is no spin.
/// Empty if all are 1.
std::vector<double> all_moments(Scene const& scene, SiteBox const& box);
/// Returns the gyromagnetic ratio of each site; empty if lattice.gyromagnetic gives them. Throws
/// SceneError for one that is not positive.
std::vector<double> gyromagnetic_of_sites(Scene const& scene, SiteBox const& box);

/// Returns the region of each site, in the order of initial_spins. Throws SceneError for a number
/// that is negative or not whole.
std::vector<std::int64_t> regions(Scene const& scene, SiteBox const& box);

/// Returns the number of regions: one more than the largest region number.
std::int64_t region_count(Scene const& scene);

/// Refuses site-dependent numbers that vary along the axis of lattice.follow. Throws SceneError.
void require_alike_where_followed(Scene const& scene);

/// Returns one number for each site, in the order of initial_spins. `key`: of the scene, for
/// messages. Throws SceneError.
std::vector<double> numbers_of_sites(Scene const& scene, SiteNumbers const& numbers,
                                     std::string_view key, SiteBox const& box);

/// Returns three numbers for each site, sites x 3 in the order of initial_spins. Throws SceneError.
std::vector<double> vectors_of_sites(Scene const& scene, SiteVectors const& vectors,
                                     std::string_view key, SiteBox const& box);

/// Returns vectors_of_sites, normalised; refuses the zero vector where there is a spin.
std::vector<double> directions_of_sites(Scene const& scene, SiteVectors const& vectors,
                                        std::string_view key, SiteBox const& box);

/// Returns the two axes of each site, sites x 3, orthonormal; if they are uniform, only those of
/// one site. Throws SceneError.
std::array<std::vector<double>, 2> crystal_axes(Scene const& scene, CrystalAnisotropy const& term,
                                                SiteBox const& box);

/// Returns the regions at both ends of the bond from each site to the next one along an axis, also
/// past the end of the box; past an open end both are equal.
std::vector<std::array<std::int64_t, 2>> regions_of_bonds(Scene const& scene, SiteBox const& box,
                                                          std::size_t axis);

/// Returns the regions at both ends of the bond from each site to the one `reach` further along an
/// axis, or back if `reach` is negative; -1 twice if one of the two has no spin, or a site between
/// them has one. A bond does not lead around a periodic axis to its own site.
std::vector<std::array<std::int64_t, 2>> regions_across(Scene const& scene, SiteBox const& box,
                                                        std::size_t axis, std::int64_t reach);

/// Returns the numbers of the sites `reach` further along an axis, or back; |reach| is below the
/// extent. 0 past an open end.
std::vector<double> numbers_across(Scene const& scene, SiteNumbers const& numbers,
                                   std::string_view key, SiteBox const& box, std::size_t axis,
                                   std::int64_t reach);

/// Returns the longest `reach` of interlayers with a range above 0, or 0.
std::int64_t reach_of_interlayers(Scene const& scene);

/// Returns true if the field needs a separate pass, for terms that few scenes have.
bool needs_pass(Scene const& scene);

/// Returns true if each site has its own moment, instead of those of a cell: by lattice.moments,
/// and for point dipoles, which act on moments rather than spins.
bool has_moments_of_sites(Scene const& scene);

/// Returns true if a site has no spin, by lattice.occupied or a moment of 0.
bool has_vacancies(Scene const& scene);

/// Returns true if H is linear in the spins, apart from the applied field. Unknown for a unit-cell
/// file, which may have biquadratic couplings.
bool has_linear_field(Scene const& scene);

/// Returns the number of a site of the cell; 1 without numbers.
double of_cell_site(std::vector<double> const& numbers, std::size_t site);

/// Returns `number` over the moment of a site of the cell; 0 where the moment is 0 (no spin).
double over_moment(Lattice const& lattice, std::size_t site, double number);

/// Returns gyromagnetic ratio over moment for each site of the cell, which scales the thermal
/// noise; 0 without a spin.
std::vector<double> noise_of_cell_sites(Scene const& scene);
/// Returns true if the damping, temperature, moment or gyromagnetic ratio is site-dependent.
bool has_noise_of_sites(Scene const& scene);
/// Returns the product of damping, temperature, and gyromagnetic ratio over moment for each site,
/// of those that are site-dependent; 0 where a spin does not move. Throws SceneError for a negative
/// number.
std::vector<double> noise_of_sites(Scene const& scene, SiteBox const& box);
/// Returns the largest of these, or of those of the cell's sites.
double largest_noise(Scene const& scene);
/// Refuses a dt for which the noise of half a step would turn spins too far. `heat`: the largest
/// damping times temperature times gyromagnetic ratio over moment.
void require_moderate_noise(Scene const& scene, double heat);

/// Returns a lattice's cell.
Crystal crystal(Lattice const& lattice);

/// Returns the inertia tensors of a rigid body scene, row by row: one when all bodies share it,
/// otherwise one per body. Throws SceneError naming a body whose tensor is not symmetric positive
/// definite.
std::vector<InertiaTensor> inertia(Scene const& scene);

/// Returns their inverses in the order xx, yy, zz, xy, xz, yz. Throws like inertia.
std::vector<std::array<double, 6>> inverse_inertia(Scene const& scene);

}  // namespace cayspin::inline v0_2::io
