// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>

// Explicit Butcher tableaux as data. To add a Runge-Kutta method, write a struct like these.
// - a: stages x stages, strictly lower triangular; b: weights; c: stage times in units of dt.
// Embedded tableaux also estimate the error of a step, and interpolate within it. For this they use
// one more stage, which evaluates the generator at the end of the step. The first stage of the next
// step uses this value again.
// - error: weights of all stages, including the additional one. The weighted sum of the increments
//   is the result of the step minus the embedded solution, which is of order embedded_order.
// - dense: for each stage, including the additional one, the coefficients of s, s^2, ... s^5 in its
//   weight at the time t + s * dt. The interpolation is of order dense_order.
namespace cayspin::inline v0_2::tableau {

/// Euler's method: order 1, one stage.
struct Euler {
  static constexpr int stages = 1, order = 1;
  static constexpr double a[1][1] = {{0}};
  static constexpr double b[1] = {1};
  static constexpr double c[1] = {0};
};

/// Heun's method (the explicit trapezoidal rule): order 2, two stages.
struct Heun {
  static constexpr int stages = 2, order = 2;
  static constexpr double a[2][2] = {{0, 0}, {1, 0}};
  static constexpr double b[2] = {0.5, 0.5};
  static constexpr double c[2] = {0, 1};
};

/// Kutta's method of order 3: three stages, at 0, 1/2 and 1. Kutta 1901.
struct Kutta3 {
  static constexpr int stages = 3, order = 3;
  static constexpr double a[3][3] = {{0, 0, 0}, {0.5, 0, 0}, {-1, 2, 0}};
  static constexpr double b[3] = {1. / 6, 2. / 3, 1. / 6};
  static constexpr double c[3] = {0, 0.5, 1};
};

/// The classical Runge-Kutta method: order 4, four stages. Kutta 1901.
struct Classical4 {
  static constexpr int stages = 4, order = 4;
  static constexpr double a[4][4] = {{0, 0, 0, 0}, {0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1, 0}};
  static constexpr double b[4] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  static constexpr double c[4] = {0, 0.5, 0.5, 1};
};

/// Kutta's 3/8 rule: order 4, four stages. Kutta 1901.
struct ThreeEighths4 {
  static constexpr int stages = 4, order = 4;
  static constexpr double a[4][4] = {
      {0, 0, 0, 0}, {1. / 3, 0, 0, 0}, {-1. / 3, 1, 0, 0}, {1, -1, 1, 0}};
  static constexpr double b[4] = {1. / 8, 3. / 8, 3. / 8, 1. / 8};
  static constexpr double c[4] = {0, 1. / 3, 2. / 3, 1};
};

/// Order 4 in six stages with the structure of RK4: each stage starts from the spins at the start
/// of the step and uses only the increment of the stage before it. The coefficients satisfy the
/// eight conditions of order 4 to 2e-14. Designed for stability along the imaginary axis: with a
/// little damping, the largest stable dt * (precession frequency) is 0.82 per stage; for RK4 it is
/// 0.71.
struct Oscillatory64 {
  static constexpr int stages = 6, order = 4;
  static constexpr double c[6] = {0,
                                  0.17760845716453608,
                                  0.4975364905249184,
                                  0.7398782940103877,
                                  0.09508339788006245,
                                  0.769585459698514};
  static constexpr double a[6][6] = {{0},          {c[1]},          {0, c[2]},
                                     {0, 0, c[3]}, {0, 0, 0, c[4]}, {0, 0, 0, 0, c[5]}};
  static constexpr double b[6] = {-0.11008852322547563, 0.593768568034667,    -0.1808081520321058,
                                  0.4468478584675798,   0.057412333557148615, 0.19286791519818647};
};

/// Order 4 in seven stages with the structure of RK4; the weights b of the first two stages are 0.
/// The eight conditions of order 4 and the last three coefficients of the stability polynomial
/// determine the other numbers. These coefficients, 0.0078, 0.00087 and 0.0001055, were found by a
/// search for long stable steps and small errors on films. The largest stable dt * (precession
/// frequency) per stage is 0.79, 0.81, 0.79, 0.61 at damping 0, 0.02, 0.1, 0.3 (RK4: 0.71, 0.72,
/// 0.73, 0.68).
struct Oscillatory74 {
  static constexpr int stages = 7, order = 4;
  static constexpr double c[7] = {0,
                                  0.20539592807993434,
                                  0.08768920619793887,
                                  0.3005134408088391,
                                  0.2422556431751244,
                                  0.7816923931860211,
                                  0.8518367764907191};
  static constexpr double a[7][7] = {{0},
                                     {c[1]},
                                     {0, c[2]},
                                     {0, 0, c[3]},
                                     {0, 0, 0, c[4]},
                                     {0, 0, 0, 0, c[5]},
                                     {0, 0, 0, 0, 0, c[6]}};
  static constexpr double b[7] = {0,
                                  0,
                                  0.11843980494594672,
                                  0.2548095327875354,
                                  0.15824198299975564,
                                  0.34767599701209795,
                                  0.12083268225466433};
};

/// Order 4 in five stages for strong damping: small errors, and stable up to dt * (decay rate) =
/// 0.70 per stage, like RK4. The last coefficient of the stability polynomial is 0.85 / 5!. Found
/// by a search for a small leading error term, which is a tenth of that of RK4.
struct Damped54 {
  static constexpr int stages = 5, order = 4;
  static constexpr double c[5] = {0, 0.14114715574092904, 0.5948055915144558, 0.1966650853743125,
                                  0.993660854459296};
  static constexpr double a[5][5] = {
      {0},
      {c[1]},
      {-0.7092991893343864, 1.3041047808488422},
      {-0.5257316359442389, 0.9416402054700906, -0.21924348415153927},
      {1.3014066834248403, -0.3115329691452973, 1.3038856843782602, -1.3000985441985073}};
  static constexpr double b[5] = {-0.02273322262758975, 0.5685080815618873, 0.5596717694246148,
                                  -0.24045170335125277, 0.13500507499234043};
};

/// Commutator-free, order 4 (Celledoni, Marthinsen and Owren 2003). The coordinates of each
/// rotation are a weighted sum of the increments dt * A of the stages. A rotation with the weights
/// a leads from the start of the step to each stage; for the last stage, a rotation with second_a
/// follows. Two rotations lead to the end of the step: first with b, then with second_b.
struct CommutatorFree4 {
  static constexpr int stages = 4, order = 4;
  static constexpr double a[4][4] = {{0, 0, 0, 0}, {0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0.5, 0, 0, 0}};
  static constexpr double second_a[4][4] = {
      {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {-0.5, 0, 1, 0}};
  static constexpr double b[4] = {1. / 4, 1. / 6, 1. / 6, -1. / 12};
  static constexpr double second_b[4] = {-1. / 12, 1. / 6, 1. / 6, 1. / 4};
  static constexpr double c[4] = {0, 0.5, 0.5, 1};
};

/// Bogacki and Shampine 1989, 3(2). Dense output: Hermite's cubic.
struct BogackiShampine3 {
  static constexpr int stages = 3, order = 3, embedded_order = 2, dense_order = 3;
  static constexpr double a[3][3] = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.75, 0}};
  static constexpr double b[3] = {2. / 9, 1. / 3, 4. / 9};
  static constexpr double c[3] = {0, 0.5, 0.75};
  static constexpr double error[4] = {2. / 9 - 7. / 24, 1. / 3 - 1. / 4, 4. / 9 - 1. / 3, -1. / 8};
  static constexpr double dense[4][5] = {
      {1, -4. / 3, 5. / 9}, {0, 1, -2. / 3}, {0, 4. / 3, -8. / 9}, {0, -1, 1}};
};

