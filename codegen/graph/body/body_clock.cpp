// The time of the task in a body, and the timers of the standard by it.
#include <fmt/format.h>

#include <utility>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/body/standard_blocks.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

using language::Operator;

namespace {
constexpr std::int64_t nanoseconds = 1'000'000;           ///< of a millisecond
constexpr double milliseconds_of_a_round = 4294967296.0;  ///< 2^32, 49.7 days
}  // namespace

/// TIME(), and what the text of a timer alone may call.
std::optional<Value> Body::of_time(const std::string& function, language::Span span) {
  if (function == "TIME") {
    return clock(span);
  }
  if (source_.library != &timers_by_clock()) {
    return std::nullopt;
  }
  if (function == "CLOCK_STEPS") {
    return steps();
  }
  if (function == "STEP_TIME") {
    return computer_.literal(Plain::Time, static_cast<double>(sample_time(span)) / double{nanoseconds});
  }
  return std::nullopt;
}

/// Of a step. Where none is stated, that is told, and one is given all the same: a block within another one is looked
/// at by itself, too, and has its sample time from outside.
std::int64_t Body::sample_time(language::Span span) {
  if (around_.sample_time_ns <= 0 && !std::exchange(lacks_sample_time_, true)) {
    refuse(error::missing_sample_time, span,
           standard_call_ ? "a timer that is called under a condition, or more than once, counts by the sample time, "
                            "which is not stated"
                          : "TIME() counts by the sample time, which is not stated",
           "Write it behind the name of the outermost block: (* @ts 1ms *).");
  }
  return around_.sample_time_ns > 0 ? around_.sample_time_ns : nanoseconds;
}

/// TIME(): the whole milliseconds since the first step. They are counted with 32 bits, as in a PLC, and each round of
/// these bits by itself: a time goes on after 49.7 days, and so does the difference of two.
Value Body::clock(language::Span span) {
  if (clock_) {
    return *clock_;
  }
  const std::int64_t ts = sample_time(span);
  const std::int64_t rest = ts % nanoseconds;
  const auto constant = [&](Plain type, std::int64_t value) {
    return computer_.literal(type, static_cast<double>(value));
  };
  const auto outer = computer_.span();
  computer_.at(path_for("CLOCK"), place_of(span));
  const auto [now, node] = delay(Plain::Udint, 0.0, "CLOCK", place_of(span));
  Value next = computer_.binary(Operator::Add, now, constant(Plain::Udint, ts / nanoseconds));
  if (rest != 0) {  // what is left of a millisecond is carried on in nanoseconds
    const auto [left, rest_node] = delay(Plain::Dint, 0.0, "CLOCK_REST", place_of(span));
    const Value sum = computer_.binary(Operator::Add, left, constant(Plain::Dint, rest));
    const Value full = computer_.binary(Operator::GreaterEqual, sum, constant(Plain::Dint, nanoseconds));
    const Value taken = computer_.binary(Operator::Subtract, sum, constant(Plain::Dint, nanoseconds));
    feed(rest_node, computer_.select(full, taken, sum));
    next = computer_.select(full, computer_.binary(Operator::Add, next, constant(Plain::Udint, 1)), next);
  }
  feed(node, next);
  const auto [round, round_node] = delay(Plain::Dint, 0.0, "CLOCK_ROUND", place_of(span));
  const Value over = computer_.binary(Operator::Less, next, now);
  feed(round_node, computer_.select(over, computer_.binary(Operator::Add, round, constant(Plain::Dint, 1)), round));
  const Value rounds = computer_.binary(Operator::Multiply, computer_.convert(round, Plain::Lreal),
                                        computer_.literal(Plain::Lreal, milliseconds_of_a_round));
  clock_ = computer_.binary(Operator::Add, computer_.convert(now, Plain::Lreal), rounds);
  clock_->type = Plain::Time;
  computer_.at(outer);
  return *clock_;
}

/// The steps of the task since its first, which come anew from 0 after 2^32.
Value Body::steps() {
  if (!steps_) {
    computer_.at(path_for("STEPS"), computer_.span());
    const auto [now, node] = delay(Plain::Udint, 0.0, "STEPS", computer_.span());
    feed(node, computer_.binary(Operator::Add, now, computer_.literal(Plain::Udint, 1.0)));
    steps_ = now;
  }
  return *steps_;
}

/// Whether a timer is called where its block of the library cannot be: under a condition, or more than once in a step.
/// Then its variables move on where it is called alone, and it reads the clock, as in a PLC.
bool Body::runs_by_clock(Place& place) const {
  place.clocked = place.clocked || (place.by_clock && conditions_ > 0 && !place.called);
  return place.clocked;
}

void Body::invoke_by_clock(Place& place, language::Span span) {
  Place& text = *place.by_clock;
  for (std::size_t i = 0; i < text.members.size(); ++i) {
    text.aliases[i] = place.find(text.members[i].name);  // the pins are those of the instance
  }
  const auto outer_call = standard_call_;
  standard_call_ = place_of(span);
  enter(text, text.type->source);
  standard_call_ = outer_call;
}

}  // namespace hysteron::bodies
