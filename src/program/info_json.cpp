// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_file.hpp"
#include "info_progress.hpp"
#include "io/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {
namespace {

Json text_or_null(std::string const& text) { return text.empty() ? Json() : Json(text); }

template <class Value>
Json list_or_null(std::vector<Value> const& values) {
  return values.empty() ? Json() : Json(values);
}

void add_lattice(Json& object, std::array<std::int64_t, 3> shape, std::int64_t cell_sites) {
  shape[2] /= cell_sites;
  object["shape"] = shape;
  object["cell_sites"] = cell_sites;
}

void add_scalars(Json& object, std::vector<io::Scalars> const& samples) {
  io::for_each_scalar([&](char const* name, auto member) {
    auto column = Json::array();
    for (auto const& sample : samples) column.push_back(sample.*member);
    object[name] = std::move(column);
  });
}

void add_cost(Json& object, io::RunCost const& cost) {
  bool const has_ended = cost.wall_seconds > 0;
  object["evaluations"] = has_ended ? Json(cost.evaluations) : Json();
  object["wall_seconds"] = has_ended ? Json(cost.wall_seconds) : Json();
  object["step_seconds"] = has_ended ? Json(cost.step_seconds) : Json();
}

// Returns `values`, in which the rows of a table are stored one after another, as a list of rows.
template <class Value>
Json in_rows(std::vector<Value> const& values, std::size_t rows) {
  auto table = Json::array();
  auto const columns = rows == 0 ? 0 : values.size() / rows;
  for (std::size_t row = 0; row < rows; ++row) {
    auto one = Json::array();
    for (std::size_t i = 0; i < columns; ++i) one.push_back(values[row * columns + i]);
    table.push_back(std::move(one));
  }
  return table;
}

Json last_sample_json(io::TrajectoryInfo const& info) {
  if (!info.last_sample) return {};
  auto const& sample = *info.last_sample;
  Json object{{"step", sample.step}, {"time", sample.time}};
  io::for_each_scalar(
      [&](char const* name, auto member) { object[name] = sample.scalars.*member; });
  auto const& more = info.header.more;
  auto next = info.more_of_last_sample.begin();
  auto const take = [&](std::size_t count) {
    std::vector<double> const values(next, next + static_cast<std::ptrdiff_t>(count));
    next += static_cast<std::ptrdiff_t>(count);
    return values;
  };
  bool const has_more = !info.more_of_last_sample.empty();
  auto const regions = has_more ? static_cast<std::size_t>(more.regions) : 0;
  object["region_magnetization"] = regions > 0 ? in_rows(take(3 * regions), regions) : Json();
  object["region_energy"] = list_or_null(take(regions));
  object["term_energy"] = nullptr;
  if (has_more)
    for (auto const& term : more.terms) object["term_energy"][term] = *next++;
  object["shift"] = has_more && more.shift ? Json(static_cast<std::int64_t>(*next)) : Json();
  return object;
}

Json progress_json(io::TrajectoryInfo const& info, std::optional<bool> being_written) {
  if (info.complete) return {};
  auto const progress = progress_of(info, being_written);
  Json object{{"running", or_null(progress.is_running)}, {"idle_seconds", progress.idle}};
  object["step"] = progress.last ? Json(progress.last->step) : Json();
  object["time"] = progress.last ? Json(progress.last->time) : Json();
  object["steps"] = or_null(progress.steps);
  object["seconds"] = or_null(progress.seconds);
  object["updates_per_second"] = or_null(progress.updates_per_second);
  object["seconds_left"] = or_null(progress.seconds_left);
  return object;
}

void add_contents(Json& object, InfoFile const& file, io::TrajectoryInfo const& info) {
  auto const& header = info.header;
  object["kind"] = "trajectory";
  object["format"] = info.format;
  object["complete"] = info.complete;
  object["progress"] = progress_json(info, file.being_written);
  auto const& relaxed = info.cost.relaxed;
  object["torque"] = relaxed ? Json(relaxed->torque) : Json();
  object["converged"] = relaxed ? Json(relaxed->converged) : Json();
  add_lattice(object, header.shape, header.cell_sites);
  object["frames"] = info.frames;
  object["samples"] = info.samples;
  add_units(object, header.units);
  object["step"] = info.frame_steps;
  object["time"] = info.frame_times;
  add_scalars(object, info.frame_scalars);
  object["sublattice_magnetization"] =
      header.cell_sites > 1 ? in_rows(info.frame_sublattices, static_cast<std::size_t>(info.frames))
                            : Json();
  object["shift"] = list_or_null(info.frame_shifts);
  object["stage"] = list_or_null(info.frame_stages);
  object["last_sample"] = last_sample_json(info);
  add_cost(object, info.cost);
  object["precision"] = header.precision;
  object["space"] = header.space;
  object["threads"] = header.threads;
  object["cayspin_version"] = header.cayspin_version;
  object["git_commit"] = header.git_commit;
  object["kokkos_version"] = header.kokkos_version;
  object["scene"] = header.scene_text;
  object["resolved_scene"] = text_or_null(header.resolved_scene);
}

// Returns "SI" or "reduced". The file does not name the units, so they are read from the scene. The
// SI values of the units are left out, because they may differ from run to run.
Json units_of_sweep(InfoFile const& file, io::SweepInfo const& sweep) {
  io::Scene scene;
  scene.path = file.path;
  scene.text = sweep.header.scene_text;
  try {
    return io::with_overrides(scene, {}).units.si ? "SI" : "reduced";
  } catch (std::exception const&) {
    return {};  // a newer version may have written the scene
  }
}

void add_runs(Json& object, io::SweepInfo const& sweep) {
  auto const column = [&](auto const& value_of) {
    auto values = Json::array();
    for (auto const& run : sweep.runs) values.push_back(value_of(run));
    return values;
  };
  // The status of a run that has not ended is null.
  auto const results = [&](auto const& value_of) {
    return column([&](io::SweptRun const& run) {
      return run.status == io::SweptRun::not_run ? Json() : Json(value_of(run));
    });
  };
  auto const last_frame = [&](auto const& value_of) {
    return column(
        [&](io::SweptRun const& run) { return run.has_file ? Json(value_of(run)) : Json(); });
  };
  object["status"] = results([](auto const& run) { return run.status; });
  object["message"] = column([](auto const& run) { return text_or_null(run.message); });
  object["step"] = last_frame([](auto const& run) { return run.step; });
  object["time"] = last_frame([](auto const& run) { return run.time; });
  io::for_each_scalar([&](char const* name, auto member) {
    object[name] = last_frame([member](auto const& run) { return run.scalars.*member; });
  });
  object["evaluations"] = last_frame([](auto const& run) { return run.cost.evaluations; });
  object["wall_seconds"] = last_frame([](auto const& run) { return run.cost.wall_seconds; });
  object["step_seconds"] = last_frame([](auto const& run) { return run.cost.step_seconds; });
}

void add_contents(Json& object, InfoFile const& file, io::SweepInfo const& sweep) {
  auto const& header = sweep.header;
  object["kind"] = "sweep";
  object["complete"] = sweep.complete;
  object["units"] = units_of_sweep(file, sweep);
  object["keys"] = Json::array();
  for (auto const& swept : header.keys) object["keys"].push_back(swept.key);
  object["values"] = Json::array();
  object["parameters"] = Json::object();
  for (std::int64_t run = 0; run < header.runs(); ++run) {
    auto row = Json::array();
    auto const chosen = header.indices(run);
    for (std::size_t key = 0; key < chosen.size(); ++key) {
      auto const& swept = header.keys[key];
      row.push_back(swept.values[chosen[key]]);
      if (!swept.numbers.empty())
        object["parameters"][swept.key].push_back(swept.numbers[chosen[key]]);
    }
    object["values"].push_back(std::move(row));
  }
  add_runs(object, sweep);
  object["precision"] = header.precision;
  object["space"] = header.space;
  object["cayspin_version"] = header.cayspin_version;
  object["git_commit"] = header.git_commit;
  object["scene"] = header.scene_text;
}

Json last_frame_json(io::EnsembleInfo const& info) {
  if (info.frames == 0) return {};
  Json object{{"step", info.step}, {"time", info.time}};
  add_scalars(object, info.last);
  object["sublattice_magnetization"] =
      info.last_sublattices.empty() ? Json() : in_rows(info.last_sublattices, info.last.size());
  auto const of_search = [&](auto member) {
    if (info.relaxed.empty()) return Json();
    auto column = Json::array();
    for (auto const& replica : info.relaxed) column.push_back(replica.*member);
    return column;
  };
  object["torque"] = of_search(&io::RelaxedReplica::torque);
  object["converged"] = of_search(&io::RelaxedReplica::converged);
  object["evaluations"] = of_search(&io::RelaxedReplica::evaluations);
  return object;
}

void add_contents(Json& object, InfoFile const&, io::EnsembleInfo const& info) {
  auto const& header = info.header;
  object["kind"] = "ensemble";
  object["complete"] = info.complete;
  object["replicas"] = info.ensemble.replicas;
  object["vary"] = Json::object();
  for (auto const& [key, values] : info.ensemble.vary) object["vary"][key] = values;
  add_lattice(object, header.shape, header.cell_sites);
  object["frames"] = info.frames;
  object["samples"] = info.samples;
  add_units(object, header.units);
  object["last_frame"] = last_frame_json(info);
  add_cost(object, info.cost);
  object["precision"] = header.precision;
  object["space"] = header.space;
  object["threads"] = header.threads;
  object["written_by"] = header.cayspin_version;
  object["git_commit"] = header.git_commit;
  object["kokkos_version"] = header.kokkos_version;
  object["scene"] = header.scene_text;
}

void add_saddles(Json& object, io::Path const& path) {
  bool const has_saddle = !path.saddles.empty();
  object["torque"] = has_saddle ? Json(path.torque) : Json();
  object["saddle_energy"] = has_saddle ? Json(path.saddles.front().energy) : Json();
  object["barrier_forward"] = has_saddle ? Json(path.barrier_forward()) : Json();
  object["barrier_backward"] = has_saddle ? Json(path.barrier_backward()) : Json();
  object["saddle_curvature"] = has_saddle ? Json(path.saddles.front().curvature) : Json();
  auto const rate = [&](auto member) { return path.rates ? Json((*path.rates).*member) : Json(); };
  object["prefactor_forward"] = rate(&io::RatesOfPath::prefactor_forward);
  object["prefactor_backward"] = rate(&io::RatesOfPath::prefactor_backward);
  object["langer_forward"] = rate(&io::RatesOfPath::langer_forward);
  object["langer_backward"] = rate(&io::RatesOfPath::langer_backward);
  object["zero_modes"] = rate(&io::RatesOfPath::zero_modes);
  object["zero_mode_volumes"] = rate(&io::RatesOfPath::volumes);
  auto const column = [&](auto member) {
    auto values = Json::array();
    for (auto const& saddle : path.saddles) values.push_back(saddle.*member);
    return values;
  };
  object["saddles"] = nullptr;
  if (!has_saddle) return;
  object["saddles"]["energy"] = column(&io::SaddleOfPath::energy);
  object["saddles"]["curvature"] = column(&io::SaddleOfPath::curvature);
  object["saddles"]["next_curvature"] = column(&io::SaddleOfPath::next_curvature);
  object["saddles"]["image"] = column(&io::SaddleOfPath::image);
}

void add_contents(Json& object, InfoFile const&, io::Path const& path) {
  auto const& header = path.header;
  object["kind"] = "path";
  object["converged"] = path.converged;
  object["end"] = path.end;
  object["from"] = path.from;
  object["to"] = path.to;
  add_lattice(object, header.shape, header.cell_sites);
  add_units(object, header.units);
  add_saddles(object, path);
  object["energy"] = path.energy;
  object["distance"] = path.distance;
  object["across"] = path.across;
  object["evaluations"] = path.evaluations;
  object["wall_seconds"] = path.wall_seconds;
  object["precision"] = header.precision;
  object["space"] = header.space;
  object["threads"] = header.threads;
  object["written_by"] = header.cayspin_version;
  object["git_commit"] = header.git_commit;
  object["scene"] = header.scene_text;
}

void add_contents(Json& object, InfoFile const&, io::BandsContents const& found) {
  auto const waves = found.wave_vectors.size();
  auto const by_waves = [&](std::vector<double> const& values) {
    return waves > 0 ? in_rows(values, waves) : Json(values);
  };
  object["kind"] = "modes";
  object["converged"] = found.converged;
  object["torque"] = found.torque;
  add_lattice(object, found.shape, found.cell_sites);
  add_units(object, found.units);
  object["wave_vector"] = list_or_null(found.wave_vectors);
  object["frequency"] = by_waves(found.frequencies);
  object["decay"] = by_waves(found.decays);
  object["residual"] = waves > 0 ? Json() : Json(found.residuals);
  object["curvature"] = list_or_null(found.curvatures);
  object["curvature_error"] = list_or_null(found.curvature_errors);
  object["curvature_residual"] = list_or_null(found.curvature_residuals);
  object["evaluations"] = found.evaluations;
  object["precision"] = found.precision;
  object["space"] = found.space;
  object["cayspin_version"] = found.cayspin_version;
  object["git_commit"] = found.git_commit;
  object["scene"] = found.scene_text;
}

}  // namespace

Json as_json(InfoFile const& file) {
  Json object{{"file", file.path.string()}};
  std::visit([&](auto const& contents) { add_contents(object, file, contents); }, file.contents);
  return object;
}

}  // namespace cayspin::program
