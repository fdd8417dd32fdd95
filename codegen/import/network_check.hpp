// What stands in a network before any of it is read: elements that no diagram has, and which pins are wired.
#pragma once

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

/// Elements that no diagram can express, and targets and instances that stand there twice.
[[nodiscard]] std::vector<Objection> objections_to(const DrawnPou& pou);

/// The variables that the network assigns, in capitals.
[[nodiscard]] std::set<std::string> targets_of(const DrawnPou& pou);

/// Whether a pin of an instance, by its name in capitals, gets what may change from step to step.
[[nodiscard]] bool is_driven(const DrawnPou& pou, std::string_view instance, std::string_view pin);

}  // namespace hysteron::import
