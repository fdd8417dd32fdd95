// Arrays and structures as wholes: what is copied, handed over, or given by a FUNCTION.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;

namespace {

/// Copied are variables: an instance is not.
bool is_copied(const Place& place) {
  return place.leaf != Place::no_leaf ||
         (place.type && (place.type->kind == BodyType::Kind::Array || place.type->kind == BodyType::Kind::Structure));
}

}  // namespace

/// Whether an expression is a variable of more than one value, or the call of a FUNCTION that gives such a one.
bool Body::is_whole(language::ExpressionId id) {
  const auto& node = expression(id).node;
  if (const auto* call = std::get_if<syntax::Call>(&node)) {
    const Source source = types_.find_unit(call->function.text, true);
    if (source.unit == nullptr) {
      return false;
    }
    const TypeRef type = types_.resolve(source.unit->result);
    return type && type->kind != BodyType::Kind::Plain;
  }
  const auto* access = std::get_if<syntax::Access>(&node);
  if (access == nullptr || !access->type.empty() || named_constant(*access)) {
    return false;
  }
  const auto list = choices(*access);
  return !list.empty() && list.front().place->leaf == Place::no_leaf;
}

/// The values of a place, in the order of its leaves.
std::vector<Value> Body::values_of(const Place& place) {
  if (place.leaf != Place::no_leaf) {
    return {read(place.leaf)};
  }
  std::vector<Value> list;
  for (const auto& part : place.parts) {
    const auto inner = values_of(*part);
    list.insert(list.end(), inner.begin(), inner.end());
  }
  return list;
}

/// Those of the one that is meant.
std::vector<Value> Body::values_of(const std::vector<Choice>& list) {
  std::vector<Value> values = values_of(*list.back().place);
  for (std::size_t i = list.size() - 1; i-- > 0;) {
    const auto here = values_of(*list[i].place);
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = computer_.select(*list[i].condition, here[k], values[k]);
    }
  }
  return values;
}

/// A place for values that belong to no variable; it lasts until its statement or its call ends.
Place* Body::keep(const TypeRef& type, const std::string& path, const std::vector<Value>& values, language::Span span) {
  const auto first = static_cast<std::uint32_t>(leaves_.size());
  wholes_.push_back(make(type, path, span, false));
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    write(first + i, values[i]);
  }
  return wholes_.back().get();
}

/// Those of the places from there on.
void Body::forget(std::size_t leaves, std::size_t wholes) {
  leaves_.resize(leaves);
  state_.values.resize(leaves);
  wholes_.resize(wholes);
}

/// The place of a whole; null where an error was reported. Where an index is not known before it runs, its values are
/// those of the element that is meant then.
Place* Body::whole(language::ExpressionId id) {
  const auto span = expression(id).span;
  if (const auto* call = std::get_if<syntax::Call>(&expression(id).node)) {
    if (const Source source = types_.find_unit(call->function.text, true); source.unit != nullptr) {
      const Result given = call_unit(source, *call, span);
      if (given.whole != nullptr || !given.value.valid()) {
        return given.whole;
      }
    }
  }
  const auto* access = std::get_if<syntax::Access>(&expression(id).node);
  if (access == nullptr || named_constant(*access)) {
    refuse(error::type_mismatch, span, "here is one value, where an array or a structure is expected",
           "Write a variable of that type, or a FUNCTION that gives one.");
    return nullptr;
  }
  const auto list = choices(*access);
  if (list.size() <= 1) {
    return list.empty() ? nullptr : list.front().place;
  }
  if (!is_copied(*list.front().place)) {
    return find(*access);
  }
  return keep(list.front().place->type, list.front().place->path, values_of(list), span);
}

Place* Body::lend(const syntax::Access& access, std::vector<Lent>& lent) {
  auto list = choices(access);
  if (list.size() <= 1) {
    return list.empty() ? nullptr : list.front().place;
  }
  if (!is_copied(*list.front().place)) {
    return find(access);
  }
  Place* const place = keep(list.front().place->type, list.front().place->path, values_of(list), access.span);
  lent.push_back({std::move(list), place});
  return place;
}

void Body::take_back(const std::vector<Lent>& lent, language::Span span) {
  for (const Lent& one : lent) {
    for (const Choice& owner : one.owners) {
      copy(*owner.place, *one.place, span, owner.condition);
    }
  }
}

void Body::assign_whole(const syntax::Access& target, language::ExpressionId id, language::Span span) {
  if (Place* const from = whole(id)) {
    assign_whole(target, *from, span);
  }
}

void Body::assign_whole(const syntax::Access& target, Place& from, language::Span span) {
  if (refuse_constant(target)) {
    return;
  }
  for (const Choice& one : choices(target)) {
    copy(*one.place, from, span, one.condition);
  }
}

void Body::copy(Place& to, Place& from, language::Span span, const std::optional<Value>& condition) {
  if (to.leaf != Place::no_leaf && from.leaf != Place::no_leaf) {
    computer_.at(place_of(span));
    const Value kept = computer_.assignable(read(from.leaf), leaves_[to.leaf].type, to.path);
    write(to.leaf, condition && kept.valid() ? computer_.select(*condition, kept, read(to.leaf)) : kept);
    return;
  }
  if (to.parts.size() != from.parts.size() || to.leaf != from.leaf || !is_copied(to) || !is_copied(from) ||
      to.type->kind != from.type->kind) {
    refuse(error::type_mismatch, span, fmt::format("'{}' and '{}' are not of one type", to.path, from.path),
           to.leaf != Place::no_leaf ? "Take one of its members or elements."
                                     : "Copy an array or a structure into one of the same type.");
    return;
  }
  for (std::size_t i = 0; i < to.parts.size(); ++i) {
    copy(*to.parts[i], *from.parts[i], span, condition);
  }
}

}  // namespace hysteron::bodies
