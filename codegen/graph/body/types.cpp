#include "codegen/graph/body/types.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/graph/body/standard_blocks.hpp"
#include "codegen/trace/block_type.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

using language::same_name;
using language::upper;
namespace syntax = language::body;

namespace {

constexpr std::array infos{
    PlainInfo{"BOOL", Family::Truth, 1, false, Type::Bool},    PlainInfo{"SINT", Family::Whole, 8, true, Type::Int},
    PlainInfo{"INT", Family::Whole, 16, true, Type::Int},      PlainInfo{"DINT", Family::Whole, 32, true, Type::Int},
    PlainInfo{"USINT", Family::Whole, 8, false, Type::Int},    PlainInfo{"UINT", Family::Whole, 16, false, Type::Int},
    PlainInfo{"UDINT", Family::Whole, 32, false, Type::Int},   PlainInfo{"BYTE", Family::Bits, 8, false, Type::Int},
    PlainInfo{"WORD", Family::Bits, 16, false, Type::Word},    PlainInfo{"DWORD", Family::Bits, 32, false, Type::Int},
    PlainInfo{"REAL", Family::Number, 32, true, Type::Real},   PlainInfo{"LREAL", Family::Number, 64, true, Type::Real},
    PlainInfo{"TIME", Family::Duration, 64, true, Type::Real},
};

constexpr std::int64_t most_elements = 4096;
constexpr int deepest_type = 20;

/// The blocks of the standard that the library has under its own name, since they need the sample time.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> timers{
    {{"TON", "HY_TON"}, {"TOF", "HY_TOF"}, {"TP", "HY_TP"}}};

Source unit_of(const syntax::Library& library, std::string_view name, bool function) {
  for (const syntax::Unit& unit : library.units) {
    if (unit.function == function && same_name(unit.name.text, name)) {
      return {&library, &unit};
    }
  }
  return {};
}

}  // namespace

const PlainInfo& info(Plain type) {
  return infos[static_cast<std::size_t>(type)];
}

bool plain_of(std::string_view name, Plain& type) {
  const auto* const found =
      std::ranges::find_if(infos, [&](const PlainInfo& one) { return same_name(one.name, name); });
  if (found != infos.end()) {
    type = static_cast<Plain>(found - infos.begin());
  }
  return found != infos.end();
}

std::int64_t lowest(Plain type) {
  return info(type).below_zero ? -(std::int64_t{1} << (info(type).width - 1)) : 0;
}

std::int64_t highest(Plain type) {
  return (std::int64_t{1} << (info(type).width - (info(type).below_zero ? 1 : 0))) - 1;
}

Types::Types(const syntax::Library& library, Report report, Constant constant)
    : library_(library), report_(std::move(report)), constant_(std::move(constant)) {}

Source Types::find_unit(std::string_view name, bool function) const {
  const Source own = unit_of(library_, name, function);
  return own.unit != nullptr ? own : unit_of(standard_blocks(), name, function);
}

TypeRef Types::named(const language::Name& name) {
  BodyType made;
  if (plain_of(name.text, made.plain)) {
    return std::make_shared<BodyType>(made);
  }
  const std::string key = upper(name.text);
  if (const auto found = known_.find(key); found != known_.end()) {
    return found->second;
  }
  TypeRef result;
  const auto type = std::ranges::find_if(
      library_.types, [&](const syntax::TypeDefinition& one) { return same_name(one.name.text, name.text); });
  if (type != library_.types.end()) {
    auto inner = type->type.values.empty() ? resolve(type->type) : enumeration(type->type, type->name.text);
    if (inner && type->initial.given()) {
      auto copy = std::make_shared<BodyType>(*inner);
      copy->initial = &type->initial;
      inner = copy;
    }
    result = inner;
  } else if (const Source source = find_unit(name.text, false); source.unit != nullptr) {
    result = block(source);
  } else {
    std::string_view wanted = name.text;
    for (const auto& [iec, own] : timers) {
      wanted = same_name(iec, name.text) ? own : wanted;
    }
    made.block = find_block_type(wanted);
    if (wanted != name.text) {
      made.by_clock = block(unit_of(timers_by_clock(), name.text, false));
    }
    made.kind = BodyType::Kind::Library;
    if (same_name(name.text, fmu_type_name)) {
      report_(error::refused_in_body, name.span, "an FMU cannot stand in a sequential body",
              "Declare it in a diagram, and wire it to the block with this body.");
      return nullptr;
    }
    if (made.block == nullptr) {
      report_(error::unknown_block, name.span, fmt::format("there is no block or type '{}'", name.text),
              "Put its TYPE or FUNCTION_BLOCK into this file; `hysteron blocks` lists the library.");
      return nullptr;
    }
    result = std::make_shared<BodyType>(std::move(made));
  }
  known_.emplace(key, result);
  return result;
}

TypeRef Types::block(const Source& source) {
  return std::make_shared<BodyType>(
      BodyType{.kind = BodyType::Kind::Block, .members = members(source.unit->declarations), .source = source});
}

