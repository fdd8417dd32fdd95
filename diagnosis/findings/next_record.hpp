// What the improved diagram will leave of a further record of the machine.
//
//   ln RMS = m ± t(0.975, n − 1)·s·√(1 + 1/n),   m and s of ln RMS over n blocks that the fit has not seen
//
// The next record is taken for one more block: another day may differ from this one as much as its parts differ among
// themselves. It is the prediction interval of a normal sample (G. J. Hahn, W. Q. Meeker, Statistical Intervals, 1991).
// A block counts with its noise at least: where a machine rested less is left, and ln RMS of it would say nothing of
// one that moves. Where less is left of all blocks than that noise, it was taken for too large, and none counts with
// it. The RMS of all blocks lies in the interval, whatever one block of many has.
#pragma once

#include <optional>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/verdict/held_out.hpp"

namespace hysteron::diagnosis {

/// `scale` is what the residuals are in units of, `noise` their deviation by noise alone in those. Nothing of less than
/// three blocks, or of residuals that are 0.
[[nodiscard]] std::optional<NextRecord> next_record(const HeldOut& unseen, double noise, double scale);

}  // namespace hysteron::diagnosis
