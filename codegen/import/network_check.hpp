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

/// Elements that no diagram can express, and targets and instances that stand there twice.
[[nodiscard]] std::vector<Objection> objections_to(const DrawnPou& pou, const OwnBlocks& own);

/// The variables that the network assigns, in capitals, with those that a block hands back.
[[nodiscard]] std::set<std::string> targets_of(const DrawnPou& pou, const OwnBlocks& own);

/// The variable of the POU that is handed over by a VAR_IN_OUT of a block, in capitals; empty where none is.
[[nodiscard]] std::string handed_over(const DrawnPou& pou, const DrawnPin& pin);

/// Whether a block hands its VAR_IN_OUT back changed: a POU of the project whose network assigns it.
[[nodiscard]] bool hands_back(const DrawnElement& block, std::string_view pin, const OwnBlocks& own);

/// Whether a pin of an instance, by its name in capitals, gets what may change from step to step.
[[nodiscard]] bool is_driven(const DrawnPou& pou, std::string_view instance, std::string_view pin);

}  // namespace hysteron::import
