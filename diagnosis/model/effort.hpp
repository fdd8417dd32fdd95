// The work that a diagnosis has done, counted so that it is the same on every machine.
#pragma once

#include <atomic>
#include <cstdint>

namespace hysteron::diagnosis {

/// A unit is one block of the diagram, simulated for one sample. What costs more counts as many as it takes the time
/// of: derivatives, and the linear algebra of a fit (`Model::count_work`). Counts are whole numbers, so that the sum
/// does not depend on the order in which threads add to it.
class Effort {
 public:
  void add(std::uint64_t units) { spent_ += units; }
  [[nodiscard]] std::uint64_t spent() const { return spent_; }

 private:
  std::atomic<std::uint64_t> spent_ = 0;
};

}  // namespace hysteron::diagnosis
