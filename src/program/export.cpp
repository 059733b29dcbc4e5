// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "io/ovf.hpp"
#include "io/relax.hpp"
#include "io/trajectory.hpp"
#include "simulation/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <numeric>

namespace cayspin::program {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  fs::path file, folder;
  std::optional<io::OvfFormat> format;  // default: the binary format in the precision of /spins
  std::string frames = "last";          // or "all", or a frame counted from 0; -1: the last
  bool overwrite = false;
};

io::OvfFormat ovf_format(std::string const& name) {
  if (auto const* const known = io::find_word<io::OvfFormat>(name)) return known->value;
  throw UsageError(fmt::format("--format {}: accepted: text, binary4, binary8", name));
}

std::vector<std::int64_t> chosen_frames(ExportOptions const& options, std::int64_t frames) {
  if (frames == 0)
    throw std::runtime_error(fmt::format("{}: it holds no frame", options.file.string()));
  auto const& text = options.frames;
  if (text == "last") return {frames - 1};
  if (text == "all") {
    std::vector<std::int64_t> all(static_cast<std::size_t>(frames));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::int64_t number = 0;
  auto const [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || stop != text.data() + text.size() || number < -frames ||
      number >= frames)
    throw UsageError(fmt::format(
        "--frames {}: accepted: last, all, {} from the end of {}", text,
        frames == 1 ? "0, or -1" : fmt::format("0 to {}, or -1 to -{}", frames - 1, frames),
        options.file.string()));
  return {number < 0 ? frames + number : number};
}

bool is_rectangular(io::Lattice const& lattice) {
  if (lattice.basis.size() > 1) return false;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t c = 0; c < 3; ++c)
      if (a == c ? lattice.cell[a][c] <= 0 : lattice.cell[a][c] != 0) return false;
  return true;
}

// Returns a mesh with a node at the center of each cell of the lattice. The scene is read without
// its start and without values per site, because a program that ran it may have passed these from
// memory.
io::OvfMesh mesh_of(io::TrajectoryInfo const& info) {
  auto const scene = io::parse_scene_to_run_or_relax(info.header.scene_text, info.path,
                                                     {"initial={uniform=[0,0,1]}"},
                                                     io::without_numbers(info.header.scene_text));
  if (!is_rectangular(scene.lattice))
    throw std::runtime_error(fmt::format(
        "{}: its sites do not form a rectangular mesh, as OVF requires; accepted: a file of a "
        "lattice of one site per cell, with cells along x, y and z",
        info.path.string()));
  io::OvfMesh mesh;
  mesh.nodes = info.header.shape;
  if (scene.units.si) mesh.unit = "m";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mesh.step[axis] =
        scene.lattice.cell[axis][axis] * scene.lattice.spacing[axis] * scene.units.length;
    mesh.base[axis] = mesh.step[axis] / 2;
  }
  return mesh;
}

io::OvfField ovf_field_of(io::TrajectoryInfo const& info, io::OvfMesh const& mesh,
                          std::int64_t frame) {
  auto const number = static_cast<std::size_t>(frame);
  io::OvfField field;
  field.title = "m";
  field.description = {info.cost.relaxed
                           ? fmt::format("Equilibrium: {}", info.frame_steps[number])
                           : fmt::format("Total simulation time: {}{}", info.frame_times[number],
                                         info.header.units.si ? " s" : ""),
                       fmt::format("Step: {}", info.frame_steps[number]),
                       fmt::format("Frame: {} of {}", frame, info.path.filename().string()),
                       fmt::format("Written by cayspin {}", info.header.cayspin_version)};
  field.mesh = mesh;
  field.values = io::read_spins(info.path, info.header.shape, frame);
  return field;
}

fs::path name_of(ExportOptions const& options, std::int64_t frame) {
  return options.folder / fmt::format("{}_{:06}.ovf", options.file.stem().string(), frame);
}

void require_free_names(ExportOptions const& options, std::vector<std::int64_t> const& frames) {
  std::error_code ignored;
  for (auto const frame : frames) {
    auto const path = name_of(options, frame);
    require_not_written(options.file, path, "another folder for --ovf");
    if (!options.overwrite && fs::exists(path, ignored))
      throw std::runtime_error(fmt::format(
          "{}: it exists (choose another folder, or overwrite with --overwrite)", path.string()));
  }
}

void create_folder(fs::path const& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw std::runtime_error(fmt::format("{}: cannot create the folder: {}", folder.string(),
                                         error ? error.message() : std::string("it is a file")));
}

int export_ovf(ExportOptions const& options) {
#if defined(SIGXFSZ)
  std::signal(SIGXFSZ, SIG_IGN);  // makes a write past the file size limit an error
#endif
  auto const info = io::read_info(options.file);
  auto const frames = chosen_frames(options, info.frames);
  auto const mesh = mesh_of(info);
  auto const bits =
      info.header.precision == "single" ? io::OvfFormat::binary4 : io::OvfFormat::binary8;
  auto const format = options.format.value_or(bits);
  require_free_names(options, frames);
  create_folder(options.folder);
  for (auto const frame : frames)
    io::write_ovf(name_of(options, frame), ovf_field_of(info, mesh, frame), format,
                  options.overwrite);
  auto const last = name_of(options, frames.back()).string();
  if (frames.size() == 1)
    fmt::print("{}\n", last);
  else
    fmt::print("{} to {}: {} files\n", name_of(options, frames.front()).string(), last,
               frames.size());
  return Status::done;
}

}  // namespace

Command add_export(CLI::App& program) {
  auto const options = std::make_shared<ExportOptions>();
  auto* const command =
      program.add_subcommand("export", "Write frames of a trajectory file for other programs");
  command->add_option("FILE", options->file, "Trajectory file (HDF5)")->required();
  command->add_option("--ovf", options->folder, "Folder for OVF 2.0 files, one per frame")
      ->required()
      ->type_name("DIR");
  command
      ->add_option_function<std::string>(
          "--format", [options](std::string const& name) { options->format = ovf_format(name); },
          "text, binary4 or binary8 (default: the binary one that keeps the bits)")
      ->type_name("NAME");
  command->add_option("--frames", options->frames,
                      "last (default), all or a number; from the end: -1");
  command->add_flag("--overwrite", options->overwrite, "Replace files that exist");
  return {command, [options](Ranks&) { return export_ovf(*options); }};
}

}  // namespace cayspin::program
