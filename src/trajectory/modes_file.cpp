// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "io/modes.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"

#include <cstddef>
#include <span>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr int modes_format_version = 1;

/// Sorts the planes of a crystal by site. Consecutive planes of `values` hold the sites of a cell
/// in turn.
std::vector<double> by_sites_of_cell(std::span<double const> values, std::size_t planes,
                                     std::size_t cell_sites) {
  std::size_t const plane = values.size() / planes;
  std::vector<double> ordered;
  ordered.reserve(values.size());
  for (std::size_t site = 0; site < cell_sites; ++site)
    for (std::size_t z = site; z < planes; z += cell_sites)
      ordered.insert(ordered.end(), values.begin() + static_cast<std::ptrdiff_t>(z * plane),
                     values.begin() + static_cast<std::ptrdiff_t>((z + 1) * plane));
  return ordered;
}

class Writer {
 public:
  Writer(hid_t file, ModesContents const& contents, fs::path const& path)
      : file_(file), contents_(contents), path_(path) {}

  void write_state() const {
    write_attributes();
    write_sites("spins", contents_.spins, {3});
  }
  void write_modes() const {
    write_state();
    write_numbers("frequency", contents_.frequencies);
    write_numbers("decay", contents_.decays);
    write_numbers("residual", contents_.residuals);
    write_vectors("mode", contents_.shapes, {3, 2});
    if (contents_.curvatures.empty()) return;
    write_numbers("curvature", contents_.curvatures);
    write_numbers("curvature_error", contents_.curvature_errors);
    write_numbers("curvature_residual", contents_.curvature_residuals);
    write_vectors("curvature_vector", contents_.curvature_vectors, {3});
  }
  void write_bands(std::vector<std::array<double, 3>> const& wave_vectors) const {
    write_state();
    hsize_t const waves = wave_vectors.size(), branches = contents_.frequencies.size() / waves;
    auto const write = [&](char const* name, Extents const& extents, void const* values) {
      write_dataset(file_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, extents, values, path_);
    };
    write("wave_vector", {waves, 3}, wave_vectors.data());
    write("frequency", {waves, branches}, contents_.frequencies.data());
    write("decay", {waves, branches}, contents_.decays.data());
  }

 private:
  void write_attributes() const {
    RootAttributes const attributes(file_, path_);
    attributes.create("cayspin_modes_format", std::int64_t{modes_format_version});
    attributes.create("scene", contents_.scene_text);
    attributes.create("cayspin_version", contents_.cayspin_version);
    attributes.create("git_commit", contents_.git_commit);
    attributes.create("precision", contents_.precision);
    attributes.create("space", contents_.space);
    attributes.create("units", std::string(contents_.units.si ? si_units : reduced_units));
    if (contents_.units.si)
      for (auto const& [name, member] : unit_attributes)
        attributes.create(name, contents_.units.*member);
    attributes.create("torque", contents_.torque);
    attributes.create("evaluations", contents_.evaluations);
    attributes.create("converged", std::int64_t{contents_.converged ? 1 : 0});
  }

  void write_numbers(char const* name, std::vector<double> const& values) const {
    write_dataset(file_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {values.size()}, values.data(),
                  path_);
  }

  void write_vectors(char const* name, std::vector<std::vector<double>> const& vectors,
                     Extents const& of_site) const {
    auto extents = extents_of_sites(of_site);
    extents.insert(extents.begin(), vectors.size());
    auto const dataset = create_dataset(file_, name, H5T_IEEE_F64LE, extents, path_);
    Extents begin(extents.size());
    extents[0] = 1;
    for (auto const& vector : vectors) {
      auto const ordered = in_order(vector);
      write_block(dataset.get(), H5T_NATIVE_DOUBLE, begin, extents, ordered.data(), path_);
      ++begin[0];
    }
  }
  void write_sites(char const* name, std::vector<double> const& values,
                   Extents const& of_site) const {
    write_dataset(file_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, extents_of_sites(of_site),
                  in_order(values).data(), path_);
  }

  std::vector<double> in_order(std::vector<double> const& values) const {
    return by_sites_of_cell(values, static_cast<std::size_t>(contents_.shape[2]),
                            static_cast<std::size_t>(contents_.cell_sites));
  }
  Extents extents_of_sites(Extents const& of_site) const {
    auto const& [nx, ny, nz] = contents_.shape;
    Extents extents;
    if (contents_.cell_sites > 1) extents.push_back(static_cast<hsize_t>(contents_.cell_sites));
    for (auto const extent : {nz / contents_.cell_sites, ny, nx})
      extents.push_back(static_cast<hsize_t>(extent));
    extents.insert(extents.end(), of_site.begin(), of_site.end());
    return extents;
  }

  hid_t file_;
  ModesContents const& contents_;
  fs::path const& path_;
};

std::uint64_t room_for(ModesContents const& contents) {
  std::size_t numbers = contents.spins.size() + 5 * contents.frequencies.size();
  for (auto const& shape : contents.shapes) numbers += shape.size() + 3;
  for (auto const& vector : contents.curvature_vectors) numbers += vector.size() + 3;
  return (1 << 20) + contents.scene_text.size() + numbers * sizeof(double);
}

template <class Write>
void write_file(fs::path const& path, ModesContents const& contents, bool overwrite,
                Write const& write) {
  QuietErrors const quiet;
  NewFile file(path, overwrite);
  OpenFileSpace space(file.get(), path);
  space.reserve(room_for(contents), path);
  write(Writer(file.get(), contents, path));
  check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), path, "cannot write the file");
  space.trim();
  auto handle = file.commit();
  check(handle.close(), path, "cannot close the file");
}

}  // namespace

void write_modes(fs::path const& path, ModesContents const& contents, bool overwrite) {
  write_file(path, contents, overwrite, [](Writer const& writer) { writer.write_modes(); });
}

void write_bands(fs::path const& path, BandsContents const& contents, bool overwrite) {
  write_file(path, contents, overwrite,
             [&](Writer const& writer) { writer.write_bands(contents.wave_vectors); });
}

}  // namespace cayspin::inline v0_2::io
