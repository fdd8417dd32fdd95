// HY_DELAY_WORD: XOUT(k) = XIN(k−1), of type WORD
#pragma once

#include "blocks/typed_delay.hpp"

namespace hysteron {

struct DelayWord : TypedDelay<Word> {
  static constexpr About about{
      .name = "HY_DELAY_WORD",
      .title = "Unit delay of a pattern of bits",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = XIN(k−1); X0 in the first sample and where R1",
      .meaning =
          "The pattern of bits of the step before: a status word of the last cycle, to see which bits have changed. In "
          "the first sample, and while R1 is TRUE, XOUT is X0. HY_DELAY does "
          "the same for an LREAL.",
      .delay = "One sample."};
};

}  // namespace hysteron
