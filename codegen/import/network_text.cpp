#include "codegen/import/network_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_map>

#include "codegen/graph/names.hpp"
#include "codegen/graph/other_names.hpp"
#include "codegen/graph/text_order.hpp"
#include "codegen/import/expression.hpp"
#include "codegen/import/function_text.hpp"
#include "codegen/import/network_check.hpp"
#include "codegen/import/network_variables.hpp"
#include "codegen/import/types.hpp"
#include "codegen/plcopen/functions.hpp"
#include "codegen/plcopen/tc6.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::import {
namespace {

/// Chains of elements that feed each other; each takes some of the stack.
constexpr std::size_t deepest_chain = 1000;

/// A longer expression gets a variable.
constexpr std::size_t longest_expression = 300;

using plcopen::OperatorFunction;

class Reader {
 public:
  Reader(const std::string& file, const DrawnPou& pou, const OwnBlocks& own, const Targets& targets)
      : file_(file), pou_(pou), own_(own), targets_(targets), variables_(pou, made_) {
    for (std::size_t i = 0; i < pou.elements.size(); ++i) {
      const DrawnElement& element = pou.elements[i];
      by_id_.emplace(element.id, i);
      if (element.kind == tc6::connector) {
        connectors_.emplace(in_capitals(element.text), i);
      }
      for (const DrawnPin& pin : element.inputs) {
        for (const Link& link : pin.links) {
          ++readers_[link.element];
        }
      }
    }
    states_.resize(pou.elements.size());
  }

  NetworkText run() {
    refuse_what_is_no_network();
    for (const std::size_t i : order_of_execution(pou_)) {
      run_element(i);
    }
    variables_.finish();
    if (refused_.has_errors()) {
      throw InputError(std::move(refused_));
    }
    made_.called.assign(called_.begin(), called_.end());
    return std::move(made_);
  }

 private:
  struct State {
    bool begun = false;
    bool done = false;
    Value value{};           ///< of a function, once done
    std::string variable{};  ///< that holds it
  };
  void refuse(const DrawnElement& element, std::string_view why, std::string mend) {
    if (!told_.insert(&element).second) {
      return;
    }
    const std::string name =
        element.instance.empty() ? element.text : fmt::format("{} {}", element.text, element.instance);
    refused_.error(error::untranslatable_element, {.file = file_, .line = element.line, .column = 1},
                   fmt::format("{}{}{} (localId {}) of {}: {}", element.kind, name.empty() ? "" : " ", name, element.id,
                               pou_.name, why),
                   std::move(mend));
  }

  void refuse_what_is_no_network() {
    const Assigners assigners = assigners_in(pou_, targets_);
    for (const Objection& one : objections_to(pou_, own_, assigners)) {
      refuse(*one.element, one.why, one.mend);
    }
    variables_.expect(assigners);
  }

  // --- elements ---

  void run_element(std::size_t index) {
    const DrawnElement& element = pou_.elements[index];
    State& state = states_[index];
    if (state.begun) {
      return;
    }
    state.begun = true;
    if (element.kind != tc6::block) {
      run_assignment(element);
    } else if (element.instance.empty()) {
      run_function(element, state);
    } else {
      run_call(element);
    }
    state.done = true;
  }

  void run_assignment(const DrawnElement& element) {
    const std::string key = target_key(element.text);
    if (variables_.find(key.substr(0, key.find('['))) == nullptr) {
      return refuse(element, "it assigns what the POU does not declare",
                    "Declare it as an output or a local variable.");
    }
    Value value = element.inputs.empty() ? Value{} : input_value(element, element.inputs.front());
    if (value.text.empty()) {
      return refuse(element, "nothing is connected to it", "Connect it, or take it out.");
    }
    variables_.assign(key, element.negated ? negation(element, value) : value.text, element.order, refusing(element));
  }

  Refuse refusing(const DrawnElement& element) {
    return [this, &element](const std::string& why, std::string mend) { refuse(element, why, std::move(mend)); };
  }

