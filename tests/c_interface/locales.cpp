// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A locale with a decimal comma does not change numbers, files or messages.
#include "../program/program_test.hpp"
#include "../support/decimal_comma.hpp"
#include "../support/file_bytes.hpp"
#include "c_interface_test.hpp"
#include "io/expression.hpp"
#include "io/ovf.hpp"
#include "io/scene.hpp"
#include "io/trajectory.hpp"

#include <cayspin/detail/text.hpp>

#include <cmath>
#include <map>
#include <sstream>
#include <string>

using namespace cayspin::test;
namespace io = cayspin::io;
namespace fs = std::filesystem;

namespace {

std::string const crystal = R"(# A cell of two atoms
1.5 1.5 1.5
1.0 0.0 0.0
0.0 1.0 0.0
0.0 0.0 1.0
2
0 0.0 0.0 0.0
1 0.5 0.5 0.5
4 isotropic
0 0 1 0 0 0 1234.5
1 1 0 0 0 0 1234.5
2 0 0 1 0 0 0.125
3 0 0 -1 0 0 0.125
)";

std::string film(std::string const& start) {
  return "[system]\nkind = \"llg\"\ndamping = 0.125\n[lattice]\nshape = [6, 2]\nspacing = [1.5, 0.25]\n"
         "occupied = \"i < 4.5 ? 1.5 : 0.0\"\n[field]\nexchange = 1.5\n"
         "applied = [0.5, \"0.25 * cos(1.5 * t)\", 1234.5e-3]\n[initial]\n" +
         start +
         "\n[integrator]\nmethod = \"rkmk4\"\ndt = 0.0625\nsteps = 20\n"
         "[output]\nevery = 5\nscalars_every = 1\ntable = true\nxdmf = true\n";
}

/// A scene with a pulse so short that an adaptive method finds it only from the times in the text
/// of the expression.
std::string const pulse = R"([system]
kind = "llg"
damping = 0.5
[lattice]
shape = [1]
[field]
applied = ["t > 5.375 && t < 5.3750001 ? 1e7 : 0", "0", "1.0"]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "tsit5"
tolerance = 1e-6
dt = 0.5
steps = 12
[output]
table = true
xdmf = true
)";

/// Results of functions that read or write numbers as text, by name.
using Results = std::map<std::string, std::string>;

std::string said(auto const& call) {
  try {
    call();
  } catch (std::exception const& error) {
    return error.what();
  }
  return "nothing";
}

std::string numbers(std::vector<double> const& values) {
  return {reinterpret_cast<char const*>(values.data()), sizeof(double) * values.size()};
}

class Locales : public cayspin::program::test::ProgramTest {
 protected:
  void run(Results& results, std::string const& name, std::string const& scene) const {
    auto const simulation = open(scene);
    auto const file = in_folder(name + ".h5");
    EXPECT_EQ(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_OK) << cayspin_last_error();
    results[name + " spins"] = numbers(last_spins(name + ".h5"));
    results[name + " scene"] = io::read_info(file).header.scene_text;
    for (auto const* beside : {".txt", ".xdmf"})
      results[name + beside] = read_bytes(fs::path(file).replace_extension(beside));
  }

  void files(Results& results) const {
    io::OvfField field;
    field.mesh.nodes = {6, 2, 1};
    field.mesh.step = {1.5, 0.25, 1234.5};
    for (int i = 0; i < 36; ++i) field.values.push_back(0.125 * i + 1234.5e3);
    auto const ovf = in_folder("start.ovf");
    io::write_ovf(ovf, field, io::OvfFormat::text, true);
    results["ovf"] = read_bytes(ovf);
    results["ovf values"] = numbers(io::read_ovf(ovf).values);
    auto text = results["ovf"];
    text.replace(text.find("Begin: Data Text\n") + 17,
                 text.find('\n', text.find("Data Text\n") + 10) - text.find("Data Text\n") - 10,
                 "1.5e-400 -1.5e400 4.9e-324");
    write_bytes(in_folder("limits.ovf"), text);
    auto const limits = io::read_ovf(in_folder("limits.ovf")).values;
    EXPECT_EQ(limits[0], 0);
    EXPECT_TRUE(std::isinf(limits[1]));
    EXPECT_EQ(limits[2], 4.9e-324);
    run(results, "film", film("expression = [\"sin(1.5*x)\", \"0.25\", \"1.5 - 0.125*y\"]"));
    run(results, "pulse", pulse);
    run(results, "from_ovf", film("file = \"" + ovf.string() + "\""));
    write_bytes(in_folder("cell.ucf"), crystal);
  }

