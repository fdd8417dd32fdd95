#include "runtime/task/trace.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <limits>
#include <system_error>

namespace hysteron::runtime {
namespace {

/// A record is its length, its kind and its contents.
constexpr std::size_t record_head = 5;

std::size_t end_of_record(std::string_view records, std::size_t begin) {
  std::uint32_t length = 0;
  std::memcpy(&length, records.data() + begin, sizeof(length));
  return begin + record_head + length;
}

TraceKind kind_of_record(std::string_view records, std::size_t begin) {
  return static_cast<TraceKind>(records[begin + 4]);
}

void append_record(std::string& to, TraceKind kind, std::span<const std::byte> contents) {
  const auto length = static_cast<std::uint32_t>(contents.size());
  to.append(reinterpret_cast<const char*>(&length), sizeof(length));
  to += static_cast<char>(kind);
  to.append(reinterpret_cast<const char*>(contents.data()), contents.size());
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

TraceSelector::TraceSelector(const TraceHead& head, std::optional<TraceTrigger> trigger)
    : inputs_(head.inputs.size()), outputs_(head.outputs.size()), trigger_(trigger) {}

void TraceSelector::feed(std::span<const std::byte> records, std::string& out) {
  const std::string_view all(reinterpret_cast<const char*>(records.data()), records.size());
  for (std::size_t at = 0; at + record_head <= all.size() && !finished_;) {
    const std::size_t end = end_of_record(all, at);
    feed_one(kind_of_record(all, at), all.substr(at, end - at), out);
    at = end;
  }
}

void TraceSelector::feed_one(TraceKind kind, std::string_view record, std::string& out) {
  const bool is_step = kind == TraceKind::step;
  if (!trigger_ || fired_) {
    out += record;
    steps_ += is_step ? 1 : 0;
    finished_ = fired_ && is_step && --left_ == 0;
    return;
  }
  if (kind == TraceKind::state || kept_.empty()) {
    kept_.emplace_back();
  }
  kept_.back().bytes += record;
  kept_.back().steps += is_step ? 1 : 0;
  // The oldest goes when the rest is enough.
  std::uint64_t later = 0;
  for (std::size_t i = 1; i < kept_.size(); ++i) {
    later += kept_[i].steps;
  }
  if (later > trigger_->before) {
    kept_.pop_front();
  }
  if (is_step && fires(record.substr(5))) {
    fired_ = true;
    left_ = trigger_->after;
    finished_ = left_ == 0;
    for (const Segment& segment : kept_) {
      out += segment.bytes;
      steps_ += segment.steps;
    }
    kept_.clear();
  }
}

bool TraceSelector::fires(std::string_view contents) {
  double value = 0.0;
  if (trigger_->signal == TraceTrigger::Signal::fault) {
    std::uint32_t fault = 0;
    std::memcpy(&fault, contents.data() + 16, sizeof(fault));
    value = fault;
  } else {
    const std::size_t column =
        trigger_->signal == TraceTrigger::Signal::input ? trigger_->index : inputs_ + outputs_ + trigger_->index;
    std::memcpy(&value, contents.data() + 20 + column * sizeof(double), sizeof(value));
  }
  const bool beyond = trigger_->above ? value > trigger_->level : value < trigger_->level;
  const bool crossed = beyond && !was_beyond_;
  was_beyond_ = beyond;
  return crossed;
}

Trace::Trace(const TraceSettings& settings, const StepProgram& program)
    : ring_(settings.ring_bytes),
      selector_(head_of(program), settings.trigger),
      file_(settings.file),
      parameters_(parameters_of(program)),
      state_(program.state_size()),
      state_every_(settings.trigger ? std::max<std::uint64_t>(1, settings.trigger->before)
                                    : std::numeric_limits<std::uint64_t>::max()),
      waits_(settings.waits) {
  const std::string head = text_of(head_of(program));
  if (file_.write(head) < head.size()) {
    const int reason = errno;
    file_.give_back();
    throw std::system_error(reason, std::generic_category(), settings.file.string());
  }
  writer_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      write_out(false);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    write_out(true);
  });
}

void Trace::finish() {
  stop_.store(true, std::memory_order_relaxed);
  if (writer_.joinable()) {
    writer_.join();
  }
}

bool Trace::push(TraceKind kind, std::span<const std::span<const std::byte>> contents) noexcept {
  std::array<std::span<const std::byte>, 6> parts;
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < contents.size(); ++i) {
    parts[i + 1] = contents[i];
    length += static_cast<std::uint32_t>(contents[i].size());
  }
  std::array<std::byte, 5> head{};
  std::memcpy(head.data(), &length, sizeof(length));
  head[4] = static_cast<std::byte>(kind);
  parts[0] = head;
  const auto record = std::span(parts).first(contents.size() + 1);
  bool pushed = ring_.push(record);
  while (!pushed && waits_) {
    std::this_thread::yield();
    pushed = ring_.push(record);
  }
  return pushed;
}

