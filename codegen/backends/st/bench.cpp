#include "codegen/backends/st/bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/st/bench_blocks.hpp"
#include "codegen/backends/st/bench_results.hpp"
#include "codegen/backends/st/bench_values.hpp"
#include "codegen/backends/st/comment.hpp"
#include "codegen/backends/st/literals.hpp"
#include "codegen/backends/st/shape.hpp"
#include "codegen/backends/st/words.hpp"

namespace hysteron {
namespace {

std::uint32_t array_length(std::size_t numbered_from_one) {
  return static_cast<std::uint32_t>(numbered_from_one + 1);
}

class BenchText {
 public:
  BenchText(const StBench& bench, const StDialect& dialect, const std::vector<BenchBlock>& blocks)
      : bench_(bench),
        dialect_(dialect),
        blocks_(blocks),
        names_(bench_words(dialect), LetterCase::Upper),
        values_(dialect, names_) {
    for (const BenchResult& one : bench_results()) {
      names_.take(one.name);
    }
    for (const std::string_view own :
         {"RESTART", "STEPS", "ABSOLUTE", "RELATIVE", "ACTUAL", "EXACT", "CHECKED", "WANTED", "SLOT", "OUTPUT",
          "ALLOWED", "WRONG", "FAILURES_OF", "STEP_OF", "OUTPUT_OF", "EXPECTED_OF", "GOT_OF"}) {
      names_.take(own);
    }
    for (const BenchBlock& block : blocks) {
      names_.take(block.made.block.name);
      most_outputs_ = std::max(most_outputs_, block.program.graph.outputs.size());
    }
    for (const StBenchCase& one : bench.cases) {
      slots_ = std::max(slots_, one.expected.size());
    }
  }

  StPou run() {
    StPou made{.name = std::string(names_.make({bench_.name}))};
    made.body = body();
    made.head = head(made.name);
    made.sections = sections();
    return made;
  }

 private:
  [[nodiscard]] std::string local(std::string_view name) const { return values_.local(name); }
  // --- the body ---

  std::string body() {
    for (const BenchBlock& block : blocks_) {
      name_variables(block);
    }
    std::string text = fmt::format("  IF {} THEN\n", local("RESTART"));
    for (const BenchResult& one : bench_results()) {
      append(text, fmt::format("    {} := {};\n", local(one.name),
                               one.type == "BOOL"   ? "FALSE"
                               : one.type == "DINT" ? "0"
                                                    : "0.0"));
    }
    append(text, fmt::format("    FOR {0} := 0 TO {1} DO\n      {2}[{0}] := 0;\n    END_FOR;\n  END_IF;\n\n",
                             local("SLOT"), bench_.cases.size(), local("FAILURES_OF")));
    append(text, fmt::format("  IF NOT {} THEN\n    IF {} = 0 THEN\n      {} := 1;\n    END_IF;\n", local("DONE"),
                             local("TEST_NUMBER"), local("TEST_NUMBER")));
    append(text, fmt::format("    FOR {} := 1 TO {} DO\n      {}[{}] := 0;\n    END_FOR;\n\n", local("SLOT"),
                             last_slot(), local("CHECKED"), local("SLOT")));
    append(text, "    (* what goes in, and what is expected of which output *)\n    CASE ", local("TEST_NUMBER"),
           " OF\n");
    for (std::size_t i = 0; i < bench_.cases.size(); ++i) {
      write_case(i, text);
    }
    append(text, "    END_CASE;\n\n    (* the step *)\n    CASE ", local("TEST_NUMBER"), " OF\n");
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      write_call(b, text);
    }
    text += "    END_CASE;\n\n";
    text += bench_comparison({.prefix = dialect_.local_prefix, .slots = last_slot(), .outputs = most_outputs_});
    append(text, fmt::format("    {0} := {0} + 1;\n    IF {0} >= {1} THEN\n      {0} := 0;\n", local("TEST_STEP"),
                             local("STEPS")));
    append(text, fmt::format("      {0} := {1} = {2};\n      IF NOT {0} THEN\n        {1} := {1} + 1;\n      END_IF;\n",
                             local("DONE"), local("TEST_NUMBER"), bench_.cases.size()));
    append(text, fmt::format("      {} := {} AND {} = 0;\n    END_IF;\n  END_IF;\n", local("PASSED"), local("DONE"),
                             local("VALUES_FAILED")));
    return text;
  }

  /// The last place of an expectation: two at least, since MATIEC skips a FOR whose bounds are equal.
  [[nodiscard]] std::size_t last_slot() const { return std::max<std::size_t>(slots_, 2); }