/// Dormand and Prince 1980, 5(4). Dense output: Shampine's polynomial of order 4.
struct DormandPrince5 {
  static constexpr int stages = 6, order = 5, embedded_order = 4, dense_order = 4;
  static constexpr double a[6][6] = {
      {0, 0, 0, 0, 0, 0},
      {1. / 5, 0, 0, 0, 0, 0},
      {3. / 40, 9. / 40, 0, 0, 0, 0},
      {44. / 45, -56. / 15, 32. / 9, 0, 0, 0},
      {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729, 0, 0},
      {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656, 0}};
  static constexpr double b[6] = {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84};
  static constexpr double c[6] = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1};
  static constexpr double error[7] = {71. / 57600,      0,         -71. / 16695, 71. / 1920,
                                      -17253. / 339200, 22. / 525, -1. / 40};
  static constexpr double dense[7][5] = {
      {1, -4034104133. / 1410260304, 105330401. / 33982176, -13107642775. / 11282082432,
       6542295. / 470086768},
      {},
      {0, 132343189600. / 32700410799, -833316000. / 131326951, 91412856700. / 32700410799,
       -523383600. / 10900136933},
      {0, -115792950. / 29380423, 185270875. / 16991088, -12653452475. / 1880347072,
       98134425. / 235043384},
      {0, 70805911779. / 24914598704, -4531260609. / 600351776, 988140236175. / 199316789632,
       -14307999165. / 24914598704},
      {0, -331320693. / 205662961, 31361737. / 7433601, -2426908385. / 822651844,
       97305120. / 205662961},
      {0, 44764047. / 29380423, -1532549. / 353981, 90730570. / 29380423, -8293050. / 29380423}};
};

