#include "codegen/graph/body/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "codegen/graph/vectors.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::upper;

Body::Body(const syntax::Library& library, const syntax::Unit& unit, Surroundings around)
    : around_(std::move(around)),
      computer_(around_.builder,
                [this](int number, language::Span span, std::string cause, std::string mend) {
                  around_.report(number, place_of(span), std::move(cause), std::move(mend));
                }),
      source_{&library, &unit},
      types_(
          library,
          [this](int number, language::Span span, std::string cause, std::string mend) {
            around_.report(number, place_of(span), std::move(cause), std::move(mend));
          },
          [this](language::ExpressionId id, double& number) { return constant(id, number); }),
      file_(library) {
  const Value none = computer_.truth(false);
  state_.returned = state_.exited = state_.continued = none;
}

Value Body::refuse(int number, language::Span span, std::string cause, std::string mend) {
  around_.report(number, place_of(span), std::move(cause), std::move(mend));
  return {};
}

/// What an operation feeds, once for each time that it is fed: paths of operations are told apart by it.
std::string Body::path_for(std::string_view name) {
  const std::string path = around_.path + std::string(name);
  const int count = ++paths_[path];
  return count == 1 ? path : fmt::format("{}_{}", path, count);
}

const Written& Body::written(const Source& source) {
  auto found = written_.find(source.unit);
  if (found == written_.end()) {
    found = written_.emplace(source.unit, written_by(source)).first;
  }
  return found->second;
}

/// A VAR_EXTERNAL is a global variable of the file, or something that this file does not have.
void Body::check_externals() {
  for (const syntax::Declaration& one : source_.unit->externals) {
    const bool known = std::ranges::any_of(types_.library().globals, [&](const syntax::Declaration& global) {
      return language::same_name(global.name.text, one.name.text);
    });
    if (!known) {
      refuse(
          error::refused_section, one.name.span,
          fmt::format("VAR_EXTERNAL '{}' reaches out of the block, and this file has no global variable of that name",
                      one.name.text),
          "Hand the variable over as VAR_INPUT, VAR_OUTPUT or VAR_IN_OUT; put a constant, or what this block alone "
          "keeps in it, into VAR_GLOBAL … END_VAR of this file.");
    }
  }
}

namespace {

/// How many ports a type is at the border: a structure its members, an array of structures its elements; none where it
/// is an instance. More than `longest_vector` are as many as these and one.
std::optional<std::size_t> port_count(const BodyType& type) {
  constexpr std::size_t too_many = longest_vector + 1;
  std::size_t count = 1;
  if (type.kind == BodyType::Kind::Array) {
    const auto each = port_count(*type.element);
    const auto length = static_cast<std::size_t>(type.high - type.low + 1);
    return each ? std::optional(std::min(too_many, *each * std::min(too_many, length))) : std::nullopt;
  }
  if (type.kind == BodyType::Kind::Structure) {
    count = 0;
    for (const Member& member : type.members) {
      const auto each = port_count(*member.type);
      if (!each) {
        return std::nullopt;
      }
      count = std::min(too_many, count + *each);
    }
  }
  const bool instance = type.kind == BodyType::Kind::Block || type.kind == BodyType::Kind::Library;
  return instance ? std::nullopt : std::optional(count);
}

/// The ports that a variable is at the border, by name: AXIS_POS of a structure, X[0] of a vector, ZONE_1_TEMP of an
/// array of structures.
void each_port(const std::string& name, Place& place, const std::function<void(const std::string&, Place&)>& take) {
  if (place.leaf != Place::no_leaf) {
    take(name, place);
    return;
  }
  const BodyType& type = *place.type;
  const bool vector = type.kind == BodyType::Kind::Array && type.element->kind == BodyType::Kind::Plain;
  for (std::size_t i = 0; i < place.parts.size(); ++i) {
    const std::int64_t index = type.low + static_cast<std::int64_t>(i);
    each_port(vector                               ? element_name(name, index)
              : type.kind == BodyType::Kind::Array ? flat_element_name(name, index)
                                                   : name + "_" + std::string(type.members[i].written.text),
              *place.parts[i], take);
  }
}

bool is_at_border(syntax::Role role) {
  return role == syntax::Role::Input || role == syntax::Role::Output || role == syntax::Role::InOut;
}

}  // namespace