void Trace::before_step(std::uint64_t number, const StepProgram& program) noexcept {
  if (!needs_state_ && ++since_state_ < state_every_) {
    return;
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    parameters_[i] = program.parameter(i);
  }
  program.save(state_);
  const std::array<std::span<const std::byte>, 3> contents{bytes_of(number), std::as_bytes(std::span(parameters_)),
                                                           std::span<const std::byte>(state_)};
  needs_state_ = !push(TraceKind::state, contents);
  since_state_ = 0;
}

void Trace::parameters_changed(std::span<const double> parameters) noexcept {
  const std::array<std::span<const std::byte>, 1> contents{std::as_bytes(parameters)};
  needs_state_ = !push(TraceKind::parameters, contents) || needs_state_;
}

void Trace::was_reset() noexcept {
  needs_state_ = !push(TraceKind::reset, {}) || needs_state_;
}

void Trace::step(std::uint64_t number, std::uint64_t period, Fault fault, std::span<const double> inputs,
                 std::span<const double> computed, std::span<const double> outputs) noexcept {
  const std::array<std::uint64_t, 2> numbers{number, period};
  const auto code = static_cast<std::uint32_t>(fault);
  const std::array<std::span<const std::byte>, 5> contents{bytes_of(numbers), bytes_of(code), std::as_bytes(inputs),
                                                           std::as_bytes(computed), std::as_bytes(outputs)};
  // Without the state that is owed, a step could not be replayed: it is not recorded, and counted.
  if (needs_state_ || !push(TraceKind::step, contents)) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    needs_state_ = true;
  }
}

void Trace::write_out(bool last) {
  std::vector<std::byte> records;
  ring_.take(records);
  std::string out;
  const std::uint64_t before = selector_.steps_written();
  selector_.feed(records, out);
  write_records(out, selector_.steps_written() - before);
  if (last) {
    const std::array<std::uint64_t, 2> numbers{kept_, dropped()};
    std::string end;
    append_record(end, TraceKind::end, std::as_bytes(std::span(numbers)));
    // A file that takes no more has often room for so little, once what was half a record is gone from it.
    if (const std::size_t written = file_.write(end); written < end.size()) {
      file_.take_back(written);
    }
  }
}

void Trace::write_records(std::string_view records, std::uint64_t steps) {
  const std::size_t written = is_cut() ? 0 : file_.write(records);
  if (written == records.size()) {
    kept_ += steps;
    return;
  }
  std::size_t whole = 0;
  std::uint64_t whole_steps = 0;
  for (std::size_t end = 0; (end = end_of_record(records, whole)) <= written; whole = end) {
    whole_steps += kind_of_record(records, whole) == TraceKind::step ? 1 : 0;
  }
  file_.take_back(written - whole);
  kept_ += whole_steps;
  dropped_.fetch_add(steps - whole_steps, std::memory_order_relaxed);
  if (!is_cut()) {
    problem_ = file_.problem();
    cut_.store(true, std::memory_order_release);
  }
}

}  // namespace hysteron::runtime
