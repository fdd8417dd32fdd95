#include "tool/processor_list.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "support/whole_number.hpp"

namespace hysteron::tool {

std::optional<std::vector<unsigned>> parse_processors(std::string_view text) {
  std::vector<unsigned> processors;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) {
    text.remove_suffix(1);
  }
  while (!text.empty()) {
    const auto comma = std::min(text.find(','), text.size());
    const std::string_view part = text.substr(0, comma);
    const auto dash = std::min(part.find('-'), part.size());
    const auto first = whole_number<std::uint64_t>(part.substr(0, dash));
    const auto last = dash == part.size() ? first : whole_number<std::uint64_t>(part.substr(dash + 1));
    constexpr std::uint64_t most = 65'535;
    if (!first || !last || *last < *first || *last > most) {
      return std::nullopt;
    }
    for (std::uint64_t one = *first; one <= *last; ++one) {
      processors.push_back(static_cast<unsigned>(one));
    }
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return processors;
}

std::string processors_text(const std::vector<unsigned>& processors) {
  std::string text;
  for (std::size_t i = 0; i < processors.size();) {
    std::size_t last = i;
    while (last + 1 < processors.size() && processors[last + 1] == processors[last] + 1) {
      ++last;
    }
    text += (text.empty() ? "" : ",") + std::to_string(processors[i]) +
            (last == i ? "" : "-" + std::to_string(processors[last]));
    i = last + 1;
  }
  return text;
}

}  // namespace hysteron::tool
