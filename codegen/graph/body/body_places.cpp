// Where values are kept, and what an access means.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "codegen/graph/body/body.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::Operator;
using language::upper;

std::string one_of_members(const Place& place, std::string_view wanted) {
  std::vector<std::string> names;
  for (const bool all : {false, true}) {  // of a structure every member, of a block what is not its own
    for (const Member& one : place.members) {
      if (all || one.role <= syntax::Role::InOut) {
        names.push_back(one.name);
      }
    }
    if (!names.empty()) {
      break;
    }
  }
  if (names.empty()) {
    return fmt::format("'{}' has no members: write it alone.", place.path);
  }
  const std::string_view near = meant_member(wanted, names);
  return near.empty() ? fmt::format("There are {}.", fmt::join(names, ", ")) : fmt::format("Did you mean {}?", near);
}

namespace {

constexpr std::size_t most_leaves = 20'000;
constexpr std::size_t most_choices = 4096;

Plain plain_of_pin(Type type, bool timer) {
  switch (type) {
    case Type::Bool:
      return Plain::Bool;
    case Type::Int:
      return Plain::Dint;
    case Type::Word:
      return Plain::Word;
    default:
      return timer ? Plain::Time : Plain::Lreal;
  }
}

}  // namespace

std::uint32_t Body::make_leaf(Plain type, double initial, const std::string& path, language::Span span, bool memory) {
  if (leaves_.size() == most_leaves) {
    refuse(error::refused_in_body, span, fmt::format("this body has more than {} variables", most_leaves),
           "Every element of an array is one: use fewer.");
  }
  leaves_.push_back({.type = type, .initial = initial, .path = path, .span = span, .memory = memory});
  state_.values.emplace_back();
  if (!memory) {
    state_.values.back() = computer_.literal(type, initial);
  }
  return static_cast<std::uint32_t>(leaves_.size() - 1);
}

void Body::make_pins(Place& place, const std::string& path, language::Span span) {
  const auto add = [&](const Field& field) {
    auto part = std::make_unique<Place>();
    part->path = path + "." + upper(field.name);
    const Plain plain = plain_of_pin(field.type, place.type->by_clock != nullptr);
    part->leaf = make_leaf(plain, plain == Plain::Time ? field.preset * 1000.0 : field.preset, part->path, span, true);
    place.parts.push_back(std::move(part));
    place.members.push_back({.name = upper(field.name)});
  };
  for (std::size_t pin = 0; pin < place.type->block->pin_count(); ++pin) {
    add(place.type->block->pin(pin));
  }
  for (const Field& output : place.type->block->outputs) {
    Field field = output;
    field.preset = 0.0;
    add(field);
  }
  place.aliases.resize(place.parts.size(), nullptr);
  if (place.type->by_clock) {
    place.by_clock = make(place.type->by_clock, path, span, true);
    place.clocked = called_again_ > 0;
  }
}

std::unique_ptr<Place> Body::make(const TypeRef& type, const std::string& path, language::Span span, bool memory) {
  auto place = std::make_unique<Place>();
  place->type = type;
  place->path = path;
  switch (type->kind) {
    case BodyType::Kind::Plain:
      place->leaf = make_leaf(type->plain, type->start, path, span, memory);
      break;
    case BodyType::Kind::Array:
      for (std::int64_t i = type->low; i <= type->high && leaves_.size() <= most_leaves; ++i) {
        place->parts.push_back(make(type->element, flat_element_name(path, i), span, memory));
      }
      break;
    case BodyType::Kind::Library:
      make_pins(*place, path, span);
      break;
    default: {
      const Source outer = source_;
      if (type->kind == BodyType::Kind::Block) {
        source_ = type->source;
      }
      make_members(*place, type->members, memory);
      source_ = outer;
    }
  }
  if (type->initial != nullptr) {
    set_initial(*place, *type->initial);
  }
  return place;
}

