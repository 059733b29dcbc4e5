// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "unit_cell_file.hpp"

#include "bond_key.hpp"
#include "io/counted.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

// The file lists the lengths of the cell's edges, its three vectors in units of these lengths, its
// atoms, its bilinear interactions and, in some files, biquadratic ones. Vampire numbers atoms by
// line and ignores the number at the start of the line. Each bond is listed from both ends, and
// contributes E = -S.J S' once. Numbers of the kinds "normalised-.." are multiplied by an energy of
// Vampire's .mat file: bilinear ones by exchange-matrix, which has an entry for each pair of
// materials, biquadratic ones by biquadratic-exchange.
namespace cayspin::inline v0_2::io::detail {
namespace {

using Words = std::vector<std::string>;

/// Reads a file as lines of words, without comments and empty lines.
class Lines {
 public:
  explicit Lines(std::filesystem::path const& path) : path_(path), stream_(path) {
    if (!stream_ || std::filesystem::is_directory(path)) fail("cannot be read");
  }

  [[noreturn]] void fail(std::string_view what) const {
    auto const place = number_ > 0 ? fmt::format("{}:{}", path_.string(), number_) : path_.string();
    throw std::runtime_error(fmt::format("{}: {}", place, what));
  }

  std::optional<Words> next() {
    for (std::string line; std::getline(stream_, line);) {
      ++number_;
      if (line.size() > 4096) fail("is longer than 4096 characters");
      if (auto words = words_of(line.substr(0, line.find('#'))); !words.empty()) return words;
    }
    return std::nullopt;
  }
  /// Returns the next line. Throws at the end of the file, and for a line of fewer than `least`
  /// words. `what`: the expected part, for the message.
  Words required(std::size_t least, std::string_view what) { return required(least, what, what); }
  /// `accepted`: the words of the line, for the message.
  Words required(std::size_t least, std::string_view what, std::string_view accepted) {
    auto words = next();
    if (!words) fail(fmt::format("ends before {}", what));
    if (words->size() < least) refuse_words(*words, accepted);
    return std::move(*words);
  }
  [[noreturn]] void refuse_words(Words const& words, std::string_view accepted) const {
    fail(fmt::format("has {}; accepted: {}", counted(std::ssize(words), "word"), accepted));
  }

  double number(std::string const& word) const {
    double value = 0;
    auto const* const end = word.data() + word.size();
    auto const [at, error] = std::from_chars(word.data() + (word[0] == '+'), end, value);
    if (error != std::errc() || at != end || !std::isfinite(value))
      fail(fmt::format("\"{:.40}\" is not a finite number", word));
    return value;
  }
  std::int64_t integer(std::string const& word, std::int64_t least, std::int64_t most) const {
    double const value = number(word);
    if (value != std::floor(value) || value < static_cast<double>(least) ||
        value > static_cast<double>(most))
      fail(fmt::format("{:.40} is not a whole number from {} to {}", word, least, most));
    return static_cast<std::int64_t>(value);
  }
  Crystal::Point vector(Words const& words, std::size_t from) const {
    return {number(words[from]), number(words[from + 1]), number(words[from + 2])};
  }

