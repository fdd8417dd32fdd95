// HY_DELAY_BOOL: XOUT(k) = XIN(k−1), of type BOOL
#pragma once

#include "blocks/typed_delay.hpp"

namespace hysteron {

struct DelayBool : TypedDelay<Bool> {
  static constexpr About about{.name = "HY_DELAY_BOOL",
                               .title = "Unit delay of a truth value",
                               .group = Group::Dynamics,
                               .equation = "XOUT(k) = XIN(k−1); X0 in the first sample and where R1",
                               .meaning =
                                   "The truth value of the step before: what a sequence or an interlock remembers. In "
                                   "the first sample, and while R1 is TRUE, XOUT is X0. HY_DELAY does "
                                   "the same for an LREAL.",
                               .delay = "One sample."};
};

}  // namespace hysteron