void Body::make_members(Place& place, const std::vector<Member>& members, bool memory) {
  const bool unit = place.type == nullptr || place.type->kind == BodyType::Kind::Block;
  for (const Member& member : members) {
    const bool global = &place == globals_.get();
    const bool fixed =
        member.role == syntax::Role::Constant || member.role == syntax::Role::Temporary ||
        (unit && !global && member.role == syntax::Role::Local && member.type->kind != BodyType::Kind::Block &&
         member.type->kind != BodyType::Kind::Library && !written(source_).names.contains(member.name));
    const std::string_view list = global && !fixed ? "VAR_GLOBAL." : "";  // a variable of the block may have its name
    const std::string path =
        place.path.empty() ? fmt::format("{}{}", list, member.name) : place.path + (unit ? "." : "_") + member.name;
    const bool again = unit && written(source_).called_again.contains(member.name);
    called_again_ += again ? 1 : 0;
    const auto first = static_cast<std::ptrdiff_t>(leaves_.size());
    auto part = make(member.type, path, place_of(member.written.span), memory && !fixed);
    called_again_ -= again ? 1 : 0;
    if (global && fixed) {
      std::for_each(leaves_.begin() + first, leaves_.end(), [](Leaf& leaf) { leaf.constant = true; });
    }
    if (member.initial != nullptr && member.initial->given()) {
      set_initial(*part, *member.initial);
    } else if (member.type->is_subrange && member.type->start != 0.0 && member.type->initial == nullptr && !fixed &&
               member.role != syntax::Role::Input && member.role != syntax::Role::InOut) {
      refuse(error::other_meaning_elsewhere, member.written.span,
             fmt::format("'{}' begins at {}, the lowest number of its subrange, as the standard has it; in CODESYS and "
                         "TwinCAT it begins at 0",
                         member.written.text, member.type->low),
             fmt::format("Give it its value: := {}.", member.type->low));
    }
    place.parts.push_back(std::move(part));
    place.members.push_back(member);
    place.aliases.push_back(nullptr);
  }
}

namespace {

/// The elements of an array; where it is an array of arrays and `innermost` is asked for, those of the last dimension.
void elements_of(const Place& place, bool innermost, std::vector<Place*>& parts) {
  for (const auto& part : place.parts) {
    if (innermost && part->type != nullptr && part->type->kind == BodyType::Kind::Array) {
      elements_of(*part, true, parts);
    } else {
      parts.push_back(part.get());
    }
  }
}

}  // namespace

void Body::set_initial(Place& place, const syntax::Initial& initial) {
  if (place.leaf != Place::no_leaf) {
    Leaf& leaf = leaves_[place.leaf];
    if (initial.value == language::no_expression) {
      refuse(error::type_mismatch, initial.span, fmt::format("'{}' takes one value", place.path),
             "Write it without brackets.");
      return;
    }
    computer_.at(place_of(expression(initial.value).span));
    const Value given = computer_.assignable(value(initial.value), leaf.type, leaf.path);
    double number = 0.0;
    if (given.valid() && !computer_.constant(given, number)) {
      refuse(error::type_mismatch, initial.span, fmt::format("the initial value of '{}' is not a constant", leaf.path),
             "Write a literal or an operation on constants.");
    }
    leaf.initial = number;
    check_subrange(place, given, initial.span);
    if (!leaf.memory && given.valid()) {
      state_.values[place.leaf] = given;
    }
    return;
  }
  // [1, 2, 3, 4] of an array of arrays gives its elements one after the other; [[1, 2], [3, 4]] gives rows.
  const bool is_flat = std::ranges::none_of(
      initial.elements, [](const syntax::Initial& one) { return !one.elements.empty() || !one.members.empty(); });
  std::vector<Place*> parts;
  elements_of(place, is_flat, parts);
  std::size_t at = 0;
  for (const syntax::Initial& element : initial.elements) {
    double count = 1.0;
    if (element.repeat != language::no_expression) {
      constant(element.repeat, count);
    }
    for (; count > 0.0; count -= 1.0) {
      if (at == parts.size()) {
        refuse(error::type_mismatch, initial.span,
               fmt::format("'{}' has {} elements, and is given more", place.path, parts.size()),
               "Give it as many values as it has elements.");
        return;
      }
      if (element.given()) {
        set_initial(*parts[at], element);
      }
      ++at;
    }
  }
  for (const auto& [name, inner] : initial.members) {
    if (Place* const part = place.find(upper(name.text))) {
      set_initial(*part, inner);
    } else {
      refuse(error::unknown_pin, name.span, fmt::format("'{}' has no member '{}'", place.path, name.text),
             one_of_members(place, name.text));
    }
  }
}

/// A constant that a subrange does not have is told; what is known when it runs alone is kept as it is.
void Body::check_subrange(const Place& place, const Value& value, language::Span span) {
  double number = 0.0;
  const bool limited = place.type != nullptr && place.type->is_subrange;
  if (limited && value.valid() && computer_.constant(value, number) &&
      (number < static_cast<double>(place.type->low) || number > static_cast<double>(place.type->high))) {
    refuse(error::type_mismatch, span,
           fmt::format("'{}' has the subrange {}..{}, which has no {}", place.path, place.type->low, place.type->high,
                       number),
           "Write a number within it, or give the variable a wider one.");
  }
}

