// Calls: of instances, and of one's own functions. Both are executed in place.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/body/standard_blocks.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::upper;

namespace {
constexpr int most_calls_in_calls = 40;

/// CODESYS and TwinCAT call some pins of the standard's blocks by longer names.
std::string standard_pin(const Place& place, const std::string& name) {
  if (place.type == nullptr || place.type->source.library != &standard_blocks() || place.find(name) != nullptr) {
    return name;
  }
  using Row = std::pair<std::string_view, std::string_view>;
  for (const auto& [longer, pin] :
       {Row{"RESET", "R"}, Row{"LOAD", "LD"}, Row{"SET", "S"}, Row{"SET1", "S1"}, Row{"RESET1", "R1"}}) {
    if (longer == name && place.find(std::string(pin)) != nullptr) {
      return std::string(pin);
    }
  }
  return name;
}

}  // namespace

void Body::invoke(const syntax::Invoke& node, language::Span span) {
  if (node.instance.steps.empty() && scope_->find(upper(node.instance.name.text)) == nullptr) {
    // A FUNCTION as a statement: its outputs count.
    if (const Source source = types_.find_unit(node.instance.name.text, true); source.unit != nullptr) {
      call_unit(source, {.function = node.instance.name, .arguments = node.arguments}, span);
      return;
    }
  }
  if (const auto list = choices(node.instance); !list.empty()) {
    invoke_one_of(list, 0, node);
  }
}

/// Of an array of instances, the one that the index means.
void Body::invoke_one_of(const std::vector<Choice>& list, std::size_t at, const syntax::Invoke& node) {
  if (at + 1 == list.size()) {
    invoke(*list[at].place, node);
    return;
  }
  choose(
      *list[at].condition, [&] { invoke(*list[at].place, node); }, [&] { invoke_one_of(list, at + 1, node); });
}

void Body::invoke(Place& place, const syntax::Invoke& node) {
  if (place.type != nullptr && place.type->kind == BodyType::Kind::Block) {
    invoke_unit(place, node);
  } else if (place.type != nullptr && place.type->kind == BodyType::Kind::Library) {
    hand_over(place, node.arguments);
    if (runs_by_clock(place)) {
      invoke_by_clock(place, node.instance.span);
    } else {
      invoke_library(place, node.instance.span);
    }
    hand_back(place, node.arguments);
  } else {
    refuse(error::type_mismatch, node.instance.span,
           fmt::format("'{}' is not an instance and cannot be called", node.instance.name.text),
           "Call an instance of a block.");
  }
}

void Body::hand_over(Place& place, const std::vector<syntax::Argument>& arguments) {
  for (const syntax::Argument& one : arguments) {
    if (one.output) {
      continue;
    }
    const std::string name = standard_pin(place, upper(one.formal.text));
    Place* const pin = place.find(name);
    const auto span = expression(one.value).span;
    if (pin == nullptr) {
      refuse(error::unknown_pin, one.formal.text.empty() ? span : one.formal.span,
             one.formal.text.empty()
                 ? fmt::format("this argument does not say which input of '{}' it is for", place.path)
                 : fmt::format("'{}' has no input '{}'", place.path, one.formal.text),
             (one.formal.text.empty() ? "Write NAME := before it. " : "") + one_of_members(place, one.formal.text));
      continue;
    }
    const auto member = std::ranges::find(place.members, name, &Member::name);
    if (member->role == syntax::Role::InOut) {
      continue;
    }
    if (pin->leaf == Place::no_leaf) {
      if (Place* const from = whole(one.value)) {
        copy(*pin, *from, span);
      }
      continue;
    }
    const Value given = value(one.value);
    computer_.at(path_for(leaves_[pin->leaf].path), place_of(span));
    write(pin->leaf, taken_by(*pin, given, std::string(one.formal.text)));
  }
}

void Body::hand_back(Place& place, const std::vector<syntax::Argument>& arguments) {
  for (const syntax::Argument& one : arguments) {
    if (!one.output) {
      continue;
    }
    Place* const pin = place.find(upper(one.formal.text));
    const auto* target = std::get_if<syntax::Access>(&expression(one.value).node);
    if (pin == nullptr) {
      refuse(error::unknown_pin, one.formal.span, fmt::format("'{}' has no output '{}'", place.path, one.formal.text),
             one_of_members(place, one.formal.text));
      continue;
    }
    if (target == nullptr) {
      refuse(error::unknown_pin, one.formal.span, fmt::format("'{}' is handed to what is no variable", one.formal.text),
             fmt::format("Write {} => and a variable of its type.", one.formal.text));
      continue;
    }
    if (pin->leaf == Place::no_leaf) {
      assign_whole(*target, *pin, one.formal.span);
      continue;
    }
    assign(*target, read(pin->leaf), one.formal.span);
  }
}

