// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

namespace cayspin::inline v0_2::io::detail {

/// Throws scene_error with the message "WRONG; accepted: ACCEPTED".
[[noreturn]] void refuse(Scene const& scene, std::string_view key, std::string_view wrong,
                         std::string_view accepted);
/// Converts a std::runtime_error from `work` into the scene_error of a key.
template <class Work>
auto for_key(Scene const& scene, std::string_view key, Work const& work) {
  try {
    return work();
  } catch (std::runtime_error const& error) {
    throw scene_error(scene, key, error.what());
  }
}

/// Returns true for units = "SI". The sections then hold typed values until convert_to_reduced.
bool read_is_si(Table const& root);
/// Reads [material]. Call it after reading the lattice and before the other sections.
void read_material(Table const& root, Scene& scene);
/// Refuses keys that do not go with the material: lattice.moments, because [material] has the
/// moments; keys of crystals and bonds in a continuum; and slab_demag if the sites of a cell may
/// have different moments.
void check_si(Scene const& scene);
/// Converts a completely read scene to reduced units.
void convert_to_reduced(Scene& scene);

/// Returns the table `name` if the scene has it; refuses it for rigid bodies.
std::optional<Table> table_of_spins(Table const& root, std::string_view name, SystemKind kind);
System read_system(Table const& root);
/// Reads regions, occupied and frozen sites, and site-dependent moments and gyromagnetic ratios.
/// Call it after reading the lattice.
void read_occupied(Table const& root, Scene& scene);
/// Reads lattice.follow. Call it after reading the lattice.
void read_follow(Table const& root, Scene& scene);
/// Reads site-dependent dampings. Call it after reading the lattice.
void read_dampings(Table const& root, Scene& scene);
/// Reads the lattice. For rigid bodies, `shape` has one extent and other keys are refused.
Lattice read_lattice(Table const& root, SystemKind kind);
/// Reads the cell of a crystal and the numbers of its sites from [lattice]. Without keys for the
/// cell, takes it from the unit-cell file if the scene has one.
void read_crystal(Table const& root, Table const& lattice_table, Lattice& lattice);
/// Reads the field. Call it after reading the lattice into the scene.
Field read_field(Table const& root, SystemKind kind);
void read_anisotropies(Item const& item, Scene& scene, Field& field);
void read_couplings(Item const& item, Scene& scene, Field& field);
/// Reads demag and dipoles. Call it after reading slab_demag.
void read_demag(Table const& field_table, Scene& scene, Field& field);
Torque read_torque(Table const& root, SystemKind kind);
/// Returns true if the text is an expression in t, or a constant one.
bool is_in_time(std::string const& text);
Initial read_initial(Table const& root);
Integrator read_integrator(Table const& root, SystemKind kind);
std::optional<Thermal> read_thermal(Table const& root, SystemKind kind);
/// Returns "site (i, j, k)" for site number `number` of a box.
std::string site_text(SiteBox const& box, std::size_t number);
/// Opens the files with site-dependent numbers and vectors, and checks types and shapes.
void check_site_numbers(Scene const& scene);
void check_site_vectors(Scene const& scene, SiteVectors const& vectors, std::string_view key);
/// Converts uniform constants into site-dependent numbers, for terms that are evaluated only with
/// such numbers. Also sets the exchange constants that interlayers and exchange_between need.
void use_numbers_of_sites(Scene& scene);
/// Refuses keys of [field.in_time] for terms that the scene does not have, or that must be
/// constant.
void check_in_time(Table const& root);
/// Refuses a lattice without a spin.
void require_occupied(Scene const& scene);
/// Returns true if a cell has several sites, or if its vectors are not along the axes with the
/// lengths of the spacing.
bool is_crystal(Lattice const& lattice);
/// In a crystal, refuses terms that need neighbours along x, y and z, because its sites may have
/// none there.
void check_crystal(Scene const& scene);
/// Refuses the pairs of refused_pairs.hpp.
void check_pairs(Scene const& scene);
/// Refuses combinations that do not work at a temperature above 0.
void check_thermal(Scene const& scene);
Ensemble read_ensemble(Table const& root);
/// Refuses keys that do not go with an ensemble, and varied values that are wrong in the first or
/// the last replica, or in one with the least or the largest value of a key.
void check_ensemble(Scene const& scene, bool relaxes);
/// `integrator`: as typed, in the units of the scene.
Output read_output(Table const& root, Integrator const& integrator);
/// Returns a time as a number of steps of dt. Refuses a negative time, and one that is not a whole
/// number of steps.
std::int64_t whole_steps(Item const& time, double dt);

/// Applies "key.path=VALUE" to the table. Creates missing tables; an integer in the path is an
/// index into an array. Throws SceneError.
void apply_override(toml::table& root, std::string const& assignment);

/// Returns why a tensor is refused; nothing if it is finite, positive definite, and symmetric to
/// within `tolerance` times its largest entry.
std::optional<std::string> inertia_fault(InertiaTensor const& tensor, double tolerance);

}  // namespace cayspin::inline v0_2::io::detail
