// Linked sets of parameters committed against a running loop: how many, and how many a step saw torn.
#pragma once

#include <array>
#include <atomic>
#include <thread>

#include "runtime/task/task.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/runtime/task/accumulator.hpp"

namespace hysteron::runtime::test {

struct LinkedSets {
  std::uint64_t committed = 0;
  std::uint64_t applied = 0;  ///< steps that began with another set; one that a newer replaced at once is not seen
  std::uint64_t torn = 0;
  std::uint64_t steps = 0;
};

inline LinkedSets commit_linked_sets(std::uint64_t count) {
  Accumulator program(50'000);
  LinkedSets result;
  double last = 1.0;
  program.during_step = [&](std::span<double> outputs) {
    result.torn += outputs[1] != 0.0 ? 1 : 0;
    result.applied += program.parameter(0) != last ? 1 : 0;
    last = program.parameter(0);
    outputs[0] = 0.0;
  };
  Task task(program, {.inputs = {{}}, .outputs = {{}, {}}}, {});
  std::atomic<bool> stop{false};
  VirtualClock clock;
  std::thread cyclic([&] { (void)task.run(clock, stop); });
  TaskDoor& door = task.door();
  const auto a = point(door, "G.A");
  const auto b = point(door, "G.B");
  const auto commit = point(door, "task.commit");
  for (std::uint64_t i = 1; i <= count; ++i) {
    const auto number = static_cast<double>(i);
    const std::array<PointWrite, 3> set{{{a, number}, {b, -number}, {commit, 1.0}}};
    result.committed += door.write(set).empty() ? 1 : 0;
    if (i % 64 == 0) {
      std::this_thread::yield();
    }
  }
  // The newest set always arrives.
  while (value(door, "G.A") != static_cast<double>(count)) {
    std::this_thread::yield();
  }
  stop = true;
  cyclic.join();
  result.steps = task.statistics().run;
  return result;
}

}  // namespace hysteron::runtime::test
