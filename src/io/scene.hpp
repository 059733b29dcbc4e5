// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/field.hpp"
#include "io/method.hpp"
#include "io/site_box.hpp"
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
namespace cayspin::inline v0_1::io {

/// what() is one line: `FILE:LINE: key: what is wrong; accepted: ...`, or
/// `--set key=value: key: ...` when an override is to blame.
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
  SiteNumbers dampings;           ///< llg: in place of it, which then is 0
  bool gilbert_of_sites = false;  ///< their torques are divided by 1 + damping^2
  bool precession = true;         ///< llg: false is the overdamped A = lambda m x H
  std::variant<PrincipalMoments, InertiaTensor, InertiaFile> inertia;  ///< rigid_body
};

/// The table [lattice].
struct Lattice {
  /// nx, ny, nz; rigid bodies: count, 1, 1. Of a crystal nz is cells times sites of a cell: plane
  /// k * basis.size() + s has the sites s of the cells k.
  std::array<std::int64_t, 3> shape = {1, 1, 1};
  Triple spacing = {1, 1, 1};
  std::array<BoundaryKind, 3> boundary = {};
  std::array<Triple, 3> cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< in units of spacing
  std::vector<Triple> basis = {{0, 0, 0}};    ///< in fractions of the cell's vectors
  std::vector<double> moments, gyromagnetic;  ///< one for each site of the cell; empty: all 1
  SiteNumbers occupied, frozen;               ///< where they are not 0; default: all, none
};

/// All spins along one direction.
struct UniformStart {
  Triple direction = {};  ///< unit vector
};
/// A start by expressions, normalised per spin.
struct ExpressionStart {
  std::array<std::string, 3> components;  ///< in x, y, z, i, j, k
};
/// Spins that are uniform on the sphere.
struct RandomStart {
  std::int64_t seed = 0;
};
/// A start from the last frame of an HDF5 file, or from an OVF file, normalised per spin.
struct FileStart {
  std::filesystem::path path;  ///< dataset /spins, or OVF 2.0
};
/// A start that a program gives beside the text of its scene, normalised per spin.
struct GivenStart {
  GivenNumbers spins;  ///< sites x 3, x fastest
};
using Initial = std::variant<UniformStart, ExpressionStart, RandomStart, FileStart, GivenStart>;

/// What a program gives beside the text of its scene.
struct Given {
  GivenNumbers spins;                                        ///< for initial.given = true
  std::map<std::string, GivenNumbers, std::less<>> numbers;  ///< for { given = true } of a key
};

/// The table [integrator]: method, coordinates and steps.
struct Integrator {
  Method const* method = nullptr;
  Generator generator = Generator::standard;
  Isotropy isotropy = Isotropy::zero;
  double sigma = 0;  ///< isotropy constant: what is added to A along m
  double isotropy_cap = std::numeric_limits<double>::infinity();  ///< of |dt sigma|
  Rotation rotation = Rotation::cayley;
  double dt = 0;                    ///< of adaptive methods: from one look at the spins to the next
  std::int64_t steps = 0;           ///< computed from `end` when the scene gives that
  std::int64_t substeps = 1;        ///< of the method in each step, where a field is dear
  std::optional<double> tolerance;  ///< of adaptive methods, which have one
  std::optional<double> error;      ///< of method "auto": what its choice is to come to
  double min_dt = 0, max_dt = std::numeric_limits<double>::infinity();  ///< of their own steps
  bool compensated = false;      ///< what rounding takes off the spins goes into the next step
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

/// The table [thermal].
struct Thermal {
  double temperature = 0;  ///< kB T over the energy of a site, >= 0
  std::int64_t seed = 0;

  static constexpr auto keys() {
    return std::to_array<Key<Thermal>>({{"temperature", &Thermal::temperature, not_negative, true},
                                        {"seed", &Thermal::seed, {"a whole number >= 0", 0}}});
  }
};

/// How often a run stores what it needs to go on with the same bits, in FILE.checkpoint.h5: after
/// so many steps, or after so many seconds of its own time. Never where both are 0.
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
  CheckpointPeriod checkpoint_every;

  static constexpr auto keys() {
    return std::to_array<Key<Output>>(
        {{"file"},
         {"every", &Output::every, {"a whole number of steps >= 1", 1}},
         {"scalars_every", &Output::scalars_every, {"a whole number of steps >= 1", 1}},
         {"compression", &Output::compression, {"a level from 0 (none) to 9", 0, 9}},
         {"chunk", &Output::chunk, {"a whole number of planes along z >= 1", 1}},
         {"checkpoint_every"},
         {"xdmf", &Output::xdmf},
         {"table", &Output::table},
         {"sync", &Output::sync}});
  }
};