TypeRef Types::array(const syntax::TypeSpec& spec) {
  syntax::TypeSpec element = spec;
  element.dimensions.clear();
  TypeRef result = resolve(element);
  std::int64_t count = 1;
  for (auto bounds = spec.dimensions.rbegin(); result && bounds != spec.dimensions.rend(); ++bounds) {
    auto made = std::make_shared<BodyType>();
    made->kind = BodyType::Kind::Array;
    double low = 0.0;
    double high = 0.0;
    const auto span = library_.expressions[bounds->second].span;
    if (!constant_(bounds->first, low) || !constant_(bounds->second, high)) {
      report_(error::refused_in_body, span, "the bounds of this array are not constant", "Write numbers or constants.");
      return nullptr;
    }
    made->low = static_cast<std::int64_t>(low);
    made->high = static_cast<std::int64_t>(high);
    count *= std::max<std::int64_t>(1, made->high - made->low + 1);
    if (made->high < made->low || count > most_elements) {
      report_(error::refused_in_body, span,
              made->high < made->low
                  ? fmt::format("the upper bound of this array, {}, is below the lower one, {}", made->high, made->low)
                  : fmt::format("this array has {} elements, more than {}", count, most_elements),
              made->high < made->low ? fmt::format("Write the lower one first: {}..{}.", made->high, made->low)
                                     : "Every element is a variable of the step: use fewer.");
      return nullptr;
    }
    made->element = result;
    result = made;
  }
  return result;
}

/// The numbers of its type: what is assigned is neither checked nor limited when it runs. Its first value is the
/// lowest.
TypeRef Types::subrange(const syntax::TypeSpec& spec, const TypeRef& base) {
  auto made = std::make_shared<BodyType>(*base);
  double low = 0.0;
  double high = 0.0;
  const auto span = library_.expressions[spec.subrange.high].span;
  if (!constant_(spec.subrange.low, low) || !constant_(spec.subrange.high, high)) {
    report_(error::refused_in_body, span, "the bounds of this subrange are not constant",
            "Write numbers or constants.");
    return nullptr;
  }
  made->low = static_cast<std::int64_t>(low);
  made->high = static_cast<std::int64_t>(high);
  if (made->high < made->low || made->low < lowest(made->plain) || made->high > highest(made->plain)) {
    report_(error::type_mismatch, span,
            made->high < made->low
                ? fmt::format("the upper bound of this subrange, {}, is below the lower one, {}", made->high, made->low)
                : fmt::format("{} does not hold the subrange {}..{}", info(made->plain).name, made->low, made->high),
            made->high < made->low ? fmt::format("Write the lower one first: {}..{}.", made->high, made->low)
                                   : fmt::format("It holds {} to {}.", lowest(made->plain), highest(made->plain)));
    return nullptr;
  }
  made->is_subrange = true;
  made->start = low;
  return made;
}

TypeRef Types::enumeration(const syntax::TypeSpec& spec, std::string_view name) {
  auto made = std::make_shared<BodyType>();
  made->is_enumeration = true;
  made->plain = Plain::Int;  // as CODESYS and TwinCAT keep it, where nothing is said
  double next = 0.0;
  for (const auto& [value, number] : spec.values) {
    if (number != language::no_expression) {
      constant_(number, next);
    }
    made->start = &value == &spec.values.front().first ? next : made->start;
    enumerators_.emplace(upper(value.text), next);
    if (!name.empty()) {
      enumerators_[upper(name) + "#" + upper(value.text)] = next;
    }
    if (next < static_cast<double>(lowest(Plain::Int)) || next > static_cast<double>(highest(Plain::Int))) {
      made->plain = Plain::Dint;
    }
    next += 1.0;
  }
  if (Plain base{}; plain_of(spec.name.text, base) && is_integer(base)) {
    made->plain = base;
  }
  return made;
}

void Types::read_enumerations() {
  if (std::exchange(enumerations_read_, true)) {
    return;
  }
  for (const syntax::TypeDefinition& type : library_.types) {
    if (!type.type.values.empty()) {
      enumeration(type.type, type.name.text);
    }
  }
}

bool Types::enumerator(std::string_view type, std::string_view name, double& value) {
  read_enumerations();
  const auto found = enumerators_.find(type.empty() ? upper(name) : upper(type) + "#" + upper(name));
  if (found != enumerators_.end()) {
    value = found->second;
  }
  return found != enumerators_.end();
}

TypeRef Types::resolve(const syntax::TypeSpec& spec) {
  if (depth_ > deepest_type) {
    report_(error::recursive_block, spec.name.span, fmt::format("'{}' contains itself", spec.name.text),
            "A type or a block cannot be a part of itself.");
    return nullptr;
  }
  ++depth_;
  TypeRef result;
  if (!spec.dimensions.empty()) {
    result = array(spec);
  } else if (!spec.values.empty()) {
    result = enumeration(spec, {});
  } else if (!spec.fields.empty()) {
    auto made = std::make_shared<BodyType>();
    made->kind = BodyType::Kind::Structure;
    made->members = members(spec.fields);
    result = made;
  } else {
    result = named(spec.name);
    if (result && spec.subrange.low != language::no_expression) {
      result = subrange(spec, result);
    }
  }
  --depth_;
  return result;
}

std::vector<Member> Types::members(const std::vector<syntax::Declaration>& declarations) {
  std::vector<Member> list;
  for (const syntax::Declaration& one : declarations) {
    if (TypeRef type = resolve(one.type)) {
      list.push_back({upper(one.name.text), std::move(type), &one.initial, one.role, one.name});
    }
  }
  return list;
}

}  // namespace hysteron::bodies
