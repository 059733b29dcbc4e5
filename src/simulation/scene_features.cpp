// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Collects a scene's time-dependent vectors for time_features.hpp.
#include "applied_field.hpp"
#include "failure.hpp"
#include "io/scene.hpp"
#include "time_features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <mutex>
#include <regex>
#include <system_error>
#include <utility>

namespace cayspin::simulation {
namespace {

using Components = std::array<io::AppliedComponent, 3>;

// Returns the numbers in the expressions, and the sums and differences of pairs of the first 16.
// Any of these may be a time at which something switches. In SI, times in expressions are in s; the
// result is in reduced units.
std::vector<double> events_of(Components const& components, double time_unit) {
  static std::regex const number(R"((\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)");
  constexpr std::size_t most_paired = 16;
  std::vector<double> numbers;
  for (auto const& component : components)
    if (auto const* const text = std::get_if<std::string>(&component))
      for (auto at = std::sregex_iterator(text->begin(), text->end(), number);
           at != std::sregex_iterator(); ++at) {
        double value = 0;
        auto const typed = at->str();  // read with a decimal point, whatever the locale
        if (std::from_chars(typed.data(), typed.data() + typed.size(), value).ec == std::errc())
          numbers.push_back(value / time_unit);
      }
  auto events = numbers;
  auto const paired = std::min(numbers.size(), most_paired);
  for (std::size_t i = 0; i < paired; ++i)
    for (std::size_t k = 0; k < i; ++k) {
      events.push_back(numbers[i] + numbers[k]);
      events.push_back(std::abs(numbers[i] - numbers[k]));
    }
  std::ranges::sort(events);
  events.erase(std::ranges::unique(events).begin(), events.end());
  return events;
}

TimeDependent vector_of(AppliedField const& field, std::string key, std::vector<double> events) {
  auto const value = [field](double t, double* three) {
    try {
      auto const h = field(t);
      three[0] = h.x, three[1] = h.y, three[2] = h.z;
    } catch (NumbersFailed const&) {
      std::fill_n(three, 3, std::numeric_limits<double>::quiet_NaN());
    }
  };
  return {std::move(key), value, std::move(events)};
}

std::vector<TimeDependent> vectors_of(io::Scene const& scene) {
  std::vector<TimeDependent> vectors;
  auto const add = [&](AppliedField const& field, char const* key, Components const& components) {
    if (field.depends_on_time())
      vectors.push_back(vector_of(field, key, events_of(components, scene.units.time)));
  };
  auto const& field = scene.field;
  add(AppliedField(field), "field.applied", field.applied.value_or(Components{}));
  for (auto const& source : field.sources) {
    constexpr auto key = "field.sources";
    Components const time{source.time, 0.0, 0.0};
    add(AppliedField(time, key), key, time);
  }
  for (auto const& [key, factor] : {std::pair{"field.in_time.exchange", field.in_time.exchange},
                                    {"field.in_time.anisotropy", field.in_time.anisotropy},
                                    {"field.in_time.dmi", field.in_time.dmi}}) {
    Components const factors{factor, 0.0, 0.0};
    add(AppliedField(factors, key), key, factors);
  }
  if (auto const& of = field.torque.zhang_li) {
    constexpr auto key = "torque.zhang_li.velocity";
    add(AppliedField(of->velocity, key), key, of->velocity);
  }
  if (auto const& of = field.torque.slonczewski) {
    constexpr auto key = "torque.slonczewski";
    Components const strengths{of->damping_like, of->field_like, 0.0};
    add(AppliedField(strengths, key), key, strengths);
  }
  return vectors;
}

std::string text_of(Components const& components) {
  std::string text;
  for (auto const& component : components)
    text += std::holds_alternative<std::string>(component)
                ? std::get<std::string>(component) + "\n"
                : fmt::format("{}\n", std::get<double>(component));
  return text;
}

std::string text_of(io::Field const& field) {
  std::string text = fmt::format("{}\n", field.mu0);
  if (field.applied) text += text_of(*field.applied);
  for (auto const& source : field.sources) text += "s\n" + text_of({source.time, 0.0, 0.0});
  if (field.in_time.there()) text += "f\n" + text_of(field.in_time.components());
  if (auto const& of = field.torque.zhang_li) text += "u\n" + text_of(of->velocity);
  if (auto const& of = field.torque.slonczewski)
    text += "a b\n" + text_of({of->damping_like, of->field_like, 0.0});
  return text;
}

// Cache of the last few results, since a scene is planned more than once.
class Known {
 public:
  std::shared_ptr<TimeFeatures const> find(std::string const& key) {
    std::lock_guard const lock(mutex_);
    for (auto const& [known, features] : all_)
      if (known == key) return features;
    return nullptr;
  }
  void add(std::string const& key, std::shared_ptr<TimeFeatures const> features) {
    std::lock_guard const lock(mutex_);
    all_.emplace_front(key, std::move(features));
    if (all_.size() > most) all_.pop_back();
  }

 private:
  static constexpr std::size_t most = 8;
  std::mutex mutex_;
  std::deque<std::pair<std::string, std::shared_ptr<TimeFeatures const>>> all_;
};

// Returns false if a vector is not finite at one of 101 times. make_plan throws for such vectors.
bool are_finite(std::vector<TimeDependent> const& vectors, FeatureSearch const& search) {
  constexpr int times = 100;
  double three[3];
  for (auto const& vector : vectors)
    for (int i = 0; i <= times; ++i) {
      vector.value(search.begin + (search.end - search.begin) * i / times, three);
      if (!std::isfinite(three[0] + three[1] + three[2])) return false;
    }
  return true;
}

FeatureSearch search_of(io::Scene const& scene, std::optional<double> error) {
  auto const& integrator = scene.integrator;
  FeatureSearch search;
  search.begin = scene.begin.time;
  search.end = search.begin + integrator.dt * static_cast<double>(integrator.steps);
  // All errors of at least 1e-6 give the same angle, so that a run and trials at other tolerances
  // see the same features.
  search.angle = std::clamp(0.01 * error.value_or(1e-6), 1e-10, 1e-8);
  if (scene.field.own.uniform) {  // a call may take long
    search.samples = 1 << 12;
    search.most_evaluations = 100'000;
  } else if (!error) {
    search.samples = std::clamp<std::int64_t>(1024 * std::min<std::int64_t>(integrator.steps, 1024),
                                              1 << 14, search.samples);
  }
  return search;
}

}  // namespace

std::shared_ptr<TimeFeatures const> features_of(io::Scene const& scene,
                                                std::optional<double> error) {
  static Known known;
  if (scene.system.kind != io::SystemKind::llg || scene.integrator.steps == 0 ||
      !io::depends_on_time(scene.field))
    return std::make_shared<TimeFeatures>();
  auto const search = search_of(scene, error);
  bool const is_own = static_cast<bool>(scene.field.own.uniform);
  auto const key = fmt::format("{}{} {} {} {}", text_of(scene.field), search.begin, search.end,
                               search.angle, search.samples);
  if (auto features = is_own ? nullptr : known.find(key)) return features;
  auto const vectors = vectors_of(scene);
  if (!are_finite(vectors, search)) return std::make_shared<TimeFeatures>();
  auto features = std::make_shared<TimeFeatures const>(find_features(vectors, search));
  if (!is_own) known.add(key, features);
  return features;
}

}  // namespace cayspin::simulation
