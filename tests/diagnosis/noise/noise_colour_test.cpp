// Noise by the fast part of a residual, against noise of known variance.
#include "diagnosis/noise/noise_colour.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t whole = 6000;

VectorXd white(std::uint64_t seed, double deviation = 1.0) {
  const std::vector<double> values = test::Noise(seed).white(whole, deviation);
  return Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
}

/// Of variance 1, behind a lag of first order.
VectorXd coloured(std::uint64_t seed, double pole) {
  VectorXd noise = white(seed);
  for (Index k = 1; k < noise.size(); ++k) {
    noise[k] = pole * noise[k - 1] + std::sqrt(1.0 - pole * pole) * noise[k];
  }
  return noise;
}

TEST(NoiseByFastPart, WhiteNoise) {
  for (const double deviation : {1e-9, 0.3, 5e6}) {
    EXPECT_NEAR(noise_by_fast_part(white(1, deviation), {whole}), deviation, 0.05 * deviation);
  }
}

TEST(NoiseByFastPart, ColouredNoiseIsSeenWhole) {
  for (const double pole : {0.3, 0.5, 0.7}) {
    double mean = 0.0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      mean += noise_by_fast_part(coloured(seed, pole), {whole}) / 8.0;
    }
    EXPECT_NEAR(mean, 1.0, 0.12) << pole;
  }
}

TEST(NoiseByFastPart, WhatIsSlowIsNoNoise) {
  VectorXd residuals = white(2);
  for (Index k = 0; k < residuals.size(); ++k) {
    residuals[k] +=
        20.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / 90.0) + 1e-2 * static_cast<double>(k);
  }
  EXPECT_NEAR(noise_by_fast_part(residuals, {whole}), 1.0, 0.06);
}

TEST(NoiseByFastPart, AFewJumpsDoNotCount) {
  VectorXd residuals = white(3);
  for (const Index at : {700, 2500, 4100}) {
    residuals.segment(at, 300).array() += 30.0;
    residuals[at + 20] += 1e4;
  }
  EXPECT_NEAR(noise_by_fast_part(residuals, {whole}), 1.0, 0.25);  // a quarter of the stretches hold one
}

TEST(NoiseByFastPart, OfRecordsOneBehindTheOther) {
  VectorXd residuals = white(4);
  residuals.tail(whole / 2).array() += 1e4;  // each has its own level
  EXPECT_NEAR(noise_by_fast_part(residuals, {whole / 2, whole / 2}), 1.0, 0.06);
}

TEST(NoiseByFastPart, NothingIsSaidOfWhatIsTooShortOrNotThere) {
  EXPECT_EQ(noise_by_fast_part(white(5).head(255), {255}), 0.0);
  EXPECT_GT(noise_by_fast_part(white(5).head(256), {256}), 0.5);
  EXPECT_EQ(noise_by_fast_part(VectorXd(), {}), 0.0);
  EXPECT_EQ(noise_by_fast_part(VectorXd::Zero(whole), {whole}), 0.0);
  VectorXd broken = white(5);
  broken[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(noise_by_fast_part(broken, {whole}), 0.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