  void run_function(const DrawnElement& element, State& state) {
    const OperatorFunction* const own = plcopen::operator_of(element.text);
    const std::string name = own != nullptr ? std::string(own->name) : known_function(element.text);
    if (name.empty()) {
      return refuse_unknown(element);
    }
    std::vector<Value> arguments;
    for (std::size_t i = 0; i < element.inputs.size(); ++i) {
      const DrawnPin& pin = element.inputs[i];
      if (is_enable(element, pin)) {
        continue;
      }
      const auto place = place_of_input(name, pin.name, arguments.size());
      if (!place) {
        return refuse(element, fmt::format("{} has no input {}", name, pin.name),
                      fmt::format("Name it as the standard does: {}.", plcopen::input_of(name, i)));
      }
      const Value value = input_value(element, pin);
      if (value.text.empty()) {
        return refuse(element, fmt::format("its input {} is not connected", plcopen::input_of(name, *place)),
                      "Connect it, or take the pin out.");
      }
      arguments.resize(std::max(arguments.size(), *place + 1));
      if (!arguments[*place].text.empty()) {
        return refuse(element, fmt::format("its input {} is there twice", plcopen::input_of(name, *place)),
                      "Name each of its inputs once.");
      }
      arguments[*place] = value;
    }
    const auto open = std::ranges::find_if(arguments, [](const Value& one) { return one.text.empty(); });
    if (arguments.empty() || open != arguments.end()) {
      const auto place = static_cast<std::size_t>(open - arguments.begin());
      return refuse(element, fmt::format("it has no input {}", plcopen::input_of(name, place)),
                    "Draw all inputs of the function.");
    }
    if (const std::string wrong = wrong_count(own, name, arguments.size()); !wrong.empty()) {
      return refuse(element, wrong, "Draw it with the inputs that the standard gives it.");
    }
    state.value = name == "MOVE" ? arguments.front() : applied(own, name, arguments);
    const bool turned = std::ranges::any_of(
        element.outputs, [](const DrawnPin& one) { return one.negated && !equal_ignoring_case(one.name, "ENO"); });
    state.value.text = turned ? negation(element, state.value) : state.value.text;
    const bool shared = readers_[element.id] > 1 || state.value.text.size() > longest_expression;
    if ((shared || !state.variable.empty()) && state.value.type) {
      const std::string variable =
          state.variable.empty() ? variables_.new_name(fmt::format("{}_{}", name, element.id)) : state.variable;
      variables_.declare(variable, *state.value.type);
      made_.statements += fmt::format("  {} := {};\n", variable, state.value.text);
      state.value.text = variable;
    }
  }

  void refuse_unknown(const DrawnElement& element) {
    const std::string_view other = block_of_other_name(element.text);
    refuse(element, fmt::format("the library has no {}", element.text),
           other.empty() ? "Draw it with blocks of the library, or bring its POU along in the export."
                         : fmt::format("Draw it with {}, which does its job.", other));
  }

  /// EN that is always TRUE means nothing.
  bool is_enable(const DrawnElement& element, const DrawnPin& pin) {
    if (!equal_ignoring_case(pin.name, "EN")) {
      return false;
    }
    const Value value = input_value(element, pin);
    if (!value.text.empty() && !equal_ignoring_case(value.text, "TRUE")) {
      refuse(element, "EN decides whether it runs", "Choose between its result and the old value by SEL.");
    }
    return true;
  }

