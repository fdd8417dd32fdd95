// Traces whose trigger is armed again: each capture is a file that replays by itself.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>

#include "runtime/task/clock.hpp"
#include "runtime/task/task.hpp"
#include "runtime/task/trace.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime::test {

struct Captures {
  std::uint64_t runs = 0;
  std::uint64_t files = 0;
  std::uint64_t missing = 0;    ///< captures without a file, or files without a capture
  std::uint64_t different = 0;  ///< files of which a step replays otherwise, or has no state before it
};

/// A wave of random length, its trigger armed again a random number of times.
inline Captures capture_many_times(const std::filesystem::path& folder, std::uint64_t runs) {
  class Wave final : public FieldIo {
   public:
    explicit Wave(double step) : step_(step) {}
    Fault read(std::span<double> inputs) noexcept override {
      inputs[0] = std::sin(step_ * static_cast<double>(++k_));
      return Fault::none;
    }
    void write(std::span<const double> /*outputs*/) noexcept override {}

   private:
    double step_;
    std::uint64_t k_ = 0;
  };
  std::mt19937_64 random(29);
  Captures result;
  for (; result.runs < runs; ++result.runs) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::uint64_t captures = 1 + random() % 6;
    const TraceTrigger trigger{.signal = TraceTrigger::Signal::input,
                               .level = 0.5,
                               .before = random() % 40,
                               .after = random() % 40,
                               .captures = captures};
    const std::string file = (folder / "trace").string();
    {
      Accumulator program;
      Wave wave(0.01 + 0.04 * static_cast<double>(random() % 1000) * 1e-3);
      Trace trace({.file = file, .trigger = trigger, .files = 8, .waits = true}, program);
      Task task(program, {.loop = {.cycles = 8000}, .inputs = {{.from_device = true}}, .outputs = {{}, {}}},
                {.field = &wave, .trace = &trace});
      VirtualClock clock;
      const std::atomic<bool> stop{false};
      (void)task.run(clock, stop);
    }
    for (std::uint64_t number = 0; number < 8; ++number) {
      const std::string one = number == 0 ? file : file + "." + std::to_string(number);
      const bool is_there = std::filesystem::exists(one);
      result.missing += is_there == (number < captures) ? 0 : 1;
      if (!is_there) {
        continue;
      }
      ++result.files;
      Accumulator program;
      ReplayResult replayed;
      const bool is_sound = replay(hysteron::test::contents_of(one), program, replayed).empty() &&
                            replayed.different == 0 && replayed.without_state == 0 && replayed.steps > trigger.after;
      result.different += is_sound ? 0 : 1;
    }
  }
  std::filesystem::remove_all(folder);
  return result;
}

}  // namespace hysteron::runtime::test
