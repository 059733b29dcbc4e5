// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// `cayspin trade` and `cayspin advise`: the errors they print are those of the runs they name.
#include "early_rest.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

namespace cayspin::program::test {
namespace {

/// Returns the arguments that follow the scene in the recommended command.
Arguments advised_arguments(std::string const& advice) {
  std::istringstream lines(advice);
  Arguments arguments;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("run it")) continue;
    std::istringstream words(line.substr(line.find(".toml") + 5));
    for (std::string word; words >> word;) {
      std::erase(word, '\'');
      arguments.push_back(word);
    }
  }
  EXPECT_FALSE(arguments.empty()) << advice;
  return arguments;
}

struct Trading : ProgramTest {
  static std::string scene() {
    return R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [6]
[field]
exchange = 0.5
applied = [0.4, 0.3, 1.0]
[initial]
expression = ["0.3+0.2*cos(pi*x)", "0.5", "0.8*x"]
[integrator]
method = "rkmk4"
dt = 0.1
end = 4.0
)toml";
  }
  Trading() { write("scene.toml", scene()); }
  std::vector<double> end(Arguments const& more) const {
    return end_of(scene(), joined(more, {"--threads", "1"}));
  }
  nlohmann::json trade(Arguments const& more) const {
    return nlohmann::json::parse(
        output_of(joined({"trade", "scene.toml", "--json", "--threads", "1"}, more)));
  }
  std::string advise(std::string const& error, Arguments const& more = {}) const {
    return output_of(joined({"advise", "scene.toml", "--error", error, "--threads", "1"}, more));
  }
  // Expects a dataset of out.h5 to have `count` times, `apart` from each other, starting at 0.
  void expect_equal_times(char const* dataset, double apart, std::size_t count) const {
    auto const times = read_dataset("out.h5", dataset).values;
    ASSERT_EQ(times.size(), count) << dataset;
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(times[i], apart * double(i), 1e-12) << dataset;
  }
  std::vector<double> exact() const { return end(set("integrator.dt=0.0005")); }
};

TEST_F(Trading, ErrorsFallAndParetoFrontHasNoDominatedPoint) {
  auto const all = trade({"--seconds", "2"});
  EXPECT_EQ(all["horizon"], 4.0);
  EXPECT_LT(all["uncertainty"].get<double>(), 1e-10);
  std::set<std::string> names;
  std::vector<std::pair<double, double>> front;
  for (auto const& method : all["methods"]) {
    names.insert(method["method"]);
    auto const& rungs = method["rungs"];
    ASSERT_FALSE(rungs.empty()) << method["method"];
    if (rungs.size() < 3) continue;  // far slower than the others
    EXPECT_LT(rungs.back()["error"].get<double>(), 0.5 * rungs.front()["error"].get<double>())
        << method["method"];
    for (auto const& rung : rungs)
      if (rung["front"].get<bool>()) front.emplace_back(rung["error"], rung["seconds"]);
  }
  for (char const* name : {"rkmk4", "rkmk4 tangent", "cf4", "ab2", "red_black4", "tsit5 tangent",
                           "projected_rk4", "projected_dp5", "rkmk4, single"})
    EXPECT_TRUE(names.contains(name)) << name;
  for (auto const& [error, seconds] : front)
    for (auto const& [other, others] : front) EXPECT_FALSE(other <= error && others < seconds);
}

/// Returns the lines after the one that starts with the heading, up to the next empty one.
std::vector<std::string> table_below(std::string const& text, std::string const& heading) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line) && !line.starts_with(heading)) continue;
  while (std::getline(stream, line) && !line.empty()) lines.push_back(line);
  return lines;
}

