// What stands in a network before any of it is read: elements that no diagram has, and which pins are wired.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/import/drawing.hpp"

namespace hysteron::import {

struct Objection {
  const DrawnElement* element = nullptr;
  std::string why{};
  std::string mend{};
};

/// What the network of one POU may call, by name in capitals: the POUs of the project that are no library blocks.
using OwnBlocks = std::map<std::string, const DrawnPou*>;

/// What the network of a POU assigns, by the name of the POU; all names in capitals.
using Targets = std::map<std::string, std::set<std::string>>;

/// Of all POUs that may be called, with what their own blocks hand back. Throws InputError HY744 where a variable is
/// handed on through too many blocks.
[[nodiscard]] Targets targets_of_all(const std::string& file, const OwnBlocks& own);

/// The name by which an element's text is found among targets: in capitals, without blanks; V[2] for an element of V.
[[nodiscard]] std::string target_key(std::string_view text);

/// What assigns each variable of one network, or each element of one, by `target_key`, as the file has it: output
/// variables, coils, and blocks that hand a VAR_IN_OUT back.
using Assigners = std::map<std::string, std::vector<const DrawnElement*>>;
[[nodiscard]] Assigners assigners_in(const DrawnPou& pou, const Targets& called);

/// Elements that no diagram can express, instances that stand there twice, and targets whose last value no order
/// states.
[[nodiscard]] std::vector<Objection> objections_to(const DrawnPou& pou, const OwnBlocks& own,
                                                   const Assigners& assigners);

/// The variable of the POU that a VAR_IN_OUT of a block may change, in capitals; empty where none is handed over.
[[nodiscard]] std::string handed_over(const DrawnPou& pou, const DrawnPin& pin);

/// Whether a block hands its VAR_IN_OUT back changed: a POU of the project whose network assigns it.
[[nodiscard]] bool hands_back(const DrawnElement& block, std::string_view pin, const Targets& targets);

/// Whether a pin of an instance, by its name in capitals, gets what may change from step to step.
[[nodiscard]] bool is_driven(const DrawnPou& pou, std::string_view instance, std::string_view name);

}  // namespace hysteron::import
