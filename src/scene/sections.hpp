// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "reader.hpp"

namespace cayspin::inline v0_1::io::detail {

/// Throws scene_error with what is accepted.
[[noreturn]] void refuse(Scene const& scene, std::string_view key, std::string_view wrong,
                         std::string_view accepted);
/// What std::runtime_error says of `work` becomes the scene_error of a key.
template <class Work>
auto for_key(Scene const& scene, std::string_view key, Work const& work) {
  try {
    return work();
  } catch (std::runtime_error const& error) {
    throw scene_error(scene, key, error.what());
  }
}

/// Is it units = "SI"? The sections then hold what is typed until convert_to_reduced.
bool read_is_si(Table const& root);
/// After the lattice; the sections after it are read with the material known.
void read_material(Table const& root, Scene& scene);
/// Refuses what [material] says, and what is of atoms in a continuum.
void check_si(Scene const& scene);
/// Turns the scene, of which all sections have been read, into reduced units.
void convert_to_reduced(Scene& scene);

/// A table that rigid bodies do not have, where it is typed.
std::optional<Table> table_of_spins(Table const& root, std::string_view name, SystemKind kind);
System read_system(Table const& root);
/// Where spins are, and where they do not move: after the lattice.
void read_occupied(Table const& root, Scene& scene);
/// Those that differ from site to site: after the lattice.
void read_dampings(Table const& root, Scene& scene);
/// A rigid body takes neither spacing nor boundary, and one extent.
Lattice read_lattice(Table const& root, SystemKind kind);
/// The keys of [lattice] that say what is in a cell. Where the cell is that of a unit-cell file,
/// this is read.
void read_crystal(Table const& root, Table const& lattice_table, Lattice& lattice);
/// After the lattice, which the scene has by then.
Field read_field(Table const& root, SystemKind kind);
void read_couplings(Item const& item, Scene& scene, Field& field);
Torque read_torque(Table const& root, SystemKind kind);
Initial read_initial(Table const& root);
Integrator read_integrator(Table const& root, SystemKind kind);
std::optional<Thermal> read_thermal(Table const& root, SystemKind kind);
/// Opens the files with numbers of sites.
void check_site_numbers(Scene const& scene);
/// Refuses a lattice without a spin.
void require_occupied(Scene const& scene);
/// Refuses terms that need neighbours along the axes of a lattice in a crystal that has none.
void check_crystal(Scene const& scene);
/// Refuses the pairs of refused_pairs.hpp.
void check_pairs(Scene const& scene);
/// Refuses what does not go with a temperature above 0.
void check_thermal(Scene const& scene);
Output read_output(Table const& root, std::int64_t steps);

/// Puts "key.path=VALUE" into the table. Missing tables are created; a whole number in the path is
/// an index into an array. Throws SceneError.
void apply_override(toml::table& root, std::string const& assignment);

/// Why a tensor is refused, or nothing when it is symmetric to `tolerance` times its largest entry
/// and positive definite.
std::optional<std::string> inertia_fault(InertiaTensor const& tensor, double tolerance);

}  // namespace cayspin::inline v0_1::io::detail