  void name_variables(const BenchBlock& block) {
    const Graph& graph = block.program.graph;
    Variables made;
    const std::string& name = block.made.block.name;
    const std::string type = dialect_.shape == StDialect::Shape::Source ? fmt::format("\"{}\"", name) : name;
    made.instance = values_.declare(names_.make({name, "1"}), type, 1, "the block under test");
    // Elements of an array are set where they are: compilers differ on which arrays may be handed over in a call.
    for (const PortGroup& group : port_groups(graph.inputs)) {
      for (std::uint32_t i = group.first; i < group.first + group.length; ++i) {
        made.inputs.push_back(group.is_array()
                                  ? fmt::format("{}.{}", made.instance, block.made.interface.inputs[i])
                                  : values_.declare(names_.make({name, graph.inputs[i].name}),
                                                    std::string(st_type(graph.inputs[i].type, block.float32)), 1,
                                                    "an input of it"));
      }
    }
    for (const std::size_t i : block.changed) {
      const Parameter& parameter = graph.parameters[i];
      made.parameters.push_back(values_.declare(names_.make({name, parameter.path}),
                                                std::string(st_type(parameter.field.type, block.float32)), 1,
                                                "a parameter that some test sets"));
    }
    variables_.push_back(std::move(made));
  }

  void write_case(std::size_t i, std::string& text) {
    const StBenchCase& one = bench_.cases[i];
    const std::size_t b = block_of(i);
    const BenchBlock& block = blocks_[b];
    const Graph& graph = block.program.graph;
    const std::string number = fmt::format("T{}", i + 1);
    append(text, fmt::format("      {}:  (* {} *)\n", i + 1, st_comment(one.name)));
    append(text,
           fmt::format("        {} := {};\n        {} := {};\n        {} := {};\n", local("STEPS"), one.steps,
                       local("ABSOLUTE"), values_.real(one.absolute), local("RELATIVE"), values_.real(one.relative)));
    for (std::size_t p = 0; p < block.changed.size(); ++p) {
      const Parameter& parameter = one.program->graph.parameters[block.changed[p]];
      append(text, fmt::format("        {} := {};\n", variables_[b].parameters[p],
                               values_.value(parameter.field.type, parameter.value.front(), block.float32)));
    }
    for (std::size_t p = 0; p < graph.inputs.size(); ++p) {
      values_.write_input({.target = variables_[b].inputs[p], .type = graph.inputs[p].type, .float32 = block.float32},
                          one.inputs[p], names_.make({number, graph.inputs[p].name}), text);
    }
    for (std::size_t slot = 0; slot < one.expected.size(); ++slot) {
      const StExpectation& expected = one.expected[slot];
      values_.write_expectation(slot + 1, expected, one.steps,
                                names_.make({number, graph.outputs[expected.output].name}), text);
    }
  }

  [[nodiscard]] std::size_t block_of(std::size_t test) const {
    for (std::size_t b = 0; b + 1 < blocks_.size(); ++b) {
      if (std::ranges::count(blocks_[b].cases, test) != 0) {
        return b;
      }
    }
    return blocks_.size() - 1;
  }

  void write_call(std::size_t b, std::string& text) {
    const BenchBlock& block = blocks_[b];
    const Graph& graph = block.program.graph;
    const StInterface& pins = block.made.interface;
    const Variables& own = variables_[b];
    std::vector<std::size_t> numbers;
    for (const std::size_t test : block.cases) {
      numbers.push_back(test + 1);
    }
    std::vector<std::string> arguments;
    for (const PortGroup& group : port_groups(graph.inputs)) {
      if (!group.is_array()) {
        arguments.push_back(fmt::format("{} := {}", pins.inputs[group.first], own.inputs[group.first]));
      }
    }
    for (std::size_t p = 0; p < block.changed.size(); ++p) {
      arguments.push_back(fmt::format("{} := {}", pins.parameters[block.changed[p]], own.parameters[p]));
    }
    arguments.push_back(fmt::format("{} := {} = 0", pins.reset, local("TEST_STEP")));
    append(text, fmt::format("      {}:\n        {}({});\n", fmt::join(numbers, ", "), own.instance,
                             fmt::join(arguments, ", ")));
    for (std::size_t i = 0; i < most_outputs_; ++i) {
      const std::string actual = fmt::format("{}[{}]", local("ACTUAL"), i + 1);
      const bool here = i < graph.outputs.size();
      append(text,
             bench_actual(actual, here ? graph.outputs[i].type : Type::Real,
                          here ? fmt::format("{}.{}", own.instance, pins.outputs[i]) : "0.0", here && block.float32));
      append(text, fmt::format("        {}[{}] := {};\n", local("EXACT"), i + 1,
                               here && graph.outputs[i].type != Type::Real ? "TRUE" : "FALSE"));
    }
  }

  // --- the declaration ---

