#include "runtime/task/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <system_error>
#include <utility>

#include "support/atomic_file.hpp"

namespace hysteron::runtime {
namespace {

/// From one try to begin another file to the next, where the disk is full or the folder gone.
constexpr std::chrono::seconds time_between_tries{10};

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

std::uint64_t memory_before(const TraceTrigger& trigger, std::size_t inputs, std::size_t outputs) {
  const std::uint64_t step = record_head + length_of_step(inputs, outputs);
  return 2 * std::max<std::uint64_t>(1, trigger.before) * step;
}

namespace {

constexpr std::uint64_t end_bytes = record_head + 2 * sizeof(std::uint64_t);

std::uint64_t bytes_of_step(const TraceHead& head) {
  return record_head + length_of_step(head.inputs.size(), head.outputs.size());
}

std::uint64_t length_of_state(const TraceHead& head) {
  return record_head + sizeof(std::uint64_t) + sizeof(double) * head.parameters.size() + head.state_size;
}

/// From a state up to the next, so that neither states nor what a file has beyond its size take much.
std::uint64_t steps_between_states(const TraceSettings& settings, const TraceHead& head) {
  const std::uint64_t bytes = std::max<std::uint64_t>(settings.file_bytes / 8, head.state_size);
  const std::uint64_t steps = std::max<std::uint64_t>(1, bytes / bytes_of_step(head));
  return settings.trigger ? std::clamp<std::uint64_t>(settings.trigger->before, 1, steps) : steps;
}

}  // namespace

TraceSelector::TraceSelector(const TraceHead& head, std::optional<TraceTrigger> trigger)
    : inputs_(head.inputs.size()),
      outputs_(head.outputs.size()),
      trigger_(trigger),
      was_beyond_(!trigger || trigger->signal != TraceTrigger::Signal::fault) {
  const std::string text = text_of(head);
  append_record(program_record_, TraceKind::program, std::as_bytes(std::span(text)));
}

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
  if (kind == TraceKind::program) {
    kept_.clear();  // of the program before, which another file would not replay
    program_record_ = record;
    out += record;
    return;
  }
  if (!trigger_ || fired_) {
    out += record;
    if (fired_ && is_step && --left_ == 0) {
      end_capture();
    }
    return;
  }
  keep(kind, record);
  if (is_step && fires(record.substr(record_head)) && !kept_.empty()) {
    begin_capture(out);
  }
}

void TraceSelector::keep(TraceKind kind, std::string_view record) {
  const bool is_armed_again = captures_ > 0;
  if (kind == TraceKind::state || (kept_.empty() && !is_armed_again)) {
    kept_.emplace_back();
  }
  if (kept_.empty()) {
    return;  // without a state before it, it could not be replayed
  }
  kept_.back().bytes += record;
  kept_.back().steps += kind == TraceKind::step ? 1 : 0;
  // The oldest goes when the rest is enough.
  std::uint64_t later = 0;
  for (std::size_t i = 1; i < kept_.size(); ++i) {
    later += kept_[i].steps;
  }
  if (later > trigger_->before) {
    kept_.pop_front();
  }
}

void TraceSelector::begin_capture(std::string& out) {
  fired_ = true;
  left_ = trigger_->after;
  out += captures_++ > 0 ? program_record_ : "";
  for (const Segment& segment : kept_) {
    out += segment.bytes;
  }
  kept_.clear();
  if (left_ == 0) {
    end_capture();
  }
}

void TraceSelector::end_capture() {
  finished_ = captures_ >= trigger_->captures;
  fired_ = finished_;
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

TraceProgram::TraceProgram(const StepProgram& program)
    : head(text_of(head_of(program))), parameters(parameters_of(program)), state(program.state_size()) {}

Trace::Trace(const TraceSettings& settings, const StepProgram& program)
    : program_(program),
      head_(program_.head),
      ring_(settings.ring_bytes),
      selector_(head_of(program), settings.trigger),
      file_(settings.file, settings.files - 1),
      state_every_(steps_between_states(settings, head_of(program))),
      waits_(settings.waits),
      file_bytes_(settings.file_bytes),
      segment_bytes_(length_of_state(head_of(program)) + state_every_ * bytes_of_step(head_of(program)) + end_bytes) {
  begin_first();
  writer_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      write_out(false);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    write_out(true);
  });
}

/// A disk that takes nothing keeps no task from starting: another file is tried later, as where a disk fills meanwhile.
void Trace::begin_first() {
  const std::size_t written = file_.write(head_);
  if (written == head_.size()) {
    file_.flush();
    return;
  }
  file_.take_back(written);
  file_.give_back();
  cut(0, file_.problem());
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
  std::array<std::byte, record_head> head{};
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
  if (!needs_state_ && ++since_state_ < state_every_ && !wants_state_.load(std::memory_order_relaxed)) {
    return;
  }
  wants_state_.store(false, std::memory_order_relaxed);
  program.save(program_.state);
  push_state(number, program);
}

void Trace::push_state(std::uint64_t number, const StepProgram& program) noexcept {
  if (needs_head_) {
    const std::array<std::span<const std::byte>, 1> contents{std::as_bytes(std::span(program_.head))};
    needs_head_ = !push(TraceKind::program, contents);
  }
  copy_parameters(program, program_.parameters);
  const std::array<std::span<const std::byte>, 3> contents{
      bytes_of(number), std::as_bytes(std::span(program_.parameters)), std::span<const std::byte>(program_.state)};
  needs_state_ = needs_head_ || !push(TraceKind::state, contents);
  since_state_ = 0;
}

