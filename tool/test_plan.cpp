#include "tool/test_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "codegen/graph/body/whole_inputs.hpp"
#include "codegen/graph/defaults.hpp"
#include "codegen/graph/sample_time.hpp"
#include "codegen/parameters/apply.hpp"
#include "records/read.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "tuning/record_options.hpp"
#include "tuning/record_units.hpp"

namespace hysteron::tool {
namespace {

/// Each once: what the diagram lacks, every one of its cases would tell again.
void add_new(const Diagnostics& found, Diagnostics& diagnostics) {
  for (const Diagnostic& one : found.all()) {
    const auto is_one = [&](const Diagnostic& other) {
      return other.number == one.number && other.cause == one.cause && other.place.file == one.place.file &&
             other.place.line == one.place.line && other.place.column == one.place.column;
    };
    if (std::ranges::none_of(diagnostics.all(), is_one)) {
      diagnostics.add(one);
    }
  }
}

/// The port of a name; its index, or -1 with an error.
std::int64_t find_port(const std::vector<Port>& ports, const TestSignal& signal, std::string_view kind,
                       Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (equal_ignoring_case(ports[i].name, signal.name)) {
      return static_cast<std::int64_t>(i);
    }
    names.push_back(ports[i].name);
  }
  const auto near = nearest_name(signal.name, names);
  diagnostics.error(error::unknown_test_key, signal.place, fmt::format("There is no {} {}.", kind, signal.name),
                    !near.empty()   ? fmt::format("did you mean {}?", near)
                    : names.empty() ? fmt::format("the block has no {}s.", kind)
                                    : fmt::format("the {}s are {}.", kind, fmt::join(names, ", ")));
  return -1;
}

void check_types(const TestSignal& signal, const Port& port, const std::optional<bodies::WholeInput>& whole,
                 const Signal& values, Diagnostics& diagnostics) {
  for (const double value : values) {
    const auto fault = input_fault(port, whole, value);
    if (!fault.empty()) {
      diagnostics.error(error::wrong_test_value, signal.value_place,
                        fmt::format("{} {}, not {}.", port.name, fault, number_text(value)),
                        port.type == Type::Bool ? "write true or false." : "write a whole number.");
      return;
    }
  }
}

/// Reads a file that a case names; what is wrong with it is said with the place of its name.
template <class Read>
auto read_named(const TestText& name, const std::filesystem::path& folder, Read read) {
  try {
    return read((folder / name.text).string());
  } catch (const InputError& refused) {
    Diagnostics diagnostics;
    for (Diagnostic one : refused.diagnostics().all()) {
      one.notes.push_back({.place = name.place, .text = "named here; files are looked for beside the test file"});
      diagnostics.add(std::move(one));
    }
    throw InputError(std::move(diagnostics));
  }
}

/// Planning of one case.
class CasePlan {
 public:
  CasePlan(const TestCase& test, const Program& program, const std::filesystem::path& folder, Diagnostics& diagnostics)
      : planned_{.test = test,
                 .diagram = &program,
                 .program = program,
                 .drive = {},
                 .time = {},
                 .expected = {},
                 .golden = {}},
        folder_(folder),
        diagnostics_(diagnostics) {}

  PlannedCase run() {
    set_parameters();
    settle_steps();
    lay_out_inputs();
    for (const TestSignal& signal : planned_.test.expected) {
      lay_out_expected(signal);
    }
    std::ranges::sort(planned_.expected, {}, &ExpectedOutput::output);
    if (const TestText& golden = planned_.test.golden; !golden.text.empty()) {
      planned_.golden = folder_ / golden.text;
      if (planned_.drive.steps < 2) {
        diagnostics_.error(error::unusable_test, golden.place, "A golden record needs two steps at least.",
                           "give the case more steps, or say what is expected with expect.");
      }
    }
    return std::move(planned_);
  }

 private:
  [[nodiscard]] Graph& graph() { return planned_.program.graph; }
  [[nodiscard]] const TestCase& test() const { return planned_.test; }

  void set_parameters() {
    if (!test().parameter_file.text.empty()) {
      parameters::apply(read_named(test().parameter_file, folder_, parameters::read_parameter_file), graph(),
                        diagnostics_);
    }
    parameters::ParameterFile inside;
    inside.values = test().parameters;
    parameters::apply(inside, graph(), diagnostics_);
  }