 private:
  static Words words_of(std::string line) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream stream(line);
    using Iterator = std::istream_iterator<std::string>;
    return Words(Iterator(stream), Iterator());
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::int64_t number_ = 0;
};

struct UnitCell {
  Crystal crystal;
  std::set<std::string> materials;  // as written; 0 if missing
};

UnitCell read_cell(Lines& lines) {
  UnitCell cell;
  auto& crystal = cell.crystal;
  auto const edges = lines.vector(lines.required(3, "the three lengths of a cell"), 0);
  double length = 0;  // of the first vector
  for (std::size_t i = 0; i < 3; ++i) {
    auto& vector = crystal.cell[i] = lines.vector(lines.required(3, "three vectors of a cell"), 0);
    if (i == 0) length = std::abs(edges[0]) * std::hypot(vector[0], vector[1], vector[2]);
    for (double& component : vector) component *= edges[i] / length;
  }
  if (!(crystal.fullness() > 1e-12)) lines.fail("the cell has no volume");

  auto const counts = lines.required(1, "the number of atoms");
  auto const atoms = lines.integer(counts[0], 1, most_sites);
  crystal.basis.clear();
  auto const last = fmt::format("the last of {}", counted(atoms, "atom"));
  auto const accepted = fmt::format("\"number x y z ..\" for each of {}", counted(atoms, "atom"));
  for (std::int64_t i = 0; i < atoms; ++i) {
    auto const atom = lines.required(4, last, accepted);
    crystal.basis.push_back(lines.vector(atom, 1));
    cell.materials.insert(atom.size() > 4 ? atom[4] : "0");
  }
  if (auto const two = crystal.sites_at_one_place())
    lines.fail(fmt::format("atoms {} and {} are at one place", (*two)[0], (*two)[1]));
  return cell;
}

void require_sites(Lines const& lines, Crystal const& file, Crystal const& scene) {
  if (file.basis.size() != scene.basis.size())
    lines.fail(fmt::format("has {} in a cell; accepted: {}, as lattice.basis",
                           counted(std::ssize(file.basis), "atom"), scene.basis.size()));
  for (std::size_t i = 0; i < file.basis.size(); ++i) {
    auto const &there = file.basis[i], &here = scene.basis[i];
    auto const is_far = [](double a, double b) { return std::abs(a - b) > 1e-4; };
    if (is_far(there[0], here[0]) || is_far(there[1], here[1]) || is_far(there[2], here[2]))
      lines.fail(fmt::format("atom {} is at ({}); accepted: ({}), as in lattice.basis", i,
                             fmt::join(there, ", "), fmt::join(here, ", ")));
  }
}

struct Kind {
  std::size_t numbers = 1;  // of an interaction
  bool normalised = false;
};

Kind kind_of(Lines const& lines, std::string_view word) {
  constexpr std::string_view normalised = "normalised-";
  bool const is_normalised = word.starts_with(normalised);
  auto const kind = is_normalised ? word.substr(normalised.size()) : word;
  if (kind == "isotropic" || kind == "0") return {1, is_normalised};
  if (kind == "vectorial" || kind == "1") return {3, is_normalised};
  if (kind == "tensorial" || kind == "2") return {9, is_normalised};
  lines.fail(fmt::format(
      "\"{:.40}\" is no kind of exchange; accepted: isotropic, vectorial, tensorial", word));
}

using Tensor = std::array<double, 9>;
using Tensors = std::map<BondKey, Tensor>;

std::string name_of(BondKey const& key) {
  auto const& [between, offset] = key;
  return fmt::format("the bond from atom {} to atom {} of the cell ({}, {}, {}) away", between[0],
                     between[1], offset[0], offset[1], offset[2]);
}

Tensor read_tensor(Lines const& lines, Words const& words, Kind const& kind) {
  Tensor tensor{};
  for (std::size_t i = 0; i < 9; ++i) {
    bool const on_diagonal = i % 4 == 0;
    if (kind.numbers == 9) tensor[i] = lines.number(words[6 + i]);
    if (kind.numbers < 9 && on_diagonal)
      tensor[i] = lines.number(words[kind.numbers == 1 ? 6 : 6 + i / 4]);
    if (kind.normalised && !on_diagonal && tensor[i] != 0)
      lines.fail(
          "has normalised numbers off the diagonal, which Vampire ignores; accepted: 0 there, "
          "or tensorial, in J");
  }
  return tensor;
}

Tensors read_interactions(Lines& lines, Words const& head, Kind const& kind, std::int64_t atoms) {
  constexpr std::int64_t most_bonds = 100'000'000, most_cells = 1'000'000;
  auto const count = lines.integer(head[0], 0, most_bonds);
  auto const numbers = kind.numbers;
  auto const accepted = fmt::format("\"number i j dx dy dz\" and {} of J for each of {}",
                                    counted(static_cast<std::int64_t>(numbers), "number"),
                                    counted(count, "interaction"));
  auto const last = fmt::format("the last of {}", counted(count, "interaction"));
  Tensors tensors;
  for (std::int64_t n = 0; n < count; ++n) {
    auto const words = lines.required(6 + numbers, last, accepted);
    if (words.size() > 6 + numbers) lines.refuse_words(words, accepted);
    BondKey key;
    auto& [between, offset] = key;
    for (std::size_t end = 0; end < 2; ++end)
      between[end] = static_cast<int>(lines.integer(words[1 + end], 0, atoms - 1));
    for (std::size_t axis = 0; axis < 3; ++axis)
      offset[axis] = static_cast<int>(lines.integer(words[3 + axis], -most_cells, most_cells));
    if (key == reversed(key)) lines.fail(fmt::format("couples atom {} to itself", between[0]));
    if (!tensors.emplace(key, read_tensor(lines, words, kind)).second)
      lines.fail(name_of(key) + " occurs twice");
  }
  return tensors;
}

// Refuses normalised numbers that one factor does not turn into energies.
void require_one_energy(Lines const& lines, Words const& head, UnitCell const& cell,
                        bool scale_is_given) {
  if (cell.materials.size() > 1)
    lines.fail(
        fmt::format("numbers of \"{:.40}\" are relative to exchange-matrix of the .mat file, which "
                    "may differ between pairs of the {} materials; accepted: one material, or "
                    "energies in J",
                    head[1], cell.materials.size()));
  if (!scale_is_given)
    lines.fail(
        fmt::format("numbers of \"{:.40}\" are relative to exchange-matrix of the .mat file; "
                    "accepted: field.couplings.scale = that energy, or energies in J",
                    head[1]));
}

/// Returns what is wrong with a line after the interactions. `head`: the line that counts them.
std::string behind_last(Words const& head) {
  return fmt::format("comes after the last of {} interaction{}", head[0],
                     head[0] == "1" ? "" : "s");
}

/// Returns each bond once, with the mean of its numbers from both ends, which may differ by
/// rounding.
Tensors one_way(Lines const& lines, Tensors const& tensors) {
  double largest = 0;
  for (auto const& [key, tensor] : tensors)
    for (double const number : tensor) largest = std::max(largest, std::abs(number));
  Tensors once;
  for (auto const& [key, tensor] : tensors) {
    auto const back = tensors.find(reversed(key));
    if (back == tensors.end()) lines.fail(name_of(key) + " is not given from its other end");
    if (!(key < reversed(key))) continue;
    auto& mean = once[key];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        double const here = tensor[3 * i + j], there = back->second[3 * j + i];
        if (std::abs(here - there) > 1e-3 * largest)
          lines.fail(
              fmt::format("{} is {} there and {} from its other end", name_of(key), here, there));
        mean[3 * i + j] = 0.5 * (here + there);
      }
  }
  return once;
}

}  // namespace