TEST_F(Trading, ItsTextHasEveryRungAndJudgesTheAdvice) {
  auto const text = output_of({"trade", "scene.toml", "--advice", "--precision", "double",
                               "--seconds", "1", "--threads", "1", "--quiet"});
  EXPECT_TRUE(contains(text, "the last t = 4\n"));

  std::vector<double> errors;  // of rkmk4
  int on_front = 0;
  constexpr std::size_t name_width = 33;
  for (auto const& line : table_below(text, "method ")) {
    std::istringstream numbers(line.substr(name_width));
    std::string kind, front;
    double steps = 0, error = 0, seconds = 0, evaluations = 0;
    ASSERT_TRUE(numbers >> kind >> steps >> error >> seconds >> evaluations) << line;
    EXPECT_TRUE(kind == "dt" || kind == "tol") << line;
    EXPECT_GT(seconds, 0) << line;
    on_front += numbers >> front && front == "*";
    if (line.starts_with("rkmk4   ")) errors.push_back(error);
  }
  EXPECT_GE(on_front, 3);
  ASSERT_GE(errors.size(), 4u);
  EXPECT_GT(errors.front(), 1e-6);
  EXPECT_LT(errors.back(), 1e-9);

  auto const goals = table_below(text, "seconds (evaluations) to an error of");
  ASSERT_GE(goals.size(), 10u);
  for (char const* goal : {"1e-02", "1e-04", "1e-06", "1e-08"})
    EXPECT_TRUE(contains(goals.front(), goal));

  auto const verdicts = table_below(text, "what `cayspin advise` says");
  ASSERT_EQ(verdicts.size(), 5u);
  for (std::size_t i = 1; i < verdicts.size(); ++i) {
    double const ratio = std::stod(verdicts[i].substr(8 + 1 + name_width + 1 + 14));
    EXPECT_GT(ratio, 0) << verdicts[i];
    EXPECT_LT(ratio, 1) << verdicts[i];
  }
}

// A rung has the evaluations of a separate run with its dt, and a comparable error.
TEST_F(Trading, ARungIsARunOfTheScene) {
  auto const reference = exact();
  auto const all = trade({"--seconds", "2"});
  auto const& methods = all["methods"];
  auto const is_rkmk4 = [](auto const& method) { return method["method"] == "rkmk4"; };
  auto const found = std::ranges::find_if(methods, is_rkmk4);
  ASSERT_NE(found, methods.end());
  auto const& rung = (*found)["rungs"].front();
  auto const dt = rung["dt"].get<double>();
  std::int64_t const steps = std::llround(4 / dt);
  std::ostringstream exactly;
  exactly.precision(17);
  exactly << "integrator={method='rkmk4',dt=" << dt << ",steps=" << steps << "}";
  auto const numbers = end(set(exactly.str()));
  EXPECT_EQ(rung["evaluations"], 4 * steps);
  // The error of a rung is the largest at a dozen points in time, not only at the end.
  EXPECT_GE(rung["error"].get<double>(), 0.9 * distance(numbers, reference));
  EXPECT_LE(rung["error"].get<double>(), 100 * distance(numbers, reference));
}

TEST_F(Trading, AdvisesOnVacancies) {
  for (std::string const vacancy : {"occupied = 'i - 1'", "moments = 'i'"}) {
    auto text = scene();
    std::string const shape = "shape = [6]\n";
    text.insert(text.find(shape) + shape.size(), vacancy + "\n");
    write("scene.toml", text);
    auto const arguments = advised_arguments(advise("1e-3"));
    auto const reference = end_of(text, set("integrator.dt=0.0005"));
    EXPECT_LT(distance(end_of(text, arguments), reference), 2e-3) << vacancy;
  }
}

TEST_F(Trading, AnAdvisedRunHasTheErrorAskedFor) {
  auto const reference = exact();
  for (bool const fine : {false, true}) {
    std::string const error = fine ? "1e-6" : "1e-3";
    // The scene of the smaller error has keys that not every method accepts.
    auto const advice = advise(
        error,
        set(fine
                ? "integrator={method=\"tsit5\",generator=\"tangent\",tolerance=1e-4,dt=0.1,end=4.0}"
                : "integrator.energy_guard=false",
            "output={every=10,scalars_every=4}"));
    auto const arguments = advised_arguments(advice);
    EXPECT_LT(distance(end(arguments), reference), 2 * std::stod(error)) << advice;
    // Frames and samples keep the scene's times, whatever the steps.
    expect_equal_times("/time", 1.0, 5);
    expect_equal_times("/scalars/time", 0.4, 11);
    auto const text = info_of("out.h5").header.scene_text;
    EXPECT_EQ(text.find("energy_guard = false") != text.npos, !fine) << text;
  }
}

TEST_F(Trading, TheConstantSigmaIsThatOfEqualSpins) {
  auto const sigmas = [&](std::string const& lattice) {
    std::set<std::string> found;
    auto const all = trade(joined({"--seconds", "0.1"}, set(lattice)));
    for (auto const& method : all["methods"]) {
      std::string const name = method["method"];
      if (auto const at = name.find(" sigma "); at != name.npos)
        found.insert(name.substr(at + 7, name.find(',', at) - at - 7));
    }
    return found;
  };
  EXPECT_EQ(sigmas("lattice={shape=[6],moments=[2.0],gyromagnetic=[6.0]}"),
            std::set<std::string>{"3"});
  EXPECT_EQ(sigmas("lattice={shape=[6],moments=\"i < 3 ? 1 : 2\"}"), std::set<std::string>());
}