/// The table [material] of a scene in SI, as typed. What it comes to in reduced units stands in
/// System, Lattice and Field.
struct Material {
  bool atomistic = false;            ///< mu_s, J and K in place of Ms, A and Ku
  double moment = 0;                 ///< Ms, A/m, or mu_s, J/T, of the first site
  std::vector<double> moments;       ///< J/T, one for each site of the cell; empty: all alike
  std::optional<double> exchange;    ///< A, J/m, or J of a bond, J
  std::optional<double> anisotropy;  ///< Ku, J/m^3, or K of a site, J
  std::optional<double> dmi;         ///< D, J/m^2, or D of a bond, J, of an interface
  std::optional<double> bulk_dmi;    ///< the same of the bulk
  SiteNumbers exchange_factors, anisotropy_factors, dmi_factors, alpha_factors;  ///< in SI
  Triple axis = {}, normal = {};                                                 ///< unit vectors
  double alpha = 0;
  bool gilbert = true;  ///< Gilbert's equation, or that of Landau and Lifshitz
  double gamma = 0;     ///< rad/(s T)
};

/// A scene: one member for each table, and where each key stands. All numbers but those of Material
/// are in reduced units, also where the scene is typed in SI.
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
  std::string text;            ///< the TOML text; re-serialised when an override changed it
  std::filesystem::path path;  ///< the scene file, or the name of a text without one
  Given given;
  std::map<std::string, std::string, std::less<>>
      places;  ///< key -> "FILE:LINE" or "--set key=value"
};

/// Reads and validates a scene. Each override is "key.path=VALUE" with a TOML value, applied in
/// order. Of the files that the scene names, only a unit-cell file that says what the cell is is
/// opened: check_files, initial_spins, couplings and inertia open the others. Throws SceneError.
Scene read_scene(std::filesystem::path const& path, std::vector<std::string> const& overrides = {},
                 Given given = {});

/// The same for a text in memory, such as that in a trajectory file. Messages name it `name`, and
/// its files lie in the folder of `name`.
Scene parse_scene(std::string text, std::filesystem::path const& name,
                  std::vector<std::string> const& overrides = {}, Given given = {});

/// A scene with more overrides, and its text with them. Errors found later name the keys of
/// `scene`, where its author finds them. Throws SceneError.
Scene with_overrides(Scene const& scene, std::vector<std::string> const& overrides);

/// A table of a scene's text, as the override "NAME={...}" that puts it into another scene.
std::string as_override(std::string const& scene_text, std::string const& name);

/// Refuses what has no meaning together, as read_scene does: method, generator, isotropy, rotation,
/// system, lattice and field. Throws SceneError.
void check_combination(Scene const& scene);

/// The one-line error for something found wrong with a key after reading, such as a shape that does
/// not fit in memory: "FILE:LINE: key: message".
SceneError scene_error(Scene const& scene, std::string_view key, std::string_view message);

/// Number of spins, or of rigid bodies.
std::int64_t sites(Scene const& scene);

/// Opens every file that the scene reads and checks the datasets' types and shapes, not the values.
/// Throws SceneError.
void check_files(Scene const& scene);

/// The start on the host, sites x 3 normalised in double: component c of site (i, j, k) lies at
/// ((k*ny + j)*nx + i)*3 + c. Throws SceneError naming the site of a zero or non-finite spin.
std::vector<double> initial_spins(Scene const& scene);

/// The start of these sites alone, in the same order. Of a file in OVF all is read.
std::vector<double> initial_spins(Scene const& scene, SiteBox const& box);

/// The bonds of a scene, each once: those that are typed, or those of its unit-cell file. Throws
/// SceneError.
std::vector<Coupling> couplings(Scene const& scene);

/// 1 for the sites that hold a spin, and for those whose spin does not move, in the order of
/// initial_spins; empty where all do and none is frozen. Throws SceneError.
std::vector<unsigned char> occupied(Scene const& scene, SiteBox const& box);
std::vector<unsigned char> frozen(Scene const& scene, SiteBox const& box);

/// A number for each site, in the order of initial_spins. `key`: of the scene, for messages. Throws
/// SceneError.
std::vector<double> numbers_of_sites(Scene const& scene, SiteNumbers const& numbers,
                                     std::string_view key, SiteBox const& box);

/// Is the field evaluated in a pass of its own, for terms that few scenes have?
bool needs_pass(Scene const& scene);

/// Has a site no spin? By lattice.occupied, or a moment of 0.
bool has_vacancies(Scene const& scene);

/// Is H linear in the spins, but for the applied field? Not known of a unit-cell file, which may
/// have biquadratic couplings.
bool has_linear_field(Scene const& scene);

/// The number of a site of the cell; 1 without numbers.
double of_cell_site(std::vector<double> const& numbers, std::size_t site);

/// `number` over the moment of a site of the cell; 0 where the moment is 0, as there is no spin.
double over_moment(Lattice const& lattice, std::size_t site, double number);

/// The gyromagnetic ratio over the moment of each site of the cell, by which noise turns its spins
/// faster; 0 without a spin.
std::vector<double> noise_of_sites(Scene const& scene);
/// The largest of these.
double largest_noise(Scene const& scene);

/// A lattice's cell.
Crystal crystal(Lattice const& lattice);

/// The inertia tensors of a rigid body scene, row by row: one when all bodies share it, otherwise
/// one per body. Throws SceneError naming the body that is not symmetric positive definite.
std::vector<InertiaTensor> inertia(Scene const& scene);

/// Their inverses in the order xx, yy, zz, xy, xz, yz. Throws as inertia does.
std::vector<std::array<double, 6>> inverse_inertia(Scene const& scene);

}  // namespace cayspin::inline v0_1::io
