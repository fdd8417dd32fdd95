#include "runtime/host/notices.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstddef>

namespace hysteron::runtime {
namespace {

constexpr std::size_t longest_line = 500;  // less than a pipe takes at once

}  // namespace

void tell(std::string_view from, const std::string& line) {
  pollfd error{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&error, 1, 0) == 1 && (error.revents & POLLOUT) != 0) {
    const std::string whole = fmt::format("{}: {}\n", from, line.substr(0, longest_line));
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, whole.data(), whole.size());
  }
}

void WriteNotices::look() {
  if (const std::string problem = retainer_ == nullptr ? "" : retainer_->problem(); problem.empty() == told_retain_) {
    told_retain_ = !told_retain_;
    tell("Retain", told_retain_
                       ? fmt::format("the newest state on the disk stays {}: {}. Clear what is in the way there; each "
                                     "further state is tried again.",
                                     retainer_->written(), problem)
                       : fmt::format("written again, state {}.", retainer_->written()));
  }
  if (trace_ != nullptr && trace_->is_cut() && !told_trace_) {
    told_trace_ = true;
    tell("Trace", fmt::format("ends here: {}. Clear what is in the way there; the next start begins a new one.",
                              trace_->problem()));
  }
}

std::string WriteNotices::at_the_end() const {
  std::string text;
  if (const std::string problem = retainer_ == nullptr ? "" : retainer_->problem(); !problem.empty()) {
    text += fmt::format("; the last state is not retained: {}", problem);
  }
  if (trace_ != nullptr && trace_->is_cut()) {
    text += fmt::format("; the trace was cut short, {} steps are not in it: {}", trace_->dropped(), trace_->problem());
  }
  return text;
}

}  // namespace hysteron::runtime