TEST_F(Trading, AnAdvisedRunKeepsTheTimesOfCheckpoints) {
  auto const advice = nlohmann::json::parse(
      advise("1e-3", joined({"--json"}, set("output={every=4,checkpoint_every=\"4 steps\"}"))));
  std::set<std::string> const overrides = advice["overrides"];
  auto const every = std::ranges::find_if(
      overrides, [](auto const& one) { return one.starts_with("output.every="); });
  ASSERT_NE(every, overrides.end()) << advice;
  EXPECT_TRUE(overrides.contains("output.checkpoint_every=\"" + every->substr(13) + " steps\""))
      << advice;
}

/// A scene to advise on, compared at each of its frames.
struct Watched : Trading {
  /// Returns the largest error at any frame, divided by the requested error.
  double error(std::string const& text, std::string const& asked) const {
    auto const frames = [&](Arguments const& more) {
      end_of(text, joined(more, {"--threads", "1"}));
      return read_dataset("out.h5", "/spins").values;
    };
    auto const exact = frames({});
    auto const advised = frames(advised_arguments(advise(asked, {"--quiet"})));
    EXPECT_EQ(advised.size(), exact.size());
    return distance(advised, exact) / std::stod(asked);
  }
};

// The spin turns by 40 radians in a quarter of the run. An implicit method halves such long steps,
// since they do not converge, so runs with 4 and with 8 steps end equally.
TEST_F(Watched, OneSpinThatTurnsFast) {
  std::string const scene = R"toml([system]
kind = "llg"
damping = 0.05
[lattice]
shape = [1]
[field]
applied = [0.1, 0.05, -1.2]
anisotropy = [{ constant = 1.0, axis = [0, 0, 1] }, { constant = -0.5, axis = [1, 0, 0] }]
[initial]
uniform = [0.02, 0.01, 1.0]
[integrator]
method = "rkmk8"
dt = 0.05
end = 60.0
[output]
every = 10
)toml";
  for (char const* error : {"1e-4", "1e-6", "1e-8"})
    EXPECT_LT(this->error(scene, error), 2) << error;
}

// Most of the motion happens in the first twentieth of the run.
TEST_F(Watched, ASlabThatComesToRestEarly) {
  std::string const scene = early_rest(R"toml([integrator]
method = "rkmk8"
dt = 0.01
end = 20.0
[output]
every = 20
)toml");
  // Near equilibrium the errors of adaptive steps vary between samples, so the bound has a margin.
  for (char const* error : {"1e-3", "1e-6"}) EXPECT_LT(this->error(scene, error), 4) << error;
}

TEST_F(Trading, ARunOfMethodAutoHasTheErrorAskedFor) {
  auto const reference = exact();
  for (std::string const error : {"1e-3", "1e-6"}) {
    auto const numbers =
        end(set("integrator={method='auto',error=" + error + ",end=4.0,dt=0.5}", "output.every=2"));
    EXPECT_LT(distance(numbers, reference), 2 * std::stod(error));
    expect_equal_times("/time", 1.0, 5);
    auto const header = info_of("out.h5").header;
    EXPECT_TRUE(contains(header.scene_text, "auto"));
    EXPECT_TRUE(
        contains(output_of({"info", "out.h5"}), "scene as resolved:\n" + header.resolved_scene));
    auto const spins = read_dataset("out.h5", "/spins").values;
    auto const again = run(header.resolved_scene).header;
    EXPECT_EQ(read_dataset("out.h5", "/spins").values, spins);
    EXPECT_EQ(again.resolved_scene, "");
  }
}

TEST_F(Trading, AScenesStartAloneIsNoChoice) {
  end(set("integrator={method='auto',error=1e-3,steps=0,dt=0.5}"));
  EXPECT_EQ(read_dataset("out.h5", "/time").values, std::vector<double>{0});
}

TEST_F(Trading, AnAdvisedRunWarnsOfNothingThatTheAdviceDoesNotSay) {
  // A constant sigma is fast here, at a dt far above the one that is stable for nearly uniform
  // spins.
  std::string const disordered = "lattice={shape=[4,4,4],boundary=\"periodic\"}";
  for (std::string const refuse : {"false", "true"}) {
    auto const advice =
        advise("1e-4", joined({"--precision", "double"},
                              set(disordered, "initial={random={seed=1}}", "field={exchange=1.0}",
                                  "system.damping=0", "integrator.refuse_unstable=" + refuse)));
    auto const outcome = run_into("out.h5", scene(), advised_arguments(advice));
    EXPECT_EQ(outcome.status, 0) << advice << outcome.errors;
    EXPECT_EQ(contains(outcome.errors, "warning: "), contains(advice, "\nrun warns "))
        << advice << outcome.errors;
    EXPECT_TRUE(refuse == "false" || outcome.errors.empty()) << outcome.errors;
  }
}

