// Example 5: what the simulated machine promises: return-point memory, creep by the logarithm of time, lag, noise, and
// the same record whenever it is asked for.
#include "examples/05_simulated_actuator/simulator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "examples/05_simulated_actuator/figures.hpp"

namespace simulated {
namespace {

constexpr Preisach::Thresholds thresholds{.low = 0.0, .distance = 0.125, .count = 33};

double density(double upper, double lower) {
  return std::exp(lower - upper) * (1.0 + 0.1 * upper);
}

/// Each relay on its own, as the definition has it.
class PlainRelays {
 public:
  double operator()(double input) {
    double up = 0.0;
    double all = 0.0;
    std::size_t relay = 0;
    for (std::size_t i = 0; i < thresholds.count; ++i) {
      for (std::size_t j = 0; j <= i; ++j, ++relay) {
        const double upper = thresholds.distance * static_cast<double>(i);
        const double lower = thresholds.distance * static_cast<double>(j);
        if (input >= upper) {
          is_up_[relay] = true;
        } else if (input < lower) {
          is_up_[relay] = false;
        }
        const double weight = density(upper, lower) * (i == j ? 0.5 : 1.0);
        all += weight;
        up += is_up_[relay] ? weight : 0.0;
      }
    }
    return up / all;
  }

 private:
  std::vector<bool> is_up_ = std::vector<bool>(thresholds.count * (thresholds.count + 1) / 2);
};

TEST(Preisach, IsThatManyRelays) {
  Preisach hysteresis(thresholds, density);
  EXPECT_EQ(hysteresis.relays(), 561U);
  PlainRelays plain;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(-0.5, 4.5);
  for (int k = 0; k < 500; ++k) {
    const double input = anywhere(random);
    EXPECT_NEAR(hysteresis(input), plain(input), 1e-12) << "sample " << k;
  }
}

TEST(Preisach, ClosesMinorLoopsExactly) {
  Preisach hysteresis(thresholds, density);
  hysteresis(3.3);
  const double left = hysteresis(1.1);
  hysteresis(2.6);
  const double inner = hysteresis(1.7);
  hysteresis(2.2);
  EXPECT_EQ(hysteresis(1.7), inner);
  EXPECT_EQ(hysteresis(1.1), left);
}

TEST(Preisach, ForgetsWhatALargerLoopHasWipedOut) {
  Preisach one(thresholds, density);
  Preisach other(thresholds, density);
  for (const double input : {2.0, 0.7, 1.6, 1.0}) {
    one(input);
  }
  one(2.5);
  other(2.5);
  for (const double input : {0.3, 1.9, 0.9, 3.1}) {
    EXPECT_EQ(one(input), other(input));
  }
}

TEST(Preisach, MinorLoopsBetweenTheSameEndsAreCongruent) {
  Preisach after_low(thresholds, density);
  Preisach after_high(thresholds, density);
  after_high(3.9);
  const auto height = [](Preisach& hysteresis) {
    hysteresis(1.0);
    const double top = hysteresis(2.0);
    return top - hysteresis(1.0);
  };
  EXPECT_NEAR(height(after_low), height(after_high), 1e-15);
}

/// A machine with a perfect sensor.
Settings without_noise() {
  Settings settings;
  settings.noise = 0.0;
  settings.converter_step = 0.0;
  settings.sensor_offset = 0.0;
  return settings;
}

TEST(Simulator, ReadsTheSensorBeforeItAppliesTheVoltage) {
  Actuator actuator(without_noise());
  EXPECT_EQ(actuator.sample(2.0), 0.0);
  EXPECT_GT(actuator.sample(2.0), 5.0);
}

TEST(Simulator, AmplifierLagIsOfFirstOrder) {
  Settings settings = without_noise();
  settings.irreversible = 0.0;
  settings.creep_per_decade = 0.0;
  settings.stiffening = 0.0;
  Actuator actuator(settings);
  for (int k = 0; k < 10; ++k) {
    const double t = settings.sample_time * k;
    EXPECT_NEAR(actuator.sample(2.0), settings.elastic * 2.0 * (1.0 - std::exp(-t / settings.amplifier_lag)), 1e-12);
  }
}

TEST(Simulator, CreepsByTheLogarithmOfTime) {
  Settings settings = without_noise();
  settings.creep_per_decade = 0.0;
  Actuator prompt(settings);
  settings.creep_per_decade = 0.015;
  Actuator creeping(settings);
  std::vector<double> crept;  // at 1, 10 and 100 s
  for (int k = 1; k <= 20000; ++k) {
    prompt.sample(2.0);
    creeping.sample(2.0);
    if (k == 200 || k == 2000 || k == 20000) {
      crept.push_back((creeping.displacement() - prompt.displacement()) / prompt.displacement());
    }
  }
  EXPECT_NEAR(crept[1] - crept[0], 0.015, 0.0005);
  EXPECT_NEAR(crept[2] - crept[1], 0.015, 0.0005);
}

TEST(Simulator, MinorLoopsCloseOnTheMachineToo) {
  Settings settings = without_noise();
  settings.creep_per_decade = 0.0;
  Actuator actuator(settings);
  const auto settle = [&](double u) {
    for (int k = 0; k < 100; ++k) {
      actuator.sample(u);
    }
    return actuator.displacement();
  };
  settle(3.0);
  const double left = settle(1.0);
  settle(2.0);
  // the amplifier comes to rest within rounding, thresholds lie apart from the voltages by more
  EXPECT_NEAR(settle(1.0), left, 1e-9);
}

TEST(Simulator, SensorHasTheStatedNoiseAndSteps) {
  const Settings settings;
  Actuator actuator(settings);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int count = 20000;
  for (int k = 0; k < count; ++k) {
    const double y = actuator.sample(0.0);
    const double steps = y / settings.converter_step;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
    sum += y - settings.sensor_offset;
    squares += (y - settings.sensor_offset) * (y - settings.sensor_offset);
  }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0.0, 4.0 * settings.noise / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), settings.noise, 0.02 * settings.noise);
}