  [[nodiscard]] std::vector<StSection> sections() {
    const std::uint32_t tests = array_length(bench_.cases.size());
    const std::uint32_t slots = array_length(last_slot() + most_outputs_);
    const std::uint32_t outputs = array_length(std::max<std::size_t>(most_outputs_, 1));
    StSection input{
        .keyword = "VAR_INPUT",
        .variables = {
            {.name = "RESTART", .type = "BOOL", .values = {"FALSE"}, .remark = "TRUE: all tests begin anew"}}};
    StSection output{.keyword = "VAR_OUTPUT", .variables = bench_result_variables()};
    std::vector<StVariable> fixed;
    std::vector<StVariable> memory{
        {.name = "FAILURES_OF", .type = "DINT", .length = tests, .remark = "by test: how many values were wrong"},
        {.name = "STEP_OF", .type = "DINT", .length = tests, .remark = "by test: the step of the first of them"},
        {.name = "OUTPUT_OF", .type = "DINT", .length = tests, .remark = "its output"},
        {.name = "EXPECTED_OF", .type = "LREAL", .length = tests, .remark = "what was expected"},
        {.name = "GOT_OF", .type = "LREAL", .length = tests, .remark = "what came"},
        {.name = "STEPS", .type = "DINT", .remark = "of the test"},
        {.name = "ABSOLUTE", .type = "LREAL", .remark = "its tolerance"},
        {.name = "RELATIVE", .type = "LREAL", .remark = "its tolerance, as a share of what is expected"},
        {.name = "CHECKED", .type = "DINT", .length = slots, .remark = "the output that is compared; 0: none"},
        {.name = "WANTED", .type = "LREAL", .length = slots, .remark = "what is expected of it"},
        {.name = "ACTUAL", .type = "LREAL", .length = outputs, .remark = "the outputs, from 1"},
        {.name = "EXACT", .type = "BOOL", .length = outputs, .remark = "which are no real numbers"},
        {.name = "SLOT", .type = "DINT"},
        {.name = "OUTPUT", .type = "DINT"},
        {.name = "ALLOWED", .type = "LREAL"},
        {.name = "WRONG", .type = "BOOL"}};
    for (StVariable& one : values_.take_declared()) {
      (one.values.empty() ? memory : fixed).push_back(std::move(one));
    }
    std::vector<StSection> list{std::move(input), std::move(output)};
    if (!fixed.empty()) {
      // SCL has no constants that are arrays.
      list.push_back({.keyword = dialect_.shape == StDialect::Shape::Source ? "VAR" : "VAR CONSTANT",
                      .remark = "what goes in, and what is expected",
                      .variables = std::move(fixed)});
    }
    list.push_back({.keyword = "VAR", .variables = std::move(memory)});
    return list;
  }

  [[nodiscard]] std::string head(std::string_view name) const {
    std::string text = fmt::format(
        "(* {}: block tests, generated by Hysteron; edit the test file, not this one.\n\n"
        "   Call one instance in every cycle, until DONE is TRUE: each call is a step of a test. The cycle of the task "
        "may\n"
        "   be any. What failed first stands in FAILED_TEST, FAILED_STEP, FAILED_OUTPUT, EXPECTED and GOT; what failed "
        "first\n   in each test in STEP_OF, OUTPUT_OF, EXPECTED_OF and GOT_OF.\n",
        name);
    append(text, "   Dialect: ", dialect_.name, ".\n");
    for (const BenchBlock& block : blocks_) {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < block.program.graph.outputs.size(); ++i) {
        names.push_back(fmt::format("{} {}", i + 1, block.made.interface.outputs[i]));
      }
      append(text, fmt::format("\n   Outputs of {}: {}.\n", block.made.block.name, fmt::join(names, ", ")));
      for (const std::size_t test : block.cases) {
        const StBenchCase& one = bench_.cases[test];
        append(text, fmt::format("   Test {}, {} {}: {}\n", test + 1, one.steps, one.steps == 1 ? "step" : "steps",
                                 st_comment(one.name)));
      }
    }
    return text + "*)\n";
  }

  struct Variables {
    std::string instance;
    std::vector<std::string> inputs;
    std::vector<std::string> parameters;  ///< by changed
  };

  const StBench& bench_;
  const StDialect& dialect_;
  const std::vector<BenchBlock>& blocks_;
  Identifiers names_;
  std::vector<Variables> variables_;  ///< by block
  BenchValues values_;
  std::size_t most_outputs_ = 0;
  std::size_t slots_ = 0;
};

}  // namespace

std::vector<GeneratedFile> generate_st_bench(const StBench& bench, const StDialect& dialect) {
  refuse_values(bench, dialect);
  const std::vector<BenchBlock> blocks = blocks_under_test(bench, dialect);
  const StPou tests = BenchText(bench, dialect, blocks).run();
  const auto file_of = [&](std::string_view name) {
    return identifier_text({name}, LetterCase::Lower) + std::string(dialect.extension);
  };
  std::vector<GeneratedFile> files{{file_of(bench.name), ""}};
  for (const BenchBlock& block : blocks) {
    std::string text = st_text(block.made.block, dialect.shape);
    if (holds_several_blocks(dialect.shape)) {
      append(files.front().text, text, "\n");
    } else {
      files.push_back({file_of(block.made.block.name), std::move(text)});
    }
  }
  files.front().text += st_text(tests, dialect.shape);
  if (dialect.shape == StDialect::Shape::OneFile) {
    Identifiers names(bench_words(dialect), LetterCase::Upper);
    append(files.front().text, "\n", st_program_text(bench_caller(tests, names)));
  }
  return files;
}

}  // namespace hysteron