  void run_call(const DrawnElement& element) {
    const DrawnVariable* const declared = variables_.find(element.instance);
    const auto own = own_.find(in_capitals(element.text));
    const BlockType* const block = own == own_.end() ? known_block(element.text) : nullptr;
    if (own == own_.end() && block == nullptr) {
      return refuse_unknown(element);
    }
    if (declared == nullptr) {
      return refuse(element, "the instance is not declared", "Declare it in the POU.");
    }
    std::string arguments;
    std::set<std::string> wired;
    for (const DrawnPin& pin : element.inputs) {
      if (is_enable(element, pin)) {
        continue;
      }
      if (!has_input(own == own_.end() ? nullptr : own->second, block, pin.name)) {
        if (!pin.links.empty() || !pin.expression.empty()) {
          refuse(element,
                 fmt::format("{} has no input {}", block != nullptr ? block->about.name : element.text, pin.name),
                 "See the inputs by: hysteron blocks NAME.");
        }
        continue;
      }
      const Value value = input_value(element, pin);
      if (!value.text.empty()) {
        wired.insert(in_capitals(pin.name));
        arguments += fmt::format("{}{} := {}", arguments.empty() ? "" : ", ", pin.name, value.text);
      }
    }
    for (const DrawnPin& pin : element.both) {
      arguments += fmt::format("{}{} := {}", arguments.empty() ? "" : ", ", pin.name, input_value(element, pin).text);
    }
    for (std::size_t i = 0; block != nullptr && i < block->inputs.size(); ++i) {
      const Field& field = block->inputs[i];
      if (field.required && !wired.contains(in_capitals(field.name))) {  // as in every IEC compiler
        arguments +=
            fmt::format("{}{} := {}", arguments.empty() ? "" : ", ", field.name, literal_text(field.type, 0.0));
      }
    }
    called_.insert(in_capitals(element.instance));
    made_.statements += fmt::format("  {}({});\n", declared->name, arguments);
    for (const DrawnPin& pin : element.both) {  // what it hands back
      const std::string variable = handed_over(pou_, pin);
      if (!variable.empty() && hands_back(element, pin.name, targets_)) {
        variables_.assign(variable, pin_value(element, element.instance, pin.name).text, element.order,
                          refusing(element));
      }
    }
  }

  // --- values ---

  /// What reaches a pin; empty where nothing does. Several wires are an OR, as in a ladder.
  Value input_value(const DrawnElement& element, const DrawnPin& pin) {
    if (pin.edge) {
      refuse(element, fmt::format("its input {} takes an edge", pin.name), "Put an R_TRIG or F_TRIG before it.");
    }
    Value result;
    if (!pin.expression.empty()) {
      result = expression_value(element, pin.expression);
    }
    for (const Link& link : pin.links) {
      const Value one = link_value(element, link);
      if (!result.text.empty() && !(may_be_bool(result) && may_be_bool(one))) {
        refuse(element,
               fmt::format("{} wires lead to {}, and only BOOLs are joined, by an OR", pin.links.size(),
                           pin.name.empty() ? "it" : "its input " + pin.name),
               "Connect one of them.");
      }
      result = result.text.empty() ? one : Value{fmt::format("({} OR {})", result.text, one.text), Type::Bool};
    }
    if (pin.negated && !result.text.empty()) {
      result.text = negation(element, result);
    }
    return result;
  }

  std::string negation(const DrawnElement& element, const Value& value) {
    if (value.type && (value.type->type == Type::Real || value.type->type == Type::Int)) {
      refuse(element, fmt::format("it negates {}, which is a number", value.text), "Negate a BOOL, or multiply by -1.");
    }
    return negated(value.text);
  }

  static bool may_be_bool(const Value& value) { return !value.type || value.type->type == Type::Bool; }

  Value link_value(const DrawnElement& reader, const Link& link) {
    const auto found = by_id_.find(link.element);
    if (found == by_id_.end()) {
      refuse(reader, fmt::format("it is connected to localId {}, which is not there", link.element),
             "Export the POU again.");
      return {"FALSE", std::nullopt};
    }
    if (++depth_ > deepest_chain) {
      --depth_;
      refuse(reader, "too many elements feed each other in a row", "Assign what is between them to a variable.");
      return {"FALSE", std::nullopt};
    }
    Value value = element_value(found->second, link, reader);
    --depth_;
    if (value.text.empty()) {
      refuse(pou_.elements[found->second], "nothing is connected to it", "Connect it, or take it out.");
      return {"FALSE", std::nullopt};
    }
    return value;
  }

