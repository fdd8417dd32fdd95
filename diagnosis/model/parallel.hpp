// Work on both cores: independent tasks by their index, results in place, so that the order of ending does not matter.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace hysteron::diagnosis {

/// Calls work(0) … work(count − 1) from as many threads as there are cores, at most `threads`. The first exception is
/// thrown on. Work must not depend on its order.
template <class Work>
void in_parallel(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = failure ? failure : std::current_exception();
        next = count;
      }
    }
  };
  const std::size_t wanted = std::min<std::size_t>(count, std::max(1U, threads));
  std::vector<std::jthread> pool;
  for (std::size_t i = 1; i < wanted; ++i) {
    pool.emplace_back(loop);
  }
  loop();
  pool.clear();
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace hysteron::diagnosis