void Trace::program_changed(std::uint64_t number, const StepProgram& program, std::span<const std::byte> state,
                            TraceProgram& next) noexcept {
  std::swap(program_, next);
  std::ranges::copy(state, program_.state.begin());
  needs_head_ = true;
  push_state(number, program);
}

void Trace::parameters_changed(const StepProgram& program) noexcept {
  copy_parameters(program, program_.parameters);
  const std::array<std::span<const std::byte>, 1> contents{std::as_bytes(std::span(program_.parameters))};
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

std::string Trace::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

std::string Trace::mend() const {
  const std::scoped_lock lock(mutex_);
  return way_out(reason_);
}

void Trace::write_out(bool last) {
  std::vector<std::byte> records;
  ring_.take(records);
  std::string out;
  selector_.feed(records, out);
  write_records(out);
  if (last) {
    if (!selector_.finished() && lose_deleted() > 0) {
      cut(0, file_.file().string() + ": somebody deleted it");
    }
    write_end();
  } else if (needs_next() && !selector_.finished()) {
    if (!selector_.waits()) {
      wants_state_.store(true, std::memory_order_relaxed);
    } else if (is_cut() || file_.is_taken_away()) {
      (void)begin_next();  // no state is written before the trigger fires, and until then the name is to be held
    }
  }
}

std::uint64_t Trace::lose_deleted() {
  const std::uint64_t lost = file_.is_deleted() ? std::exchange(kept_, 0) : 0;
  dropped_.fetch_add(lost, std::memory_order_relaxed);
  return lost;
}

void Trace::write_end() {
  if (file_.size() == 0) {
    return;  // there was no room for its head: with an end alone it would be no trace, and refuse the next start
  }
  const std::array<std::uint64_t, 2> numbers{kept_, dropped() - dropped_before_};
  std::string end;
  append_record(end, TraceKind::end, std::as_bytes(std::span(numbers)));
  // A file that takes no more has often room for so little, once what was half a record is gone from it.
  if (const std::size_t written = file_.write(end); written < end.size()) {
    file_.take_back(written);
  }
}

bool Trace::needs_next() const {
  if (is_cut()) {
    return std::chrono::steady_clock::now() >= next_try_;
  }
  const bool is_full = kept_ > 0 && file_.size() + segment_bytes_ > file_bytes_;
  return is_full || (file_.size() > 0 && file_.is_taken_away());
}

bool Trace::begin_next() {
  next_try_ = std::chrono::steady_clock::now() + time_between_tries;
  if (!is_cut()) {
    write_end();
  }
  const std::uint64_t deleted = lose_deleted();
  if (!file_.begin_next()) {
    cut(0, file_.problem());
    return false;
  }
  if (const std::size_t written = file_.write(head_); written < head_.size()) {
    file_.take_back(written);
    cut(0, file_.problem());
    return false;
  }
  if (deleted > 0) {
    remarks_.say(fmt::format("{} was deleted, or moved to another disk, and {} steps with it. Another file is begun.",
                             file_.file().string(), deleted));
  }
  file_.flush();
  kept_ = 0;
  dropped_before_ = dropped();
  cut_.store(false, std::memory_order_release);
  return true;
}

void Trace::write_records(std::string_view records) {
  const auto is_begin = [&](std::size_t at) {
    const TraceKind kind = kind_of_record(records, at);
    return kind == TraceKind::state || kind == TraceKind::program;
  };
  for (std::size_t begin = 0; begin < records.size();) {
    std::size_t end = end_of_record(records, begin);
    if (kind_of_record(records, begin) == TraceKind::program) {
      head_ = records.substr(begin + record_head, end - begin - record_head);
      is_other_ = true;
      begin = end;
      continue;
    }
    while (end < records.size() && !is_begin(end)) {
      end = end_of_record(records, end);
    }
    if (kind_of_record(records, begin) == TraceKind::state && (is_other_ || needs_next())) {
      is_other_ = !begin_next() && is_other_;
    }
    write_part(records.substr(begin, end - begin));
    begin = end;
  }
}

void Trace::write_part(std::string_view records) {
  const std::size_t written = is_cut() ? 0 : file_.write(records);
  std::size_t whole = 0;
  std::uint64_t lost = 0;
  for (std::size_t begin = 0; begin < records.size();) {
    const std::size_t end = end_of_record(records, begin);
    const std::uint64_t steps = kind_of_record(records, begin) == TraceKind::step ? 1 : 0;
    if (end <= written) {
      whole = end;
      kept_ += steps;
    } else {
      lost += steps;
    }
    begin = end;
  }
  if (written < records.size()) {
    file_.take_back(written - whole);
    cut(lost, file_.problem());
  }
}

/// From here on nothing is written until another file can be begun.
void Trace::cut(std::uint64_t lost, const std::string& problem) {
  dropped_.fetch_add(lost, std::memory_order_relaxed);
  if (!is_cut()) {
    next_try_ = std::chrono::steady_clock::now() + time_between_tries;
    const std::scoped_lock lock(mutex_);
    problem_ = problem;
    reason_ = file_.reason();
    cut_.store(true, std::memory_order_release);
  }
}

}  // namespace hysteron::runtime
