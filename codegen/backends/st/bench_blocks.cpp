#include "codegen/backends/st/bench_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "codegen/backends/st/words.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

bool same_states(const Graph& a, const Graph& b) {
  return std::ranges::equal(a.initial_states, b.initial_states, [](const InitialState& x, const InitialState& y) {
    return x.node == y.node && x.state == y.state && x.value == y.value;
  });
}

/// An array has its numbers in the declaration: no call hands it over in every dialect.
bool same_arrays(const Graph& a, const Graph& b) {
  return std::ranges::equal(a.parameters, b.parameters, [](const Parameter& x, const Parameter& y) {
    return x.field.length == 1 || x.value == y.value;
  });
}

bool suits(const BenchBlock& block, const StBenchCase& one, const Program* diagram) {
  const Graph& graph = one.program->graph;
  return one.diagram == diagram && one.float32 == block.float32 && same_states(block.program.graph, graph) &&
         same_arrays(block.program.graph, graph) && block.program.graph.sample_time_ns == graph.sample_time_ns;
}

/// The program of a case, with the parameters of the diagram but for arrays.
Program with_defaults(const StBenchCase& one) {
  Program program = *one.program;
  for (std::size_t i = 0; i < program.graph.parameters.size(); ++i) {
    if (program.graph.parameters[i].field.length == 1) {
      program.graph.parameters[i].value = one.diagram->graph.parameters[i].value;
    }
  }
  return program;
}

/// The name of a block, numbered where one before it has the same.
std::string free_name(const std::string& name, std::span<const BenchBlock> before) {
  std::string free = name;
  const auto taken = [&](const BenchBlock& one) { return equal_ignoring_case(one.program.graph.name, free); };
  for (int number = 2; std::ranges::any_of(before, taken); ++number) {
    free = fmt::format("{}_{}", name, number);
  }
  return free;
}

std::vector<std::size_t> changed_parameters(const BenchBlock& block, const StBench& bench) {
  std::vector<std::size_t> changed;
  const auto& defaults = block.program.graph.parameters;
  for (std::size_t i = 0; i < defaults.size(); ++i) {
    if (std::ranges::any_of(block.cases, [&](std::size_t test) {
          return bench.cases[test].program->graph.parameters[i].value != defaults[i].value;
        })) {
      changed.push_back(i);
    }
  }
  return changed;
}

class Refusals {
 public:
  explicit Refusals(const StDialect& dialect) : dialect_(dialect) {}

  /// The first value of a signal that has no literal.
  template <class Values>
  void check(const StBenchCase& one, std::string_view what, const Place& place, const Values& values) {
    for (const double value : values) {
      const double size = std::abs(value);
      if (!std::isfinite(value)) {
        refuse(one, place, fmt::format("{} is {}, and no PLC has a literal for it", what, number_text(value)));
        return;
      }
      if (dialect_.small_literals && size != 0.0 &&
          (size > std::numeric_limits<float>::max() || size < std::numeric_limits<float>::min())) {
        refuse(one, place,
               fmt::format("{} is {}, and the dialect {} has no literal above 3.4E38 or below 1.2E-38", what,
                           number_text(value), dialect_.name));
        return;
      }
    }
  }

  void finish() {
    if (diagnostics_.has_errors()) {
      throw InputError(std::move(diagnostics_));
    }
  }

 private:
  void refuse(const StBenchCase& one, const Place& place, std::string cause) {
    diagnostics_.error(error::no_bench, place, fmt::format("\"{}\": {}.", one.name, cause),
                       "give the case another value, or leave it out of the bench with --filter.");
  }

  const StDialect& dialect_;
  Diagnostics diagnostics_;
};

}  // namespace

std::vector<BenchBlock> blocks_under_test(const StBench& bench, const StDialect& dialect) {
  std::vector<BenchBlock> blocks;
  std::vector<const Program*> diagrams;  // beside blocks
  for (std::size_t i = 0; i < bench.cases.size(); ++i) {
    const StBenchCase& one = bench.cases[i];
    std::size_t b = 0;
    while (b < blocks.size() && !suits(blocks[b], one, diagrams[b])) {
      ++b;
    }
    if (b == blocks.size()) {
      blocks.push_back({.program = with_defaults(one), .float32 = one.float32});
      diagrams.push_back(one.diagram);
    }
    blocks[b].cases.push_back(i);
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    BenchBlock& block = blocks[b];
    block.program.graph.name = free_name(block.program.graph.name, {blocks.data(), b});
    block.changed = changed_parameters(block, bench);
    block.made = make_st_pou(block.program, {.dialect = dialect, .float32 = block.float32});
  }
  return blocks;
}

void refuse_values(const StBench& bench, const StDialect& dialect) {
  Refusals refusals(dialect);
  for (const StBenchCase& one : bench.cases) {
    const Graph& graph = one.program->graph;
    for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
      refusals.check(one, fmt::format("the input {}", graph.inputs[i].name), one.place, one.inputs[i]);
    }
    for (const StExpectation& expected : one.expected) {
      std::vector<double> values;
      for (const auto& [step, value] : expected.values) {
        values.push_back(value);
      }
      refusals.check(one, fmt::format("what is expected of {}", graph.outputs[expected.output].name), expected.place,
                     values);
    }
    refusals.check(one, "a tolerance", one.place, std::vector{one.absolute, one.relative});
  }
  refusals.finish();
}

bool (*bench_words(const StDialect& dialect))(std::string_view) {
  return dialect.shape == StDialect::Shape::Source ? is_scl_word : is_st_word;
}

}  // namespace hysteron
