// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "choice.hpp"

#include <fmt/format.h>

namespace cayspin::program::extremity {

std::string Choice::method() const {
  auto const& key = entry->key;
  std::string name(io::to_string(key.method));
  if (key.isotropy != io::Isotropy::zero) name += fmt::format(" {}", io::to_string(key.isotropy));
  if (key.tangent) name += " tangent";
  if (key.compensated) name += " compensated";
  if (key.rigid_body) name += " (rigid body)";
  return name;
}

std::string Choice::variant() const {
  if (is_baseline() || entry->key.tangent) return "";
  return fmt::format("{} {}", io::to_string(generator), io::to_string(rotation));
}

std::string Choice::toml() const {
  auto const method = fmt::format("method = \"{}\"\ncompensated = {}\n",
                                  io::to_string(entry->key.method), entry->key.compensated);
  if (is_baseline()) return method;
  return fmt::format("{}generator = \"{}\"\nisotropy = \"{}\"\nrotation = \"{}\"\n", method,
                     io::to_string(generator), io::to_string(entry->key.isotropy),
                     io::to_string(rotation));
}

namespace {

std::vector<Choice> choices_of(bool adaptive) {
  using enum io::Generator;
  std::vector<Choice> choices;
  for (auto const& entry : method_entries()) {
    if (io::is_adaptive(entry.key.method) != adaptive) continue;
    std::vector<io::Generator> generators{standard, orthogonal};
    if (io::is_baseline(entry.key.method) || io::is_red_black(entry.key.method))
      generators = {standard};
    if (entry.key.tangent) generators = {tangent};
    for (auto const generator : generators) {
      choices.push_back({&entry, generator,
                         io::needs_exponential(entry.key.method) ? io::Rotation::exponential
                                                                 : io::Rotation::cayley});
      if (entry.exponential) choices.push_back({&entry, generator, io::Rotation::exponential});
    }
  }
  return choices;
}

}  // namespace

std::vector<Choice> fixed_step_choices() { return choices_of(false); }
std::vector<Choice> adaptive_choices() { return choices_of(true); }

}  // namespace cayspin::program::extremity
