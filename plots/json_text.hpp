// JSON as it stands in a page: seven digits, which a plot cannot tell from more, and null for what is not finite.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hysteron::plots {

/// A text in quotes, in ASCII, that ends no element of a page.
[[nodiscard]] std::string text_of(std::string_view text);
[[nodiscard]] std::string number_of(double value);
[[nodiscard]] std::string array_of(const std::vector<double>& values);

/// Start and step where the samples are evenly spaced, which says the same in fewer bytes; else every time.
[[nodiscard]] std::string time_of(const std::vector<double>& time);

template <class Item, class Print>
std::string json_list(const std::vector<Item>& items, const Print& print) {
  std::string json = "[";
  for (const Item& item : items) {
    json += (json.size() == 1 ? "" : ",\n") + print(item);
  }
  return json + "]";
}

}  // namespace hysteron::plots
