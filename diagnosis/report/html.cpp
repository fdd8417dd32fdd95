#include "diagnosis/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/numbers.hpp"

namespace hysteron::diagnosis::report {
std::string figure(double value, int digits) {
  if (!std::isfinite(value)) {
    return "–";
  }
  const double size = std::fabs(value);
  if (size >= std::pow(10.0, digits) && size < 1e6) {
    return fmt::format("{:.0f}", value);
  }
  return fmt::format("{:.{}g}", value == 0.0 ? 0.0 : value, digits);
}

std::string quantity(double value, std::string_view unit, int digits) {
  const std::string number = figure(value, digits);
  return unit.empty() || unit == "1" || !std::isfinite(value) ? number : fmt::format("{} {}", number, unit);
}

std::string percent(double share) {
  if (!std::isfinite(share)) {
    return "–";
  }
  if (share > 0.999 && share < 1.0) {
    return "> 99.9 %";
  }
  if (share > 0.0 && share < 5e-4) {
    return "below 0.1 %";
  }
  const bool fine = (std::fabs(share) < 0.0995 && share != 0.0) || (share > 0.99 && share < 1.0);
  return fmt::format("{:.{}f} %", 100.0 * share, fine ? 1 : 0);
}

std::vector<std::string> percents_of_whole(const std::vector<double>& shares) {
  std::vector<double> remainders;
  std::vector<int> whole;
  int sum = 0;
  for (const double share : shares) {
    const double percent = 100.0 * std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0);
    whole.push_back(static_cast<int>(std::floor(percent)));
    remainders.push_back(percent - std::floor(percent));
    sum += whole.back();
  }
  const auto left = static_cast<std::size_t>(std::max(0, 100 - sum));
  for (std::size_t i = 0; i < std::min(left, whole.size()); ++i) {
    const auto largest = std::ranges::max_element(remainders) - remainders.begin();
    ++whole[static_cast<std::size_t>(largest)];
    remainders[static_cast<std::size_t>(largest)] = -1.0;
  }
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const bool is_trace = whole[i] == 0 && shares[i] > 0.0;
    const bool is_nearly_all = whole[i] == 100 && shares[i] < 1.0;
    texts.push_back(is_trace ? "below 1 %" : is_nearly_all ? "> 99 %" : fmt::format("{} %", whole[i]));
  }
  return texts;
}

std::pair<std::string, std::string> interval_ends(double low, double high) {
  constexpr int digits = 4;
  return std::isfinite(low) && std::isfinite(high) ? distinct_texts(low, high, digits)
                                                   : std::pair(figure(low, digits), figure(high, digits));
}

std::string with_unit(std::string_view name, std::string_view unit) {
  return unit.empty() || unit == "1" ? std::string(name) : fmt::format("{} [{}]", name, unit);
}

std::string words_of(std::string_view identifier) {
  std::string words(identifier);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string share_bar(double share, std::string_view css_class) {
  return fmt::format(
      "<svg class=\"share-bar\" viewBox=\"0 0 100 10\" aria-hidden=\"true\"><rect class=\"rest\" "
      "width=\"100\" height=\"10\"/><rect class=\"{}\" width=\"{:.1f}\" height=\"10\"/></svg>",
      css_class, 100.0 * std::clamp(share, 0.0, 1.0));
}

std::string list_of(const std::vector<std::string>& texts, std::string_view css_class) {
  if (texts.empty()) {
    return {};
  }
  std::string html = fmt::format("<ul class=\"{}\">\n", css_class);
  for (const std::string& text : texts) {
    html += fmt::format("<li>{}</li>\n", escaped(text));
  }
  return html + "</ul>\n";
}

}  // namespace hysteron::diagnosis::report