/// The variables of a call that belong to the caller: their names stand for the caller's places while it runs.
void Body::invoke_unit(Place& place, const syntax::Invoke& node) {
  hand_over(place, node.arguments);
  std::vector<Lent> lent;
  for (std::size_t i = 0; i < place.members.size(); ++i) {
    if (place.members[i].role != syntax::Role::InOut) {
      continue;
    }
    const auto argument = std::ranges::find_if(
        node.arguments, [&](const syntax::Argument& one) { return upper(one.formal.text) == place.members[i].name; });
    const auto* access =
        argument == node.arguments.end() ? nullptr : std::get_if<syntax::Access>(&expression(argument->value).node);
    if (access == nullptr) {
      refuse(error::unconnected_input, node.instance.span,
             fmt::format("the VAR_IN_OUT {} needs a variable", place.members[i].written.text),
             fmt::format("Write {} := a variable.", place.members[i].written.text));
      return;
    }
    Place* const found = lend(*access, lent);
    if (found == nullptr) {
      return;
    }
    if (found->leaf != Place::no_leaf && place.parts[i]->leaf != Place::no_leaf &&
        leaves_[found->leaf].type != leaves_[place.parts[i]->leaf].type) {
      refuse(error::type_mismatch, access->span,
             fmt::format("the VAR_IN_OUT {} is of another type than its variable", place.members[i].written.text),
             "Hand over a variable of the same type.");
      return;
    }
    place.aliases[i] = found;
  }
  const auto span = node.instance.span;
  const bool standard = place.type->source.library == &standard_blocks();
  const auto outer_call = standard_call_;
  if (standard) {
    standard_call_ = place_of(span);
  }
  for (std::size_t i = 0; i < place.members.size(); ++i) {
    if (place.members[i].role == syntax::Role::Temporary) {
      restart(*place.parts[i]);
    }
  }
  enter(place, place.type->source);
  standard_call_ = outer_call;
  std::ranges::fill(place.aliases, nullptr);
  take_back(lent, node.instance.span);
  hand_back(place, node.arguments);
}

void Body::enter(Place& place, const Source& source) {
  if (level_ >= most_calls_in_calls) {
    refuse(error::recursive_block, source.unit->name.span, fmt::format("'{}' calls itself", source.unit->name.text),
           "A block or a function cannot be a part of itself.");
    return;
  }
  ++level_;
  Place* const outer_scope = std::exchange(scope_, &place);
  const Source outer_source = std::exchange(source_, source);
  const Value none = computer_.truth(false);
  const Value returned = std::exchange(state_.returned, none);
  const Value exited = std::exchange(state_.exited, none);
  const Value continued = std::exchange(state_.continued, none);
  execute(source.unit->statements);
  state_.returned = returned;
  state_.exited = exited;
  state_.continued = continued;
  source_ = outer_source;
  scope_ = outer_scope;
  --level_;
}

void Body::invoke_library(Place& place, language::Span span) {
  const BlockType& type = *place.type->block;
  if (conditions_ > 0) {
    refuse(error::conditional_call, span, fmt::format("'{}' is called under a condition", place.path),
           fmt::format("{} moves its memory on in every step: call it in front of the IF, CASE or RETURN, with the "
                       "condition in its inputs.",
                       type.about.name));
    return;
  }
  if (place.called) {
    refuse(error::double_drive, span, fmt::format("'{}' is called twice in a step", place.path),
           "Declare a second instance for the second call.");
    return;
  }
  place.called = true;
  auto& graph = around_.builder.graph();
  const std::uint32_t node = around_.builder.block(type, around_.path + place.path, around_.rate, place_of(span));
  const auto first = graph.nodes[node].first_wire;
  for (std::size_t pin = 0; pin < type.pin_count(); ++pin) {
    const Field& field = type.pin(pin);
    const std::uint32_t leaf = place.parts[pin]->leaf;
    const bool parameter = pin >= type.inputs.size();
    Wire wire;
    double known = 0.0;
    if (state_.values[leaf] && !(parameter && computer_.constant(*state_.values[leaf], known))) {
      wire = computer_.given(*state_.values[leaf]);
    } else if (parameter) {
      std::vector<double> numbers(field.length, field.preset);
      numbers[0] = state_.values[leaf] ? known : field.preset;
      wire = around_.add_parameter({.path = upper(around_.path + place.path) + "." + upper(field.name),
                                    .field = field,
                                    .value = std::move(numbers),
                                    .span = place_of(span)});
    } else {
      if (field.required) {
        refuse(error::unconnected_input, span, fmt::format("{}.{} is not connected", place.path, field.name),
               fmt::format("Connect it: {}({} := …).", place.path, field.name));
      }
      wire = around_.builder.literal(field.type, field.preset);
      open_pins_.emplace_back(leaf, span);
    }
    graph.wires[first + pin] = wire;
  }
  for (std::size_t i = 0; i < type.outputs.size(); ++i) {
    const std::uint32_t leaf = place.parts[type.pin_count() + i]->leaf;
    computer_.at(path_for(leaves_[leaf].path), place_of(span));
    const Wire wire{Wire::From::Node, type.outputs[i].type, static_cast<std::uint16_t>(i), node};
    const Plain plain = leaves_[leaf].type;
    write(leaf, is_integer(plain) || plain == Plain::Time ? computer_.taken(wire, plain)
                                                          : Value{.wire = wire, .type = plain});
  }
}

