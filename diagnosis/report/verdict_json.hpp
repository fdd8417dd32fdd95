// verdict.json, version 1: the verdict for programs. The schema is stable; what it holds beyond is never removed.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis {

[[nodiscard]] std::string verdict_json(const Diagnosis& found);

}  // namespace hysteron::diagnosis
