// Lines in time that the drivers of a machine have themselves: what they drive repeats with them.
#pragma once

#include <vector>

#include "diagnosis/evidence/driver_signals.hpp"

namespace hysteron::diagnosis {

/// Takes off the frequencies, Hz, that a driver has, or has a whole fraction of: a disturbance in time would stand for
/// any law of that driver.
void bar_lines_of(const std::vector<DriverSignal>& drivers, double sample_time, std::vector<double>& frequencies);

}  // namespace hysteron::diagnosis
