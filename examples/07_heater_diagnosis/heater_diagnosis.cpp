#include "examples/07_heater_diagnosis/heater_diagnosis.hpp"

#include <cmath>
#include <numeric>
#include <span>

#include "examples/example.hpp"
#include "records/data_folder.hpp"
#include "records/read.hpp"

namespace hysteron::examples {
namespace {

constexpr std::size_t stride = 5;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::optional<records::Record> heater_record() {
  const auto path = records::find_record("tclab-thermal/prbs_open_loop.csv", path_of("..").lexically_normal());
  if (!path) {
    return std::nullopt;
  }
  const records::Record measured = records::read_record(path->string());
  const std::size_t first = measured.rows_between(400.0, 1e9).first;
  const std::size_t rows = (measured.size() - first + stride - 1) / stride;
  records::Record thin =
      records::Record::even(measured.time()[first], static_cast<double>(stride) * measured.sample_time(), rows);
  for (const records::Column& column : measured.columns()) {
    records::Column kept{.name = column.name, .unit = column.unit};
    for (std::size_t k = first; k < measured.size(); k += stride) {
      kept.values.push_back(column.values[k]);
    }
    thin.add(std::move(kept));
  }
  return thin;
}

const std::vector<std::string>& hysteretic_effects() {
  static const std::vector<std::string> effects{"backlash", "coulomb_friction", "creep", "dead_zone",
                                                "stribeck_friction"};
  return effects;
}

const std::vector<std::string>& effects_of_heaters() {
  static const std::vector<std::string> effects = [] {
    std::vector<std::string> all{"cross_coupling", "delay",      "drift",      "even_nonlinearity",
                                 "gain_drift",     "lag",        "load",       "odd_nonlinearity",
                                 "rate_limit",     "relaxation", "saturation", "thermal_drift"};
    all.insert(all.end(), hysteretic_effects().begin(), hysteretic_effects().end());
    return all;
  }();
  return effects;
}

std::vector<double> heater_gaps(const Round& round, const records::Record& record) {
  std::vector<double> gaps;
  for (const std::vector<double>& residual : residuals_of(round, record)) {
    gaps.push_back(rms(std::span(residual).subspan(1)));
  }
  return gaps;
}

double left_by_a_line(const records::Record& record, const std::string& input, const std::string& output) {
  const std::vector<double>& u = record.column(input).values;
  const std::vector<double>& y = record.column(output).values;
  const double middle_u = mean(u);
  const double middle_y = mean(y);
  double uu = 0.0;
  double uy = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    uu += (u[k] - middle_u) * (u[k] - middle_u);
    uy += (u[k] - middle_u) * (y[k] - middle_y);
  }
  std::vector<double> left;
  for (std::size_t k = 0; k < u.size(); ++k) {
    left.push_back(y[k] - middle_y - uy / uu * (u[k] - middle_u));
  }
  return rms(left) / range(y);
}

}  // namespace hysteron::examples