  Value element_value(std::size_t index, const Link& link, const DrawnElement& reader) {
    const DrawnElement& element = pou_.elements[index];
    if (element.kind == tc6::in_variable || element.kind == tc6::in_out_variable) {
      Value value = expression_value(element, element.text);
      value.text = element.negated ? negation(element, value) : value.text;
      return value;
    }
    if (element.kind == tc6::left_rail) {
      return {"TRUE", Type::Bool};
    }
    if (element.kind == tc6::contact) {
      return contact_value(element);
    }
    if (element.kind == tc6::coil) {
      return element.inputs.empty() ? Value{} : input_value(element, element.inputs.front());
    }
    if (element.kind == tc6::continuation || element.kind == tc6::connector) {
      const auto from = connectors_.find(in_capitals(element.text));
      if (from == connectors_.end() || pou_.elements[from->second].inputs.empty()) {
        refuse(element, "no connector of this name feeds it", "Draw the connector, or connect it directly.");
        return {"FALSE", std::nullopt};
      }
      return input_value(pou_.elements[from->second], pou_.elements[from->second].inputs.front());
    }
    if (element.kind == tc6::block) {
      if (!reader.order || reader.kind != tc6::block || element.order == reader.order) {
        run_element(index);  // what feeds a variable, or a block without an order of its own, runs before it
      }
      return element.instance.empty() ? function_value(index, link.pin) : output_value(element, link.pin);
    }
    refuse(reader, fmt::format("it is connected to a {}", element.kind), "Connect it to a block or a variable.");
    return {"FALSE", std::nullopt};
  }

  Value contact_value(const DrawnElement& element) {
    Value own = expression_value(element, element.text);
    own.text = element.negated ? negated(own.text) : own.text;
    const Value before = element.inputs.empty() ? Value{} : input_value(element, element.inputs.front());
    if (before.text.empty()) {
      return {};
    }
    if (!may_be_bool(own) || !may_be_bool(before)) {
      refuse(element, "it takes a BOOL", "Compare the value first, by GT or NE.");
    }
    return before.text == "TRUE" ? own : Value{fmt::format("({} AND {})", before.text, own.text), Type::Bool};
  }

  /// Read before it is worked out, a function's result is the last cycle's.
  Value function_value(std::size_t index, const std::string& pin) {
    State& state = states_[index];
    const DrawnElement& element = pou_.elements[index];
    const bool has_pin =
        pin.empty() || element.outputs.empty() ||
        std::ranges::any_of(element.outputs, [&](const DrawnPin& one) { return equal_ignoring_case(one.name, pin); });
    if (!has_pin || equal_ignoring_case(pin, "ENO")) {
      refuse(element, has_pin ? "its ENO is read" : fmt::format("a wire leaves its output {}, which it has not", pin),
             "Connect the wire to its result.");
      return {"FALSE", std::nullopt};
    }
    if (state.done) {
      return state.value;
    }
    const std::optional<Carried> type = result_type(pou_, variables_.all(), element);
    if (!type) {
      refuse(element, "it is in a loop, and its type cannot be told", "Put a variable into the loop.");
      return {"FALSE", std::nullopt};
    }
    if (state.variable.empty()) {
      state.variable = variables_.new_name(fmt::format("{}_{}", in_capitals(element.text), element.id));
    }
    return variables_.delayed(state.variable, *type);
  }

  Value output_value(const DrawnElement& element, const std::string& pin) {
    const auto drawn =
        std::ranges::find_if(element.outputs, [&](const DrawnPin& one) { return equal_ignoring_case(one.name, pin); });
    const std::string& name = !pin.empty() ? pin : !element.outputs.empty() ? element.outputs.front().name : pin;
    Value value = pin_value(element, element.instance, name);
    if (drawn != element.outputs.end() && drawn->negated) {
      value.text = negation(element, value);
    }
    return value;
  }

