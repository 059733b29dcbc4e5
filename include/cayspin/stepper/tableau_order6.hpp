// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

namespace cayspin::inline v0_2::tableau {

/// Order 6 in eight stages. The coefficients satisfy the 37 conditions of order 6 to 1e-16, and the
/// last coefficients of the stability polynomial are 1.05 / 7! and 1.39 / 8!. Found by a search for
/// small errors of order 7, many zeros in a, and stability on the imaginary axis. The largest
/// stable dt * (precession frequency) per stage is 0.46, 0.48, 0.51, 0.48 at damping 0, 0.02, 0.1,
/// 0.3 (Dormand-Prince 5: 0.17, 0.35, 0.44, 0.51).
struct Oscillatory86 {
  static constexpr int stages = 8, order = 6;
  static constexpr double a[8][8] = {
      {0},
      {0.10326490671231096},
      {0, 0.20652981342462193},
      {0.6609426616125077, -1.2108253239677063, 0.8968310034307628},
      {0, 0.21843625717135165, -0.13714349614474083, 0.4946305400603941},
      {-0.1478938917225398, 0, 1.2919420014013994, -1.0769124321617156, 0.7106310382942242},
      {0, 0.16540436438656425, 0, 0.6804959053999188, -0.5536021048741566, 0.6230606172983512},
      {0.8653270027064872, -0.5794663800282169, -1.3372159754808983, 1.3170498809827327,
       1.100402073809939, -0.5845379263681936, 0.21844132437814992}};
  static constexpr double b[8] = {0.0659654333058967,  0,
                                  0.2747383814207237,  0.08930345068107473,
                                  0.26157831038871826, 0.17350665221354525,
                                  0.0972323650569302,  0.03767540693311116};
  static constexpr double c[8] = {0,
                                  0.10326490671231096,
                                  0.20652981342462193,
                                  0.3469483410755642,
                                  0.5759233010870048,
                                  0.7777667158113682,
                                  0.9153587822106776,
                                  1};
};

/// Order 6 in eight stages for strong damping. The last coefficients of the stability polynomial
/// are 0.8 / 7! and 0.33 / 8!. The largest stable dt * (decay rate) is 0.86 per stage (RK4: 0.70,
/// Dormand-Prince 5: 0.55).
struct Damped86 {
  static constexpr int stages = 8, order = 6;
  static constexpr double a[8][8] = {
      {0},
      {0.1761739464587774},
      {-0.3990208703151919, 0.9894790456513753},
      {0.104393318341294, 0.10226542869420957, 0.008796532636713504},
      {0, -0.36766255020673594, 0, 0.8575363566372257},
      {0.3393499046169464, 0, -0.020423827434114326, -0.31396805089561874, 0.7600661964964567},
      {-0.13725015905249685, 0.7188899836375106, 0, -0.03723935286893348, -0.020437165877512608,
       0.2693822151291866},
      {0, -0.6698057887170868, 0.011485617423228638, 1.2189171531853777, 0, 0, 0.4394030181084804}};
  static constexpr double b[8] = {0.0684836514994184,
                                  0,
                                  0,
                                  0.3012183388440253,
                                  0.24537373841399104,
                                  0.1686404438056908,
                                  0.14710109698350177,
                                  0.06918273045337264};
  static constexpr double c[8] = {0,
                                  0.1761739464587774,
                                  0.5904581753361834,
                                  0.21545527967221706,
                                  0.4898738064304898,
                                  0.76502422278367,
                                  0.7933455209677542,
                                  1};
};

}  // namespace cayspin::inline v0_2::tableau
