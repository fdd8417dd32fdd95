// Heads that state the same of each channel, side by side above pairs of time and value, as TwinCAT's Scope exports
// them:
//
//   Name            u       Name            y
//   SampleTime[ms]  1       SampleTime[ms]  1
//   SymbolName      MAIN.u  SymbolName      MAIN.y
//   Unit            mV      Unit            um
//
//   0               0,0000  0               0,0000
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "records/text/source_text.hpp"

namespace hysteron::records {

struct ChannelHead {
  struct Channel {
    std::string name{};
    std::string unit{};
  };
  std::vector<Channel> channels{};
  std::string time_unit{};           ///< as SampleTime[ms] states it; empty where nothing does
  std::vector<std::string> notes{};  ///< what the head states and is left aside
};

/// Reads the lines of a head, of which rows have `cells` cells; nothing where it is none of these.
[[nodiscard]] std::optional<ChannelHead> channel_head(const std::vector<Line>& head, std::size_t first_row,
                                                      std::size_t cells, char separator);

}  // namespace hysteron::records
