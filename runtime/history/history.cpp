#include "runtime/history/history.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hysteron::runtime {
namespace {

using database::DatabaseError;
using database::Trouble;

constexpr std::int64_t one_second = 1'000'000'000;
constexpr std::int64_t longest_pause = 60 * one_second;
/// Age is judged by a clock that has kept still for so long: one that is wrong for a while deletes nothing.
constexpr std::int64_t trust = 3600 * one_second;
constexpr std::size_t batch = 5000;  ///< rows of one transaction
constexpr int niceness = 10;         ///< whatever runs the machine goes before

HistoryFault fault_of(Trouble trouble) {
  switch (trouble) {
    case Trouble::Full:
      return HistoryFault::Full;
    case Trouble::Damaged:
      return HistoryFault::Damaged;
    case Trouble::Held:
      return HistoryFault::Held;
    case Trouble::Unreachable:
    case Trouble::Other:
      break;
  }
  return HistoryFault::Unreachable;
}

}  // namespace

HistoryKeeper::HistoryKeeper(HistorySettings settings, SampleTap& tap, KeptCounter& counter, BesideClocks clocks)
    : settings_(std::move(settings)),
      tap_(&tap),
      counter_(&counter),
      time_(std::move(clocks), settings_.plan.run.period, settings_.virtual_time),
      judges_age_from_(time_.steady() + trust) {
  settings_.plan.run.begun_ms = time_.now_ms();
  tap_->wait_for_reader(settings_.virtual_time);
}

void HistoryKeeper::turn(bool is_last) {
  watch_clock();
  const std::int64_t now = time_.steady();
  if (now < retry_at_ && !is_last) {
    return;
  }
  try {
    open();
    write(now);
    is_well();
  } catch (const DatabaseError& problem) {
    failed(problem);
  }
  if (is_last) {
    tap_->take(waiting_);
    counter_->add_lost(waiting_.size());
    waiting_.clear();
    file_.reset();
  }
}

void HistoryKeeper::open() {
  if (file_ && !file_->is_there()) {
    remarks_.say("its file is gone; another one is begun. Rows of the last second may be lost.");
    file_->finish_log();
    file_.reset();
  }
  if (settings_.lock && !settings_.lock->is_there()) {
    settings_.lock.reset();  // what deleted it may have let another task in
  }
  if (!settings_.lock) {
    settings_.lock.emplace(settings_.plan.file);
  }
  if (file_) {
    return;
  }
  file_.emplace(settings_.plan, is_damaged_);
  is_damaged_ = false;
  if (!file_->aside().empty()) {
    remarks_.say(fmt::format("what stood in {} is damaged or of another version, and is {} now. A new file is begun.",
                             settings_.plan.file.string(), file_->aside()));
  }
}

void HistoryKeeper::write(std::int64_t now) {
  trim(now);
  do {
    if (waiting_.empty()) {
      tap_->take(waiting_);
    }
    while (!waiting_.empty()) {
      const std::size_t count = std::min(batch, waiting_.size());
      std::vector<std::int64_t> times;
      times.reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        times.push_back(time_.utc_ms(waiting_[i].elapsed));
      }
      file_->add(std::span(waiting_).first(count), times);
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
      counter_->add_done(count);
      newest_ms_ = times.back();
      trim(now);  // on a virtual clock, all of a run may come in one turn
    }
    tap_->take(waiting_);
  } while (!waiting_.empty());
}

/// A virtual clock is never set: there, age is judged by the newest row.
void HistoryKeeper::trim(std::int64_t now) {
  const std::optional<std::int64_t> today_ms = settings_.virtual_time    ? newest_ms_
                                               : now >= judges_age_from_ ? std::optional(time_.now_ms())
                                                                         : std::nullopt;
  file_->trim(today_ms ? std::optional(*today_ms - settings_.keep / 1'000'000) : std::nullopt);
}

void HistoryKeeper::watch_clock() {
  if (const double step = time_.look(); step != 0.0) {
    remarks_.say(
        fmt::format("the machine's clock was set {} by {:.1f} s. Rows keep their order, and their time since "
                    "the start.",
                    step > 0.0 ? "forward" : "back", std::abs(step)));
    judges_age_from_ = time_.steady() + trust;
  }
}

void HistoryKeeper::failed(const DatabaseError& problem) {
  file_.reset();
  is_damaged_ = problem.trouble() == Trouble::Damaged;
  pause_ = std::clamp(2 * pause_, one_second, longest_pause);
  retry_at_ = time_.steady() + pause_;
  tap_->wait_for_reader(false);
  counter_->set_fault(static_cast<std::uint16_t>(fault_of(problem.trouble())));
  remarks_.failed(problem.what(), fmt::format("nothing is written any more: {}. {}; it is tried again, at last once a "
                                              "minute. The task goes on.",
                                              problem.what(), database::way_out(problem)));
}

void HistoryKeeper::is_well() {
  pause_ = 0;
  retry_at_ = 0;
  tap_->wait_for_reader(settings_.virtual_time);
  counter_->set_fault(static_cast<std::uint16_t>(HistoryFault::None));
  remarks_.is_well(fmt::format("written again; {} rows are lost since the start.", counter_->read().lost));
}

History::History(HistorySettings settings, SampleTap& tap, KeptCounter& counter, BesideClocks clocks)
    : interval_(settings.virtual_time ? 1 : 1000), keeper_(std::move(settings), tap, counter, std::move(clocks)) {
  thread_ = std::thread([this] { run(); });
}

History::~History() {
  finish();
}

void History::run() {
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);
  std::unique_lock lock(mutex_);
  while (!is_over_) {
    lock.unlock();
    keeper_.turn();
    lock.lock();
    asked_.wait_for(lock, interval_, [this] { return is_over_; });
  }
  lock.unlock();
  keeper_.turn(true);
}

void History::finish() {
  {
    const std::scoped_lock lock(mutex_);
    is_over_ = true;
  }
  asked_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

}  // namespace hysteron::runtime
