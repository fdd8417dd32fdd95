#include "codegen/graph/body/globals.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/graph/body/assigned.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::same_name;
using language::upper;

namespace {

bool meets(const std::set<const syntax::Unit*>& some, const std::set<const syntax::Unit*>& others) {
  return std::ranges::any_of(some, [&](const syntax::Unit* one) { return others.contains(one); });
}

/// One of the first that is not among the second; null where there is none.
const syntax::Unit* outside(const std::set<const syntax::Unit*>& some, const std::set<const syntax::Unit*>& others) {
  const auto found = std::ranges::find_if(some, [&](const syntax::Unit* one) { return !others.contains(one); });
  return found == some.end() ? nullptr : *found;
}

bool declares(const syntax::Unit& unit, std::string_view name) {
  return (unit.function && same_name(unit.name.text, name)) ||
         std::ranges::any_of(unit.declarations,
                             [&](const syntax::Declaration& one) { return same_name(one.name.text, name); });
}

}  // namespace

Globals::Globals(const syntax::Library& library) : library_(library), declarations_(library.globals) {
  if (std::ranges::all_of(declarations_, [](const auto& one) { return one.role == syntax::Role::Constant; })) {
    return;
  }
  for (const syntax::Declaration& one : declarations_) {
    if (one.role != syntax::Role::Constant) {
      users_.emplace(upper(one.name.text), Users{});
    }
  }
  for (const syntax::Unit& unit : library.units) {
    const Written written = written_by({&library, &unit});
    for (auto& [name, users] : users_) {
      if (declares(unit, name)) {
        continue;
      }
      if (written.read.contains(name)) {
        users.readers.insert(&unit);
      }
      if (written.assigned.contains(name)) {
        users.writers.insert(&unit);
      }
    }
    auto& named = named_[&unit];
    named = written.called;
    for (const syntax::Declaration& one : unit.declarations) {
      named.insert(upper(one.type.name.text));
    }
  }
  for (syntax::Declaration& one : declarations_) {
    const auto users = users_.find(upper(one.name.text));
    if (users != users_.end() && users->second.writers.empty()) {
      one.role = syntax::Role::Constant;
    }
  }
}

/// A unit and what it calls, in any depth.
Globals::Units Globals::within(const syntax::Unit& unit) const {
  Units found{&unit};
  std::vector<const syntax::Unit*> open{&unit};
  while (!open.empty()) {
    const auto named = named_.find(open.back());
    open.pop_back();
    for (const syntax::Unit& other : library_.units) {
      if (named != named_.end() && named->second.contains(upper(other.name.text)) && found.insert(&other).second) {
        open.push_back(&other);
      }
    }
  }
  return found;
}

std::vector<const syntax::Declaration*> Globals::variables_of(const syntax::Unit& unit) const {
  std::vector<const syntax::Declaration*> list;
  const Units own = users_.empty() ? Units{} : within(unit);
  for (const syntax::Declaration& one : declarations_) {
    const auto users = users_.find(upper(one.name.text));
    if (users != users_.end() && one.role != syntax::Role::Constant &&
        (meets(users->second.readers, own) || meets(users->second.writers, own))) {
      list.push_back(&one);
    }
  }
  return list;
}

/// It, its type, or a member of its type is given one.
bool Globals::has_value(const syntax::Declaration& global) const {
  return global.initial.given() || std::ranges::any_of(library_.types, [&](const syntax::TypeDefinition& type) {
           return same_name(type.name.text, global.type.name.text) &&
                  (type.initial.given() || std::ranges::any_of(type.type.fields, [](const syntax::Declaration& one) {
                     return one.initial.given();
                   }));
         });
}

void Globals::check(const syntax::Unit& unit, const Types::Report& report) const {
  const Units own = users_.empty() ? Units{} : within(unit);
  for (const syntax::Declaration& one : declarations_) {
    const auto found = users_.find(upper(one.name.text));
    if (found == users_.end() || !(meets(found->second.readers, own) || meets(found->second.writers, own))) {
      continue;
    }
    const auto& [readers, writers] = found->second;
    const auto refuse = [&](std::string cause, std::string mend) {
      report(error::refused_section, one.name.span, std::move(cause), std::move(mend));
    };
    const std::string_view name = one.name.text;
    if (writers.empty() && !has_value(one)) {
      refuse(fmt::format("the global variable '{}' is read, and nothing in this file gives it a value", name),
             fmt::format("Make it a VAR_INPUT of {}; where it is a constant, give it its value: {} : {} := …;",
                         unit.name.text, name, one.type.name.text));
    } else if (!writers.empty() && readers.empty()) {
      refuse(fmt::format("the global variable '{}' is assigned, and nothing in this file reads it", name),
             fmt::format("Make it a VAR_OUTPUT of {}.", (*writers.begin())->name.text));
    } else if (const syntax::Unit* const other = outside(writers, own) != nullptr ? outside(writers, own)
                                                 : writers.empty()                ? nullptr
                                                                                  : outside(readers, own)) {
      refuse(fmt::format("the global variable '{}' joins {} and {}", name, unit.name.text, other->name.text),
             fmt::format("Hand it over: a VAR_OUTPUT of the one that assigns it, a VAR_INPUT of the other."));
    }
  }
}

}  // namespace hysteron::bodies
