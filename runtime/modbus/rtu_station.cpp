#include "runtime/modbus/rtu_station.hpp"

#include <algorithm>
#include <utility>

namespace hysteron::runtime::modbus {
namespace {

Served sum(const Served& a, const Served& b) {
  return {
      .requests = a.requests + b.requests, .exceptions = a.exceptions + b.exceptions, .writes = a.writes + b.writes};
}

}  // namespace

std::chrono::nanoseconds rtu_silence(int baud) {
  constexpr std::chrono::nanoseconds shortest = std::chrono::microseconds(1750);
  constexpr std::int64_t bits = 11;
  return baud > 19200 ? shortest : std::max(shortest, std::chrono::nanoseconds(7 * bits * 1'000'000'000 / (2 * baud)));
}

Served RtuStation::received(std::span<const std::uint8_t> bytes, Instant now, Responder& responder,
                            const Caller& caller) {
  Served before;
  if (!input_.empty() && now - last_byte_ > timing_.longest_gap) {
    before = silent(now, responder, caller);
  }
  last_byte_ = now;
  take_echo(bytes, now);
  if (bytes.empty()) {
    return before;
  }
  // A master that speaks on has given up on the answer that waits.
  forget_output();
  input_.insert(input_.end(), bytes.begin(), bytes.end());
  return sum(before, frames(now, responder, caller));
}

/// Whole frames at the begin of the input, by their length and checksum. What is left waits for more, or for silence.
Served RtuStation::frames(Instant now, Responder& responder, const Caller& caller) {
  Served all;
  while (!is_spoiled_) {
    const std::size_t size = whole_frame();
    if (size == 0) {
      break;
    }
    ++counts_.frames;
    const std::vector<std::uint8_t> frame(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(size));
    input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(size));
    if (is_own(frame[0])) {
      all = sum(all, answer(frame, now, responder, caller));
    }
  }
  if (input_.size() > longest_rtu_frame) {
    is_spoiled_ = true;
    input_.resize(1);
  }
  return all;
}

/// The size of the frame at the begin of the input; 0 where none is whole. Of other units it may be an answer, or of a
/// function without a known length.
std::size_t RtuStation::whole_frame() const {
  const std::span<const std::uint8_t> input(input_);
  const auto is_whole = [&](std::size_t size) {
    return size > 0 && input.size() >= size && is_rtu_frame(input.first(size));
  };
  if (input.empty()) {
    return 0;
  }
  if (const std::size_t size = rtu_request_size(input); is_whole(size)) {
    return size;
  }
  if (is_own(input[0])) {
    return 0;
  }
  const std::size_t size = rtu_answer_size(input);
  return is_whole(size) ? size : is_rtu_frame(input) ? input.size() : 0;
}

Served RtuStation::answer(std::span<const std::uint8_t> frame, Instant now, Responder& responder,
                          const Caller& caller) {
  const bool is_broadcast = frame[0] == 0;
  const auto pdu = frame.subspan(1, frame.size() - 3);
  if (is_broadcast) {
    ++counts_.broadcasts;
  }
  const Reply reply = responder.answer(pdu, caller);
  // Nobody reads an answer to all.
  forget_output();
  output_ = is_broadcast ? std::vector<std::uint8_t>() : rtu_frame(unit_, reply.pdu());
  answer_at_ = now + timing_.silence;
  Served served;
  served.count(reply);
  return served;
}

Served RtuStation::silent(Instant now, Responder& responder, const Caller& caller) {
  if (input_.empty() || now - last_byte_ <= timing_.longest_gap) {
    return {};
  }
  const std::vector<std::uint8_t> rest = std::exchange(input_, {});
  const bool is_sound = !std::exchange(is_spoiled_, false) && is_rtu_frame(rest);
  ++(is_sound ? counts_.frames : counts_.broken);
  // A function that is none of ours has no length, and an answer all the same.
  return is_sound && is_own(rest[0]) ? answer(rest, now, responder, caller) : Served{};
}

void RtuStation::take_echo(std::span<const std::uint8_t>& bytes, Instant now) {
  if (!echo_.empty() && now > echo_until_) {
    ++counts_.echo_lost;
    echo_.clear();
  }
  const std::size_t count = std::min(bytes.size(), echo_.size());
  if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count), echo_.begin())) {
    ++counts_.echo_lost;
    echo_.clear();
    return;
  }
  echo_.erase(echo_.begin(), echo_.begin() + static_cast<std::ptrdiff_t>(count));
  bytes = bytes.subspan(count);
}

std::span<const std::uint8_t> RtuStation::output(Instant now) const {
  return now >= answer_at_ ? std::span(output_).subspan(output_sent_) : std::span<const std::uint8_t>();
}

void RtuStation::sent(std::size_t count, Instant now) {
  if (has_echo_) {
    const auto begin = output_.begin() + static_cast<std::ptrdiff_t>(output_sent_);
    echo_.insert(echo_.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
    echo_until_ = now + static_cast<std::int64_t>(echo_.size()) * timing_.silence + timing_.longest_gap;
  }
  output_sent_ += count;
  if (output_sent_ == output_.size()) {
    forget_output();
  }
}

void RtuStation::forget_output() {
  output_.clear();
  output_sent_ = 0;
}

std::optional<Instant> RtuStation::next_deadline() const {
  if (!output_.empty()) {
    return answer_at_;
  }
  return input_.empty() ? std::nullopt : std::optional(last_byte_ + timing_.longest_gap + std::chrono::nanoseconds(1));
}

void RtuStation::reset() {
  input_.clear();
  is_spoiled_ = false;
  forget_output();
  echo_.clear();
}

}  // namespace hysteron::runtime::modbus
