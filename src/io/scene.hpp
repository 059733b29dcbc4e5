// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble.hpp"
#include "io/field.hpp"
#include "io/given.hpp"
#include "io/initial.hpp"
#include "io/integrator.hpp"
#include "io/key.hpp"
#include "io/lattice.hpp"
#include "io/material.hpp"
#include "io/output.hpp"
#include "io/site_box.hpp"
#include "io/site_numbers.hpp"
#include "io/stage.hpp"
#include "io/system.hpp"
#include "io/thermal.hpp"
#include "io/units.hpp"

#include <cayspin/coupling.hpp>
#include <cayspin/crystal.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// A scene file as plain data. docs/reference/scene.md describes every key.
namespace cayspin::inline v0_2::io {

/// Error in a scene. what() is one line: `FILE:LINE: key: what is wrong; accepted: ...`, or `--set
/// key=value: key: ...` when an override is to blame.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Stage;

/// A scene: a member for each table, and where each key was typed. Numbers are in reduced units,
/// even if the scene is typed in SI, unless a comment says otherwise.
struct Scene {
  Units units;
  /// The next three are set only for units = "SI". Their numbers are in SI: t in s, velocities in
  /// m/s, strengths in T.
  std::optional<Material> material;
  std::optional<std::array<AppliedComponent, 3>> applied_in_tesla;
  Torque torque_in_si;
  System system;
  Lattice lattice;
  Field field;
  Initial initial;
  Integrator integrator;
  std::optional<Thermal> thermal;
  Output output;
  Ensemble ensemble;
  std::optional<Columns> columns;
  std::string text;            ///< the TOML text; re-serialised if changed, as by an override
  std::filesystem::path path;  ///< the scene file, or the name of a text without one
  std::vector<std::filesystem::path> files;  ///< input files named in its own tables, not in stages
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

/// A table [[stage]]. Its scene has the changes of this stage and of all earlier ones.
struct Stage {
  std::string name;                 ///< or empty
  std::optional<StageRelax> relax;  ///< if set, the stage takes no steps
  Scene scene;                      ///< without nested stages
};

/// Reads and validates a scene. Each override is "key.path=VALUE" with a TOML value, applied in
/// order. Opens no file that the scene names, except a unit-cell file that defines the cell;
/// functions such as check_files, initial_spins, couplings and inertia open the others. Throws
/// SceneError.
Scene read_scene(std::filesystem::path const& path, std::vector<std::string> const& overrides = {},
                 Given given = {});

/// Parses a text in memory, such as that of a trajectory file. Messages call it `name`; file names
/// in it are relative to the folder of `name`.
Scene parse_scene(std::string text, std::filesystem::path const& name,
                  std::vector<std::string> const& overrides = {}, Given given = {});

/// Returns the scene with more overrides, which its text then contains. Later errors give the
/// places of keys in `scene`, not the overrides, because the author of the scene has not typed
/// these. Throws SceneError.
Scene with_overrides(Scene const& scene, std::vector<std::string> const& overrides);

/// Returns a table of a scene's text as the override "NAME={...}" for another scene.
std::string as_override(std::string const& scene_text, std::string const& name);

/// Refuses contradictory combinations of method, generator, isotropy, rotation, system, lattice and
/// field, like read_scene. Throws SceneError.
void check_combination(Scene const& scene);

/// Returns the one-line error "FILE:LINE: key: message" for a fault that is found after the scene
/// has been read, such as a shape that does not fit in memory.
SceneError scene_error(Scene const& scene, std::string_view key, std::string_view message);

/// Returns the number of spins, or of rigid bodies.
std::int64_t sites(Scene const& scene);

/// Opens every file that the scene reads, and checks the types and shapes of datasets. Checks
/// values only in a unit-cell file, of regions, and where they decide which sites have a spin: a
/// lattice without any spin is refused. Throws SceneError.
void check_files(Scene const& scene);

/// Returns the initial spins on the host, sites x 3, normalised in double: component c of site (i,
/// j, k) is at ((k*ny + j)*nx + i)*3 + c. A site without a spin has the zero vector. Throws
/// SceneError if a spin is zero or not finite.
std::vector<double> initial_spins(Scene const& scene);

/// Returns the initial spins of the sites in a box, in the same order. Reads an OVF file
/// completely.
std::vector<double> initial_spins(Scene const& scene, SiteBox const& box);

/// Returns the bonds of a scene, each once: those typed or made from shells, or those of its
/// unit-cell file. Throws SceneError.
std::vector<Coupling> couplings(Scene const& scene);

/// Return 1 for each site that has a spin (occupied) or is frozen (frozen), and 0 for each other
/// site, in the order of initial_spins. Return an empty vector if no key decides that: all sites
/// are occupied, or none is frozen. Throw SceneError.
std::vector<unsigned char> occupied(Scene const& scene, SiteBox const& box);
std::vector<unsigned char> frozen(Scene const& scene, SiteBox const& box);

/// Returns site-dependent moments as the scene gives them (0: no spin); empty if moments are
/// uniform or given for the sites of a cell. Throws SceneError for a negative one.
std::vector<double> moments_of_sites(Scene const& scene, SiteBox const& box);

/// Returns the moment of each site, however the scene gives moments; 0 where there is no spin.
/// If empty, all are 1.
std::vector<double> all_moments(Scene const& scene, SiteBox const& box);
/// Returns site-dependent gyromagnetic ratios; empty if they are uniform or given for the sites of
/// a cell. Throws SceneError for one that is not positive.
std::vector<double> gyromagnetic_of_sites(Scene const& scene, SiteBox const& box);

/// Returns the region of each site, in the order of initial_spins. Throws SceneError for a number
/// that is negative, not whole or too large.
std::vector<std::int64_t> regions(Scene const& scene, SiteBox const& box);

/// Returns the number of regions: one more than the largest region number.
std::int64_t region_count(Scene const& scene);

/// Refuses site-dependent numbers that vary along the axis of lattice.follow. Throws SceneError.
void require_alike_where_followed(Scene const& scene);

/// Returns one number for each site, in the order of initial_spins. `key`: the scene's key for
/// these numbers, which messages name. Throws SceneError.
std::vector<double> numbers_of_sites(Scene const& scene, SiteNumbers const& numbers,
                                     std::string_view key, SiteBox const& box);

/// Returns three numbers for each site, sites x 3 in the order of initial_spins. Throws SceneError.
std::vector<double> vectors_of_sites(Scene const& scene, SiteVectors const& vectors,
                                     std::string_view key, SiteBox const& box);

/// Returns vectors_of_sites, normalised; refuses the zero vector where there is a spin.
std::vector<double> directions_of_sites(Scene const& scene, SiteVectors const& vectors,
                                        std::string_view key, SiteBox const& box);

/// Returns both axes of each site, each as sites x 3, orthonormal where there is a spin. If both
/// are uniform, returns those of only one site. Throws SceneError.
std::array<std::vector<double>, 2> crystal_axes(Scene const& scene, CrystalAnisotropy const& term,
                                                SiteBox const& box);

/// Reads all site-dependent axes, normals and polarizations of the field and the torques, some
/// planes at a time. Throws SceneError for a site where one has no direction, or where two axes of
/// an anisotropy are not at right angles.
void require_directions(Scene const& scene);

/// For each site of a box, returns its region and the region of the next site along an axis, which
/// may be outside the box. Past an open end, both are the site's own region.
std::vector<std::array<std::int64_t, 2>> regions_of_bonds(Scene const& scene, SiteBox const& box,
                                                          std::size_t axis);

/// For each site of a box, returns its region and the region of the site `reach` further along an
/// axis, or back if `reach` is negative. Returns (-1, -1) if one of the two sites has no spin, if a
/// site between them has one, past an open end, and if |reach| is not below the lattice's extent.
std::vector<std::array<std::int64_t, 2>> regions_across(Scene const& scene, SiteBox const& box,
                                                        std::size_t axis, std::int64_t reach);

/// For each site of a box, returns the value that `numbers` has at the site `reach` further along
/// an axis, or back if `reach` is negative; 0 past an open end. |reach| must be below the extent of
/// the lattice along that axis.
std::vector<double> numbers_across(Scene const& scene, SiteNumbers const& numbers,
                                   std::string_view key, SiteBox const& box, std::size_t axis,
                                   std::int64_t reach);

/// Returns the longest `reach` of interlayers with a range above 0, or 0.
std::int64_t reach_of_interlayers(Scene const& scene);

/// Returns true if H needs a separate pass over the sites, for terms and lattices that few scenes
/// have.
bool needs_pass(Scene const& scene);

/// Returns true if moments are stored for each site of the lattice rather than of a cell: if
/// lattice.moments is site-dependent; also if the sites of the cell have moments and there are
/// point dipoles, whose field depends on moments rather than unit spins.
bool has_moments_of_sites(Scene const& scene);

/// Returns true if sites may have no spin: with lattice.occupied, with a moment of 0, and with
/// site-dependent moments that are not given by regions.
bool has_vacancies(Scene const& scene);

/// Returns true if H is linear in the spins, apart from the applied field. Returns false for a file
/// of couplings, because some of them may be biquadratic.
bool has_linear_field(Scene const& scene);

/// Returns numbers[site], a number of a site of the cell; 1 if `numbers` is empty.
double of_cell_site(std::vector<double> const& numbers, std::size_t site);

/// Returns number / moment for a site of the cell; 0 where the moment is 0 (no spin).
double over_moment(Lattice const& lattice, std::size_t site, double number);

/// Returns gyromagnetic ratio / moment for each site of the cell, which scales the thermal noise; 0
/// without a spin.
std::vector<double> noise_of_cell_sites(Scene const& scene);
/// Returns true if the damping, temperature, moment or gyromagnetic ratio is site-dependent.
bool has_noise_of_sites(Scene const& scene);
/// Returns gyromagnetic ratio / moment for each site, multiplied by the damping if that is
/// site-dependent, and by the temperature if that is; 0 where no spin moves. In Gilbert's form with
/// site-dependent damping, it is also divided by 1 + damping^2. Throws SceneError for a negative
/// damping or temperature.
std::vector<double> noise_of_sites(Scene const& scene, SiteBox const& box);
/// Returns the largest number of noise_of_sites if has_noise_of_sites, otherwise of
/// noise_of_cell_sites.
double largest_noise(Scene const& scene);
/// Refuses a dt for which heat * dt is above 1: the noise of one step would erase all memory of a
/// spin's direction. `heat`: the largest damping * temperature * gyromagnetic ratio / moment of a
/// site. Throws SceneError.
void require_moderate_noise(Scene const& scene, double heat);

/// Returns a lattice's cell, with the sites in it.
Crystal crystal(Lattice const& lattice);

/// Returns the inertia tensors of a rigid body scene, row by row: one when all bodies share it,
/// otherwise one per body. Throws SceneError naming a body whose tensor is not symmetric positive
/// definite.
std::vector<InertiaTensor> inertia(Scene const& scene);

/// Returns the inverse tensors in the order xx, yy, zz, xy, xz, yz. Throws like inertia.
std::vector<std::array<double, 6>> inverse_inertia(Scene const& scene);

}  // namespace cayspin::inline v0_2::io
