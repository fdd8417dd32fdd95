// What was left out of the fits or taken off the record, as the user reads it.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/effects/edges.hpp"
#include "diagnosis/faults/left_out.hpp"
#include "diagnosis/findings/findings.hpp"

namespace hysteron::diagnosis {

struct LeftOutOfFits {
  const std::vector<LeftOut>& left_out;
  const std::vector<NoiseFloor>& floors;
  const std::vector<double>& noise;  ///< of each output what may be noise, in floors
  const std::vector<std::string>& tried;
};

/// An effect of its own where it is no small part of the noise, and beside two or more others as much as a third one
/// has to close; a remark in any case. By itself it makes the verdict.
void add_left_out(const Findings& findings, const LeftOutOfFits& from, const std::vector<Edge>& edges,
                  Diagnosis& result);

}  // namespace hysteron::diagnosis
