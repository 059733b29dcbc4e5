// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "files/durable.hpp"
#include "fletcher32.hpp"
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/checkpoint.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "require.hpp"

#include <array>
#include <cstring>
#include <map>
#include <span>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

constexpr char const* format_mark = "checkpoint_format";
constexpr char const* sum_mark = "checksum";  // an attribute of the file, and of each field
constexpr std::int64_t checkpoint_version = 1;
constexpr std::uint64_t checkpoint_overhead_bytes = 64 * 1024;
constexpr hsize_t most_components = 3;
constexpr std::array extent_names{"nx", "ny", "nz"};

// Never 0: otherwise zeros in place of a field and its checksum would be valid.
std::int64_t checksum(Fletcher32 const& sum) { return std::int64_t{1} + sum.value(); }

}  // namespace

/// Contents of a checkpoint; of its fields only the checksums.
struct CheckpointContents {
  CheckpointHeader header;
  std::map<std::string, double> numbers;
  std::map<std::string, std::int64_t> fields;  // checksums of the fields

  std::int64_t checksum() const {
    Bytes bytes;
    for (auto const* const text :
         {&header.scene_text, &header.resolved_scene, &header.cayspin_version, &header.precision})
      bytes.add(*text);
    for (auto const number : {header.cell_sites, header.step, std::int64_t{header.si}})
      bytes.add(number);
    bytes.add(header.time);
    for (auto const& [name, number] : numbers) {
      bytes.add(name);
      bytes.add(number);
    }
    for (auto const& [name, sum] : fields) {
      bytes.add(name);
      bytes.add(sum);
    }
    Fletcher32 sum;
    sum.add(std::as_bytes(std::span(bytes.all)));
    return io::checksum(sum);
  }

 private:
  struct Bytes {
    std::string all;
    void add(std::string const& text) {
      add(static_cast<std::int64_t>(text.size()));
      all += text;
    }
    template <class Number>
    void add(Number const& number) {
      std::array<char, sizeof(Number)> bytes;
      std::memcpy(bytes.data(), &number, sizeof(Number));
      all.append(bytes.data(), bytes.size());
    }
  };
};

std::filesystem::path checkpoint_beside(std::filesystem::path trajectory) {
  // Any other ending may tell runs apart, as in film_0.5 and film_0.6.
  if (trajectory.extension() == ".h5") trajectory.replace_extension();
  return trajectory += ".checkpoint.h5";
}

class CheckpointWriter::Implementation {
 public:
  Implementation(std::filesystem::path path, CheckpointHeader const& header)
      : path_(std::move(path)),
        stored_(header.precision == single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE),
        file_(path_, true, true),
        space_(file_.get(), path_),
        contents_{header, {}, {}} {
    auto const [nx, ny, nz] = header.shape;
    for (auto const extent : {nz, ny, nx}) extents_.push_back(static_cast<hsize_t>(extent));
    space_.reserve(
        checkpoint_overhead_bytes + header.scene_text.size() + header.resolved_scene.size(), path_);
    RootAttributes const attributes(file_.get(), path_);
    attributes.create(format_mark, checkpoint_version);
    attributes.create("cayspin_version", header.cayspin_version);
    attributes.create("scene", header.scene_text);
    attributes.create("resolved_scene", header.resolved_scene);
    attributes.create("precision", header.precision);
    if (header.cell_sites > 1) attributes.create("cell_sites", header.cell_sites);
    attributes.create("step", header.step);
    attributes.create("time", header.time);
    attributes.create("units", std::string(header.si ? si_units : reduced_units));
    numbers_ = create_group(file_.get(), "numbers", path_);
    for (std::size_t axis = 0; axis < 3; ++axis)
      number(extent_names[axis], static_cast<double>(header.shape[axis]));
    if (header.stage == StageBegin{}) return;
    number("stage", static_cast<double>(header.stage.stage));
    number("stage_step", static_cast<double>(header.stage.step));
    number("stage_time", header.stage.time);
  }

  void number(std::string const& name, double value) {
    require_open();
    RootAttributes(numbers_.get(), path_).create(name.c_str(), value);
    contents_.numbers[name] = value;
  }

  void field(std::string const& name, std::vector<double> const& numbers) {
    auto const sites = elements(extents_);
    if (numbers.empty() || numbers.size() % sites != 0 || numbers.size() / sites > most_components)
      throw std::invalid_argument(path_.string() + ": field " + name + " has " +
                                  std::to_string(numbers.size()) + " numbers for " +
                                  std::to_string(sites) + " sites; accepted: 1 to 3 of each site");
    planes(name, numbers.size() / sites, numbers);
  }

