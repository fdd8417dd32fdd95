#include "codegen/graph/body/body.hpp"

#include <fmt/format.h>

#include <utility>

#include "codegen/graph/body/assigned.hpp"
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

const std::set<std::string>& Body::assigned(const Source& source) {
  auto found = assigned_.find(source.unit);
  if (found == assigned_.end()) {
    found = assigned_.emplace(source.unit, assigned_names(source)).first;
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
    if (member.front().type->kind != BodyType::Kind::Plain) {
      if (in_place) {
        continue;
      }
      refuse(error::refused_in_body, one.name.span,
             fmt::format("'{}' at the border of the block is an array, a structure or an instance", one.name.text),
             "Give it inputs and outputs of plain types, or call it from another block of this file.");
      continue;
    }
    BorderPort port{.name = std::string(one.name.text),
                    .type = member.front().type->plain,
                    .role = one.role,
                    .initial = member.front().type->start,
                    .written = one.name,
                    .declaration = i,
                    .assigned = assigned(source_).contains(upper(one.name.text))};
    Place place;
    const auto made = make(member.front().type, port.name, one.name.span, true);
    if (one.initial.given()) {
      set_initial(*made, one.initial);
    }
    port.initial = leaves_[made->leaf].initial;
    port.initial = port.type == Plain::Time ? port.initial / 1000.0 : port.initial;
    list.push_back(std::move(port));
  }
  return list;
}

std::map<std::string, Wire> Body::run(const std::map<std::string, Wire>& inputs) {
  root_ = std::make_unique<Place>();
  make_members(*root_, types_.members(source_.unit->declarations), true);
  scope_ = root_.get();
  for (const auto& [name, wire] : inputs) {
    const Place* const place = root_->find(name);
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
    if ((role == syntax::Role::Output || role == syntax::Role::InOut) && place.leaf != Place::no_leaf) {
      computer_.at(path_for(root_->members[i].name), leaves_[place.leaf].span);
      results[root_->members[i].name] = computer_.given(read(place.leaf));
    }
  }
  close_cells();
  return results;
}

}  // namespace hysteron::bodies
