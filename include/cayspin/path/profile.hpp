// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

// The energy along a path, and the positions of its images, computed on the host.
namespace cayspin::inline v0_2::detail {

struct PointOfProfile {
  double distance, energy, slope;
  bool is_fixed;
};

/// Returns weights of the vectors to the states before and after, for the direction of a path.
/// Where the energy rises or falls, only the vector to the higher state counts; at a maximum or
/// minimum both count, weighted by the energy differences, so that the direction does not jump
/// (Henkelman and Jonsson 2000).
inline std::array<double, 2> weights_of_direction(double before, double here, double after) {
  if (before < here && here < after) return {0, 1};
  if (before > here && here > after) return {1, 0};
  auto const [less, more] = std::minmax({std::abs(after - here), std::abs(before - here)});
  if (!(more > 0)) return {1, 1};
  return after > before ? std::array{less, more} : std::array{more, less};
}

/// A point at `fraction` of the way from an image to the next one.
struct PlaceOnPath {
  std::size_t image;
  double fraction;
};

struct Peak {
  PlaceOnPath place;
  double energy, prominence;
};

/// Returns the slopes at the ends of a cubic between two points, limited so that the cubic has no
/// maximum or minimum inside unless the slopes have opposite signs (Fritsch and Carlson 1980).
inline std::array<double, 2> slopes_between(PointOfProfile const& a, PointOfProfile const& b) {
  double const arc = b.distance - a.distance, mean = arc > 0 ? (b.energy - a.energy) / arc : 0;
  if (a.slope * b.slope < 0) return {a.slope, b.slope};
  auto const limited = [mean](double slope) {
    return slope * mean > 0 ? std::copysign(std::min(std::abs(slope), 3 * std::abs(mean)), mean)
                            : 0;
  };
  return {limited(a.slope), limited(b.slope)};
}

/// Returns the maxima of the energy between fixed images, highest first, from cubics between the
/// images. On either side of a maximum, the lowest energy is searched for as far as the first fixed
/// image or the first point higher than the maximum. The prominence is the height of the maximum
/// above the higher of these two lowest energies.
inline std::vector<Peak> peaks_of(std::vector<PointOfProfile> const& points) {
  constexpr std::size_t pieces = 50;
  struct Sample {
    PlaceOnPath place;
    double energy;
    bool is_fixed;
  };
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < points.size(); ++k) {
    samples.push_back({{k, 0}, points[k].energy, points[k].is_fixed});
    if (k + 1 == points.size()) break;
    auto const &a = points[k], &b = points[k + 1];
    double const arc = b.distance - a.distance;
    auto const [first, last] = slopes_between(a, b);
    for (std::size_t piece = 1; piece < pieces; ++piece) {
      double const s = static_cast<double>(piece) / pieces, u = 1 - s;
      samples.push_back({{k, s},
                         u * u * (1 + 2 * s) * a.energy + s * s * (3 - 2 * s) * b.energy +
                             s * u * arc * (u * first - s * last),
                         false});
    }
  }
  std::vector<Peak> peaks;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    double const here = samples[i].energy;
    if (samples[i].is_fixed || samples[i - 1].energy >= here || samples[i + 1].energy > here)
      continue;
    auto const lowest = [&](int way) {
      double least = here;
      for (auto j = static_cast<std::ptrdiff_t>(i) + way;
           j >= 0 && j < static_cast<std::ptrdiff_t>(samples.size()); j += way) {
        auto const& sample = samples[static_cast<std::size_t>(j)];
        if (sample.energy > here) break;
        least = std::min(least, sample.energy);
        if (sample.is_fixed) break;
      }
      return least;
    };
    peaks.push_back({samples[i].place, here, here - std::max(lowest(-1), lowest(1))});
  }
  std::ranges::sort(peaks, std::greater<>(), &Peak::energy);
  return peaks;
}

/// Returns which images the fixed nodes of a path should become, so that all images are about
/// equally spaced. `fixed`: indices of these nodes. `arcs`: distances between successive nodes.
inline std::vector<std::size_t> places_of(std::vector<std::size_t> const& fixed,
                                          std::vector<double> const& arcs, std::size_t images) {
  double total = 0;
  for (double const arc : arcs) total += arc;
  std::vector<std::size_t> places;
  double at = 0;
  std::size_t node = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    for (; node < fixed[i]; ++node) at += arcs[node];
    double const wanted = total > 0 ? at / total * static_cast<double>(images - 1) : 0;
    auto const least = i == 0 ? 0 : places.back() + 1;
    auto const most = images - (fixed.size() - i);
    places.push_back(std::clamp(static_cast<std::size_t>(std::llround(wanted)), least, most));
  }
  places.back() = images - 1;
  return places;
}

/// Returns where an image is among the nodes, if the nodes `fixed` become the images `places` and
/// the other images are spaced evenly between these.
inline PlaceOnPath point_of_image(std::size_t image, std::vector<std::size_t> const& fixed,
                                  std::vector<std::size_t> const& places,
                                  std::vector<double> const& arcs) {
  std::size_t part = 0;
  while (part + 2 < places.size() && places[part + 1] <= image) ++part;
  double length = 0;
  for (std::size_t node = fixed[part]; node < fixed[part + 1]; ++node) length += arcs[node];
  double rest = length * static_cast<double>(image - places[part]) /
                static_cast<double>(places[part + 1] - places[part]);
  std::size_t node = fixed[part];
  while (node + 1 < fixed[part + 1] && rest > arcs[node]) rest -= arcs[node++];
  return {node, arcs[node] > 0 ? std::min(1.0, rest / arcs[node]) : 0};
}

}  // namespace cayspin::inline v0_2::detail