  /// How many steps, at which times: from the record, the key `steps`, or the longest list.
  void settle_steps() {
    Drive& drive = planned_.drive;
    if (!test().csv.text.empty()) {
      record_ = read_named(test().csv, folder_, [&](const std::string& path) {
        return records::read_record(path, drive_options({}, planned_.program));
      });
      convert_units(*record_, planned_.program, diagnostics_);
      for (const std::string& note : record_->notes()) {
        planned_.notes.emplace_back(record_->file(), note);
      }
      settle_sample_time(*record_, planned_.program, diagnostics_);
      const auto rows = record_->size();
      if (test().steps.value_or(0) > rows) {
        diagnostics_.error(error::unusable_test, test().csv.place,
                           fmt::format("The case has {} steps, the record {} rows.", *test().steps, rows),
                           fmt::format("write steps = {} at most, or leave it out to use the whole record.", rows));
      }
      record_ = record_->slice({0, std::min(rows, test().steps.value_or(rows))});
      drive.steps = record_->size();
      drive.sample_time = record_->sample_time();
      planned_.time.assign(record_->time().begin(), record_->time().end());
      return;
    }
    drive.steps = test().steps ? *test().steps : longest_list();
    if (drive.steps == 0) {
      diagnostics_.error(error::unusable_test, test().place,
                         fmt::format("How many steps the case \"{}\" has is nowhere said.", test().name),
                         "write steps = 10, or give an input or an output as a list.");
    }
    if (graph().sample_time_ns == 0) {
      diagnostics_.add(missing_sample_time(graph()));
    }
    for (std::size_t k = 0; k < drive.steps; ++k) {
      planned_.time.push_back(static_cast<double>(k) * graph().sample_time());
    }
  }

  [[nodiscard]] std::size_t longest_list() const {
    std::size_t longest = 0;
    for (const auto* const signals : {&test().inputs, &test().expected}) {
      for (const TestSignal& signal : *signals) {
        if (const auto* const list = std::get_if<std::vector<double>>(&signal.values)) {
          longest = std::max(longest, list->size());
        }
      }
    }
    return longest;
  }

  /// Whether the values of a signal suit the steps of the case; says what does not.
  bool fits(const TestSignal& signal) {
    const auto steps = planned_.drive.steps;
    if (const auto* const list = std::get_if<std::vector<double>>(&signal.values);
        list != nullptr && list->size() != steps) {
      diagnostics_.error(
          error::unusable_test, signal.value_place,
          fmt::format("{} has {} values for {} steps.", signal.name, list->size(), steps),
          fmt::format("give one value for each step, or values by step: {} = {{0 = 0.0, 5 = 1.0}}.", signal.name));
      return false;
    }
    if (const auto* const by_step = std::get_if<ValuesByStep>(&signal.values);
        by_step != nullptr && by_step->rbegin()->first >= steps) {
      diagnostics_.error(error::unusable_test, signal.value_place,
                         fmt::format("{} has a value for step {}, but the last of {} steps is {}.", signal.name,
                                     by_step->rbegin()->first, steps, steps == 0 ? 0 : steps - 1),
                         "steps count from 0; give the case more steps, or leave the value out.");
      return false;
    }
    return true;
  }

  void lay_out_inputs() {
    std::vector<Signal> given(graph().inputs.size());
    const auto wholes = bodies::whole_inputs(graph());
    for (const TestSignal& signal : test().inputs) {
      const auto port = find_port(graph().inputs, signal, "input", diagnostics_);
      if (port < 0) {
        continue;
      }
      const auto index = static_cast<std::size_t>(port);
      if (!fits(signal)) {
        given[index] = {graph().inputs[index].preset};  // given, if wrongly: one fault, one message
        continue;
      }
      if (!given[index].empty() || (record_ && record_->find(signal.name) != nullptr)) {
        diagnostics_.error(
            error::unusable_test, signal.place, fmt::format("The input {} is given twice.", signal.name),
            record_ ? "leave it out here, or take the column out of the record." : "keep one of the two.");
        continue;
      }
      given[index] = signal_of(signal);
      check_types(signal, graph().inputs[index], wholes[index], given[index], diagnostics_);
      bodies::carry(wholes[index], given[index]);
    }
    if (record_) {
      planned_.drive = drive_from(*record_, planned_.program, std::move(given), diagnostics_);
      return;
    }
    for (std::size_t i = 0; i < given.size(); ++i) {
      const Port& input = graph().inputs[i];
      if (given[i].empty() && !has_default(graph(), input)) {
        diagnostics_.error(error::unusable_test, test().place,
                           fmt::format("The case \"{}\" says nothing of the input {}.", test().name, input.name),
                           fmt::format("add it: inputs = {{{} = {}}}.", toml_key(input.name),
                                       input.type == Type::Bool ? "false" : "0.0"),
                           {{.place = graph().place(input.span), .text = "the input; it has no default"}});
      }
      if (given[i].empty()) {
        given[i] = {input.preset};
      }
    }
    planned_.drive.inputs = std::move(given);
  }

