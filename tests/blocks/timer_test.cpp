// Timers: exact in steps for every PT = n·TS, against a model that counts in whole numbers; and never past the end.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>

#include "blocks/blink.hpp"
#include "blocks/off_delay.hpp"
#include "blocks/on_delay.hpp"
#include "blocks/pulse_timer.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

constexpr double sample_times[] = {5e-5, 1e-3, 1e-2, 0.1, 1.0 / 3.0, 1.0, 62.5e-6, 1.0 / 44100.0, 7e-7, 60.0};

TEST(StepsIn, PresetOfNStepsIsNStepsWhereverTheProductRounds) {
  for (const double ts : sample_times) {
    for (std::int32_t n = 0; n < 200000; ++n) {
      ASSERT_EQ(steps_in(n * ts, ts), n) << ts;
    }
    std::mt19937 random(1);
    std::uniform_int_distribution<std::int32_t> any(0, std::numeric_limits<std::int32_t>::max() - 1);
    for (int k = 0; k < 100000; ++k) {
      const std::int32_t n = any(random);
      ASSERT_EQ(steps_in(n * ts, ts), n) << ts;
    }
  }
}

TEST(StepsIn, PresetWrittenInDecimalsIsTheNumberOfStepsThatItSays) {
  // 0.05, 0.1, 0.15 … seconds as they stand in a diagram, at 50 µs: 1000, 2000, 3000 … steps.
  for (std::int32_t n = 1; n < 20000; ++n) {
    const double decimal = static_cast<double>(5 * n) / 100.0;
    ASSERT_EQ(steps_in(decimal, 5e-5), 1000 * n);
  }
}

TEST(StepsIn, SinglePrecisionIsExactUpToItsStatedLength) {
  for (const double ts : sample_times) {
    for (std::int32_t n = 0; n <= 300000; n += 7) {
      ASSERT_EQ(steps_in(static_cast<float>(n * ts), static_cast<float>(ts)), n) << ts;
    }
  }
}

TEST(StepsIn, PartsOfAStepCountUpwards) {
  EXPECT_EQ(steps_in(0.0, 1.0), 0);
  EXPECT_EQ(steps_in(-5.0, 1.0), 0);
  EXPECT_EQ(steps_in(2.1, 1.0), 3);
  EXPECT_EQ(steps_in(2.9, 1.0), 3);
  EXPECT_EQ(steps_in(infinity, 1.0), std::numeric_limits<std::int32_t>::max());
}

TEST(OnDelay, ElapsesAfterExactlyNSteps) {
  for (const double ts : sample_times) {
    for (const int n : {0, 1, 2, 3, 7, 10, 100, 999}) {
      Stepper<OnDelay> timer(ts);
      EXPECT_FALSE(timer({.IN = false, .PT = n * ts}).Q);
      for (int k = 0; k < n + 5; ++k) {
        const auto out = timer({.IN = true, .PT = n * ts});
        ASSERT_EQ(out.Q, k >= n) << n << " steps of " << ts;
        ASSERT_EQ(out.ET, k >= n ? n * ts : k * ts);
      }
      const auto off = timer({.IN = false, .PT = n * ts});
      EXPECT_FALSE(off.Q);
      EXPECT_EQ(off.ET, 0.0);
    }
  }
}

/// The count of a timer that has ended says no more when it did: ET is the PT of the step, as the description says.
TEST(OnDelay, BehindItsEndTheElapsedTimeIsThePresetOfTheStep) {
  Stepper<OnDelay> timer(0.1);
  for (int k = 0; k < 4; ++k) {
    (void)timer({.IN = true, .PT = 0.2});
  }
  const auto out = timer({.IN = true, .PT = 30.0});
  EXPECT_TRUE(out.Q);
  EXPECT_EQ(out.ET, 30.0);
}

TEST(OnDelay, InterruptionStartsAgain) {
  Stepper<OnDelay> timer(1.0);
  for (int k = 0; k < 10; ++k) {
    EXPECT_FALSE(timer({.IN = k % 3 != 2, .PT = 2.0}).Q);
  }
}

TEST(OnDelay, CountStaysAtItsEnd) {
  Stepper<OnDelay> timer(5e-5);
  timer.state.COUNT = std::numeric_limits<std::int32_t>::max() - 2;
  for (int k = 0; k < 10; ++k) {
    const auto out = timer({.IN = true, .PT = 0.1});
    EXPECT_TRUE(out.Q);
    EXPECT_EQ(out.ET, 0.1);
  }
}

