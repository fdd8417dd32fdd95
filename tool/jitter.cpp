#include "tool/jitter.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include "runtime/task/cyclic_loop.hpp"

namespace hysteron::tool {
namespace {

/// Upper edges of the classes in nanoseconds: 1, 2, 5 of each decade from a microsecond to a second.
std::vector<JitterClass> empty_classes() {
  std::vector<JitterClass> classes;
  for (std::int64_t decade = 1'000; decade <= 1'000'000'000; decade *= 10) {
    for (const std::int64_t edge : {decade, 2 * decade, 5 * decade}) {
      classes.push_back({.below = edge});
    }
  }
  return classes;
}

/// A step that does nothing but to note how late it began.
class EmptyStep final : public runtime::CycleBody {
 public:
  EmptyStep(Jitter& jitter, std::int64_t period) : jitter_(&jitter), period_(period) {}
  bool cycle(const runtime::CycleMoment& moment) noexcept override {
    // Behind its own time, also where whole periods passed.
    const std::int64_t late = moment.start - moment.due + static_cast<std::int64_t>(moment.skipped) * period_;
    jitter_->lateness.add(late, moment.number);
    const auto found = std::ranges::find_if(jitter_->classes, [&](const JitterClass& one) { return late < one.below; });
    ++(found == jitter_->classes.end() ? jitter_->classes.back() : *found).count;
    return true;
  }
  bool finished(const runtime::LoopStatistics& /*statistics*/, std::int64_t /*duration*/,
                runtime::Verdict /*verdict*/) noexcept override {
    return true;
  }

 private:
  Jitter* jitter_;
  std::int64_t period_;
};

}  // namespace

Jitter measure_jitter(const JitterRequest& request, runtime::Clock& clock) {
  Jitter jitter{.classes = empty_classes()};
  std::thread([&] {
    runtime::touch_stack();
    const auto obtained = runtime::obtain_scheduling(request.scheduling);
    jitter.obtained =
        runtime::description_of(obtained) + (obtained.refused.empty() ? "" : " (refused: " + obtained.refused + ")");
    EmptyStep body(jitter, request.period);
    runtime::LoopStatistics statistics;
    const std::atomic<bool> stop{false};
    runtime::LoopSettings settings{.period = request.period, .tolerance = request.period / 10};
    settings.cycles = request.cycles;
    (void)runtime::run_loop(settings, clock, body, stop, statistics);
    jitter.skipped = statistics.skipped;
  }).join();
  while (!jitter.classes.empty() && jitter.classes.back().count == 0) {
    jitter.classes.pop_back();
  }
  return jitter;
}

}  // namespace hysteron::tool
