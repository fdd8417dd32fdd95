#include "runtime/task/trace_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "runtime/task/layout_text.hpp"
#include "support/whole_number.hpp"

namespace hysteron::runtime {
namespace {

std::string lines_of(std::string_view word, const std::vector<TraceColumn>& columns) {
  std::string text;
  for (const TraceColumn& column : columns) {
    text += std::string(word) + " " + column.name + (column.unit.empty() ? "" : " " + column.unit) + "\n";
  }
  return text;
}

std::vector<TraceColumn> columns_of(const std::vector<ProgramSignal>& signals) {
  std::vector<TraceColumn> columns;
  columns.reserve(signals.size());
  for (const ProgramSignal& signal : signals) {
    columns.push_back({.name = signal.name, .unit = signal.unit});
  }
  return columns;
}

/// One line of the head; false where it has no meaning.
bool read_line(std::string_view line, TraceHead& head) {
  const auto space = line.find(' ');
  const auto word = line.substr(0, space);
  const auto rest = space == std::string_view::npos ? std::string_view() : line.substr(space + 1);
  if (word == "program") {
    head.program = rest;
  } else if (word == "layout") {
    head.layout = rest;
  } else if (word == "period") {
    const auto period = whole_number<std::int64_t>(rest, 1);
    head.period = period.value_or(0);
    return period.has_value();
  } else if (word == "state") {
    const auto size = whole_number<std::size_t>(rest);
    head.state_size = size.value_or(0);
    return size.has_value();
  } else if (word == "input" || word == "output" || word == "parameter") {
    const auto end = rest.find(' ');
    TraceColumn column{.name = std::string(rest.substr(0, end)),
                       .unit = end == std::string_view::npos ? "" : std::string(rest.substr(end + 1))};
    (word == "input" ? head.inputs : word == "output" ? head.outputs : head.parameters).push_back(std::move(column));
  } else {
    return false;
  }
  return !rest.empty();
}

/// Reads contents forward; their length was checked before.
class Contents {
 public:
  explicit Contents(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  T number() {
    T value{};
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return value;
  }
  void numbers(std::vector<double>& into) {
    for (double& value : into) {
      value = number<double>();
    }
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

std::string at_byte(std::string_view what, std::size_t byte) {
  return std::string(what) + " at byte " + std::to_string(byte);
}

std::size_t length_of(TraceKind kind, const TraceHead& head) {
  const std::size_t parameters = head.parameters.size() * sizeof(double);
  switch (kind) {
    case TraceKind::state:
      return 8 + parameters + head.state_size;
    case TraceKind::parameters:
      return parameters;
    case TraceKind::reset:
      return 0;
    case TraceKind::step:
      return length_of_step(head.inputs.size(), head.outputs.size());
    case TraceKind::end:
      return 16;
    case TraceKind::program:
      break;
  }
  return static_cast<std::size_t>(-1);
}

void hand_on(TraceKind kind, std::string_view bytes, const TraceVisitor& visitor, TraceStep& step,
             std::vector<double>& parameters) {
  Contents contents(bytes);
  if (kind == TraceKind::state && visitor.state) {
    const auto next = contents.number<std::uint64_t>();
    contents.numbers(parameters);
    visitor.state(next, parameters,
                  {reinterpret_cast<const std::byte*>(contents.rest().data()), contents.rest().size()});
  } else if (kind == TraceKind::parameters && visitor.parameters) {
    contents.numbers(parameters);
    visitor.parameters(parameters);
  } else if (kind == TraceKind::reset && visitor.reset) {
    visitor.reset();
  } else if (kind == TraceKind::step && visitor.step) {
    step.number = contents.number<std::uint64_t>();
    step.period = contents.number<std::uint64_t>();
    step.fault = static_cast<Fault>(contents.number<std::uint32_t>());
    contents.numbers(step.inputs);
    contents.numbers(step.computed);
    contents.numbers(step.outputs);
    visitor.step(step);
  } else if (kind == TraceKind::end && visitor.end) {
    const auto steps = contents.number<std::uint64_t>();
    visitor.end(steps, contents.number<std::uint64_t>());
  }
}

/// The head; gives back where the data begins, 0 with a fault.
std::size_t read_head(std::string_view bytes, TraceHead& head, std::string& fault) {
  if (!bytes.starts_with(std::string(trace_first_line) + "\n")) {
    fault = "this is no trace: it does not begin with \"" + std::string(trace_first_line) + "\"";
    return 0;
  }
  std::size_t at = trace_first_line.size() + 1;
  for (;;) {
    const auto end = bytes.find('\n', at);
    if (end == std::string_view::npos) {
      fault = at_byte("the head does not end", at);
      return 0;
    }
    const auto line = bytes.substr(at, end - at);
    if (line == trace_last_line_of_head) {
      return end + 1;
    }
    if (!read_line(line, head)) {
      fault = at_byte("a line of the head that has no meaning", at);
      return 0;
    }
    at = end + 1;
  }
}

}  // namespace

bool is_begin_of_trace(std::string_view bytes) {
  // A file system may give a file its size before its bytes: a power cut between the two leaves zeros.
  const bool is_blank = bytes.find_first_not_of('\0') == std::string_view::npos;
  return is_blank || bytes.starts_with(trace_first_line) || trace_first_line.starts_with(bytes);
}

TraceHead head_of(const StepProgram& program) {
  const ProgramShape& shape = program.shape();
  return {.program = shape.name,
          .layout = shape.layout,
          .period = shape.period,
          .state_size = program.state_size(),
          .inputs = columns_of(shape.inputs),
          .outputs = columns_of(shape.outputs),
          .parameters = columns_of(shape.parameters)};
}

std::string text_of(const TraceHead& head) {
  return std::string(trace_first_line) + "\nprogram " + head.program + "\nlayout " + head.layout + "\nperiod " +
         std::to_string(head.period) + "\nstate " + std::to_string(head.state_size) + "\n" +
         lines_of("input", head.inputs) + lines_of("output", head.outputs) + lines_of("parameter", head.parameters) +
         std::string(trace_last_line_of_head) + "\n";
}

std::optional<TraceHead> trace_head(std::string_view bytes) {
  TraceHead head;
  std::string fault;
  return read_head(bytes, head, fault) > 0 ? std::optional(std::move(head)) : std::nullopt;
}

std::string read_trace(std::string_view bytes, TraceHead& head,
                       const std::function<TraceVisitor(const TraceHead&)>& visit) {
  std::string fault;
  std::size_t at = read_head(bytes, head, fault);
  if (at == 0) {
    return fault;
  }
  const TraceVisitor visitor = visit(head);
  TraceStep step{.inputs = std::vector<double>(head.inputs.size()),
                 .computed = std::vector<double>(head.outputs.size()),
                 .outputs = std::vector<double>(head.outputs.size())};
  std::vector<double> parameters(head.parameters.size());
  while (bytes.size() - at >= record_head) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + at, sizeof(length));
    const auto kind = static_cast<TraceKind>(bytes[at + 4]);
    if (length_of(kind, head) != length) {
      return at_byte("a record of an unknown kind or wrong length", at);
    }
    if (bytes.size() - at - record_head < length) {
      break;  // cut off
    }
    hand_on(kind, bytes.substr(at + record_head, length), visitor, step, parameters);
    at += record_head + length;
  }
  return {};
}

namespace {
/// Not finite where one is: 0, the bits are compared by themselves.
double square_of(double difference) {
  return std::isfinite(difference) ? difference * difference : 0.0;
}
}  // namespace

std::string replay(std::string_view bytes, StepProgram& program, ReplayResult& result,
                   const std::function<void(const TraceStep&)>& on_step) {
  std::string fault;
  std::uint64_t next = 0;
  bool known = false;
  std::vector<double> computed(program.shape().outputs.size());
  result.difference_rms.assign(computed.size(), 0.0);
  result.limited_rms.assign(computed.size(), 0.0);
  const auto set_all = [&](std::span<const double> parameters) { set_parameters(program, parameters); };
  const auto visit = [&](const TraceHead& head) {
    TraceVisitor visitor;
    if (head.layout != program.shape().layout || head.state_size != program.state_size()) {
      fault = diagram_of(head.layout) == diagram_of(program.shape().layout)
                  ? "the trace was recorded by another engine, whose state lies in other bytes"
                  : "the trace is of another diagram, or of this one before an edit (" + head.program + ")";
      return visitor;
    }
    visitor.state = [&](std::uint64_t number, std::span<const double> parameters, std::span<const std::byte> state) {
      set_all(parameters);
      program.restore(state);
      next = number;
      known = true;
    };
    visitor.parameters = set_all;
    visitor.reset = [&] { program.reset(); };
    visitor.step = [&](const TraceStep& step) {
      known = known && step.number == next;
      if (known) {
        program.step(step.inputs, computed);
        ++result.steps;
        next = step.number + 1;
        for (std::size_t i = 0; i < computed.size(); ++i) {
          result.difference_rms[i] += square_of(step.computed[i] - computed[i]);
          result.limited_rms[i] += square_of(step.outputs[i] - step.computed[i]);
        }
        for (std::size_t i = 0; i < computed.size(); ++i) {
          const bool same = std::bit_cast<std::uint64_t>(computed[i]) == std::bit_cast<std::uint64_t>(step.computed[i]);
          if (!same && !(std::isnan(computed[i]) && std::isnan(step.computed[i]))) {
            result.first_different = result.different == 0 ? step.number : result.first_different;
            ++result.different;
            break;
          }
        }
      } else {
        ++result.without_state;
      }
      if (on_step) {
        on_step(step);
      }
    };
    visitor.end = [&](std::uint64_t /*steps*/, std::uint64_t dropped) {
      result.dropped = dropped;
      result.complete = true;
    };
    return visitor;
  };
  TraceHead head;
  const auto broken = read_trace(bytes, head, visit);
  for (auto* const squares : {&result.difference_rms, &result.limited_rms}) {
    for (double& sum : *squares) {
      sum = result.steps > 0 ? std::sqrt(sum / static_cast<double>(result.steps)) : 0.0;
    }
  }
  return fault.empty() ? broken : fault;
}

}  // namespace hysteron::runtime
