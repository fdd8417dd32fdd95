#include "diagnosis/report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

namespace hysteron::diagnosis::report {
namespace {

std::string text_of(std::string_view text) {
  const std::string json =
      nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);  // ASCII only
  std::string result;
  for (const char c : json) {
    result += c == '<' ? std::string("\\u003c") : std::string(1, c);
  }
  return result;
}

void add_number(std::string& json, double value) {
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(json), "{:.7g}", value);
  } else {
    json += "null";
  }
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

/// Start and step where the samples are evenly spaced, which says the same in fewer bytes; else every time.
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

std::string residual_of(const char* name, const std::vector<double>& model, const std::vector<double>& measured) {
  if (model.empty() || measured.empty()) {
    return {};
  }
  std::vector<double> residual(std::min(model.size(), measured.size()));
  for (std::size_t i = 0; i < residual.size(); ++i) {
    residual[i] = model[i] - measured[i];
  }
  return fmt::format(",\"{}\":{}", name, array_of(residual));
}

std::string trace_of(const Diagnosis& diagnosis, const Trace& trace) {
  double floor = 0.0;
  for (const GapFinding& gap : diagnosis.gaps) {
    floor = gap.signal == trace.signal ? gap.floor.value : floor;
  }
  if (diagnosis.gap.signal == trace.signal) {
    floor = diagnosis.gap.floor.value;
  }
  return fmt::format(R"({{"record":{},"signal":{},"unit":{},"floor":{},"time":{},"measured":{}{}{}{}}})",
                     text_of(trace.record), text_of(trace.signal), text_of(trace.unit), number_of(floor),
                     time_of(trace.time), array_of(trace.measured),
                     residual_of("nominal", trace.nominal, trace.measured),
                     residual_of("calibrated", trace.calibrated, trace.measured),
                     residual_of("improved", trace.improved, trace.measured));
}

std::string map_of(const MapFinding& map) {
  return fmt::format(R"({{"over":{},"unit":{},"share":{},"places":{},"before":{},"after":{},"mean":{}}})",
                     text_of(map.over), text_of(map.unit), number_of(map.share), array_of(map.places),
                     array_of(map.before), array_of(map.after), array_of(map.mean));
}

template <class Item, class Print>
std::string json_list(const std::vector<Item>& items, const Print& print) {
  std::string json = "[";
  for (const Item& item : items) {
    json += (json.size() == 1 ? "" : ",\n") + print(item);
  }
  return json + "]";
}

}  // namespace

std::string page_data(const Diagnosis& diagnosis) {
  const NextExperiment& next = diagnosis.next;
  return fmt::format(
      "{{\"unit\":{},\n\"traces\":{},\n\"maps\":{},\n\"next\":{{\"input\":{},\"unit\":{},\"time\":{},\"values\":{}}}}}",
      text_of(diagnosis.gap.unit),
      json_list(diagnosis.traces, [&](const Trace& trace) { return trace_of(diagnosis, trace); }),
      json_list(diagnosis.maps, map_of), text_of(next.input), text_of(next.unit), time_of(next.time),
      array_of(next.values));
}

}  // namespace hysteron::diagnosis::report