std::vector<BorderPort> Body::ports(bool in_place) {
  std::vector<BorderPort> list;
  root_ = std::make_unique<Place>();
  check_externals();
  if (!in_place) {
    file_.check(*source_.unit, around_.report);
  }
  const auto& declarations = source_.unit->declarations;
  for (std::size_t i = 0; i < declarations.size(); ++i) {
    const syntax::Declaration& one = declarations[i];
    const auto member = types_.members({one});
    if (!is_at_border(one.role) || member.empty()) {
      continue;
    }
    const TypeRef& type = member.front().type;
    const auto count = port_count(*type);
    if (!count || *count > longest_vector) {
      if (!in_place) {
        refuse(error::refused_in_body, one.name.span,
               count ? fmt::format("'{}' at the border of the block has more than {} elements", one.name.text,
                                   longest_vector)
                     : fmt::format("'{}' at the border of the block is an instance, or has one in it", one.name.text),
               count
                   ? "Each is an input or output: use fewer, or call the block from another block of this file."
                   : "Give it inputs and outputs of plain types, arrays and structures, or call it from another block "
                     "of this file.");
      }
      continue;
    }
    const auto made = make(type, std::string(one.name.text), one.name.span, true);
    if (one.initial.given()) {
      set_initial(*made, one.initial);
    }
    each_port(std::string(one.name.text), *made,
              [&](const std::string& name, const Place& place) { list.push_back(port(i, *type, name, place)); });
  }
  return list;
}

BorderPort Body::port(std::size_t declaration, const BodyType& whole, std::string name, const Place& place) {
  const syntax::Declaration& one = source_.unit->declarations[declaration];
  const BodyType& type = *place.type;
  const double initial = leaves_[place.leaf].initial;
  std::string output;
  if (one.role == syntax::Role::InOut && written(source_).names.contains(upper(one.name.text))) {
    const auto element = element_of(name);
    output = element ? element_name(std::string(element->vector) + "_OUT", element->index) : name + "_OUT";
  }
  const bool plain = whole.kind == BodyType::Kind::Plain ||
                     (whole.kind == BodyType::Kind::Array && whole.element->kind == BodyType::Kind::Plain);
  return {.name = std::move(name),
          .type = type.plain,
          .role = one.role,
          .initial = type.plain == Plain::Time ? initial / 1000.0 : initial,
          .written = one.name,
          .declaration = declaration,
          .output = std::move(output),
          .within = !plain,
          .range = type.is_subrange
                       ? std::optional(std::pair(static_cast<double>(type.low), static_cast<double>(type.high)))
                       : std::nullopt};
}

std::map<std::string, Wire> Body::run(const std::map<std::string, Wire>& inputs) {
  globals_ = std::make_unique<Place>();
  std::vector<Member> globals = types_.members(file_.declarations());
  for (const syntax::Declaration* const one : shared()) {
    const auto member = std::ranges::find(globals, upper(one->name.text), &Member::name);
    if (member != globals.end() && !port_count(*member->type)) {
      refuse(error::refused_section, one->name.span,
             fmt::format("the global variable '{}' is an instance", one->name.text),
             fmt::format("Declare it between VAR and END_VAR of {}.", source_.unit->name.text));
    }
  }
  std::erase_if(globals, [](const Member& one) { return !port_count(*one.type); });
  make_members(*globals_, globals, true);
  root_ = std::make_unique<Place>();
  make_members(*root_, types_.members(source_.unit->declarations), true);
  scope_ = root_.get();
  std::vector<std::pair<std::string, Place*>> outputs;
  for (std::size_t i = 0; i < root_->members.size(); ++i) {
    const Member& member = root_->members[i];
    if (!is_at_border(member.role) || !port_count(*member.type)) {
      continue;
    }
    each_port(member.name, *root_->parts[i], [&](const std::string& name, Place& place) {
      const std::string key = upper(name);
      if (const auto given = inputs.find(key); given != inputs.end()) {
        computer_.at(path_for(key), leaves_[place.leaf].span);
        write(place.leaf, computer_.taken(given->second, leaves_[place.leaf].type));
      }
      if (member.role != syntax::Role::Input) {
        outputs.emplace_back(key, &place);
      }
    });
  }
  execute(source_.unit->statements);
  std::map<std::string, Wire> results;
  for (const auto& [name, place] : outputs) {
    computer_.at(path_for(name), leaves_[place->leaf].span);
    results[name] = computer_.given(read(place->leaf));
  }
  close_cells();
  return results;
}

}  // namespace hysteron::bodies
