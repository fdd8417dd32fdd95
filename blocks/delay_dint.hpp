// HY_DELAY_DINT: XOUT(k) = XIN(k−1), of type DINT
#pragma once

#include "blocks/typed_delay.hpp"

namespace hysteron {

struct DelayInt : TypedDelay<Int> {
  static constexpr About about{.name = "HY_DELAY_DINT",
                               .title = "Unit delay of a whole number",
                               .group = Group::Dynamics,
                               .equation = "XOUT(k) = XIN(k−1); X0 in the first sample and where R1",
                               .meaning =
                                   "The whole number of the step before: what a counter or a state machine remembers. "
                                   "In the first sample, and while R1 is TRUE, XOUT is X0. HY_DELAY does "
                                   "the same for an LREAL.",
                               .delay = "One sample."};
};

}  // namespace hysteron
