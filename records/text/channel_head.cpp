#include "records/text/channel_head.hpp"

#include <utility>

#include "records/text/scale_row.hpp"
#include "records/text/unit_text.hpp"
#include "support/names.hpp"

namespace hysteron::records {

std::optional<ChannelHead> channel_head(const std::vector<Line>& head, std::size_t first_row, std::size_t cells,
                                        char separator) {
  if (cells < 2 || cells % 2 != 0) {
    return std::nullopt;
  }
  ChannelHead result;
  std::vector<Cell> line;
  for (std::size_t i = 0; i < first_row; ++i) {
    cut_line(head[i].text, separator, line);
    if (line.size() != cells) {
      continue;
    }
    const std::string_view key = line.front().text;
    bool same = !key.empty();
    for (std::size_t c = 2; c < cells; c += 2) {
      same = same && line[c].text == key;
    }
    if (!same) {
      continue;
    }
    if (equal_ignoring_case(key, "Name")) {
      result.channels.clear();
      for (std::size_t c = 1; c < cells; c += 2) {
        result.channels.push_back({.name = std::string(line[c].text)});
      }
    } else if (const auto [name, unit] = split_header(key); equal_ignoring_case(name, "SampleTime")) {
      result.time_unit = unit;
    }
    for (std::size_t channel = 0; channel < result.channels.size(); ++channel) {
      ChannelHead::Channel& one = result.channels[channel];
      const std::string_view said = line[2 * channel + 1].text;
      if (is_key_of_units(key)) {
        one.unit = unit_of_word(said);
      } else if (auto note = note_of_scale(key, said, one.name)) {
        result.notes.push_back(std::move(*note));
      }
    }
  }
  // Of one channel, no key stands twice: a line "Name u" alone may be anything.
  const bool sure = cells > 2 || !result.time_unit.empty();
  return sure && !result.channels.empty() ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace hysteron::records
