// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// All functions of steppers refuse fields and generators of other lattices. Spins in the stepper's
// own memory are refused or moved correctly.
#include "wrong_calls.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/rkmk4_as_printed.hpp>
#include <cayspin_paper/series4.hpp>

#include <cmath>
#include <memory>

namespace cayspin::test {
namespace {

/// Calls visit(name, make) for one stepper of each kind; make(like) returns a new one.
template <class Visit>
void for_each_stepper(Visit const& visit) {
  visit("LieEuler", [](Spins const& like) { return LieEuler(like); });
  visit("LieHeun", [](Spins const& like) { return LieHeun(like); });
  visit("LieHeun, swept", [](Spins const& like) {
    LieHeun stepper(like);
    stepper.use(Path::sweep);
    return stepper;
  });
  visit("LieAdamsBashforth2", [](Spins const& like) { return LieAdamsBashforth2(like); });
#if !defined(__SANITIZE_ADDRESS__)  // with the sanitizer the others take minutes to compile
  visit("LieEuler, Analytic",
        [](Spins const& like) { return LieEuler(like, isotropy::Analytic()); });
  visit("Compensated", [](Spins const& like) { return Compensated<LieHeun<Spins>>(like); });
  visit("ImplicitMidpoint", [](Spins const& like) { return ImplicitMidpoint(like); });
  visit("Series4", [](Spins const& like) { return Series4(like); });
  visit("RedBlack2", [](Spins const& like) { return RedBlack2(like); });
  visit("AdaptiveRkmk", [](Spins const& like) {
    return AdaptiveRkmk<Spins, tableau::BogackiShampine3>(like, {.tolerance = 1e-4});
  });
  visit("Rkmk4AsPrinted", [](Spins const& like) { return Rkmk4AsPrinted<Spins>(like); });
#endif
}

/// Returns all calls of a stepper with these spins and this generator.
template <class Make>
std::vector<WrongCall> calls_of(std::string const& what, Make const& make, Lattice const& own,
                                Spins spins, Generator const& generator) {
  Spins const like("like", own);
  std::vector<WrongCall> calls{
      {what + ", step", [=]() mutable { make(like).step(Exec(), generator, spins, 0, 0.1); }},
      {what + ", integrate",
       [=]() mutable {
         auto stepper = make(like);
         integrate(Exec(), stepper, generator, spins, Times{0, 0.1, 3});
       }},
      {what + ", integrate over no steps", [=]() mutable {
         auto stepper = make(like);
         integrate(Exec(), stepper, generator, spins, Times{0, 0.1, 0},
                   [](Exec const&, Step const&, Spins const&) { FAIL() << "an observer sees it"; });
       }}};
  using Stepper = decltype(make(like));
  if constexpr (requires(Stepper stepper) { stepper.batch(Exec(), generator, spins, 0, 0.1, 2); })
    calls.push_back({what + ", batch",
                     [=]() mutable { make(like).batch(Exec(), generator, spins, 0, 0.1, 2); }});
  if constexpr (requires(Stepper stepper) { stepper.remember(Exec(), generator, spins, 0, 0.1); })
    calls.push_back({what + ", remember",
                     [=]() mutable { make(like).remember(Exec(), generator, spins, 0, 0.1); }});
  return calls;
}

TEST(WrongCallsOfSteppers, SpinsOfOthers) {
  for_each_stepper([](std::string const& name, auto const& make) {
    for (auto const& own : own_lattices)
      for (auto const& [kind, spins] : fields_of_others<Spins>(own)) {
        for (std::int64_t site = 0; site < spins.sites(); ++site) spins.set(site, {0.6, 0, 0.8});
        expect_refused(calls_of(name + ", spins " + kind, make, own, spins, generator_on(own)));
        for (std::int64_t site = 0; site < spins.sites(); ++site)
          EXPECT_EQ(spins.get(site).y, 0) << name << " changed spins " << kind;
      }
  });
  Lattice const own = own_lattices[0];
  Spins const like("like", own);
  Spins other("other", Lattice::chain(3));
  EXPECT_EQ(refusal([&] { RedBlack2(like).step(Exec(), generator_on(own), other, 0, 0.1); }),
            "cayspin::RedBlack2::step: the spins are not of the stepper's lattice");
}

TEST(WrongCallsOfSteppers, GeneratorsOfOthers) {
  for_each_stepper([](std::string const& name, auto const& make) {
    Lattice const own = own_lattices[0];
    for (auto const& [kind, lattice] : lattices_of_others(own))
      expect_made_for_another("Exchange", lattice, own,
                              calls_of(name + ", generator " + kind, make, own, Spins("spins", own),
                                       generator_on(lattice)));
  });
}

TEST(WrongCallsOfSteppers, MadeForNoField) {
  for_each_stepper([](std::string const& name, auto const& make) {
    expect_refused({{name, [&] { make(Spins()); }},
                    {name + ", moved", [&] { make(moved_from<Spins>(own_lattices[0])); }}});
  });
}

TEST(WrongCallsOfSteppers, MovedFrom) {
  for_each_stepper([](std::string const& name, auto const& make) {
    Lattice const own = own_lattices[0];
    auto const generator = generator_on(own);
    Spins spins("spins", own);
    auto const step = [&](auto& stepper) { stepper.step(Exec(), generator, spins, 0, 0.1); };
    auto stepper = make(spins);
    auto other = std::move(stepper);
    expect_refused({{name + ", step", [&] { step(stepper); }},
                    {name + ", integrate", [&] {
                       integrate(Exec(), stepper, generator, spins, Times{0, 0.1, 3});
                     }}});
    step(other);
    stepper = std::move(other);
    expect_refused({{name + ", after it was assigned", [&] { step(other); }}});
    step(stepper);
  });
}

TEST(WrongCallsOfSteppers, SigmasThatAreNotFinite) {
  Spins const like("like", own_lattices[0]);
  for (double const wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    isotropy::Constant const sigma{wrong};
    expect_refused({
        {"LieEuler", [&] { LieEuler(like, sigma); }},
        {"Compensated", [&] { Compensated<LieHeun<Spins, isotropy::Constant>>(like, sigma); }},
        {"LieAdamsBashforth2", [&] { LieAdamsBashforth2(like, sigma); }},
        {"ImplicitLieEuler", [&] { ImplicitLieEuler(like, sigma); }},
        {"AdaptiveRkmk",
         [&] {
           AdaptiveRkmk<Spins, tableau::BogackiShampine3, isotropy::Constant>(
               like, {.tolerance = 1e-4}, sigma);
         }},
    });
  }
}

TEST(WrongCallsOfSteppers, BatchesOfNoSteps) {
  Lattice const own = own_lattices[0];
  for (std::int64_t const count : {0, -1, -2}) {
    auto const batch = [&](auto made) {
      auto const stepper = std::make_shared<decltype(made)>(std::move(made));
      return [&own, count, stepper] {
        Spins spins("spins", own);
        stepper->batch(Exec(), generator_on(own), spins, 0, 0.1, count);
      };
    };
    Spins const like("like", own);
    auto const text = std::to_string(count);
    expect_refused({{"LieEuler, " + text, batch(LieEuler(like))},
                    {"LieHeun, " + text, batch(LieHeun(like))},
                    {"RedBlack2, " + text, batch(RedBlack2(like))}});
  }
}

// A step may swap the memory of the spins with the stepper's own. A second handle on the original
// memory is then a handle on the stepper's. This handle is refused, or steps with it are as correct
// as with the first handle.
TEST(WrongCallsOfSteppers, ASecondHandleOnTheSpins) {
  for_each_stepper([](std::string const& name, auto const& make) {
    Lattice const own = own_lattices[0];
    auto const generator = generator_on(own);
    auto const start = [&] {
      Spins spins("spins", own);
      for (std::int64_t site = 0; site < spins.sites(); ++site)
        spins.set(site, site % 2 == 0 ? Vec3<double>{0.6, 0, 0.8} : Vec3<double>{0, -0.6, 0.8});
      return spins;
    };
    auto right = start(), spins = start();
    auto reference = make(right), stepper = make(spins);
    for (int step = 0; step < 6; ++step) {
      Spins second = spins;
      double const t = 0.1 * step;
      reference.step(Exec(), generator, right, t, 0.1);
      stepper.step(Exec(), generator, spins, t, 0.1);
      if (second.allocation().data() == spins.allocation().data()) continue;
      copy_from_host(copy_to_host(spins), second);
      try {
        stepper.step(Exec(), generator, second, t + 0.1, 0.1);
      } catch (std::invalid_argument const&) {
        continue;
      }
      reference.step(Exec(), generator, right, t + 0.1, 0.1);
      EXPECT_EQ(copy_to_host(second), copy_to_host(right)) << name << ", step " << step;
      spins = second;
    }
  });
}

}  // namespace
}  // namespace cayspin::test