/// Puts variables back to their initial values: those of a function in each call, VAR_TEMP of a block.
void Body::restart(Place& place) {
  if (place.leaf != Place::no_leaf) {
    write(place.leaf, computer_.literal(leaves_[place.leaf].type, leaves_[place.leaf].initial));
  }
  for (const auto& part : place.parts) {
    restart(*part);
  }
}

bool Body::constant(language::ExpressionId id, double& number) {
  const Value result = value(id);
  return result.valid() && computer_.constant(result, number);
}

std::optional<Value> Body::named_constant(const syntax::Access& access) {
  const std::string name = upper(access.name.text);
  if (access.type.empty() && scope_ != nullptr && scope_->find(name) != nullptr) {
    return std::nullopt;
  }
  double number = 0.0;
  const bool qualified = access.steps.size() == 1 && !access.steps.front().member.text.empty();
  if (qualified && types_.enumerator(access.name.text, access.steps.front().member.text, number)) {
    return computer_.literal(Plain::Dint, number, true);
  }
  if (!access.steps.empty()) {
    return std::nullopt;
  }
  if (types_.enumerator(access.type, access.name.text, number)) {
    return computer_.literal(Plain::Dint, number, true);
  }
  const auto among = [&](const std::vector<syntax::Declaration>& declarations) -> std::optional<Value> {
    for (const syntax::Declaration& one : declarations) {
      Plain type = Plain::Bool;
      if (one.role == syntax::Role::Constant && upper(one.name.text) == name && plain_of(one.type.name.text, type) &&
          one.initial.value != language::no_expression && level_ < 20) {
        ++level_;
        const Value result = computer_.assignable(value(one.initial.value), type, name);
        --level_;
        return result;
      }
    }
    return std::nullopt;
  };
  const auto own = among(source_.unit->declarations);
  return own || source_.library != &types_.library() ? own : among(file_.declarations());
}

std::vector<Body::Choice> Body::choices(const syntax::Access& access) {
  Place* root = scope_ == nullptr ? nullptr : scope_->find(upper(access.name.text));
  if (root == nullptr && globals_ != nullptr && source_.library == &types_.library()) {
    root = globals_->find(upper(access.name.text));
  }
  if (root == nullptr) {
    // What was declared with a type that was refused has been told.
    const auto is_meant = [&](const syntax::Declaration& one) {
      return language::same_name(one.name.text, access.name.text);
    };
    const bool told = std::ranges::any_of(source_.unit->declarations, is_meant) ||
                      std::ranges::any_of(source_.unit->externals, is_meant);
    if (!told || scope_ == nullptr) {
      Plain type{};
      const bool is_type = plain_of(access.name.text, type);
      const auto cause = fmt::format("'{}' is {}", access.name.text, is_type ? "a type, no value" : "not declared");
      refuse(error::unknown_name, access.name.span, cause,
             is_type ? "Name a variable; the time since the first step is TIME(), with its parentheses."
                     : "Declare it in a VAR section; variables outside of the block come in as VAR_INPUT.");
    }
    return {};
  }
  std::vector<Choice> list{{.place = root}};
  for (const syntax::Step& step : access.steps) {
    if (!step_into(list, step, access)) {
      return {};
    }
  }
  return list;
}

bool Body::step_into(std::vector<Choice>& list, const syntax::Step& step, const syntax::Access& access) {
  if (step.bit >= 0) {
    const Place& place = *list.front().place;
    if (place.leaf == Place::no_leaf || !is_integer(leaves_[place.leaf].type) ||
        step.bit >= info(leaves_[place.leaf].type).width) {
      const bool has_bits = place.leaf != Place::no_leaf && is_integer(leaves_[place.leaf].type);
      refuse(error::type_mismatch, access.span, fmt::format("'{}' has no bit {}", access.name.text, step.bit),
             has_bits ? fmt::format("It is {}, with the bits 0 to {}.", info(leaves_[place.leaf].type).name,
                                    info(leaves_[place.leaf].type).width - 1)
                      : "Name a bit of a BYTE, a WORD or a DWORD, from 0 on.");
      return false;
    }
    std::ranges::for_each(list, [&](Choice& one) { one.bit = step.bit; });
    return true;
  }
  if (step.indexes.empty()) {
    const std::string name = upper(step.member.text);
    for (Choice& one : list) {
      Place* const part = one.place->find(name);
      if (part == nullptr) {
        refuse(error::unknown_pin, step.member.span,
               fmt::format("'{}' has no member '{}'", access.name.text, step.member.text),
               one_of_members(*one.place, step.member.text));
        return false;
      }
      one.place = part;
    }
    return true;
  }
  for (const language::ExpressionId id : step.indexes) {
    const Value index = value(id);
    if (!index.valid() || !index_into(list, index, expression(id).span)) {
      return false;
    }
  }
  return true;
}