  /// The values of an input over the steps. One by step holds until the next; before the first it is the default.
  [[nodiscard]] Signal signal_of(const TestSignal& signal) {
    const auto steps = planned_.drive.steps;
    if (const auto* const constant = std::get_if<double>(&signal.values)) {
      return {*constant};
    }
    if (const auto* const list = std::get_if<std::vector<double>>(&signal.values)) {
      return *list;
    }
    Signal values(steps);
    if (const auto* const ramp = std::get_if<Ramp>(&signal.values)) {
      for (std::size_t k = 0; k < steps; ++k) {
        const double share = steps > 1 ? static_cast<double>(k) / static_cast<double>(steps - 1) : 0.0;
        values[k] = ramp->from + (ramp->to - ramp->from) * share;
      }
      return values;
    }
    const auto& by_step = std::get<ValuesByStep>(signal.values);
    if (by_step.begin()->first != 0) {
      diagnostics_.error(error::unusable_test, signal.value_place,
                         fmt::format("{} has no value for step 0.", signal.name),
                         fmt::format("say where it begins: {} = {{0 = 0.0, …}}.", signal.name));
    }
    for (auto change = by_step.begin(); change != by_step.end(); ++change) {
      const auto next = std::next(change);
      const auto end = next == by_step.end() ? steps : next->first;
      std::fill(values.begin() + static_cast<std::ptrdiff_t>(change->first),
                values.begin() + static_cast<std::ptrdiff_t>(end), change->second);
    }
    return values;
  }

  void lay_out_expected(const TestSignal& signal) {
    const auto port = find_port(graph().outputs, signal, "output", diagnostics_);
    if (port < 0 || !fits(signal)) {
      return;
    }
    ExpectedOutput expected{.output = static_cast<std::size_t>(port), .values = {}, .place = signal.value_place};
    if (const auto* const by_step = std::get_if<ValuesByStep>(&signal.values)) {
      expected.values = *by_step;
    } else {
      const Signal values = signal_of(signal);
      for (std::size_t k = 0; k < planned_.drive.steps; ++k) {
        expected.values.emplace_hint(expected.values.end(), k, at_step(values, k));
      }
    }
    Signal flat;
    for (const auto& [step, value] : expected.values) {
      flat.push_back(value);
    }
    check_types(signal, graph().outputs[expected.output], std::nullopt, flat, diagnostics_);
    planned_.expected.push_back(std::move(expected));
  }

  PlannedCase planned_;
  const std::filesystem::path& folder_;
  Diagnostics& diagnostics_;
  std::optional<records::Record> record_;
};

}  // namespace

const Program* TestPlanner::program_of(const TestCase& test, Diagnostics& diagnostics) {
  const auto top = in_capitals(test.block.text);
  if (const auto found = programs_.find(top); found != programs_.end()) {
    return &found->second;
  }
  try {
    Diagnostics warnings;  // `hysteron check` shows them
    return &programs_.emplace(top, compile_file(diagram_, {.top = test.block.text}, warnings)).first->second;
  } catch (const InputError& refused) {
    const Diagnostic& first = refused.diagnostics().all().front();
    if (refused.diagnostics().all().size() == 1 && first.number == error::ambiguous_top) {
      diagnostics.error(error::unusable_test, test.block.text.empty() ? test.place : test.block.place,
                        fmt::format("Which block \"{}\" tests cannot be told: {}.", test.name, first.cause),
                        "name one that the diagram has, as in block = \"PLANT\".");
    } else {
      diagnostics.add_all(refused.diagnostics());
    }
    return nullptr;
  }
}

PlannedCase TestPlanner::plan(const TestCase& test, Diagnostics& diagnostics) {
  Diagnostics found;
  PlannedCase planned;
  try {
    if (const Program* const program = program_of(test, found)) {
      planned = CasePlan(test, *program, folder_, found).run();
    }
  } catch (const InputError& refused) {
    found.add_all(refused.diagnostics());
  }
  add_new(found, diagnostics);
  return planned;
}

}  // namespace hysteron::tool
