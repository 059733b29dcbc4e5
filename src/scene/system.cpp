// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace cayspin::inline v0_2::io::detail {
namespace {

constexpr std::string_view inertia_accepted =
    "three principal moments, a symmetric 3x3 array, or { file = \"...\" }";

std::variant<PrincipalMoments, InertiaTensor, InertiaFile> read_inertia(Item const& item,
                                                                        Scene& scene) {
  if (item.node->is_table()) {
    Table const table(item, scene);
    table.accept_only({"file"});
    return InertiaFile{input_file(table, "file")};
  }
  auto const rows = entries(item, 3, 3, inertia_accepted);
  if (!rows[0].node->is_array()) {
    PrincipalMoments moments;
    std::ranges::transform(rows, moments.begin(), positive_number);
    return moments;
  }
  InertiaTensor tensor;
  for (std::size_t row = 0; row < 3; ++row) {
    auto const numbers = triple(rows[row]);
    std::ranges::copy(numbers, tensor.begin() + 3 * static_cast<std::ptrdiff_t>(row));
  }
  constexpr double tolerance = 16 * std::numeric_limits<double>::epsilon();
  if (auto const fault = inertia_fault(tensor, tolerance)) item.fail(*fault, inertia_accepted);
  return tensor;
}

void refuse_key(Table const& table, std::string_view name, std::string_view kind) {
  if (auto const item = table.find(name)) {
    item->fail(fmt::format("has no meaning for kind = \"{}\"", kind), "no such key");
  }
}

}  // namespace

std::optional<Table> table_of_spins(Table const& root, std::string_view name, SystemKind kind) {
  auto const found = root.find(name);
  if (!found) return std::nullopt;
  if (kind == SystemKind::rigid_body)
    found->fail("has no meaning for kind = \"rigid_body\"", "no such table");
  return Table(*found, root.scene());
}

System read_system(Table const& root) {
  auto const table = root.table("system", "a table [system]");
  table.accept_only({"kind", "damping", "precession", "inertia"});
  System system;
  system.kind = word<SystemKind>(table.required("kind", all_words<SystemKind>()));
  if (system.kind == SystemKind::llg) {
    refuse_key(table, "inertia", "llg");
    if (!table.scene().units.si) {
      auto const item = table.required("damping", not_negative_or_of_sites.accepted);
      if (!item.node->is_string() && !item.node->is_table())
        system.damping = number(item, not_negative_or_of_sites);
    } else if (auto const item = table.find("damping")) {
      item->fail("belongs to reduced units", "material.alpha with material.damping_form");
    }
    if (auto const item = table.find("precession")) system.precession = boolean(*item);
  } else {
    refuse_key(table, "damping", "rigid_body");
    refuse_key(table, "precession", "rigid_body");
    system.inertia = read_inertia(table.required("inertia", inertia_accepted), table.scene());
  }
  return system;
}

void read_dampings(Table const& root, Scene& scene) {
  auto const item = root.table("system", "a table [system]").find("damping");
  if (item && scene.system.kind == SystemKind::llg)
    read_site_numbers(*item, scene, scene.system.dampings);
}

}  // namespace cayspin::inline v0_2::io::detail
