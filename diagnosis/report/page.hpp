// The report of a diagnosis: one page of HTML that needs nothing beside itself.
//
// The verdict, the bar of the gap, the diagram and the tables are in the page as text and SVG; a small script draws
// what can be zoomed: residuals over time, maps, the next experiment. Nothing is read from another host.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis {

/// The page of a diagnosis; `improved` is the program of `Diagnosis::improved_text`, or the diagram as it was where no
/// effect was added. Parts without content are left out.
[[nodiscard]] std::string report_page(const Diagnosis& diagnosis, const Program& improved);

}  // namespace hysteron::diagnosis
