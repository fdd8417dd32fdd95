// What another thread or process will do, waited for.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace hysteron::test {

/// Whether `holds` comes true in time; half a minute is enough for a loaded machine, and short for one that hangs.
inline bool soon(const std::function<bool()>& holds, std::chrono::milliseconds patience = std::chrono::seconds(30)) {
  for (auto waited = std::chrono::milliseconds(0); waited < patience; waited += std::chrono::milliseconds(1)) {
    if (holds()) {
      return true;  // once is enough: asked again it may not hold any more
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return holds();
}

}  // namespace hysteron::test
