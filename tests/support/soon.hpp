// What another thread or process will do, waited for.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace hysteron::test {

/// Whether `holds` comes true within half a minute: long enough for a loaded machine, and short for one that hangs.
inline bool soon(const std::function<bool()>& holds) {
  for (int i = 0; i < 30'000 && !holds(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return holds();
}

}  // namespace hysteron::test
