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

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace

TraceSelector::TraceSelector(const TraceHead& head, std::optional<TraceTrigger> trigger)
    : inputs_(head.inputs.size()), outputs_(head.outputs.size()), trigger_(trigger) {}

void TraceSelector::feed(std::span<const std::byte> records, std::string& out) {
  const std::string_view all(reinterpret_cast<const char*>(records.data()), records.size());
  for (std::size_t at = 0; at + 5 <= all.size() && !finished_;) {
    std::uint32_t length = 0;
    std::memcpy(&length, all.data() + at, sizeof(length));
    feed_one(static_cast<TraceKind>(all[at + 4]), all.substr(at, 5 + length), out);
    at += 5 + length;
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
      file_(settings.file, std::ios::binary | std::ios::trunc),
      parameters_(parameters_of(program)),
      state_(program.state_size()),
      state_every_(settings.trigger ? std::max<std::uint64_t>(1, settings.trigger->before)
                                    : std::numeric_limits<std::uint64_t>::max()),
      waits_(settings.waits) {
  if (!file_) {
    throw std::system_error(errno, std::generic_category(), settings.file.string());
  }
  file_ << text_of(head_of(program));
  writer_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      write_out(false);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    write_out(true);
  });
}

Trace::~Trace() {
  stop_.store(true, std::memory_order_relaxed);
  writer_.join();
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
  selector_.feed(records, out);
  if (last) {
    const std::array<std::uint64_t, 2> numbers{selector_.steps_written(), dropped()};
    const std::uint32_t length = sizeof(numbers);
    out.append(reinterpret_cast<const char*>(&length), sizeof(length));
    out += static_cast<char>(TraceKind::end);
    out.append(reinterpret_cast<const char*>(numbers.data()), sizeof(numbers));
  }
  if (!out.empty()) {
    file_.write(out.data(), static_cast<std::streamsize>(out.size()));
    file_.flush();
    if (!file_) {
      failures_.fetch_add(1, std::memory_order_relaxed);
    }
  }
}

}  // namespace hysteron::runtime