  /// INSTANCE.PIN, as a wire or a text names it.
  Value pin_value(const DrawnElement& reader, const std::string& instance, const std::string& pin) {
    const DrawnVariable* const declared = variables_.find(instance);
    if (declared == nullptr) {
      refuse(reader, fmt::format("{} is not declared", instance), "Declare it in the POU.");
      return {"FALSE", std::nullopt};
    }
    const std::string text = fmt::format("{}.{}", declared->name, pin);
    const bool called = called_.contains(in_capitals(instance));
    if (const auto own = own_.find(in_capitals(declared->type)); own != own_.end()) {
      for (const DrawnVariable& one : own->second->variables) {
        using Section = DrawnVariable::Section;
        if ((one.section == Section::Output || one.section == Section::Both) && equal_ignoring_case(one.name, pin)) {
          const auto type = known_type(one.type);
          const std::string output = fmt::format("{}.{}", declared->name, name_of_output(one));
          return called || !type ? Value{output, type ? std::optional(type->carried) : std::nullopt}
                                 : variables_.delayed(output, type->carried);
        }
      }
    } else if (const BlockType* const block = known_block(declared->type)) {
      for (std::size_t i = 0; i < block->outputs.size(); ++i) {
        if (equal_ignoring_case(block->outputs[i].name, pin)) {
          return block_output(reader, {block, i, in_capitals(instance), find_block_type(declared->type) != nullptr},
                              {text, block->outputs[i].type}, called);
        }
      }
    }
    refuse(reader, fmt::format("{} has no output {}", instance, pin), "See its outputs by: hysteron blocks NAME.");
    return {"FALSE", std::nullopt};
  }

  /// What hands out memory alone is read before its call: behind it, the block has moved on.
  struct BlockOutput {
    const BlockType* block = nullptr;
    std::size_t output = 0;
    std::string instance{};   ///< in capitals
    bool of_library = false;  ///< called HY_…
  };

  Value block_output(const DrawnElement& reader, const BlockOutput& from, Value value, bool called) {
    const PinSet& pins = from.block->trace.feedthrough[from.output];
    bool direct = !has_memory(from.block->trace, from.output);
    for (std::size_t i = 0; i < from.block->pin_count(); ++i) {
      direct = direct || (pins.contains(i) && is_driven(pou_, from.instance, from.block->pin(i).name));
    }
    const bool remembers = !direct && from.of_library;  // a block of the standard has its value behind its call
    if (called && remembers) {
      refuse(reader, fmt::format("it reads {} behind its call, where a PLC has the next cycle's value", value.text),
             "Let it run before the block: give it the lower executionOrderId.");
    }
    return called || remembers ? value : variables_.delayed(value.text, *value.type);
  }

  Value expression_value(const DrawnElement& element, const std::string& text) {
    const auto read = [&](const NameRead& name) {
      return name.pin.empty() ? variables_.read(name, refusing(element)) : pin_value(element, name.name, name.pin).text;
    };
    const auto rewritten = rewrite_expression(with_known_literals(text), read);
    if (!rewritten) {
      refuse(element, fmt::format("\"{}\" is no expression of a diagram", text.substr(0, longest_expression)),
             "Write it with operators and functions that docs/reference/language.md lists.");
      return {"FALSE", std::nullopt};
    }
    const auto dot = text.find('.');
    std::optional<Carried> type = type_of_text(variables_.all(), text);
    if (const DrawnVariable* const instance = variables_.find(text.substr(0, dot));
        !type && dot != std::string::npos && instance != nullptr) {
      const auto of_pin = output_type(instance->type, text.substr(dot + 1));
      type = of_pin ? std::optional<Carried>(*of_pin) : std::nullopt;
    }
    return {*rewritten, type};
  }

  const std::string& file_;
  const DrawnPou& pou_;
  const OwnBlocks& own_;
  const Targets& targets_;
  std::unordered_map<std::uint64_t, std::size_t> by_id_;
  std::map<std::string, std::size_t> connectors_;
  std::unordered_map<std::uint64_t, std::size_t> readers_;  ///< by localId: how many wires leave it
  std::vector<State> states_;                               ///< by element
  std::set<std::string> called_;
  std::set<const DrawnElement*> told_;
  std::size_t depth_ = 0;
  Diagnostics refused_;
  NetworkText made_;
  NetworkVariables variables_;
};

}  // namespace

NetworkText text_of_network(const std::string& file, const DrawnPou& pou, const OwnBlocks& own,
                            const Targets& targets) {
  return Reader(file, pou, own, targets).run();
}

}  // namespace hysteron::import