TEST(OffDelay, FallsExactlyNStepsAfterItsInput) {
  for (const double ts : sample_times) {
    for (const int n : {0, 1, 2, 5, 250}) {
      Stepper<OffDelay> timer(ts);
      for (int k = 0; k < 3; ++k) {
        const auto before = timer({.IN = false, .PT = n * ts});
        EXPECT_FALSE(before.Q) << "nothing runs before the input was TRUE";
        EXPECT_EQ(before.ET, 0.0);
      }
      for (int k = 0; k < 3; ++k) {
        const auto on = timer({.IN = true, .PT = n * ts});
        EXPECT_TRUE(on.Q);
        EXPECT_EQ(on.ET, 0.0);
      }
      for (int k = 0; k < n + 5; ++k) {
        const auto out = timer({.IN = false, .PT = n * ts});
        ASSERT_EQ(out.Q, k < n);
        ASSERT_EQ(out.ET, k >= n ? n * ts : k * ts);
      }
    }
  }
}

TEST(PulseTimer, PulseLastsExactlyNStepsWhateverTheInputDoes) {
  for (const double ts : sample_times) {
    for (const int n : {1, 2, 3, 40}) {
      for (const int width : {1, 2, 39, 60}) {
        Stepper<PulseTimer> timer(ts);
        EXPECT_FALSE(timer({.IN = false, .PT = n * ts}).Q);
        for (int k = 0; k < 70; ++k) {
          const auto out = timer({.IN = k < width, .PT = n * ts});
          ASSERT_EQ(out.Q, k < n);
          ASSERT_EQ(out.ET, k < n ? k * ts : (k < width ? n * ts : 0.0));
        }
      }
    }
  }
}

/// The pulse timer by its states, as the standard's timing diagram draws it: ready, running, waiting for IN to fall.
struct PulseModel {
  enum { Ready, Running, Waiting } phase = Ready;
  bool last = false;
  int count = 0;
  bool step(bool in, int n) {
    if (phase == Running) {
      ++count;
    } else if (phase == Ready && in && !last) {
      phase = Running;
      count = 0;
    }
    if (phase == Running && count >= n) {
      phase = Waiting;
    }
    if (phase == Waiting && !in) {
      phase = Ready;
    }
    last = in;
    return phase == Running;
  }
};

TEST(PulseTimer, AgreesWithItsTimingDiagramOnAnyInput) {
  std::mt19937 random(23);
  for (int n = 0; n < 8; ++n) {
    Stepper<PulseTimer> timer(5e-5);
    PulseModel model;
    for (int k = 0; k < 20000; ++k) {
      const bool in = (random() & 3U) == 0;
      ASSERT_EQ(timer({.IN = in, .PT = n * 5e-5}).Q, model.step(in, n)) << n << " steps, step " << k;
    }
  }
}

/// On-delay by its states; the off-delay is one of NOT IN, begun by the first TRUE, with NOT Q.
struct DelayModel {
  bool over = false;
  int count = -1;
  bool step(bool in, int n) {
    count = in ? count + 1 : -1;
    over = in && (over || count >= n);
    return over;
  }
};

TEST(Timers, WhatHasTimedOutStaysSoWhateverBecomesOfThePreset) {
  constexpr double ts = 5e-5;
  std::mt19937 random(29);
  Stepper<PulseTimer> pulse(ts);
  Stepper<OnDelay> on(ts);
  Stepper<OffDelay> off(ts);
  PulseModel pulse_model;
  DelayModel on_model;
  DelayModel off_model;
  bool in = true;
  off({.IN = true, .PT = ts});  // from here on it has been TRUE once
  for (int k = 0; k < 50000; ++k) {
    if ((random() & 7U) == 0) {
      in = !in;
    }
    const int n = static_cast<int>(random() & 7U);
    ASSERT_EQ(pulse({.IN = in, .PT = n * ts}).Q, pulse_model.step(in, n)) << "step " << k;
    ASSERT_EQ(on({.IN = in, .PT = n * ts}).Q, on_model.step(in, n)) << "step " << k;
    ASSERT_EQ(off({.IN = in, .PT = n * ts}).Q, !off_model.step(!in, n)) << "step " << k;
  }
}

TEST(Blink, EdgesNeitherDriftNorJitter) {
  const double ts = 5e-5;
  Stepper<Blink> blink(ts, {.THIGH = 3 * ts, .TLOW = 7 * ts});
  for (int k = 0; k < 1000000; ++k) {
    ASSERT_EQ(blink({.RUN = true}).Q, k % 10 < 3) << k;
  }
  EXPECT_FALSE(blink({.RUN = false}).Q);
  for (int k = 0; k < 30; ++k) {
    ASSERT_EQ(blink({.RUN = true}).Q, k % 10 < 3) << "starts again with TRUE";
  }
}

}  // namespace
}  // namespace hysteron::testing
