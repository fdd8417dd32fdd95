// A small plot of a parameter over time, for a page that has thousands.
#pragma once

#include <string>
#include <vector>

#include "fleet/report/analysis.hpp"

namespace hysteron::fleet {

/// Values with their 95 % intervals, the siblings' band of ± 3 standard deviations, the change where it is a finding.
/// `links` are what the dots lead to, one a record; without them the dots are one path. Colours are those of the page.
[[nodiscard]] std::string small_plot(const Track& track, const Parameter& parameter, int width, int height,
                                     const std::vector<std::string>& links = {});

/// All machines of a parameter along one axis: those that stand out are marked.
[[nodiscard]] std::string strip_plot(const Analysis& all, const Parameter& parameter, int width, int height);

}  // namespace hysteron::fleet