TEST(Simulator, SameSeedSameRecord) {
  const std::vector<double> u = identification_voltage(0.005);
  const std::vector<double> y = play(u);
  EXPECT_EQ(play(u), y);
  Settings other;
  other.seed = 2;
  EXPECT_NE(play(u, other), y);
}

TEST(Simulator, RecordIsLikeThatOfARealStack) {
  // a PICMA stack at the same voltage: 45.7 µm, 22 %, 7.4 %, 0.39 µm, 0.07 µm
  const std::vector<double> u = identification_voltage(0.005);
  const LoopFigures figures = figures_of(u, play(u), 200);
  EXPECT_NEAR(figures.range, 45.7, 2.0);
  EXPECT_NEAR(figures.width, 0.22, 0.01);
  EXPECT_NEAR(figures.line_rms, 0.074, 0.005);
  EXPECT_NEAR(figures.creep, 0.39, 0.05);
  EXPECT_NEAR(figures.noise, 0.07, 0.015);
}

TEST(Simulator, ReferenceOfTheTestRisesFallsAndRests) {
  const std::vector<double> reference = test_reference(0.005);
  const auto largest = [&](double from, double to) {
    double size = 0.0;
    for (auto k = static_cast<std::size_t>(from * 200.0); k < static_cast<std::size_t>(to * 200.0); ++k) {
      size = std::max(size, std::fabs(reference[k]));
    }
    return size;
  };
  EXPECT_EQ(largest(0.0, 1.0), 20.0);
  EXPECT_EQ(largest(9.0, 10.0), 20.0);
  EXPECT_NEAR(largest(12.0, 13.0), 11.0, 1.0);
  EXPECT_EQ(largest(15.0, 25.0), 0.0);
  EXPECT_NEAR(largest(27.0, 28.0), 11.0, 1.0);
  EXPECT_EQ(largest(31.0, 32.0), 20.0);
}

TEST(Simulator, SharesNothingWithTheBlocks) {
  for (const char* name : {"preisach.hpp", "preisach.cpp", "simulator.hpp", "simulator.cpp", "figures.hpp"}) {
    std::ifstream file(std::filesystem::path(HYSTERON_EXAMPLES) / "05_simulated_actuator" / name);
    ASSERT_TRUE(file) << name;
    for (std::string line; std::getline(file, line);) {
      EXPECT_TRUE(!line.starts_with("#include \"") || line.starts_with("#include \"examples/05_simulated_actuator/"))
          << name << ": " << line;
    }
  }
}

}  // namespace
}  // namespace simulated
