// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/refused_pairs.hpp"

#include "io/scene.hpp"
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::string_view method_key = "integrator.method",
                           another_method = "another method, such as \"heun\", \"rkmk4\", \"dp5\"",
                           isotropy_key = "integrator.isotropy",
                           no_isotropy = "\"zero\", { constant = sigma }",
                           control_key = "integrator.energy_control";

bool has_torque(Scene const& scene) { return io::has_torque(scene.field); }
bool has_demag(Scene const& scene, std::string_view key) {
  return scene.field.demag && scene.field.demag->key == key;
}
bool has_sources(Scene const& scene) { return !scene.field.sources.empty(); }
bool depends_on_time(Scene const& scene) { return io::depends_on_time(scene.field); }
bool changes_in_time(Scene const& scene) { return scene.field.in_time.there(); }
bool is_nonlinear(Scene const& scene) { return !has_linear_field(scene); }
bool moves_by_sites(Scene const& scene) {
  return scene.system.dampings.there() || scene.lattice.frozen.there();
}
bool has_dampings(Scene const& scene) { return scene.system.dampings.there(); }

bool all_equal(std::vector<double> const& numbers, double to) {
  return std::ranges::all_of(numbers, [&](double number) { return number == to; });
}
bool turns_by_sites(Scene const& scene) {
  auto const& ratios = scene.lattice.gyromagnetic;
  return scene.lattice.gyromagnetic_of_sites.there() ||
         (!ratios.empty() && !all_equal(ratios, ratios[0]));
}
bool has_moments(Scene const& scene) {
  auto const& lattice = scene.lattice;
  return lattice.moments_of_sites.there() || lattice.gyromagnetic_of_sites.there() ||
         !all_equal(lattice.moments, 1) || !all_equal(lattice.gyromagnetic, 1);
}

bool by_two_colours(Scene const& scene) { return scene.integrator.method->by_colour; }
bool by_series(Scene const& scene) { return scene.integrator.method->differentiates_field; }
bool by_analytic(Scene const& scene) { return scene.integrator.isotropy == Isotropy::analytic; }
bool by_control(Scene const& scene) { return scene.integrator.energy_control; }
bool until_torque(Scene const& scene) { return scene.integrator.until_torque.has_value(); }

constexpr std::string_view
    nonlinear =
        "cubic and hexagonal axes, second constants, biquadratic bonds, interlayers, torques",
    own_numbers = "damping or frozen spins of sites",
    moments = "moments and gyromagnetic ratios other than 1";

constexpr std::string_view neighbors_alone = "method \"{}\" needs a field of the neighbours only";

constexpr RefusedPair pairs[] = {
    {"a program's own nonlocal field", "red_black2, red_black4", neighbors_alone, "field",
     "no nonlocal field, or another method",
     [](Scene const& scene) { return bool{scene.field.own.nonlocal}; }, by_two_colours},
    {"demag", "red_black2, red_black4", neighbors_alone, "field.demag",
     "no such key, or another method", [](Scene const& scene) { return has_demag(scene, "demag"); },
     by_two_colours},
    {"dipoles", "red_black2, red_black4", neighbors_alone, "field.dipoles",
     "no such key, or another method",
     [](Scene const& scene) { return has_demag(scene, "dipoles"); }, by_two_colours},
    {"slab_demag on the host", "red_black2, red_black4", neighbors_alone, "field.slab_demag",
     "no where = \"host\", or another method",
     [](Scene const& scene) { return is_nonlocal(scene.field); }, by_two_colours},
    {"couplings, cubic axes, torques, vacancies, values per site, in_time",
     "red_black2, red_black4",
     "\"{}\" needs a field of the neighbours only: it moves spins while their neighbours stay, and "
     "these terms are evaluated for all spins beforehand",
     method_key, another_method, needs_pass, by_two_colours},
    {nonlinear, "series4, series4_paper",
     "\"{}\" differentiates the field, which cubic and hexagonal axes, second constants of "
     "axes, biquadratic bonds, "
     "interlayers and torques make nonlinear in the spins",
     method_key, another_method, is_nonlinear, by_series},
    {own_numbers, "series4, series4_paper",
     "\"{}\" does not go with damping per site or frozen spins: it differentiates the motion with "
     "one damping for all spins",
     method_key, another_method, moves_by_sites, by_series},
    {"gyromagnetic ratios that differ", "series4, series4_paper",
     "\"{}\" does not go with gyromagnetic ratios that differ: it differentiates the field with "
     "one gyromagnetic ratio for all spins",
     method_key, another_method, turns_by_sites, by_series},
    {"sources", "series4, series4_paper",
     "\"{}\" does not go with field.sources: it differentiates the field with one applied field "
     "for all spins",
     method_key, another_method, has_sources, by_series},
    {"a field that depends on t", "series4, series4_paper",
     "\"{}\" refuses fields that depend on t", method_key,
     "a method without derivatives, or numbers in place of expressions in t", depends_on_time,
     by_series},
    {nonlinear, "isotropy analytic",
     "\"analytic\" does not go with cubic and hexagonal axes, second constants of axes, biquadratic "
     "bonds, interlayers and torques: "
     "it needs a field that is linear in the spins",
     isotropy_key, no_isotropy, is_nonlinear, by_analytic},
    {"sources", "isotropy analytic",
     "\"analytic\" does not go with sources: it needs one applied field for all spins",
     isotropy_key, no_isotropy, has_sources, by_analytic},
    {"constants that change in time", "isotropy analytic",
     "\"analytic\" does not go with field.in_time: it needs constant terms", isotropy_key,
     no_isotropy, changes_in_time, by_analytic},
    {"gyromagnetic ratios that differ", "isotropy analytic",
     "\"analytic\" does not go with gyromagnetic ratios that differ", isotropy_key, no_isotropy,
     turns_by_sites, by_analytic},
    {"torques", "energy_control",
     "does not go with a spin torque: a current does work on the spins", control_key, "no such key",
     has_torque, by_control},
    {"damping of sites", "energy_control", "does not go with damping", control_key, "no such key",
     has_dampings, by_control},
    {moments, "energy_control",
     "does not go with moments and gyromagnetic ratios other than 1: the field is not the "
     "derivative of the energy",
     control_key, "no such key", has_moments, by_control},
    {"a field that depends on t", "energy_control", "needs a field without t", control_key,
     "no such key", depends_on_time, by_control},
    {"torques", "until_torque", "a current can keep spins in motion", "integrator.until_torque",
     "no such key", has_torque, until_torque},
};

}  // namespace

std::span<RefusedPair const> refused_pairs() { return pairs; }

namespace detail {

void check_pairs(Scene const& scene) {
  for (auto const& pair : pairs)
    if (pair.has_terms(scene) && pair.has_other(scene))
      refuse(scene, pair.key, fmt::format(fmt::runtime(pair.why), scene.integrator.method->word),
             pair.accepted);
}

}  // namespace detail
}  // namespace cayspin::inline v0_2::io
