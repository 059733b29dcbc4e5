// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "program_test.hpp"

#include "../support/larger.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

void limit(int resource, long value) {
  if (value < 0) return;
  auto const most = static_cast<rlim_t>(value);
  rlimit const limit{most, most};
  if (::setrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) ::_exit(120);
}

[[noreturn]] void become_program(fs::path const& folder, Arguments const& arguments,
                                 Treatment const& treatment, char const* output = "stdout",
                                 char const* errors = "stderr") {
  auto const redirect = [&](char const* name, int to) {
    ::dup2(::open((folder / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), to);
  };
  redirect(output, STDOUT_FILENO);
  redirect(errors, STDERR_FILENO);
  if (::chdir(folder.c_str()) != 0) ::_exit(121);
  limit(RLIMIT_FSIZE, treatment.file_limit);
  limit(RLIMIT_AS, treatment.memory_limit);
  limit(RLIMIT_CPU, treatment.seconds_limit);
  std::vector<char*> words{const_cast<char*>("cayspin")};
  for (auto const& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  ::execv(treatment.program.c_str(), words.data());
  ::_exit(122);
}

// Converts a status from wait() to one as in Outcome::status.
int status_of(int waited) {
  return WIFEXITED(waited) ? WEXITSTATUS(waited) : 128 + WTERMSIG(waited);
}

// Returns true if a process has its own action for SIGINT. Linux says so in /proc; elsewhere, this
// waits for a second.
bool catches_interrupts(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  if (!status) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    return true;
  }
  std::string line;
  while (std::getline(status, line))
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1U) != 0;
  return false;
}

}  // namespace

Arguments joined(Arguments first, Arguments const& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

ProgramTest::ProgramTest() {
  auto pattern = (fs::path(testing::TempDir()) / "cayspin_program_XXXXXX").string();
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("cannot create " + pattern);
  folder_ = pattern;
  write("chain.toml", chain_scene());
  write("spin.toml", macrospin_scene());
}

ProgramTest::~ProgramTest() { fs::remove_all(folder_); }

Outcome ProgramTest::start(Arguments const& arguments, Treatment const& treatment) const {
  pid_t const child = ::fork();
  if (child == 0) become_program(folder_, arguments, treatment);
  if (treatment.interrupt_when_caught || !treatment.interrupt_when.empty()) {
    EXPECT_TRUE(eventually([&] {
      return treatment.interrupt_when_caught ? catches_interrupts(child)
                                             : fs::exists(treatment.interrupt_when);
    })) << treatment.interrupt_when;
    std::this_thread::sleep_for(std::chrono::duration<double>(treatment.interrupt_after));
    ::kill(child, SIGINT);
  }
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  return {status_of(status), text_of("stdout"), text_of("stderr"),
          1024.0 * static_cast<double>(usage.ru_maxrss)};
}

Outcome ProgramTest::expect_status(int status, Arguments const& arguments,
                                   Treatment const& treatment) const {
  auto const outcome = start(arguments, treatment);
  auto const asked = testing::PrintToString(arguments);
  EXPECT_EQ(outcome.status, status) << asked << ": " << outcome.errors;
  if (status == 0)
    EXPECT_EQ(outcome.errors, "") << asked;
  else
    EXPECT_TRUE(is_one_line(outcome.errors)) << asked;
  return outcome;
}

void ProgramTest::expect_refused(Arguments const& arguments, std::string const& part,
                                 Treatment const& treatment) const {
  auto const outcome = expect_status(2, arguments, treatment);
  EXPECT_TRUE(contains(outcome.errors, part)) << testing::PrintToString(arguments);
  EXPECT_EQ(outcome.output, "");
}

std::string ProgramTest::output_of(Arguments const& arguments) const {
  return expect_status(0, arguments).output;
}

pid_t ProgramTest::begin(Arguments const& arguments, fs::path const& program) const {
  Treatment treatment;
  treatment.program = program;
  pid_t const child = ::fork();
  if (child == 0) become_program(folder_, arguments, treatment, "/dev/null", "/dev/null");
  return child;
}

int ProgramTest::end(pid_t process, int signal) {
  if (signal != 0) ::kill(process, signal);
  int status = 0;
  ::waitpid(process, &status, 0);
  return status_of(status);
}

bool ProgramTest::eventually(std::function<bool()> const& is_so) {
  auto const deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

Outcome ProgramTest::run_into(std::string const& file, std::string const& scene,
                              Arguments const& more) const {
  write("scene.toml", scene);
  return start(joined({"run", "scene.toml", "--quiet", "--overwrite", "--output", file}, more));
}

io::TrajectoryInfo ProgramTest::run(std::string const& scene, Arguments const& more) const {
  auto const outcome = run_into("out.h5", scene, more);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "");
  EXPECT_EQ(outcome.output, "");
  auto const info = io::read_info(in_folder("out.h5"));
  EXPECT_TRUE(info.complete);
  return info;
}

std::vector<double> ProgramTest::end_of(std::string const& scene, Arguments const& more) const {
  auto const outcome = run_into("out.h5", scene, more);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  return last_spins("out.h5");
}

fs::path ProgramTest::write(std::string const& name, std::string const& text) const {
  std::ofstream(folder_ / name) << text;
  return folder_ / name;
}

std::string ProgramTest::text_of(std::string const& name) const {
  std::ifstream file(folder_ / name);
  return {std::istreambuf_iterator<char>(file), {}};
}

Dataset ProgramTest::read_dataset(std::string const& name, std::string const& dataset) const {
  hid_t const file = H5Fopen((folder_ / name).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t const data = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  hid_t const space = H5Dget_space(data);
  std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  Dataset read{{extents.begin(), extents.end()},
               std::vector<double>(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)))};
  EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.values.data()), 0);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  return read;
}

