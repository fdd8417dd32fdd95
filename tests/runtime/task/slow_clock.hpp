// A clock that goes on by what sleeps, and by what a step takes, which the test adds.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/task/clock.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::runtime::test {

class SlowClock final : public Clock {
 public:
  std::int64_t now() noexcept override { return now_; }
  void sleep_until(std::int64_t time) noexcept override { now_ = std::max(now_, time); }
  std::int64_t own_cpu() noexcept override { return now_; }
  std::int64_t stolen() noexcept override { return 0; }
  void pass(std::int64_t nanoseconds) { now_ += nanoseconds; }

 private:
  std::int64_t now_ = 0;
};

}  // namespace hysteron::runtime::test
