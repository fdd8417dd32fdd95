#include "plots/json_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace hysteron::plots {
namespace {

void add_number(std::string& json, double value) {
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(json), "{:.7g}", value);
  } else {
    json += "null";
  }
}

}  // namespace

std::string text_of(std::string_view text) {
  const std::string json =
      nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);  // ASCII only
  std::string result;
  for (const char c : json) {
    result += c == '<' ? std::string("\\u003c") : std::string(1, c);
  }
  return result;
}

std::string number_of(double value) {
  std::string json;
  add_number(json, value);
  return json;
}

std::string array_of(const std::vector<double>& values) {
  std::string json = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    json += i == 0 ? "" : ",";
    add_number(json, values[i]);
  }
  return json + "]";
}

std::string time_of(const std::vector<double>& time) {
  const std::size_t count = time.size();
  const double step = count > 1 ? (time.back() - time.front()) / static_cast<double>(count - 1) : 0.0;
  bool even = count > 1;
  for (std::size_t i = 0; i < count && even; ++i) {
    even = std::fabs(time[i] - time.front() - step * static_cast<double>(i)) <= 0.01 * step;
  }
  return even ? fmt::format(R"({{"start":{},"step":{:.12g},"count":{}}})", number_of(time.front()), step, count)
              : fmt::format("{{\"values\":{}}}", array_of(time));
}

}  // namespace hysteron::plots