Body::Result Body::call_unit(const Source& source, const syntax::Call& call, language::Span span) {
  const std::size_t leaves = leaves_.size();
  const std::size_t wholes = wholes_.size();
  const TypeRef result_type = types_.resolve(source.unit->result);
  if (!result_type) {
    return {};
  }
  const Source outer = source_;
  std::vector<Member> members = types_.members(source.unit->declarations);
  const std::string name = upper(source.unit->name.text);
  members.push_back({.name = name, .type = result_type, .written = source.unit->name});
  // Arguments are computed before the variables of the call are made: they may hold calls of the same function.
  std::vector<Value> given(call.arguments.size());
  std::vector<Place*> handed(call.arguments.size(), nullptr);
  std::vector<Lent> lent;
  std::vector<std::size_t> targets(call.arguments.size(), members.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const syntax::Argument& one = call.arguments[i];
    if (one.formal.text.empty()) {
      while (next < members.size() && members[next].role != syntax::Role::Input &&
             members[next].role != syntax::Role::InOut) {
        ++next;
      }
      targets[i] = next++;
    } else {
      targets[i] =
          static_cast<std::size_t>(std::ranges::find(members, upper(one.formal.text), &Member::name) - members.begin());
    }
    if (targets[i] >= members.size() || level_ >= most_calls_in_calls) {
      refuse(targets[i] >= members.size() ? error::unknown_function : error::recursive_block, span,
             targets[i] >= members.size() ? fmt::format("{} does not take these arguments", name)
                                          : fmt::format("'{}' calls itself", name),
             targets[i] >= members.size() ? "Give its inputs in their order, or by name."
                                          : "A function cannot be a part of itself.");
      return {};
    }
    const bool plain = members[targets[i]].type->kind == BodyType::Kind::Plain;
    if (!one.output && plain && members[targets[i]].role != syntax::Role::InOut) {
      given[i] = value(one.value);
      if (!given[i].valid()) {
        return {};
      }
    } else if (!one.output && members[targets[i]].role != syntax::Role::InOut) {
      handed[i] = whole(one.value);
      if (handed[i] == nullptr) {
        return {};
      }
    } else if (!one.output) {
      const auto* access = std::get_if<syntax::Access>(&expression(one.value).node);
      handed[i] = access != nullptr ? lend(*access, lent) : nullptr;
      if (handed[i] == nullptr) {
        return {};
      }
    }
  }
  Place frame;
  frame.path = name;
  source_ = source;
  make_members(frame, members, false);
  source_ = outer;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    Place& target = *frame.parts[targets[i]];
    if (handed[i] != nullptr && members[targets[i]].role == syntax::Role::InOut) {
      frame.aliases[targets[i]] = handed[i];
    } else if (handed[i] != nullptr) {
      copy(target, *handed[i], span);
    } else if (given[i].valid()) {
      computer_.at(place_of(span));
      write(target.leaf, taken_by(target, given[i], std::string(members[targets[i]].written.text)));
    }
  }
  enter(frame, source);
  take_back(lent, span);
  const Place& given_back = *frame.parts.back();
  const std::vector<Value> result = values_of(given_back);
  hand_back(frame, call.arguments);
  forget(leaves, wholes);
  if (given_back.leaf == Place::no_leaf) {
    return {.whole = keep(result_type, name, result, span)};
  }
  return {.value = result.front()};
}

}  // namespace hysteron::bodies
