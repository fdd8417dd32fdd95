// The report of a fit as a page: parameters, train and test apart, what is left, pictures with zoom.
#pragma once

#include <string>

#include "tool/tune_report.hpp"

namespace hysteron::tool {

[[nodiscard]] std::string tune_page(const TuneReport& report);

}  // namespace hysteron::tool
