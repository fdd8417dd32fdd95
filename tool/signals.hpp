// Signals over the steps of a run, as commands use them: tuning/simulation.hpp.
#pragma once

#include "tuning/simulation.hpp"

namespace hysteron::tool {

using hysteron::at_step;
using hysteron::Drive;
using hysteron::drive_from;
using hysteron::has_default;
using hysteron::interpret;
using hysteron::output_wires;
using hysteron::settle_sample_time;
using hysteron::Signal;
using hysteron::type_fault;

}  // namespace hysteron::tool
