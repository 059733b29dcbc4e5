// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/scene.hpp"
#include "sections.hpp"
#include "values_of_sites.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::string_view axes[] = {"x", "y", "z"};
constexpr Word<int> axis_words[] = {{axes[0], 0}, {axes[1], 1}, {axes[2], 2}};

// Returns true if values change along the axis. read(box) returns the numbers of a box's sites, the
// same count for each site.
template <class Read>
bool differs_along(Lattice const& lattice, std::size_t axis, Read const& read) {
  auto const& shape = lattice.shape;
  auto const of_plane = static_cast<std::size_t>(shape[0] * shape[1]);
  std::vector<double> first;
  bool differs = false;
  for_each_box_of_planes(shape, sizeof(double), [&](SiteBox const& box) {
    auto const values = read(box);
    auto const sites = of_plane * static_cast<std::size_t>(box.extent[2]);
    auto const count = values.size() / sites;
    if (first.empty())
      first.assign(values.begin(), values.begin() + std::ptrdiff_t(of_plane * count));
    for (std::size_t site = 0; site < sites; ++site) {
      auto const nx = static_cast<std::size_t>(shape[0]), in_plane = site % of_plane;
      auto const like = axis == 0   ? site - site % nx
                        : axis == 1 ? site - in_plane + site % nx
                                    : in_plane;
      auto const& from = axis == 2 ? first : values;
      for (std::size_t c = 0; c < count; ++c)
        differs = differs || values[count * site + c] != from[count * like + c];
    }
  });
  return differs;
}

}  // namespace

namespace detail {

void read_follow(Table const& root, Scene& scene) {
  auto const item = root.table("lattice", "a table [lattice]").find("follow");
  if (!item) return;
  if (!item->node->is_table()) item->wrong_type("{ axis = \"x\", quantity = \"mz\", value = 0 }");
  Table const table(*item, scene);
  table.accept_only({"axis", "quantity", "value"});
  auto const axis_item = table.required("axis", "\"x\", \"y\", \"z\"");
  auto const quantity = table.required("quantity", all_words<Followed>());
  Follow follow{.axis = word_among<int>(axis_words, axis_item),
                .quantity = word<Followed>(quantity)};
  auto const& lattice = scene.lattice;
  auto const name = axes[follow.axis];
  bool const by_charge = follow.quantity == Followed::charge;
  if (auto const value = table.find("value")) {
    if (by_charge)
      value->fail("has no meaning for the charge, which stays in the middle", "no such key");
    follow.value = number(*value, {"a number from -1 to 1", -1, 1});
  }
  if (by_charge && (follow.axis == 2 || lattice.shape[0] < 2 || lattice.shape[1] < 2))
    axis_item.fail("the charge is that of planes along x and y",
                   "\"x\" or \"y\", with cells along both");
  if (follow.axis == 2 && lattice.basis.size() > 1)
    axis_item.fail("\"z\" does not go with several sites in a cell", "\"x\", \"y\"");
  if (lattice.shape[follow.axis] < 2)
    axis_item.fail(fmt::format("the lattice has only one cell along {}", name),
                   "an axis with several cells");
  if (lattice.boundary[follow.axis] == BoundaryKind::periodic)
    axis_item.fail(fmt::format("the lattice is periodic along {}, and nothing comes in", name),
                   "an axis with open ends");
  scene.lattice.follow = follow;
}

}  // namespace detail

void require_alike_where_followed(Scene const& scene) {
  auto const& lattice = scene.lattice;
  if (!lattice.follow) return;
  auto const axis = static_cast<std::size_t>(lattice.follow->axis);
  auto const require = [&](std::string_view key, auto const& read) {
    if (!differs_along(lattice, axis, read)) return;
    detail::refuse(
        scene, "lattice.follow",
        fmt::format("{} differs along {}, along which lattice.follow moves the lattice", key,
                    axes[axis]),
        fmt::format("values per site that are the same along {}, or no such key", axes[axis]));
  };
  auto const check = [&](SiteNumbers const& numbers, std::string_view key) {
    if (numbers.there())
      require(numbers.key_or(key),
              [&](SiteBox const& box) { return numbers_of_sites(scene, numbers, key, box); });
  };
  auto const check_vectors = [&](SiteVectors const& vectors, std::string_view key) {
    if (vectors.there())
      require(vectors.key_or(key),
              [&](SiteBox const& box) { return vectors_of_sites(scene, vectors, key, box); });
  };
  detail::for_each_value_of_sites(scene, check, check_vectors);
}

}  // namespace cayspin::inline v0_2::io
