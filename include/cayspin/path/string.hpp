// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>
#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/path/great_circles.hpp>
#include <cayspin/path/image_energy.hpp>
#include <cayspin/path/pairs.hpp>
#include <cayspin/path/profile.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// A string of images between two states. Each step is a preconditioned L-BFGS step across the path
/// for all images together. The images are then spaced evenly along the path again (the simplified
/// string method of E, Ren and Vanden-Eijnden 2007, with the directions of Henkelman and Jonsson
/// 2000). Fixed images (the ends, and known saddles and minima) do not move.
template <class Spins>
class PathString {
  using Real = typename Spins::value_type;
  using Mobile = ScalarField<Real, typename Spins::memory_space>;
  static constexpr std::size_t pairs = path_pairs;
  using Products = ProductsOfPath<Real>;

 public:
  /// Number of fields per image, in addition to its spins.
  static constexpr int fields_per_image = 3 + 2 * (static_cast<int>(pairs) + 1);

  explicit PathString(std::vector<Spins> const& images) {
    auto const& lattice = images.front().lattice();
    for (auto const& spins : images)
      images_.push_back({spins, Spins("path::trial", lattice), Spins("path::across", lattice),
                         Spins("path::direction", lattice),
                         numbered_fields<Spins, pairs + 1>("path::step", lattice),
                         numbered_fields<Spins, pairs + 1>("path::change", lattice)});
    scratch_ = {Spins("path::scratch_1", lattice), Spins("path::scratch_2", lattice)};
  }

  std::size_t size() const { return images_.size(); }
  Spins const& spins(std::size_t image) const { return images_[image].spins; }
  bool is_fixed(std::size_t image) const { return images_[image].is_fixed; }
  double energy(std::size_t image) const { return images_[image].energy.value; }
  double across(std::size_t image) const { return images_[image].largest_across; }
  double square(std::size_t image) const { return is_fixed(image) ? 0 : images_[image].squares[2]; }
  std::int64_t evaluations() const { return evaluations_; }

  void fix(std::size_t image, Energy const& energy) {
    images_[image].is_fixed = true;
    images_[image].energy = energy;
    images_[image].slope = images_[image].largest_across = 0;
  }