std::vector<double> ProgramTest::last_spins(std::string const& name) const {
  auto const spins = read_dataset(name, "/spins");
  auto const frames = static_cast<std::ptrdiff_t>(spins.extents.at(0));
  if (frames == 0) throw std::runtime_error(name + " has no frame");
  auto const frame = static_cast<std::ptrdiff_t>(spins.values.size()) / frames;
  return {spins.values.end() - frame, spins.values.end()};
}

double distance(std::vector<double> const& a, std::vector<double> const& b) {
  if (a.size() != b.size()) return INFINITY;
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    double const apart = std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]);
    if (!std::isfinite(apart)) return INFINITY;
    largest = cayspin::test::larger(largest, apart);
  }
  return largest;
}

testing::AssertionResult is_one_line(std::string const& text) {
  if (std::ranges::count(text, '\n') == 1 && text.size() > 1 && text.ends_with('\n'))
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << "not one line: \"" << text << '"';
}

std::string behind_warning(std::string const& errors) {
  auto const end = errors.find('\n') + 1;
  auto const warning = errors.substr(0, end), behind = errors.substr(end);
  EXPECT_TRUE(contains_all(warning, {"warning: ", "integrator.dt"}));
  EXPECT_TRUE(is_one_line(behind));
  return behind;
}

testing::AssertionResult contains(std::string const& text, std::string const& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << text << "\" lacks \"" << part << '"';
}

testing::AssertionResult contains_all(std::string const& text,
                                      std::vector<std::string> const& parts) {
  for (auto const& part : parts)
    if (auto const found = contains(text, part); !found) return found;
  return testing::AssertionSuccess();
}

std::string chain_scene() {
  return R"([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [20, 3]
[field]
exchange = 1.0
anisotropy = [{ constant = 0.5, axis = [0, 0, 1] }, { constant = -0.2, axis = [0, 1, 1] }]
applied = [0.3, -0.2, 0.1]
slab_demag = { normal = [1, 0, 0] }
[initial]
random = { seed = 3 }
[integrator]
method = "rkmk4"
dt = 0.02
steps = 25
[output]
file = "chain.h5"
every = 10
)";
}

std::string macrospin_scene() {
  return R"([system]
kind = "llg"
damping = 0.5
[lattice]
shape = [1]
[field]
applied = [0, 0, 1]
[initial]
uniform = [1, 0, 0.2]
[integrator]
method = "rkmk4"
dt = 0.1
end = 5.0
)";
}

std::string bodies_scene() {
  return R"([system]
kind = "rigid_body"
inertia = [1.0, 2.0, 3.0]
[lattice]
shape = [5]
[initial]
random = { seed = 2 }
[integrator]
method = "rkmk4"
dt = 0.05
steps = 40
)";
}

}  // namespace cayspin::program::test
