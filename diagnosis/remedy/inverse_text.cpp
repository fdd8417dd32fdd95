#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "codegen/graph/names.hpp"
#include "diagnosis/remedy/inverse_blocks.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

bool is_name(std::string_view text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

}  // namespace

InverseText::InverseText(double sample_time, const Graph& graph) : sample_time_(sample_time) {
  name("FEEDFORWARD");
  for (const Port& port : graph.inputs) {
    name(port.name);
  }
  reference_ = name("REF");
}

std::string InverseText::name(std::string_view wish) {
  std::string base = language::upper(wish);
  std::ranges::replace_if(
      base, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  std::string result = base;
  for (int k = 2; is_reserved(result) || std::ranges::find(taken_, result) != taken_.end(); ++k) {
    result = fmt::format("{}_{}", base, k);
  }
  taken_.push_back(result);
  return result;
}

std::string InverseText::instance(std::string_view wish, std::string_view block, const std::string& settings) {
  std::string result = name(wish);
  locals_.push_back(settings.empty() ? fmt::format("{} : {};", result, block)
                                     : fmt::format("{} : {} := ({});", result, block, settings));
  return result;
}

void InverseText::call(const std::string& instance, const std::string& arguments) {
  statements_.push_back(fmt::format("{}({});", instance, arguments));
}

std::string InverseText::signal(std::string_view wish, const std::string& expression, std::string_view unit) {
  if (is_name(expression)) {
    return expression;
  }
  std::string result = name(wish);
  locals_.push_back(unit.empty() ? fmt::format("{} : LREAL;", result)
                                 : fmt::format("{} : LREAL; (* @unit {} *)", result, unit));
  statements_.push_back(fmt::format("{} := {};", result, expression));
  return result;
}

std::string InverseText::rate(std::string_view wish, const std::string& of, double weight) {
  const std::string first = instance(fmt::format("{}_RATE", wish), "HY_DERIVATIVE");
  call(first, "XIN := " + of);
  if (weight == 0.0) {
    return first + ".XOUT";
  }
  const std::string second = instance(fmt::format("{}_CHANGE", wish), "HY_DERIVATIVE");
  call(second, fmt::format("XIN := {}.XOUT, RUN := {}", first, started(2)));
  const std::string ahead =
      instance(fmt::format("{}_AHEAD", wish), "HY_GAIN", "K := " + real_literal(weight * sample_time_));
  call(ahead, fmt::format("XIN := {}.XOUT", second));
  return signal(fmt::format("{}_RATE_NOW", wish), fmt::format("{}.XOUT + {}.XOUT", first, ahead));
}

std::string InverseText::started(int samples) {
  if (second_.empty()) {
    second_ = instance("SECOND", "HY_DELAY");
    call(second_, "XIN := 1.0");
  }
  if (samples > 1 && third_.empty()) {
    third_ = instance("THIRD", "HY_DELAY");
    call(third_, fmt::format("XIN := {}.XOUT", second_));
  }
  return fmt::format("{}.XOUT > 0.5", samples > 1 ? third_ : second_);
}

void InverseText::input(const std::string& declaration) {
  if (std::ranges::find(inputs_, declaration) == inputs_.end()) {
    inputs_.push_back(declaration);
  }
}

void InverseText::note(std::string text) {
  if (std::ranges::find(notes_, text) == notes_.end()) {
    notes_.push_back(std::move(text));
  }
}

const std::vector<double>& BlockStage::values(std::string_view parameter) const {
  const std::size_t inputs = node.block->inputs.size();
  for (std::size_t i = 0; i < node.block->params.size(); ++i) {
    if (node.block->params[i].name == parameter) {
      const Wire& wire = graph.wire(node, inputs + i);
      if (wire.from == Wire::From::Parameter) {
        return graph.parameters[wire.index].value;
      }
    }
  }
  throw NoInverse(fmt::format("{}.{} is not a constant", node.path, parameter));
}

std::string BlockStage::settings() const {
  std::string result;
  for (const Field& field : node.block->params) {
    const std::vector<double>& value = values(field.name);
    if (value.size() != 1 || value.front() == field.preset) {
      continue;
    }
    result +=
        fmt::format("{}{} := {}", result.empty() ? "" : ", ", field.name, literal_text(field.type, value.front()));
  }
  return result;
}

std::string BlockStage::arguments(const std::string& input) const {
  std::string result;
  for (std::size_t i = 0; i < node.block->inputs.size(); ++i) {
    const std::string text = i == pin ? input : operand(i);
    if (!text.empty()) {
      result += fmt::format("{}{} := {}", result.empty() ? "" : ", ", node.block->inputs[i].name, text);
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
