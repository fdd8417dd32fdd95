// General bases of the kinds that a gap may be of. Each is wide enough to hold what the effects of that kind do, and is
// made of signals that know nothing of the residual: inputs, the diagram as it runs, other columns, the time.
//
//   linear dynamics   each input, delayed (an impulse response in steps), and through resonators at the residual's
//   lines;
//                     the other signals of the diagram, and their rates
//   static curve      1, z², z³, |z|, z|z| and two corners at ±½, on each edge through the diagram; the same of rates
//   memory            play of four widths, and the direction of motion, alone and with the load; on each edge
//   time              slow waves and decays over the record, and a ramp times the signal of an edge
//   periodic          the residual's lines over time that no driver has, and over positions
//   columns           columns that the diagram does not use, quick and slow, alone and times the signal of an edge
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "diagnosis/evidence/blocks.hpp"
#include "diagnosis/evidence/space.hpp"

namespace hysteron::diagnosis {

enum class GapKind : std::uint8_t { Linear, Static, Memory, Time, Periodic, Columns };

struct GapKindText {
  GapKind kind;
  std::string_view name;     ///< in verdict.json
  std::string_view words;    ///< in the report
  std::string_view effects;  ///< what of the library is of this kind
};

inline constexpr std::array gap_kinds{
    GapKindText{GapKind::Linear, "linear_dynamics", "linear dynamics", "a lag, a delay, a resonance, a creep"},
    GapKindText{GapKind::Static, "static_curve", "a static curve", "a limit, a dead zone, a bend, an offset"},
    GapKindText{GapKind::Memory, "memory", "memory of direction", "dry friction, play, hysteresis"},
    GapKindText{GapKind::Time, "time", "a change over time", "a drift, a warm-up, the state at the start"},
    GapKindText{GapKind::Periodic, "periodic", "something periodic", "cogging, a cyclic error, a hum"},
    GapKindText{GapKind::Columns, "columns", "another column", "a coupling, a load that was logged"}};

/// The columns of each kind in the order of gap_kinds, on the rows of one output: `rows` are those of one output alone.
[[nodiscard]] std::array<MatrixXd, gap_kinds.size()> gap_bases(const Task& task, const Space& space, std::size_t output,
                                                               const Blocks& rows, unsigned threads);

}  // namespace hysteron::diagnosis