/// A variable index means each of the elements under a condition; one outside of the array, the nearest end.
bool Body::index_into(std::vector<Choice>& list, const Value& index, language::Span span) {
  std::vector<Choice> next;
  for (const Choice& one : list) {
    if (one.place->type == nullptr || one.place->type->kind != BodyType::Kind::Array || !is_integer(index.type)) {
      const std::string_view type = info(index.type).name;
      refuse(error::type_mismatch, span,
             is_integer(index.type) ? "this is one index too many: what stands before it is no array"
                                    : fmt::format("this index is {}, no whole number", type),
             is_integer(index.type) ? "Leave it out, or declare the variable as an ARRAY."
                                    : fmt::format("Index by an INT or a DINT: {}_TO_DINT( … ).", type));
      return false;
    }
    const BodyType& array = *one.place->type;
    double known = 0.0;
    if (computer_.constant(index, known)) {
      const bool outside = known < static_cast<double>(array.low) || known > static_cast<double>(array.high);
      if (outside && index.loose) {  // a literal: nobody means the nearest element
        refuse(error::refused_access, span,
               fmt::format("the index {} lies outside of {}..{}", known, array.low, array.high),
               fmt::format("'{}' has the elements {} to {}.", one.place->path, array.low, array.high));
        return false;
      }
      known = std::clamp(known, static_cast<double>(array.low), static_cast<double>(array.high));
      Choice chosen = one;
      chosen.place = one.place->parts[static_cast<std::size_t>(known - static_cast<double>(array.low))].get();
      next.push_back(chosen);
      continue;
    }
    for (std::int64_t i = array.low; i <= array.high; ++i) {
      Choice chosen = one;
      chosen.place = one.place->parts[static_cast<std::size_t>(i - array.low)].get();
      const Operator op =
          i == array.low ? Operator::LessEqual : (i == array.high ? Operator::GreaterEqual : Operator::Equal);
      const Value here =
          array.low == array.high
              ? computer_.truth(true)
              : computer_.binary(op, index, computer_.literal(Plain::Dint, static_cast<double>(i), true));
      chosen.condition = one.condition ? computer_.binary(Operator::And, *one.condition, here) : here;
      next.push_back(chosen);
    }
  }
  if (next.size() > most_choices) {
    refuse(error::refused_in_body, span, fmt::format("this access means one of more than {} elements", most_choices),
           "Use a smaller array.");
    return false;
  }
  list = std::move(next);
  return true;
}

Place* Body::find(const syntax::Access& access) {
  const auto list = choices(access);
  if (list.size() > 1) {
    refuse(error::refused_in_body, access.span, "which variable this is, is not known before it runs",
           "Use a constant index here.");
  }
  return list.size() == 1 ? list.front().place : nullptr;
}

Value Body::read(const syntax::Access& access) {
  if (const auto known = named_constant(access)) {
    return *known;
  }
  if (!access.type.empty()) {
    return refuse(error::unknown_name, access.span,
                  fmt::format("there is no value {}#{}", access.type, access.name.text),
                  "Name a value of an enumeration in this file.");
  }
  const auto list = choices(access);
  Value result;
  for (std::size_t i = list.size(); i-- > 0;) {
    const Choice& one = list[i];
    if (one.place->leaf == Place::no_leaf) {
      return refuse(error::type_mismatch, access.span, fmt::format("'{}' is no single value", access.name.text),
                    "Name one of its members, outputs or elements.");
    }
    Value here = read(one.place->leaf);
    if (one.bit >= 0) {
      here = computer_.shifted(here, computer_.literal(Plain::Dint, one.bit), false);
      here = computer_.binary(Operator::And, here, computer_.literal(here.type, 1.0));
      here = computer_.binary(Operator::NotEqual, here, computer_.literal(here.type, 0.0));
    }
    result = i + 1 == list.size() ? here : computer_.select(*one.condition, here, result);
  }
  return result;
}

}  // namespace hysteron::bodies
