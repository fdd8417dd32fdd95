#include "diagnosis/report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plots/json_text.hpp"

namespace hysteron::diagnosis::report {
namespace {

using plots::array_of;
using plots::json_list;
using plots::number_of;
using plots::text_of;
using plots::time_of;

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

std::string over_of(const Trace& trace) {
  if (trace.over.name.empty()) {
    return {};
  }
  return fmt::format(R"(,"over":{{"name":{},"unit":{},"values":{}}})", text_of(trace.over.name),
                     text_of(trace.over.unit), array_of(trace.over.values));
}

std::string trace_of(const Diagnosis& diagnosis, const Trace& trace) {
  double floor = 0.0;
  for (const GapFinding& gap : diagnosis.gaps) {
    floor = gap.signal == trace.signal ? gap.floor.value : floor;
  }
  if (diagnosis.gap.signal == trace.signal) {
    floor = diagnosis.gap.floor.value;
  }
  return fmt::format(R"({{"record":{},"signal":{},"unit":{},"floor":{},"time":{},"measured":{}{}{}{}{}}})",
                     text_of(trace.record), text_of(trace.signal), text_of(trace.unit), number_of(floor),
                     time_of(trace.time), array_of(trace.measured),
                     residual_of("nominal", trace.nominal, trace.measured),
                     residual_of("calibrated", trace.calibrated, trace.measured),
                     residual_of("improved", trace.improved, trace.measured), over_of(trace));
}

std::string map_of(const MapFinding& map) {
  return fmt::format(R"({{"over":{},"unit":{},"share":{},"places":{},"before":{},"after":{},"mean":{}}})",
                     text_of(map.over), text_of(map.unit), number_of(map.share), array_of(map.places),
                     array_of(map.before), array_of(map.after), array_of(map.mean));
}

std::string friction_of(const FrictionCurve& curve) {
  return fmt::format(R"({{"block":{},"forceUnit":{},"velocityUnit":{},"velocity":{},"force":{}}})",
                     text_of(curve.block), text_of(curve.force_unit), text_of(curve.velocity_unit),
                     array_of(curve.velocity), array_of(curve.force));
}

}  // namespace

std::string page_data(const Diagnosis& diagnosis) {
  const NextExperiment& next = diagnosis.next;
  return fmt::format(
      "{{\"unit\":{},\n\"traces\":{},\n\"frictions\":{},\n\"maps\":{},\n\"next\":{{\"input\":{},\"unit\":{},\"time\":{}"
      ",\"values\":{}}}}}",
      text_of(diagnosis.gap.unit),
      json_list(diagnosis.traces, [&](const Trace& trace) { return trace_of(diagnosis, trace); }),
      json_list(diagnosis.frictions, friction_of), json_list(diagnosis.maps, map_of), text_of(next.input),
      text_of(next.unit), time_of(next.time), array_of(next.values));
}

}  // namespace hysteron::diagnosis::report