/// Tsitouras 2011, 5(4), with its dense output of order 4.
struct Tsitouras5 {
  static constexpr int stages = 6, order = 5, embedded_order = 4, dense_order = 4;
  static constexpr double a[6][6] = {
      {0, 0, 0, 0, 0, 0},
      {0.161, 0, 0, 0, 0, 0},
      {-0.008480655492356989, 0.335480655492357, 0, 0, 0, 0},
      {2.8971530571054935, -6.359448489975075, 4.3622954328695815, 0, 0, 0},
      {5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525, 0, 0},
      {5.86145544294642, -12.92096931784711, 8.159367898576159, -0.071584973281401,
       -0.028269050394068383, 0}};
  static constexpr double b[6] = {0.09646076681806523, 0.01,
                                  0.4798896504144996,  1.379008574103742,
                                  -3.290069515436081,  2.324710524099774};
  static constexpr double c[6] = {0, 0.161, 0.327, 0.9, 0.9800255409045097, 1};
  static constexpr double error[7] = {
      -0.00178001105222577714, -0.0008164344596567469, 0.007880878010261995, -0.1447110071732629,
      0.5823571654525552,      -0.45808210592918697,   0.015151515151515152};
  static constexpr double dense[7][5] = {
      {1, -2.763706197274826, 2.9132554618219126, -1.0530884977290216},
      {0, 0.13169999999999998, -0.2234, 0.1017},
      {0, 3.9302962368947516, -5.941033872131505, 2.490627285651253},
      {0, -12.411077166933676, 30.33818863028232, -16.548102889244902},
      {0, 37.50931341651104, -88.1789048947664, 47.37952196281928},
      {0, -27.896526289197286, 65.09189467479366, -34.87065786149661},
      {0, 1.5, -4, 2.5}};
};

/// An embedded tableau with the stage at the end of the step appended. The weight b of this stage
/// is 0. The value of the generator there is used again by the first stage of the next step.
template <class Embedded>
struct FirstSameAsLast : Embedded {
  static constexpr bool first_same_as_last = true;
  static constexpr int stages = Embedded::stages + 1;

 private:
  template <class Entry>
  struct Entries {  // indexed by int, as the arrays of the tableaux are
    Entry entries[std::size_t{stages}];
    constexpr Entry const& operator[](int i) const { return entries[i]; }
  };
  using Row = Entries<double>;
  static constexpr Row extended(double const (&row)[std::size_t{Embedded::stages}], double last) {
    Row all{};
    for (int i = 0; i < Embedded::stages; ++i) all.entries[i] = row[i];
    all.entries[Embedded::stages] = last;
    return all;
  }

 public:
  static constexpr Entries<Row> a = [] {
    Entries<Row> all{};
    for (int i = 0; i < Embedded::stages; ++i) all.entries[i] = extended(Embedded::a[i], 0);
    all.entries[Embedded::stages] = extended(Embedded::b, 0);
    return all;
  }();
  static constexpr Row b = extended(Embedded::b, 0);
  static constexpr Row c = extended(Embedded::c, 1);
};

}  // namespace cayspin::inline v0_2::tableau
