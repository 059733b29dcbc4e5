// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "variant.hpp"

#include "io/scene.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cayspin::simulation {
namespace {

template <int... Shard>
std::vector<Variant> all_shards(std::integer_sequence<int, Shard...>) {
  std::vector<Variant> all;
  for (auto const& some : {method_shard<Shard>()...})
    all.insert(all.end(), some.begin(), some.end());
  std::ranges::stable_sort(all, {}, [](Variant const& variant) {
    return std::ranges::find(io::methods(), variant.method);
  });
  return all;
}

}  // namespace

std::span<Variant const> variants() {
  static auto const all = all_shards(std::make_integer_sequence<int, CAYSPIN_METHOD_SHARDS>{});
  return all;
}

Variant const& find_variant(io::Scene const& scene) {
  auto const& integrator = scene.integrator;
  auto const isotropy =
      integrator.isotropy == io::Isotropy::constant ? io::Isotropy::zero : integrator.isotropy;
  auto const is_it = [&](Variant const& variant) {
    return variant.method == integrator.method && variant.isotropy == isotropy &&
           variant.in_chart == (integrator.generator == io::Generator::tangent) &&
           variant.compensated == integrator.compensated;
  };
  // Rigid bodies use their own variant of a method if there is one; otherwise that of spins.
  bool const bodies = scene.system.kind == io::SystemKind::rigid_body;
  Variant const* found = nullptr;
  for (auto const& variant : variants())
    if (is_it(variant) && (!found || variant.of_rigid_bodies == bodies)) found = &variant;
  if (!found)
    throw std::logic_error("no variant of the method " + std::string(integrator.method->word));
  return *found;
}

}  // namespace cayspin::simulation