  /// Returns the energy along the path at the last evaluation.
  std::vector<PointOfProfile> profile() const {
    std::vector<PointOfProfile> points;
    double distance = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      points.push_back({distance, energy(k), images_[k].slope, is_fixed(k)});
      if (k < arcs_.size()) distance += arcs_[k];
    }
    return points;
  }

  /// Evaluates the images that are not fixed. Returns the largest gradient across the path; NaN if
  /// an energy or a gradient is not finite.
  template <class Exec, class Field>
  double look(Exec const& exec, Field const& field, double time) {
    for (auto& image : images_) {
      if (image.is_fixed) continue;
      image.energy = look_at_image(exec, field, time, image.spins, image.changes[count_]).energy;
      ++evaluations_;
    }
    measure_arcs(exec, [this](std::size_t k) -> Spins const& { return spins(k); });
    double largest = 0;
    for (std::size_t k = 1; k + 1 < size(); ++k) {
      auto& image = images_[k];
      if (image.is_fixed) continue;
      auto const [before, after] = weights_of_direction(energy(k - 1), energy(k), energy(k + 1));
      auto const [square, slope] =
          find_direction(exec, image.spins, spins(k - 1), spins(k + 1), image.changes[count_],
                         before, after, image.direction);
      image.per_square = square > 0 ? 1 / square : 0;
      image.slope = slope * std::sqrt(image.per_square);
      auto const& change = image.changes[count_];
      image.squares = reduce_sites<Sum, 3>(
          exec, "cayspin::path::gradient_across", image.spins.layout(),
          GradientAcross<Real>{change.array(), image.direction.array(), image.across.array(),
                               image.steps[count_].array(), change.array(),
                               slope * image.per_square});
      image.largest_across = largest_length(exec, image.across);
      if (!std::isfinite(image.largest_across) || !std::isfinite(image.energy.value))
        return std::numeric_limits<double>::quiet_NaN();
      largest = std::max(largest, image.largest_across);
    }
    return largest;
  }

  /// Takes one step with all images that are not fixed. Call it after look().
  template <class Exec>
  void step(Exec const& exec, Preconditioner<Spins>& preconditioner, Mobile const& is_mobile,
            double longest_turn) {
    if (has_step_) keep_pair();
    find_products(exec);
    auto const product = [this](std::size_t i, std::size_t j) {
      return of_pairs_[Products::of(i, j)];
    };
    std::array<bool, pairs> use{};
    for (std::size_t i = 0; i < count_; ++i)
      use[i] = product(i, i) > 1e-6 * std::sqrt(squares_[i][0] * squares_[i][1]);
    Recursion::Numbers along{};
    for (std::size_t i = 0; i < count_; ++i) along[i] = of_pairs_[i];
    recursion_.begin(count_, use, along, product);
    double const scale = sweeps() ? share_ : scale_of(exec, preconditioner, use, product);

    auto const& left = scratch_[0];
    std::vector<std::array<double, pairs + 1>> of_images(size());
    along = {};
    for (std::size_t const k : order()) {
      auto const* const image = &images_[k];
      Kokkos::Array<Real, pairs> weights{};
      double t = 0;
      for (std::size_t i = 0; i < count_; ++i) {
        weights[i] = static_cast<Real>(-recursion_.alpha[i]);
        t += recursion_.alpha[i] * image->products[Products::change_along + i];
      }
      sum(exec, *image, image->across, 1, t * image->per_square, image->changes, weights, left);
      double const more =
          sweeps() ? preconditioner.first_shift() + follow_higher(exec, k, left) : 0;
      preconditioner.apply(exec, left, next_step(*image), more);
      of_images[k] = changes_along(exec, *image, next_step(*image));
      for (std::size_t i = 0; i < count_; ++i)
        along[i] += scale * across_of(*image, of_images[k], i);
    }
    recursion_.end(count_, use, along, product);
    double longest = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      auto const* const image = &images_[k];
      if (image->is_fixed) continue;
      Kokkos::Array<Real, pairs> weights{};
      double t = scale * of_images[k][pairs];
      for (std::size_t i = 0; i < count_; ++i) {
        weights[i] = static_cast<Real>(-recursion_.weights[i]);
        t += recursion_.weights[i] * image->products[Products::step_along + i];
      }
      auto const& next = next_step(*image);
      sum(exec, *image, next, -scale, t * image->per_square, image->steps, weights, next);
      for_each_site<Real>(exec, "cayspin::path::keep_mobile", next.layout(),
                          KeepTangent<Real>{image->spins.array(), next.array(), is_mobile.array(),
                                            next.output(false)});
      longest = std::max(longest, largest_length(exec, next) / longest_turn);
      // Steps longer than the distances between images would fold the path.
      double const spacing = 0.5 * (arcs_[k - 1] + arcs_[k]);
      if (spacing > 0) longest = std::max(longest, 2 * length(exec, next) / spacing);
    }
    double const factor = longest > 1 ? 1 / longest : 1;
    for (auto& image : images_) {
      if (image.is_fixed) {
        Kokkos::deep_copy(exec, image.trial.allocation(), image.spins.allocation());
        continue;
      }
      auto const& next = next_step(image);
      if (factor < 1) combine(exec, factor, next, 0, next, next);
      for_each_site<Real>(
          exec, "cayspin::path::turn", next.layout(),
          TurnTowards<Real>{image.spins.array(), next.array(), image.trial.output(false), Real(1)});
    }
    has_step_ = !sweeps();
    space_evenly(exec);
  }

  bool sweeps() const { return share_ > 0; }
  /// From the next step on, replaces L-BFGS by sweeps from high to low energy. If an image moves,
  /// the path turns at its lower neighbour, and the sweep makes that one follow. L-BFGS assumes
  /// such couplings to be symmetric, and fails where the energy falls steeply between close images.
  /// `share`: fraction of each step that is taken; 0 returns to L-BFGS.
  void sweep(double share) {
    share_ = share;
    forget_pairs();
  }

  void forget_pairs() {
    count_ = 0;
    has_step_ = false;
  }

  /// Adds a state as a fixed image between image `after` and the next one. The number of images
  /// stays the same: those that are not fixed shift along the path. Returns false if all are fixed.
  template <class Exec>
  bool insert(Exec const& exec, Spins const& state, Energy const& energy, std::size_t after) {
    std::vector<Spins> nodes;
    std::vector<std::size_t> fixed;  // indices of nodes
    for (std::size_t k = 0; k < size(); ++k) {
      if (is_fixed(k)) fixed.push_back(nodes.size());
      nodes.push_back(spins(k));
      if (k != after) continue;
      fixed.push_back(nodes.size());
      nodes.push_back(state);
    }
    if (fixed.size() > size()) return false;
    measure_arcs(
        exec, [&](std::size_t k) -> Spins const& { return nodes[k]; }, nodes.size());
    auto const places = places_of(fixed, arcs_, size());
    std::vector<Energy> energies;
    for (auto const& image : images_)
      if (image.is_fixed) energies.push_back(image.energy);
    auto const number = std::ranges::find(fixed, after + 1) - fixed.begin();
    energies.insert(energies.begin() + number, energy);
    for (std::size_t k = 0; k < size(); ++k) {
      auto const [node, fraction] = point_of_image(k, fixed, places, arcs_);
      point_between(exec, nodes[node], nodes[std::min(node + 1, nodes.size() - 1)], fraction,
                    images_[k].trial);
    }
    for (std::size_t i = 0; i < fixed.size(); ++i)
      Kokkos::deep_copy(exec, images_[places[i]].trial.allocation(), nodes[fixed[i]].allocation());
    for (auto& image : images_) {
      Kokkos::deep_copy(exec, image.spins.allocation(), image.trial.allocation());
      image.is_fixed = false;
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) fix(places[i], energies[i]);
    forget_pairs();
    measure_arcs(exec, [this](std::size_t k) -> Spins const& { return spins(k); });
    return true;
  }

 private:
  struct Image {
    Spins spins, trial, across, direction;
    std::array<Spins, pairs + 1> steps, changes;
    Energy energy = {};
    bool is_fixed = false;
    double per_square = 0;  // 1 / |direction|^2
    double slope = 0;       // of the energy along the path
    double largest_across = 0;
    std::array<double, 3> squares{};  // sums over sites: of the step, its change, and g across
    std::array<double, Products::values> products{};
  };

  Spins const& next_step(Image const& image) const { return image.steps[count_]; }

  /// Returns the images that are not fixed; for sweeps, sorted by energy, highest first.
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> images;
    for (std::size_t k = 0; k < size(); ++k)
      if (!is_fixed(k)) images.push_back(k);
    if (sweeps())
      std::ranges::stable_sort(images, std::greater<>(), [this](auto k) { return energy(k); });
    return images;
  }

  /// Adds to the gradient of an image the change due to the step of its higher neighbour, which
  /// turns the path. Returns the curvature that this turning of the path adds at the image.
  template <class Exec>
  double follow_higher(Exec const& exec, std::size_t k, Spins const& gradient) const {
    auto const higher = energy(k - 1) > energy(k + 1) ? k - 1 : k + 1;
    double const arc = arcs_[std::min(k, higher)];
    if (!(energy(higher) > energy(k) && arc > 0)) return 0;
    double const curvature = std::abs(images_[k].slope) / arc;
    if (!is_fixed(higher))
      combine(exec, 1, gradient, curvature, next_step(images_[higher]), gradient);
    return curvature;
  }

  void keep_pair() {
    squares_[count_] = {};
    for (auto const& image : images_) {
      if (image.is_fixed) continue;
      squares_[count_][0] += image.squares[0];
      squares_[count_][1] += image.squares[1];
    }
    if (count_ < pairs) {
      ++count_;
      return;
    }
    std::rotate(squares_.begin(), squares_.begin() + 1, squares_.end());
    for (auto& image : images_) {
      std::rotate(image.steps.begin(), image.steps.begin() + 1, image.steps.end());
      std::rotate(image.changes.begin(), image.changes.begin() + 1, image.changes.end());
    }
  }

  static ArraysOfPath<Real> arrays_of(std::array<Spins, pairs + 1> const& fields) {
    ArraysOfPath<Real> arrays;
    for (std::size_t i = 0; i < pairs; ++i) arrays[i] = fields[i].array();
    return arrays;
  }

  /// Computes the products of pairs for each image, and sums over all images of s_i.g and s_i.y_j
  /// across the path.
  template <class Exec>
  void find_products(Exec const& exec) {
    of_pairs_ = {};
    if (count_ == 0) return;
    for (auto& image : images_) {
      if (image.is_fixed) continue;
      image.products = reduce_sites<Sum, Products::values>(
          exec, "cayspin::path::products", image.spins.layout(),
          Products{image.spins.array(), image.across.array(), image.direction.array(),
                   arrays_of(image.steps), arrays_of(image.changes), static_cast<int>(count_)});
      auto const& p = image.products;
      for (std::size_t j = 0; j < count_; ++j) {
        of_pairs_[j] += p[j];
        for (std::size_t i = 0; i <= j; ++i)
          of_pairs_[Products::of(i, j)] +=
              p[Products::of(i, j)] -
              p[Products::step_along + i] * p[Products::change_along + j] * image.per_square;
      }
    }
  }

  /// Returns the factor of the preconditioner P: s.y / (y.P y) of the last pair, within limits.
  template <class Exec, class Product>
  double scale_of(Exec const& exec, Preconditioner<Spins>& preconditioner,
                  std::array<bool, pairs> const& use, Product const& product) {
    if (count_ == 0 || !use[count_ - 1]) return 1;
    auto const last = count_ - 1;
    auto const& [change, conditioned] = scratch_;
    double along = 0;
    for (auto const& image : images_) {
      if (image.is_fixed) continue;
      sum(exec, image, image.changes[last], 1,
          -image.products[Products::change_along + last] * image.per_square, image.steps, {},
          change);
      preconditioner.apply(exec, change, conditioned);
      along += across_of(image, changes_along(exec, image, conditioned), last);
    }
    double const scale = product(last, last) / along;
    return scale > 0 && std::isfinite(scale) ? std::clamp(scale, 0.05, 20.0) : 1;
  }

  template <class Exec>
  std::array<double, pairs + 1> changes_along(Exec const& exec, Image const& image,
                                              Spins const& vector) const {
    return reduce_sites<Sum, ChangesAlong<Real>::values>(
        exec, "cayspin::path::changes_along", image.spins.layout(),
        ChangesAlong<Real>{image.spins.array(), vector.array(), image.direction.array(),
                           arrays_of(image.changes), static_cast<int>(count_)});
  }
  static double across_of(Image const& image, std::array<double, pairs + 1> const& found,
                          std::size_t pair) {
    return found[pair] -
           image.products[Products::change_along + pair] * found[pairs] * image.per_square;
  }

  template <class Exec>
  void sum(Exec const& exec, Image const& image, Spins const& vector, double factor, double along,
           std::array<Spins, pairs + 1> const& others, Kokkos::Array<Real, pairs> const& weights,
           Spins const& to) const {
    for_each_site<Real>(
        exec, "cayspin::path::sum", to.layout(),
        SumOfPath<Real>{image.spins.array(), vector.array(), image.direction.array(),
                        arrays_of(others), weights, static_cast<Real>(factor),
                        static_cast<Real>(along), static_cast<int>(count_), to.output(false)});
  }

  template <class Exec, class At>
  void measure_arcs(Exec const& exec, At const& at, std::size_t count = 0) {
    if (count == 0) count = size();
    arcs_.assign(count - 1, 0);
    for (std::size_t k = 0; k + 1 < count; ++k) arcs_[k] = distance_between(exec, at(k), at(k + 1));
  }

  /// Sets the spins to states that are evenly spaced along the path of trial states, between fixed
  /// images.
  template <class Exec>
  void space_evenly(Exec const& exec) {
    measure_arcs(exec, [this](std::size_t k) -> Spins const& { return images_[k].trial; });
    std::vector<std::size_t> fixed;
    for (std::size_t k = 0; k < size(); ++k)
      if (is_fixed(k)) fixed.push_back(k);
    for (std::size_t k = 0; k < size(); ++k) {
      if (is_fixed(k)) continue;
      auto const [node, fraction] = point_of_image(k, fixed, fixed, arcs_);
      point_between(exec, images_[node].trial, images_[node + 1].trial, fraction, images_[k].spins);
    }
  }

  std::vector<Image> images_;
  std::array<Spins, 2> scratch_;
  std::vector<double> arcs_;
  std::size_t count_ = 0;
  bool has_step_ = false;
  double share_ = 0;
  std::array<std::array<double, 2>, pairs + 1> squares_{};
  std::array<double, Products::values> of_pairs_{};
  Recursion recursion_;
  std::int64_t evaluations_ = 0;
};

}  // namespace cayspin::inline v0_2::detail