Crystal read_unit_cell(std::filesystem::path const& path) {
  Lines lines(path);
  return read_cell(lines).crystal;
}

std::vector<Coupling> read_unit_cell_couplings(std::filesystem::path const& path,
                                               Crystal const& crystal, double scale,
                                               bool scale_is_given) {
  Lines lines(path);
  auto const cell = read_cell(lines);
  require_sites(lines, cell.crystal, crystal);
  auto const atoms = static_cast<std::int64_t>(crystal.basis.size());
  auto const head = lines.required(1, "the number of interactions");
  if (head.size() < 2)
    lines.fail(
        "has no kind of exchange after the number of interactions; accepted: isotropic, vectorial "
        "or tensorial for numbers in J, normalised-.. for multiples of exchange-matrix");
  auto const kind = kind_of(lines, head[1]);
  if (kind.normalised) require_one_energy(lines, head, cell, scale_is_given);
  auto const tensors = one_way(lines, read_interactions(lines, head, kind, atoms));
  std::map<BondKey, Coupling> couplings;
  auto const coupling = [&](BondKey const& key) -> Coupling& {
    auto& found = couplings[key];
    std::tie(found.between, found.offset) = key;
    return found;
  };
  for (auto const& [key, tensor] : tensors)
    std::ranges::transform(tensor, coupling(key).tensor.begin(),
                           [&](double number) { return scale * number; });
  if (auto const more = lines.next()) {
    if (more->size() != 2) lines.fail(behind_last(head));
    auto const biquadratic = kind_of(lines, (*more)[1]);
    if (biquadratic.numbers != 1)
      lines.fail("biquadratic interactions that are not isotropic are not known");
    if ((kind.normalised || biquadratic.normalised) && (*more)[0] != "0")
      lines.fail(
          "has biquadratic interactions in a file with normalised numbers, and one scale cannot "
          "be the energy of both; accepted: all numbers in J");
    for (auto const& [key, tensor] :
         one_way(lines, read_interactions(lines, *more, biquadratic, atoms)))
      coupling(key).biquadratic = scale * tensor[0];
    if (lines.next()) lines.fail(behind_last(*more));
  }
  std::vector<Coupling> all;
  for (auto const& [key, made] : couplings) all.push_back(made);
  return all;
}

}  // namespace cayspin::inline v0_2::io::detail
