#include "codegen/graph/body/body.hpp"

#include <fmt/format.h>

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
          [this](language::ExpressionId id, double& number) { return constant(id, number); }) {
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

std::vector<BorderPort> Body::ports(bool in_place) {
  std::vector<BorderPort> list;
  root_ = std::make_unique<Place>();
  const auto& declarations = source_.unit->declarations;
  for (std::size_t i = 0; i < declarations.size(); ++i) {
    const syntax::Declaration& one = declarations[i];
    const bool border =
        one.role == syntax::Role::Input || one.role == syntax::Role::Output || one.role == syntax::Role::InOut;
    const auto member = types_.members({one});
    if (!border || member.empty()) {
      continue;
    }
    const BodyType& type = *member.front().type;
    if (type.kind == BodyType::Kind::Array && type.element->kind == BodyType::Kind::Plain &&
        type.high - type.low < longest_vector) {
      add_elements(list, i, *member.front().type);
      continue;
    }
    if (type.kind != BodyType::Kind::Plain) {
      if (in_place) {
        continue;
      }
      refuse(error::refused_in_body, one.name.span,
             fmt::format("'{}' at the border of the block is a structure, an instance, or an array of several "
                         "dimensions or of more than {} elements",
                         one.name.text, longest_vector),
             "Give it inputs and outputs of plain types or vectors of these, or call it from another block of this "
             "file.");
      continue;
    }
    const auto made = make(member.front().type, std::string(one.name.text), one.name.span, true);
    if (one.initial.given()) {
      set_initial(*made, one.initial);
    }
    list.push_back(port(i, type, std::string(one.name.text), *made));
  }
  return list;
}

BorderPort Body::port(std::size_t declaration, const BodyType& type, std::string name, const Place& place) {
  const syntax::Declaration& one = source_.unit->declarations[declaration];
  const double initial = leaves_[place.leaf].initial;
  return {.name = std::move(name),
          .type = type.plain,
          .role = one.role,
          .initial = type.plain == Plain::Time ? initial / 1000.0 : initial,
          .written = one.name,
          .declaration = declaration,
          .assigned = written(source_).names.contains(upper(one.name.text))};
}

/// A vector at the border: a port for each element.
void Body::add_elements(std::vector<BorderPort>& list, std::size_t declaration, const BodyType& type) {
  const syntax::Declaration& one = source_.unit->declarations[declaration];
  const auto made = make(std::make_shared<BodyType>(type), std::string(one.name.text), one.name.span, true);
  if (one.initial.given()) {
    set_initial(*made, one.initial);
  }
  for (std::size_t i = 0; i < made->parts.size(); ++i) {
    list.push_back(port(declaration, *type.element,
                        element_name(one.name.text, type.low + static_cast<std::int64_t>(i)), *made->parts[i]));
  }
}

Place* Body::border(std::string_view name) {
  const auto element = element_of(name);
  Place* const place = root_->find(element ? upper(element->vector) : std::string(name));
  if (!element || place == nullptr) {
    return place;
  }
  const std::int64_t at = element->index - place->type->low;
  return at < 0 || at >= static_cast<std::int64_t>(place->parts.size())
             ? nullptr
             : place->parts[static_cast<std::size_t>(at)].get();
}

std::map<std::string, Wire> Body::run(const std::map<std::string, Wire>& inputs) {
  root_ = std::make_unique<Place>();
  make_members(*root_, types_.members(source_.unit->declarations), true);
  scope_ = root_.get();
  for (const auto& [name, wire] : inputs) {
    const Place* const place = border(name);
    if (place != nullptr && place->leaf != Place::no_leaf) {
      computer_.at(path_for(name), leaves_[place->leaf].span);
      write(place->leaf, computer_.taken(wire, leaves_[place->leaf].type));
    }
  }
  execute(source_.unit->statements);
  std::map<std::string, Wire> results;
  for (std::size_t i = 0; i < root_->members.size(); ++i) {
    const auto role = root_->members[i].role;
    const Place& place = *root_->parts[i];
    if (role != syntax::Role::Output && role != syntax::Role::InOut) {
      continue;
    }
    const auto give = [&](const std::string& name, const Place& one) {
      if (one.leaf != Place::no_leaf) {
        computer_.at(path_for(name), leaves_[one.leaf].span);
        results[name] = computer_.given(read(one.leaf));
      }
    };
    give(root_->members[i].name, place);
    for (std::size_t k = 0;
         k < place.parts.size() && place.type != nullptr && place.type->kind == BodyType::Kind::Array; ++k) {
      give(element_name(root_->members[i].name, place.type->low + static_cast<std::int64_t>(k)), *place.parts[k]);
    }
  }
  close_cells();
  return results;
}

}  // namespace hysteron::bodies