  void planes(std::string const& name, hsize_t components, std::vector<double> const& numbers) {
    require_open();
    auto const of_plane = components * extents_[1] * extents_[2];
    if (components < 1 || components > most_components || numbers.empty() ||
        numbers.size() % of_plane != 0)
      throw std::invalid_argument(path_.string() + ": field " + name + " has " +
                                  std::to_string(numbers.size()) +
                                  " numbers; accepted: those of whole planes along z");
    auto const planes = numbers.size() / of_plane;
    if (written_planes_ == 0) create_field(name, components);
    if (name != name_ || components != extents_of_field_[3] ||
        written_planes_ + planes > extents_[0])
      throw std::logic_error(path_.string() + ": field " + name + " has other planes than " +
                             name_ + ", which is not whole");
    auto extents = extents_of_field_;
    extents[0] = planes;
    write_block(field_.get(), H5T_NATIVE_DOUBLE, {written_planes_, 0, 0, 0}, extents,
                numbers.data(), path_);
    sum_.add(std::as_bytes(std::span(numbers)));
    written_planes_ += planes;
    if (written_planes_ < extents_[0]) return;
    RootAttributes(field_.get(), path_).create(sum_mark, checksum(sum_));
    contents_.fields[name] = checksum(sum_);
    field_.close();
    has_spins_ = has_spins_ || name == "spins";
    written_planes_ = 0;
  }

  void commit() {
    require_open();
    if (written_planes_ > 0)
      throw std::logic_error(path_.string() + ": field " + name_ + " is not whole");
    if (!has_spins_)
      throw std::logic_error(path_.string() + ": a checkpoint without a field spins is of no use");
    std::string const action = "cannot write the file";
    RootAttributes(file_.get(), path_).create(sum_mark, contents_.checksum());
    numbers_.close();
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), path_, action);
    space_.trim();
    if (int const error = space_.sync()) throw_failure(path_, action, std::strerror(error));
    auto committed = file_.commit();
    has_name_ = true;
    check(committed.close(), path_, action);
    if (int const error = sync_folder_of(path_)) throw_failure(path_, action, std::strerror(error));
  }

 private:
  void require_open() const {
    if (has_name_) throw std::logic_error(path_.string() + ": the checkpoint has its name already");
    if (numbers_.get() < 0)
      throw std::logic_error(path_.string() + ": the checkpoint could not be written");
  }

  void create_field(std::string const& name, hsize_t components) {
    name_ = name;
    sum_ = {};
    extents_of_field_ = extents_;
    extents_of_field_.push_back(components);
    space_.reserve(sizeof(double) * elements(extents_of_field_) + checkpoint_overhead_bytes, path_);
    field_ = create_dataset(file_.get(), name.c_str(), stored_, extents_of_field_, path_);
  }

  std::filesystem::path path_;
  hid_t stored_;
  Extents extents_, extents_of_field_;
  NewFile file_;
  OpenFileSpace space_;
  GroupHandle numbers_;
  CheckpointContents contents_;
  bool has_spins_ = false, has_name_ = false;
  DatasetHandle field_;  // the field being written
  std::string name_;
  hsize_t written_planes_ = 0;
  Fletcher32 sum_;
};

CheckpointWriter::CheckpointWriter(std::filesystem::path path, CheckpointHeader const& header) {
  require_precision(header.precision);
  require_shape(header.shape);
  QuietErrors const quiet;
  implementation_ = std::make_unique<Implementation>(std::move(path), header);
}

CheckpointWriter::~CheckpointWriter() {
  QuietErrors const quiet;
  implementation_.reset();
}

void CheckpointWriter::number(std::string const& name, double& value) {
  QuietErrors const quiet;
  implementation_->number(name, value);
}

void CheckpointWriter::field(std::string const& name, std::vector<double>& numbers) {
  QuietErrors const quiet;
  implementation_->field(name, numbers);
}

void CheckpointWriter::planes(std::string const& name, std::int64_t components,
                              std::vector<double> const& numbers) {
  QuietErrors const quiet;
  implementation_->planes(name, static_cast<hsize_t>(components), numbers);
}

void CheckpointWriter::commit() {
  QuietErrors const quiet;
  implementation_->commit();
}

