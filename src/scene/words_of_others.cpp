// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/words_of_others.hpp"

#include "io/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace cayspin::inline v0_2::io {
namespace {

struct ForeignWord {
  std::string_view of_others, here;
};

// Lower-case words of mumax3 and mumax+, OOMMF and Ubermag, Spirit, Vampire, UppASD, Sunny.
constexpr std::array foreign_words{
    ForeignWord{"msat", "material.Ms"},
    ForeignWord{"aex", "material.A"},
    ForeignWord{"dind", "material.D"},
    ForeignWord{"dbulk", "material.D_bulk"},
    ForeignWord{"ku1", "material.Ku"},
    ForeignWord{"kc1", "field.anisotropy = { cubic = K, axes = [..] }"},
    ForeignWord{"anisu", "material.axis"},
    ForeignWord{"anisc1", "field.anisotropy = { cubic = K, axes = [..] }"},
    ForeignWord{"b_ext", "field.applied"},
    ForeignWord{"bext", "field.applied"},
    ForeignWord{"external_field", "field.applied"},
    ForeignWord{"external_field_magnitude", "field.applied"},
    ForeignWord{"applied_field", "field.applied"},
    ForeignWord{"zeeman", "field.applied"},
    ForeignWord{"enabledemag", "field.demag"},
    ForeignWord{"demagnetization", "field.demag"},
    ForeignWord{"ddi_method", "field.dipoles"},
    ForeignWord{"pbc", "lattice.boundary"},
    ForeignWord{"setpbc", "lattice.boundary"},
    ForeignWord{"boundary_conditions", "lattice.boundary"},
    ForeignWord{"cellsize", "lattice.spacing"},
    ForeignWord{"lattice_constant", "lattice.spacing"},
    ForeignWord{"gridsize", "lattice.shape"},
    ForeignWord{"n_basis_cells", "lattice.shape"},
    ForeignWord{"ncell", "lattice.shape"},
    ForeignWord{"setgeom", "lattice.occupied"},
    ForeignWord{"geometry", "lattice.occupied"},
    ForeignWord{"defregion", "lattice.regions"},
    ForeignWord{"bravais_lattice", "lattice.crystal"},
    ForeignWord{"posfile", "lattice.basis"},
    ForeignWord{"momfile", "lattice.moments"},
    ForeignWord{"mu_spin", "material.mu_s"},
    ForeignWord{"atomic-spin-moment", "material.mu_s"},
    ForeignWord{"maxerr", "integrator.tolerance"},
    ForeignWord{"fixdt", "integrator.dt"},
    ForeignWord{"timestep", "integrator.dt"},
    ForeignWord{"time-step", "integrator.dt"},
    ForeignWord{"llg_dt", "integrator.dt"},
    ForeignWord{"llg_n_iterations", "integrator.steps"},
    ForeignWord{"nstep", "integrator.steps"},
    ForeignWord{"solver", "integrator.method"},
    ForeignWord{"setsolver", "integrator.method"},
    ForeignWord{"alpha", "system.damping, in SI material.alpha"},
    ForeignWord{"lambda", "system.damping"},
    ForeignWord{"lambda1", "system.damping"},
    ForeignWord{"llg_damping", "system.damping"},
    ForeignWord{"gammall", "material.gamma"},
    ForeignWord{"xi", "torque.zhang_li.nonadiabaticity"},
    ForeignWord{"llg_beta", "torque.zhang_li.nonadiabaticity"},
    ForeignWord{"pol", "torque.slonczewski.efficiency or torque.zhang_li.polarization"},
    ForeignWord{"fixedlayer", "torque.slonczewski.polarization"},
    ForeignWord{"temp", "thermal.temperature"},
    ForeignWord{"llg_temperature", "thermal.temperature"},
    ForeignWord{"thermseed", "thermal.seed"},
    ForeignWord{"llg_seed", "thermal.seed"},
    ForeignWord{"exchange-matrix", "field.couplings"},
    ForeignWord{"jij", "field.couplings"},
    ForeignWord{"n_shells_exchange", "field.couplings = { shells = [..] }"},
    ForeignWord{"interaction_pairs_file", "field.couplings"},
    ForeignWord{"n_interaction_pairs", "field.couplings"},
    ForeignWord{"pairs", "field.couplings"},
    ForeignWord{"jfile", "field.couplings"},
    ForeignWord{"dmfile", "field.couplings, each bond with its D"},
    ForeignWord{"unit-cell-file", "field.couplings = { file = \"NAME.ucf\" }"},
    ForeignWord{"autosave", "output.every"},
    ForeignWord{"tableautosave", "output.scalars_every"},
    ForeignWord{"dear", "multirate"},
    ForeignWord{"rk45", "dp5"},
    ForeignWord{"rkf54", "dp5"},
    ForeignWord{"rk23", "bs3"},
    ForeignWord{"rk4", "rkmk4 or projected_rk4"},
    ForeignWord{"rk56", "projected_rk64"},
    ForeignWord{"depondt", "heun or rkmk4"},
    ForeignWord{"sib", "implicit_midpoint"},
    ForeignWord{"llg-heun", "projected_heun"},
    ForeignWord{"llg-midpoint", "implicit_midpoint"},
    ForeignWord{"minimize", "cayspin relax"},
    ForeignWord{"minimise", "cayspin relax"},
    ForeignWord{"regrid", "initial.file, of a lattice of the same shape"}};

template <class Section>
bool has_key(std::string_view word) {
  return std::ranges::any_of(Section::keys(), [&](auto const& key) { return key.name == word; });
}

// Returns the table that has a key of this name.
std::string_view table_of(std::string_view word) {
  constexpr std::array of_lattice{"shape", "spacing", "boundary", "occupied", "regions"};
  constexpr std::array of_field{"exchange", "anisotropy", "dmi", "applied", "demag", "couplings"};
  if (has_key<Integrator>(word)) return "integrator";
  if (has_key<Output>(word)) return "output";
  if (has_key<Thermal>(word)) return "thermal";
  if (std::ranges::find(of_lattice, word) != of_lattice.end()) return "lattice";
  if (std::ranges::find(of_field, word) != of_field.end()) return "field";
  if (word == "damping" || word == "precession") return "system";
  return {};
}

}  // namespace

std::string hint_for_other_table(std::string_view key) {
  auto const table = table_of(key);
  return table.empty() ? std::string() : fmt::format(", did you mean \"{}.{}\"?", table, key);
}

std::string hint_for_word_of_others(std::string_view word) {
  // Vampire writes material[1]:exchange-matrix[2].
  if (auto const colon = word.find(':'); colon != word.npos) word.remove_prefix(colon + 1);
  word = word.substr(0, word.find('['));
  std::string lower(word);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  auto const* const found = std::ranges::find(foreign_words, lower, &ForeignWord::of_others);
  return found == foreign_words.end() ? std::string() : fmt::format(", here it is {}", found->here);
}

}  // namespace cayspin::inline v0_2::io
