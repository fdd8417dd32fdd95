// Lines on standard error while a task runs: what went wrong beside the cycle, and that it is well again.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/task/retain.hpp"
#include "runtime/task/trace.hpp"

namespace hysteron::runtime {

/// Where standard error takes a line at once: nobody who reads it is waited for.
void tell(std::string_view from, const std::string& line);

/// What could not be written, each once until it is well again.
class WriteNotices {
 public:
  /// Each may be null.
  WriteNotices(const Retainer* retainer, const Trace* trace) : retainer_(retainer), trace_(trace) {}

  /// To be called as time goes by.
  void look();
  /// For the status line at the end, each beginning with a semicolon; empty where all is on the disk. After both are
  /// finished.
  [[nodiscard]] std::string at_the_end() const;

 private:
  const Retainer* retainer_;
  const Trace* trace_;
  bool told_retain_ = false;
  bool told_trace_ = false;
};

}  // namespace hysteron::runtime
