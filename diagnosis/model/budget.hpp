// What a search may cost: work, and where it is asked for, time.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "diagnosis/model/effort.hpp"
#include "diagnosis/model/parallel.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {

class Budget {
 public:
  /// From now on: so many units of work, and so many seconds by the clock; infinite: no limit.
  explicit Budget(std::shared_ptr<const Effort> effort, double work = infinity, double seconds = infinity)
      : effort_(std::move(effort)), work_(work), seconds_(seconds), work_ends_(spent() + work), clock_ends_(seconds) {}

  /// Whether it is used up. What asks would go on otherwise. Within a batch several threads ask, and the answer is that
  /// of its begin unless the clock ends it.
  [[nodiscard]] bool is_over() {
    if (!in_batch_) {
      work_is_over_ = spent() >= work_ends_;
    }
    const bool clock_is_over = elapsed() > clock_ends_;
    if (work_is_over_) {
      cut_by_work_ = true;
    } else if (clock_is_over) {
      cut_by_clock_ = true;
    }
    return work_is_over_ || clock_is_over;
  }

  /// What begins now has this share of the whole, if no more is left.
  void at_least(double share) {
    work_ends_ = std::max(work_ends_, spent() + share * work_);
    clock_ends_ = std::max(clock_ends_, elapsed() + share * seconds_);
  }

  [[nodiscard]] bool has_cut_work() const { return cut_by_work_; }   ///< something was not done since it was over
  [[nodiscard]] bool has_cut_time() const { return cut_by_clock_; }  ///< since its seconds were, though not its work

  /// While it lives, work is done side by side.
  class Batch {
   public:
    explicit Batch(Budget& budget) : budget_(budget) {
      budget_.work_is_over_ = budget_.spent() >= budget_.work_ends_;
      budget_.in_batch_ = true;
    }
    ~Batch() { budget_.in_batch_ = false; }
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;

   private:
    Budget& budget_;
  };

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] double spent() const { return static_cast<double>(effort_->spent()); }
  [[nodiscard]] double elapsed() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

  std::shared_ptr<const Effort> effort_;
  double work_;
  double seconds_;
  double work_ends_;
  double clock_ends_;
  Clock::time_point begun_ = Clock::now();
  bool in_batch_ = false;
  bool work_is_over_ = false;
  std::atomic<bool> cut_by_work_ = false;
  std::atomic<bool> cut_by_clock_ = false;
};

/// As in_parallel, in batches: each is done whole as far as the work goes, and `work` asks the budget for itself. So a
/// search ends at the same place with any number of threads.
template <class Work>
void in_batches(std::size_t count, unsigned threads, Budget* budget, const Work& work) {
  constexpr std::size_t most = 64;  // enough that no thread waits long for the others at the end of one
  if (budget == nullptr) {
    in_parallel(count, threads, work);
    return;
  }
  for (std::size_t begin = 0; begin < count; begin += most) {
    const Budget::Batch batch(*budget);
    in_parallel(std::min(most, count - begin), threads, [&](std::size_t i) { work(begin + i); });
  }
}

}  // namespace hysteron::diagnosis
