// Heads that say of the columns by keys, with no row of names above the numbers: GW Instek, LabChart, Yokogawa.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "records/text/layout.hpp"
#include "records/text/source_text.hpp"

namespace hysteron::records {

struct KeyedHead {
  std::vector<TextLayout::Name> columns{};  ///< as many as a row has cells, without an empty one at its end
  std::vector<std::string> notes{};
};

/// `Source,CH1,CH2` and `Vertical Units,V,V` above `Waveform Data`; `ChannelTitle=`, `UnitName=` and `Range=` above the
/// rows; `TraceName,u,y` above rows that begin with an empty cell; `Name;u;y` far above, and another key right above.
/// Signals may stand alone, behind one time, or each behind its own. `values` says which cells of a row hold numbers.
/// Nothing where the head is of another kind.
[[nodiscard]] std::optional<KeyedHead> keyed_head(const std::vector<Line>& head, std::size_t first_row,
                                                  const std::vector<bool>& values, char separator);

}  // namespace hysteron::records
