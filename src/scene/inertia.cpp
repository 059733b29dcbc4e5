// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5/guarded_reading.hpp"
#include "hdf5/real_dataset.hpp"
#include "io/scene.hpp"
#include "sections.hpp"
#include "start_file.hpp"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

Eigen::Matrix3d symmetric_part(InertiaTensor const& tensor) {
  Eigen::Map<Eigen::Matrix3d const> const matrix(tensor.data());
  return matrix / 2 + matrix.transpose() / 2;
}

Eigen::Matrix3d inverse(InertiaTensor const& tensor) {
  return symmetric_part(tensor).llt().solve(Eigen::Matrix3d::Identity());
}

// Opens dataset /inertia, which must be (count, 3, 3). Throws std::runtime_error with one line.
RealDataset open_inertia(std::filesystem::path const& path, std::int64_t count) {
  RealDataset inertia(path, "/inertia");
  if (inertia.extents() != Extents{static_cast<hsize_t>(count), 3, 3})
    inertia.refuse_extents(fmt::format("({}, 3, 3)", count));
  return inertia;
}

std::vector<InertiaTensor> read_file(Scene const& scene, std::filesystem::path const& path) {
  constexpr std::string_view key = "system.inertia.file";
  std::vector<InertiaTensor> tensors(static_cast<std::size_t>(sites(scene)));
  auto const read = [&] {
    auto const dataset = open_inertia(path, sites(scene));
    return std::pair(dataset.read(), dataset.epsilon());
  };
  auto const [values, epsilon] =
      detail::for_key(scene, key, [&] { return read_guarded(path, read); });
  for (std::size_t body = 0; body < tensors.size(); ++body) {
    std::copy_n(values.data() + 9 * body, 9, tensors[body].begin());
    if (auto const fault = detail::inertia_fault(tensors[body], 16 * epsilon))
      throw scene_error(scene, key, fmt::format("{}: body {}: {}", path.string(), body, *fault));
  }
  return tensors;
}

}  // namespace

std::optional<std::string> detail::inertia_fault(InertiaTensor const& tensor, double tolerance) {
  Eigen::Map<Eigen::Matrix3d const> const matrix(tensor.data());
  if (!matrix.allFinite()) return "the tensor is not finite";
  double const largest = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > tolerance * largest) {
    return "the tensor is not symmetric";
  }
  bool const positive = symmetric_part(tensor).llt().info() == Eigen::Success;
  if (!positive || !inverse(tensor).allFinite()) return "the tensor is not positive definite";
  return std::nullopt;
}

namespace {

void check_files_of_one(Scene const& scene) {
  if (auto const* const start = std::get_if<FileStart>(&scene.initial))
    detail::for_key(scene, "initial.file",
                    [&] { detail::check_start_file(start->path, scene.lattice); });
  couplings(scene);
  detail::require_occupied(scene);
  detail::check_site_numbers(scene);
  auto const* const file = std::get_if<InertiaFile>(&scene.system.inertia);
  if (scene.system.kind == SystemKind::rigid_body && file != nullptr)
    detail::for_key(scene, "system.inertia.file", [&] {
      try_reading(file->path, [&] { open_inertia(file->path, sites(scene)); });
    });
}

}  // namespace

void check_files(Scene const& scene) {
  check_files_of_one(scene);
  // Refuses numbers that are not regions, even if no term of this scene depends on regions: those
  // of a later stage may. All stages have the same regions.
  if (scene.lattice.regions.there()) region_count(scene);
  for (auto const& stage : scene.stages) check_files_of_one(stage.scene);
}

std::vector<InertiaTensor> inertia(Scene const& scene) {
  auto const& given = scene.system.inertia;
  if (auto const* const file = std::get_if<InertiaFile>(&given))
    return read_file(scene, file->path);
  if (auto const* const tensor = std::get_if<InertiaTensor>(&given)) return {*tensor};
  auto const& moments = std::get<PrincipalMoments>(given);
  return {{moments[0], 0, 0, 0, moments[1], 0, 0, 0, moments[2]}};
}

std::vector<std::array<double, 6>> inverse_inertia(Scene const& scene) {
  if (auto const* const moments = std::get_if<PrincipalMoments>(&scene.system.inertia)) {
    return {{1 / (*moments)[0], 1 / (*moments)[1], 1 / (*moments)[2], 0, 0, 0}};
  }
  auto const tensors = inertia(scene);
  std::vector<std::array<double, 6>> inverses(tensors.size());
  std::ranges::transform(tensors, inverses.begin(), [](InertiaTensor const& tensor) {
    Eigen::Matrix3d const m = inverse(tensor);
    return std::array<double, 6>{m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  });
  return inverses;
}

}  // namespace cayspin::inline v0_2::io