class CheckpointReader::Implementation {
 public:
  explicit Implementation(std::filesystem::path path)
      : path_(std::move(path)), file_(open_file(path_)) {
    RootAttributes const attributes(file_.get(), path_);
    if (!attributes.has(format_mark))
      throw_failure(path_, "cannot read the checkpoint", "it is not one");
    attributes.require_version(format_mark, checkpoint_version, "cannot read the checkpoint");
    header_.cayspin_version = attributes.read_text("cayspin_version");
    header_.scene_text = attributes.read_text("scene");
    header_.resolved_scene = attributes.read_text("resolved_scene");
    header_.precision = attributes.read_text("precision");
    if (attributes.has("cell_sites")) header_.cell_sites = attributes.read_integer("cell_sites");
    header_.step = attributes.read_integer("step");
    header_.time = attributes.read_real("time");
    header_.si = attributes.read_word("units", si_units, reduced_units);
    auto const extents = dataset_extents(open_dataset(file_.get(), "spins", 4, path_).get(), path_);
    for (int axis = 0; axis < 3; ++axis)
      header_.shape[axis] = static_cast<std::int64_t>(extents[2 - axis]);
    numbers_ = open_group(file_.get(), "numbers", path_);
    // Files of earlier versions have no checksum.
    if (attributes.has(sum_mark) && attributes.read_integer(sum_mark) != contents().checksum())
      throw_failure(path_, "cannot read the checkpoint", "its contents are not those written");
    // The checksums do not cover the extents of fields, but these numbers, which files of earlier
    // versions lack.
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (RootAttributes(numbers_.get(), path_).has(extent_names[axis]) &&
          number(extent_names[axis]) != static_cast<double>(header_.shape[axis]))
        throw_failure(path_, "cannot read dataset spins", "its extents are not those written");
    if (RootAttributes(numbers_.get(), path_).has("stage"))
      header_.stage = {static_cast<std::int64_t>(number("stage")),
                       static_cast<std::int64_t>(number("stage_step")), number("stage_time")};
  }

  double number(std::string const& name) const {
    return RootAttributes(numbers_.get(), path_).read_real(name.c_str());
  }

  std::vector<double> field(std::string const& name, SiteBox const& box) const {
    auto const dataset = open_dataset(file_.get(), name.c_str(), 4, path_);
    auto const extents = dataset_extents(dataset.get(), path_);
    // Checked before memory is allocated.
    if (!std::equal(header_.shape.rbegin(), header_.shape.rend(), extents.begin()) ||
        extents[3] > most_components)
      throw_failure(path_, "cannot read dataset " + name, "its extents are not those of the spins");
    Fletcher32 sum;
    auto const components = static_cast<std::int64_t>(extents[3]);
    auto const at_once = planes_to_read(header_.shape, 8 * components);
    auto chosen = read_by_planes(
        box, header_.shape, components, at_once, [&](std::int64_t first, std::int64_t planes) {
          auto of_planes = extents;
          of_planes[0] = static_cast<hsize_t>(planes);
          std::vector<double> numbers(elements(of_planes));
          read_block(dataset.get(), H5T_NATIVE_DOUBLE, {static_cast<hsize_t>(first), 0, 0, 0},
                     of_planes, numbers.data(), path_);
          sum.add(std::as_bytes(std::span(numbers)));
          return numbers;
        });
    if (RootAttributes(dataset.get(), path_).read_integer(sum_mark) != checksum(sum))
      throw_failure(path_, "cannot read dataset " + name, "its numbers are not those written");
    return chosen;
  }

  void read_all() const {
    for (auto const& [name, sum] : contents().fields) field(name, {});
  }

  CheckpointHeader const& header() const { return header_; }
  std::filesystem::path const& path() const { return path_; }

 private:
  CheckpointContents contents() const {
    std::vector<std::string> fields, numbers;
    auto const keep = [](hid_t, char const* name, auto const*, void* to) -> herr_t {
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
      return 0;
    };
    check(H5Literate(file_.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keep, &fields), path_,
          "cannot read the checkpoint");
    check(H5Aiterate2(numbers_.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keep, &numbers),
          path_, "cannot read the checkpoint");
    CheckpointContents found{header_, {}, {}};
    for (auto const& name : numbers) found.numbers[name] = number(name);
    for (auto const& name : fields)
      if (name != "numbers")
        found.fields[name] =
            RootAttributes(open_dataset(file_.get(), name.c_str(), 4, path_).get(), path_)
                .read_integer(sum_mark);
    return found;
  }

  std::filesystem::path path_;
  FileHandle file_;
  GroupHandle numbers_;
  CheckpointHeader header_;
};

CheckpointReader::CheckpointReader(std::filesystem::path path) {
  QuietErrors const quiet;
  try_reading(path, [&] { Implementation(path).read_all(); });
  implementation_ = std::make_unique<Implementation>(std::move(path));
}

CheckpointReader::~CheckpointReader() = default;
CheckpointHeader const& CheckpointReader::header() const { return implementation_->header(); }
std::filesystem::path const& CheckpointReader::path() const { return implementation_->path(); }

void CheckpointReader::number(std::string const& name, double& value) {
  QuietErrors const quiet;
  value = implementation_->number(name);
}

void CheckpointReader::field(std::string const& name, std::vector<double>& numbers) {
  numbers = field(name, SiteBox{{0, 0, 0}, header().shape});
}

std::vector<double> CheckpointReader::field(std::string const& name, SiteBox const& box) const {
  QuietErrors const quiet;
  return implementation_->field(name, box);
}

bool is_checkpoint(std::filesystem::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] {
    auto const file = open_file(path);
    return RootAttributes(file.get(), path).has(format_mark);
  });
}

}  // namespace cayspin::inline v0_2::io
