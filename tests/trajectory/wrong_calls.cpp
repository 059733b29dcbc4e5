// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Wrong uses of the writers give an error of one line, and leave the file unchanged.
#include "../support/wrong_call.hpp"
#include "io/checkpoint.hpp"
#include "io/run_output.hpp"
#include "io/sweep.hpp"
#include "trajectory_test.hpp"

#include <cmath>
#include <limits>

namespace cayspin::inline v0_2::io {
namespace {

using test::expect_refused;
using test::WrongCall;

constexpr auto most = std::numeric_limits<std::int64_t>::max();

/// Returns invalid headers, each with its fault.
std::vector<std::pair<std::string, TrajectoryHeader>> impossible_headers() {
  std::vector<std::pair<std::string, TrajectoryHeader>> headers;
  for (auto const* const precision : {"half", "", "Double"})
    headers.emplace_back(std::string("precision ") + precision, small_header(precision));
  for (auto const& shape : {std::array<std::int64_t, 3>{0, 1, 1},
                            {4, -3, 2},
                            {-4, -3, 2},
                            {most, 1, 1},
                            {1L << 31, 1L << 31, 1L << 31},
                            {1L << 32, 1L << 32, 1},
                            {1L << 60, 1, 1}}) {
    headers.emplace_back("shape " + std::to_string(shape[0]), small_header());
    headers.back().second.shape = shape;
  }
  return headers;
}

CheckpointHeader checkpoint_of(TrajectoryHeader const& header) {
  CheckpointHeader checkpoint;
  checkpoint.precision = header.precision;
  checkpoint.shape = header.shape;
  return checkpoint;
}

TEST_F(TrajectoryTest, FilesThatCannotBeAreNotMade) {
  auto const path = folder_ / "a.h5";
  for (auto const& [what, of] : impossible_headers()) {
    auto const& header = of;
    expect_refused({
        {"TrajectoryFile, " + what, [&] { TrajectoryFile(path, header, false); }},
        {"RunOutput, " + what, [&] { RunOutput(path, header, {}); }},
        {"CheckpointWriter, " + what, [&] { CheckpointWriter(path, checkpoint_of(header)); }},
    });
  }
  for (auto const& storage : {TrajectoryStorage{-1, 0}, {10, 0}, {0, -1}})
    expect_refused({
        {"TrajectoryFile, storage", [&] { TrajectoryFile(path, small_header(), false, storage); }},
        {"RunOutput, storage", [&] { RunOutput(path, small_header(), {.storage = storage}); }},
    });
  for (double const spacing : {0.0, -1.0, std::nan(""), HUGE_VAL})
    expect_refused({{"spacing " + std::to_string(spacing), [&] {
                       RunOutput(path, small_header(), {.xdmf = true, .spacing = {1, spacing, 1}});
                     }}});
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

template <class Writer>
std::vector<WrongCall> calls_of(std::string const& what, Writer& writer) {
  return {{what + ", write_scalars", [&] { writer.write_scalars(1, 1, {}); }},
          {what + ", finish", [&] { writer.finish({}); }},
          {what + ", close", [&] { writer.close({}); }}};
}
std::vector<WrongCall> all_of(std::string const& what, TrajectoryFile& file) {
  static auto const single = numbered_spins<float>(small_header(), 0);
  static auto const spins = numbered_spins<double>(small_header(), 0);
  static std::vector<std::byte> room(spins.size() * sizeof(double) + 4);
  auto calls = calls_of("TrajectoryFile " + what, file);
  calls.push_back({what + ", write_frame", [&] { file.write_frame(1, 1, {}, spins.data()); }});
  calls.push_back({what + ", of floats", [&] { file.write_frame(1, 1, {}, single.data()); }});
  calls.push_back({what + ", planes", [&] { file.write_planes(2, room.data()); }});
  calls.push_back({what + ", end_frame", [&] { file.end_frame(1, 1, {}); }});
  return calls;
}
std::vector<WrongCall> all_of(std::string const& what, RunOutput& output) {
  auto calls = calls_of("RunOutput " + what, output);
  calls.push_back({what + ", frame", [&] { output.frame<double>(); }});
  calls.push_back({what + ", frame of floats", [&] { output.frame<float>(); }});
  calls.push_back({what + ", write_piece", [&] { output.write_piece(); }});
  calls.push_back({what + ", write_frame", [&] { output.write_frame(1, 1, {}); }});
  return calls;
}

TEST_F(TrajectoryTest, WritersThatWereMovedAwayTakeNothing) {
  auto file = write_frames(folder_ / "a.h5", 1);
  RunOutput output(folder_ / "b.h5", small_header(), {});
  auto const other = std::move(file);
  auto const other_output = std::move(output);
  expect_refused<std::logic_error>(all_of("moved", file));
  expect_refused<std::logic_error>(all_of("moved", output));
  expect_refused<std::logic_error>({
      {"frames", [&] { file.frames(); }},
      {"path", [&] { file.path(); }},
      {"frames of RunOutput", [&] { output.frames(); }},
      {"path of RunOutput", [&] { output.path(); }},
  });
}

TEST_F(TrajectoryTest, WritersThatHaveEndedTakeNothing) {
  auto file = write_frames(folder_ / "a.h5", 1);
  RunOutput output(folder_ / "b.h5", small_header(), {});
  file.finish({});
  output.finish({});
  expect_refused<std::logic_error>(all_of("ended", file));
  expect_refused<std::logic_error>(all_of("ended", output));
  EXPECT_EQ(file.frames(), 1);
  EXPECT_EQ(output.frames(), 0);
  for (auto const* const name : {"a.h5", "b.h5"}) {
    EXPECT_TRUE(read_info(folder_ / name).complete);
    EXPECT_EQ(read_info(folder_ / name).samples, name[0] == 'a');
  }
}

TEST_F(TrajectoryTest, FramesWithoutSpinsAreNotWritten) {
  auto file = write_frames(folder_ / "a.h5", 1);
  RunOutput output(folder_ / "b.h5", small_header(), {});
  expect_refused<std::logic_error>({
      {"null", [&] { file.write_frame(1, 1, {}, static_cast<double const*>(nullptr)); }},
      {"null of floats", [&] { file.write_frame(1, 1, {}, static_cast<float const*>(nullptr)); }},
      {"null planes", [&] { file.write_planes(2, nullptr); }},
  });
  for (int frame = 0; frame < 3; ++frame) {
    expect_refused<std::logic_error>(
        {{"write_frame without frame()", [&] { output.write_frame(1, 1, {}); }}});
    output.frame<double>();
    output.write_frame(frame, frame, {});
  }
  file.finish({});
  output.finish({});
  EXPECT_EQ(read_info(folder_ / "a.h5").frames, 1);
  EXPECT_EQ(read_info(folder_ / "b.h5").frame_steps, (std::vector<std::int64_t>{0, 1, 2}));
}

TEST_F(TrajectoryTest, CheckpointThatCouldNotBeWrittenHasNoName) {
  auto const path = folder_ / "a.checkpoint.h5";
  auto spins = numbered_spins<double>(small_header(), 0);
  CheckpointWriter writer(path, checkpoint_of(small_header()));
  writer.field("spins", spins);
  std::filesystem::create_directory(path);
  EXPECT_THROW(writer.commit(), std::runtime_error);
  try {
    writer.commit();
    ADD_FAILURE() << "no error";
  } catch (std::logic_error const& error) {
    EXPECT_TRUE(contains(error.what(), "the checkpoint could not be written"));
  }
}

TEST_F(TrajectoryTest, CheckpointsTakeFieldsOfTheirLatticeAlone) {
  auto const path = folder_ / "a.checkpoint.h5";
  double number = 0.25;
  auto spins = numbered_spins<double>(small_header(), 0);
  {
    CheckpointWriter first(path, checkpoint_of(small_header()));
    first.number("a", number);
    first.field("spins", spins);
    first.commit();
    expect_refused<std::logic_error>({
        {"number after commit", [&] { first.number("b", number); }},
        {"field after commit", [&] { first.field("b", spins); }},
        {"commit after commit", [&] { first.commit(); }},
    });
  }
  {
    CheckpointWriter second(path, checkpoint_of(small_header()));
    for (std::size_t const size : {0, 1, 23, 25, 71, 73, 4 * 24}) {
      std::vector<double> wrong(size);
      expect_refused({{std::to_string(size) + " numbers", [&] { second.field("spins", wrong); }}});
    }
    expect_refused<std::logic_error>({{"commit without spins", [&] { second.commit(); }}});
    second.number("a", number);
    second.field("spins", spins);
    expect_refused<std::runtime_error>({
        {"the same number again", [&] { second.number("a", number); }},
        {"the same field again", [&] { second.field("spins", spins); }},
        {"a field without a name", [&] { second.field("", spins); }},
        {"a field in no group", [&] { second.field("none/spins", spins); }},
    });
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
  CheckpointReader reader(path);
  EXPECT_EQ(reader.header().shape, small_header().shape);
  std::vector<double> read;
  expect_refused<std::runtime_error>({
      {"a number that is not there", [&] { reader.number("b", number); }},
      {"a field that is not there", [&] { reader.field("b", read); }},
      {"a group as a field", [&] { reader.field("numbers", read); }},
  });
  reader.number("a", number);
  reader.field("spins", read);
  EXPECT_EQ(number, 0.25);
  EXPECT_EQ(read, spins);
}

TEST_F(TrajectoryTest, SweepsHaveAResultForEachRun) {
  SweepInfo sweep;
  sweep.header.keys = {{"a", {"1", "2"}, {1, 2}}, {"b", {"3", "4", "5"}, {}}};
  sweep.runs.resize(6);
  auto const path = folder_ / "sweep.h5";
  auto const write = [&](auto const& change) {
    return [&, change] {
      auto wrong = sweep;
      change(wrong);
      write_sweep(path, wrong);
    };
  };
  expect_refused({
      {"a run less", write([](auto& wrong) { wrong.runs.pop_back(); })},
      {"a run more", write([](auto& wrong) { wrong.runs.emplace_back(); })},
      {"a number less", write([](auto& wrong) { wrong.header.keys[0].numbers.pop_back(); })},
      {"a key without values", write([](auto& wrong) { wrong.header.keys[1].values.clear(); })},
      {"run -1", [&] { sweep.header.indices(-1); }},
      {"run 6", [&] { sweep.header.overrides(6); }},
  });
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
  EXPECT_TRUE(write_sweep(path, sweep));
  EXPECT_EQ(read_sweep(path).header.overrides(5), (std::vector<std::string>{"a=2", "b=5"}));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