TEST_F(Trading, TheCommandOfAnAdviceIsOneForAShell) {
  write("its scene.toml", scene());
  auto const advice = output_of(joined(
      {"advise", "its scene.toml", "--error", "1e-3", "--threads", "1", "--precision", "double"},
      set("output.file='its run.h5'")));
  EXPECT_TRUE(contains(
      advice, R"(cayspin run 'its scene.toml' --set 'output.file='\''its run.h5'\''' --set )"))
      << advice;
}

TEST_F(Trading, ShortensTheHorizonOfVeryLongRuns) {
  auto const all = trade(joined({"--seconds", "1e-9", "--precision", "double"},
                                set("integrator={method='rkmk4',dt=1,end=1e8}")));
  EXPECT_EQ(all["horizon"], std::ldexp(1e8, -20));
}

TEST_F(Trading, AdviseReportsBudgetExceeded) {
  auto const outcome = expect_status(
      3, {"advise", "scene.toml", "--error", "1e-6", "--budget", "0.000000001s", "--threads", "1"});
  EXPECT_TRUE(contains(outcome.errors, "beyond the budget"));
}

// Without --precision, both precisions are tried; single precision is among the fastest here.
TEST_F(Trading, TriesTheOnePrecisionThatIsAskedFor) {
  for (std::string const precision : {"double", "single"}) {
    auto const methods = trade({"--seconds", "0.1", "--precision", precision})["methods"];
    ASSERT_FALSE(methods.empty());
    for (auto const& method : methods)
      EXPECT_EQ(method["method"].get<std::string>().find(", single") != std::string::npos,
                precision == "single")
          << method["method"];
  }
}

TEST_F(Trading, AdvisesInTheOnePrecisionThatIsAskedFor) {
  for (std::string const precision : {"double", "single"}) {
    auto const advice = advise("1e-3", {"--precision", precision});
    auto const command = advice.substr(advice.find("run it"));
    EXPECT_EQ(command.find("--precision single") != std::string::npos, precision == "single")
        << advice;
    std::istringstream lines(advice.substr(advice.find("the next best:")));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line))
      EXPECT_EQ(line.find(", single") != std::string::npos, precision == "single") << line;
  }
}

TEST_F(Trading, AnAdviceNamesTheSpaceAndThreadsOfItsTime) {
  auto const command = advise("1e-3", {"--space", another_space, "--precision", "double"});
  EXPECT_TRUE(contains(command, " --space " + another_space)) << command;
  auto const threads = advise("1e-3", {"--precision", "double"});
  EXPECT_TRUE(contains(threads, " --space " + default_space + " --threads 1\n")) << threads;
  // The scene names no output file, so the advised command names one.
  EXPECT_TRUE(contains(threads, "--set 'output.file=\"scene.h5\"'")) << threads;
}

TEST_F(Trading, TheCommandOfAnAdviceRunsAsItStands) {
  auto const advice = advise("1e-3");
  auto const begin = advice.find("cayspin run ");
  auto const command = advice.substr(begin + 8, advice.find('\n', begin) - begin - 8);
  auto const script = write("pasted.sh", std::string("'") + CAYSPIN_PROGRAM + "' " + command);
  EXPECT_EQ(std::system(("cd " + in_folder("").string() + " && sh " + script.string() +
                         " > pasted.txt 2>&1")
                            .c_str()),
            0)
      << advice << text_of("pasted.txt");
  EXPECT_TRUE(exists("scene.h5"));
}

TEST_F(Trading, ALatticeThatDoesNotFitIsRefusedWithItsNeed) {
  for (Arguments const& command :
       {Arguments{"advise", "scene.toml", "--error", "1e-3"}, Arguments{"trade", "scene.toml"},
        joined({"run", "scene.toml", "--output", "out.h5"},
               set("integrator={method='auto',error=1e-3,end=4.0}")),
        joined({"check", "scene.toml"}, set("integrator={method='auto',error=1e-3,end=4.0}"))}) {
    auto const outcome =
        expect_status(2, joined(command, set("lattice={shape=[300000000,3000000]}")));
    EXPECT_TRUE(contains(outcome.errors, "lattice.shape: trying methods needs ")) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, " is available; accepted: a smaller lattice"))
        << outcome.errors;
  }
}

}  // namespace
}  // namespace cayspin::program::test