  void scenes(Results& results) const {
    auto const scene = io::parse_scene(film("uniform = [0.5, 1.25, -1.5]"), "film.toml",
                                       {"system.damping=0.0625", "lattice.shape=[1234, 2]",
                                        "integrator.dt=1.5e-3", "output.table=false"});
    results["overridden"] = scene.text;
    results["initial spins"] = numbers(io::initial_spins(scene));
    for (auto const* table : {"integrator", "lattice", "output"})
      results[table] = io::as_override(scene.text, table);
    double const t = 0.5;
    results["expression"] = numbers({io::Expression("1.5 * t + 1234.5e-1", {"t"})(&t)});
    results["ucf"] = [&] {
      auto const of_cell = io::parse_scene(
          "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\nshape = [2, 2, 2]\n"
          "spacing = 1.5\ncell = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n"
          "basis = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.5]]\n[field]\ncouplings = { file = \"" +
              in_folder("cell.ucf").string() +
              "\", scale = 0.5 }\n[initial]\nuniform = [0, 0, 1]\n"
              "[integrator]\nmethod = \"rkmk4\"\ndt = 0.1\nsteps = 1\n",
          "cell.toml");
      std::vector<double> all;
      for (auto const& coupling : io::couplings(of_cell))
        all.insert(all.end(), coupling.tensor.begin(), coupling.tensor.end());
      EXPECT_FALSE(all.empty());
      return numbers(all);
    }();
  }

  static void messages(Results& results) {
    std::string const text = film("uniform = [0.5, 1.25, -1.5]");
    int count = 0;
    for (std::string const override :
         {"system.damping=-0.25", "integrator.dt=\"1234567\"", "integrator.steps=1.5",
          "lattice.spacing=[1.5, 0.0]", "integrator.steps=12345678901234567", "output.table=12345",
          "initial={uniform=[0.5, 1.5]}", "field.applied=[1.5, \"1,5\", 0]", "output.every=true",
          "field.exchange=-1.5e-7", "lattice.shape=[1234567890123]", "output.xdmf=1979-05-27"})
      results["message " + std::to_string(++count)] =
          said([&] { io::parse_scene(text, "film.toml", {override}); });
    results["to_text"] = cayspin::detail::to_text(1234567.25) + cayspin::detail::to_text(1.5e-12);
    auto const simulation = open(text);
    cayspin_minimum found{};
    EXPECT_EQ(cayspin_relax(simulation.get(), -1234.5, 12345, nullptr, &found),
              CAYSPIN_WRONG_USAGE);
    results["relax"] = cayspin_last_error();
    EXPECT_EQ(cayspin_step(simulation.get(), -12345), CAYSPIN_WRONG_USAGE);
    results["step"] = cayspin_last_error();
  }

  Results all() const {
    Results results;
    files(results);
    scenes(results);
    messages(results);
    return results;
  }
};

TEST_F(Locales, DecimalCommaChangesNothing) {
  auto const expected = all();
  DecimalComma const comma(in_folder("."));
  std::ostringstream stream;
  stream << 1234.5;
  ASSERT_EQ(stream.str(), "1.234,5");
  char text[8];
  std::snprintf(text, sizeof text, "%.1f", 1.5);
  ASSERT_STREQ(text, comma.has_c ? "1,5" : "1.5");
  RecordProperty("locale of C", comma.has_c ? "de_DE" : "none");
  auto const found = all();
  ASSERT_EQ(found.size(), expected.size());
  for (auto const& [name, result] : expected) EXPECT_EQ(found.at(name), result) << name;
}

}  // namespace
