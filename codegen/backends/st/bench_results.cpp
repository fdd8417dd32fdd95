#include "codegen/backends/st/bench_results.hpp"

#include <fmt/format.h>

#include <array>

#include "codegen/backends/shared/generated_file.hpp"

namespace hysteron {
namespace {

constexpr std::array bench_result_list{
    BenchResult{"DONE", "BOOL", "all tests have run"},
    BenchResult{"PASSED", "BOOL", "all tests have run, and none failed"},
    BenchResult{"TESTS_FAILED", "DINT", "how many tests have failed"},
    BenchResult{"VALUES_COMPARED", "DINT", "how many values were held against an expected one"},
    BenchResult{"VALUES_FAILED", "DINT", "how many of all tests were wrong"},
    BenchResult{"TEST_NUMBER", "DINT", "the test that has run last, from 1"},
    BenchResult{"TEST_STEP", "DINT", "its step that comes next, from 0"},
    BenchResult{"FAILED_TEST", "DINT", "of the first value that was wrong: the test; 0: none"},
    BenchResult{"FAILED_STEP", "DINT", "its step, from 0"},
    BenchResult{"FAILED_OUTPUT", "DINT", "the output of the block, from 1"},
    BenchResult{"EXPECTED", "LREAL", "what was expected; TRUE is 1"},
    BenchResult{"GOT", "LREAL", "what came"},
    BenchResult{"NOT_FINITE", "BOOL", "nothing was expected in this step, but the value is infinite or no number"},
};

}  // namespace

std::span<const BenchResult> bench_results() {
  return bench_result_list;
}

std::vector<StVariable> bench_result_variables() {
  std::vector<StVariable> list;
  list.reserve(std::size(bench_result_list));
  for (const BenchResult& one : bench_result_list) {
    list.push_back({.name = std::string(one.name), .type = std::string(one.type), .remark = std::string(one.meaning)});
  }
  return list;
}

std::string bench_actual(const std::string& target, Type type, const std::string& from, bool float32) {
  switch (type) {
    case Type::Bool:
      return fmt::format("        {0} := 0.0;\n        IF {1} THEN\n          {0} := 1.0;\n        END_IF;\n", target,
                         from);
    case Type::Int:
      return fmt::format("        {} := DINT_TO_LREAL({});\n", target, from);
    case Type::Word:
      return fmt::format("        {} := UINT_TO_LREAL(WORD_TO_UINT({}));\n", target, from);
    default:
      return float32 ? fmt::format("        {} := REAL_TO_LREAL({});\n", target, from)
                     : fmt::format("        {} := {};\n", target, from);
  }
}

std::string bench_comparison(const BenchComparison& of) {
  constexpr std::string_view form =
      R"(    (* what came, against what is expected; then whether each output is a number *)
    FOR {SLOT} := 1 TO {last} DO
      {WRONG} := FALSE;
      IF {SLOT} <= {slots} THEN
        {OUTPUT} := {CHECKED}[{SLOT}];
        IF {OUTPUT} > 0 THEN
          {VALUES_COMPARED} := {VALUES_COMPARED} + 1;
          {ALLOWED} := 0.0;
          IF NOT {EXACT}[{OUTPUT}] THEN
            {ALLOWED} := {ABSOLUTE} + {RELATIVE} * ABS({WANTED}[{SLOT}]);
          END_IF;
          {WRONG} := NOT (ABS({ACTUAL}[{OUTPUT}] - {WANTED}[{SLOT}]) <= {ALLOWED});
        END_IF;
      ELSE
        {OUTPUT} := {SLOT} - {slots};
        {WRONG} := NOT ({ACTUAL}[{OUTPUT}] - {ACTUAL}[{OUTPUT}] = 0.0);
      END_IF;
      IF {WRONG} THEN
        {VALUES_FAILED} := {VALUES_FAILED} + 1;
        IF {FAILURES_OF}[{TEST_NUMBER}] = 0 THEN
          {TESTS_FAILED} := {TESTS_FAILED} + 1;
          {STEP_OF}[{TEST_NUMBER}] := {TEST_STEP};
          {OUTPUT_OF}[{TEST_NUMBER}] := {OUTPUT};
          {EXPECTED_OF}[{TEST_NUMBER}] := {WANTED}[{SLOT}];
          {GOT_OF}[{TEST_NUMBER}] := {ACTUAL}[{OUTPUT}];
        END_IF;
        {FAILURES_OF}[{TEST_NUMBER}] := {FAILURES_OF}[{TEST_NUMBER}] + 1;
        IF {FAILED_TEST} = 0 THEN
          {FAILED_TEST} := {TEST_NUMBER};
          {FAILED_STEP} := {TEST_STEP};
          {FAILED_OUTPUT} := {OUTPUT};
          {EXPECTED} := {WANTED}[{SLOT}];
          {GOT} := {ACTUAL}[{OUTPUT}];
          {NOT_FINITE} := {SLOT} > {slots};
        END_IF;
      END_IF;
    END_FOR;

)";
  std::string text;
  for (std::size_t at = 0; at < form.size();) {
    const std::size_t open = form.find('{', at);
    text.append(form.substr(at, open - at));
    if (open == std::string_view::npos) {
      break;
    }
    const std::size_t close = form.find('}', open);
    const std::string_view word = form.substr(open + 1, close - open - 1);
    text += word == "slots"  ? std::to_string(of.slots)
            : word == "last" ? std::to_string(of.slots + of.outputs)
                             : std::string(of.prefix).append(word);
    at = close + 1;
  }
  return text;
}

StPou bench_caller(const StPou& tests, Identifiers& names) {
  StPou program{.name = std::string(names.make({tests.name, "program"})),
                .head = fmt::format("(* Runs {} once after a start. *)\n", tests.name)};
  const std::string instance(names.make({tests.name, "1"}));
  StSection section{.keyword = "VAR", .variables = {{.name = instance, .type = tests.name}}};
  program.body = fmt::format("  {}(RESTART := FALSE);\n", instance);
  for (const BenchResult& one : bench_result_list) {
    section.variables.push_back(
        {.name = std::string(one.name), .type = std::string(one.type), .remark = std::string(one.meaning)});
    append(program.body, fmt::format("  {0} := {1}.{0};\n", one.name, instance));
  }
  program.sections.push_back(std::move(section));
  return program;
}

}  // namespace hysteron
