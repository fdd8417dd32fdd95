// A task in a thread of its own whose diagram may change, on a clock that leaves others their turn.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <initializer_list>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/host/online_change.hpp"
#include "runtime/task/changeable_program.hpp"
#include "runtime/task/clock.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/task.hpp"
#include "runtime/task/trace.hpp"
#include "support/diagnostic.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::test {

/// Virtual time that leaves others their turn; a step can take some of it.
class PacedClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now() noexcept override { return now_; }
  void sleep_until(std::int64_t time) noexcept override {
    std::this_thread::sleep_for(std::chrono::microseconds(20));
    now_ = std::max(now_, time);
  }
  [[nodiscard]] std::int64_t own_cpu() noexcept override { return 0; }
  [[nodiscard]] std::int64_t stolen() noexcept override { return 0; }
  void pass(std::int64_t time) noexcept { now_ += time; }

 private:
  std::int64_t now_ = 0;
};

inline TaskSettings plant_settings() {
  return {.watchdog = {.time = 500'000'000}, .inputs = {{}}, .outputs = {{.low = -50.0, .high = 50.0}}};
}

/// A task in a thread of its own, with what is asked for attached.
class Plant {
 public:
  explicit Plant(std::unique_ptr<StepProgram> first, double most = 1e300, double load = 1e6)
      : program_(std::move(first)),
        task_(program_, plant_settings()),
        change_(program_, task_, {{.limit = {.most = most, .low = -50.0, .high = 50.0}, .origin = "a test"}}, load) {}
  ~Plant() { end(); }
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;
  Plant(Plant&&) = delete;
  Plant& operator=(Plant&&) = delete;

  void keep_in(const hysteron::test::ScratchFolder& folder) {
    files_ = std::make_unique<RetainFolder>(folder.path() / "kept");
    files_->open();
    retainer_ = std::make_unique<Retainer>(*files_, program_, Recovery{}, state_of(program_));
    trace_ = std::make_unique<Trace>(TraceSettings{.file = folder / "run.trace", .waits = true}, program_);
  }
  /// Its registers, on a port that is free.
  void serve(ModbusConfig modbus) {
    modbus.port = 0;
    run_file_.task = plant_settings();
    run_file_.modbus = std::move(modbus);
    registers_ = std::make_unique<ServedMap>(run_file_, program_.shape().name, task_, nullptr);
  }
  void start() {
    task_.attach({.retainer = retainer_.get(), .trace = trace_.get(), .changes = &program_});
    thread_ = std::thread([this] { (void)task_.run(clock_, stop_); });
    change_.begin(retainer_.get(), trace_.get(), registers_.get());
    run(20);
  }
  /// So many cycles more.
  void run(double cycles) {
    const double now = value(door(), "task.cycles");
    ASSERT_TRUE(hysteron::test::soon([&] { return value(door(), "task.cycles") >= now + cycles; }));
  }
  void end() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
    change_.end();
  }
  void finish_trace() { trace_->finish(); }
  [[nodiscard]] std::string write(std::initializer_list<std::pair<const char*, double>> values) {
    std::vector<PointWrite> writes;
    for (const auto& [name, number] : values) {
      writes.push_back({point(door(), name), number});
    }
    return door().write(writes);
  }

  [[nodiscard]] TaskDoor& door() { return task_.door(); }
  [[nodiscard]] OnlineChange& change() { return change_; }
  [[nodiscard]] Task& task() { return task_; }
  [[nodiscard]] PacedClock& clock() { return clock_; }
  [[nodiscard]] RetainFolder& files() { return *files_; }
  [[nodiscard]] modbus::Server& server() { return registers_->server(); }

 private:
  std::unique_ptr<RetainFolder> files_{};
  ChangeableProgram program_;
  std::unique_ptr<Retainer> retainer_{};
  std::unique_ptr<Trace> trace_{};
  PacedClock clock_;
  Task task_;
  OnlineChange change_;
  RunConfig run_file_{};
  std::unique_ptr<ServedMap> registers_{};
  std::atomic<bool> stop_{false};
  std::thread thread_{};
};

/// What refuses it: HY850: The input X is gone.
template <class Work>
std::string refusal_by(const Work& work) {
  try {
    (void)work();
  } catch (const InputError& refused) {
    std::string text;
    for (const Diagnostic& one : refused.diagnostics().all()) {
      text += fmt::format("{}HY{}: {}", text.empty() ? "" : " ", one.number, one.cause);
    }
    return text;
  }
  return "";
}

}  // namespace hysteron::runtime::test
