#include "fleet/report/trend.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "fleet/report/statistics.hpp"
#include "support/median.hpp"

namespace hysteron::fleet {
namespace {

/// Places that a change is looked for; of more records, these are spread evenly over them.
constexpr std::size_t most_places = 24;

/// Below this share of its size a number is one of rounding, not of a measurement.
constexpr double rounding = 1e-9;

std::size_t times_in(const Series& series) {
  return std::set<double>(series.time.begin(), series.time.end()).size();
}

/// 0 before the change and above behind it, so that y = a + b·h is the form.
std::vector<double> shape_of(const Series& series, Change change, std::size_t place) {
  std::vector<double> h;
  for (const double t : series.time) {
    const double behind = t - series.time[place];
    h.push_back(change == Change::Step ? (behind >= 0.0 ? 1.0 : 0.0) : std::max(0.0, behind));
  }
  return h;
}

struct Line {
  double a = 0.0;
  double b = 0.0;
  double t = 0.0;  ///< b over its standard deviation; 0 where the points do not tell
};

/// y = a + b·h by least squares with weights 1/σ²; without the point `without`.
Line fitted(const std::vector<double>& h, const std::vector<double>& y, const std::vector<double>& sigma,
            std::size_t without) {
  double w = 0.0;
  double mean_h = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (i == without) {
      continue;
    }
    const double weight = 1.0 / (sigma[i] * sigma[i]);
    w += weight;
    mean_h += weight * (h[i] - mean_h) / w;
    mean_y += weight * (y[i] - mean_y) / w;
  }
  double hh = 0.0;
  double hy = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double weight = i == without ? 0.0 : 1.0 / (sigma[i] * sigma[i]);
    hh += weight * (h[i] - mean_h) * (h[i] - mean_h);
    hy += weight * (h[i] - mean_h) * (y[i] - mean_y);
  }
  if (!(hh > 0.0)) {
    return {.a = mean_y};
  }
  return {.a = mean_y - hy / hh * mean_h, .b = hy / hh, .t = hy / std::sqrt(hh)};
}

/// No record is left out.
constexpr std::size_t no_record = static_cast<std::size_t>(-1);

struct Form {
  Change change = Change::None;
  std::size_t place = 0;
  Line line{};
};

std::vector<double> residuals_of(const Series& series, const std::vector<double>& h, const Line& line) {
  std::vector<double> result;
  for (std::size_t i = 0; i < h.size(); ++i) {
    result.push_back(series.value[i] - line.a - line.b * h[i]);
  }
  return result;
}

/// Standard deviation about the form; three numbers are taken from the points: a, b and the place.
double own_scatter(const Series& series, const Form& form) {
  const auto residuals = residuals_of(series, shape_of(series, form.change, form.place), form.line);
  const auto n = static_cast<double>(residuals.size());
  double sum = 0.0;
  for (const double r : residuals) {
    sum += r * r;
  }
  return n > 3.0 ? std::sqrt(sum / (n - 3.0)) : 0.0;
}

std::vector<double> deviations_of(const Series& series, double at_least) {
  std::vector<double> absolute;
  for (const double y : series.value) {
    absolute.push_back(std::abs(y));
  }
  const double floor = std::max(rounding * median(absolute), 1e-300);
  std::vector<double> result;
  for (const double error : series.error) {
    result.push_back(std::max({std::isfinite(error) ? error : 0.0, std::isfinite(at_least) ? at_least : 0.0, floor}));
  }
  return result;
}

/// Where a change may begin: at each record but the last for a ramp, at each but the first for a step.
std::vector<Form> forms_of(const Series& series) {
  const std::size_t n = series.time.size();
  const std::size_t stride = (n + most_places - 1) / most_places;
  std::vector<Form> forms;
  for (std::size_t k = 0; k < n; k += stride) {
    if (series.time[k] < series.time.back()) {
      forms.push_back({.change = Change::Ramp, .place = k});
    }
    if (series.time[k] > series.time.front() && (k == 0 || series.time[k] > series.time[k - 1])) {
      forms.push_back({.change = Change::Step, .place = k});
    }
  }
  return forms;
}

}  // namespace

Scatter scatter_of(const std::vector<Series>& machines) {
  std::vector<double> distances;
  double machines_counted = 0.0;
  for (const Series& series : machines) {
    if (times_in(series) < least_records) {
      continue;
    }
    const double slope = theil_sen_slope(series.time, series.value);
    std::vector<double> rest;
    for (std::size_t i = 0; i < series.value.size(); ++i) {
      rest.push_back(series.value[i] - slope * (series.time[i] - series.time.front()));
    }
    const double middle = median(rest);
    for (const double r : rest) {
      distances.push_back(std::abs(r - middle));
    }
    machines_counted += 1.0;
  }
  const auto n = static_cast<double>(distances.size());
  const double freedom = n - 2.0 * machines_counted;
  if (freedom <= 0.0) {
    return {};
  }
  return {.deviation = deviation_of_median * median(distances) * std::sqrt(n / freedom), .freedom = freedom};
}

Trend trend_of(const Series& series, const Scatter& scatter) {
  Trend trend{.slope = theil_sen_slope(series.time, series.value)};
  if (times_in(series) < least_records || !(scatter.freedom > 0.0)) {
    return trend;
  }
  const auto forms = forms_of(series);
  std::vector<double> sigma = deviations_of(series, scatter.deviation);
  Form best;
  for (Form form : forms) {
    form.line = fitted(shape_of(series, form.change, form.place), series.value, sigma, no_record);
    if (best.change == Change::None || std::abs(form.line.t) > std::abs(best.line.t)) {
      best = form;
    }
  }
  sigma = deviations_of(
      series, std::max(std::isfinite(scatter.deviation) ? scatter.deviation : 0.0, own_scatter(series, best)));
  const auto h = shape_of(series, best.change, best.place);
  best.line = fitted(h, series.value, sigma, no_record);
  double least = std::abs(best.line.t);
  for (std::size_t without = 0; without < h.size(); ++without) {
    const Line left = fitted(h, series.value, sigma, without);
    least = std::min(least, left.b * best.line.b > 0.0 ? std::abs(left.t) : 0.0);
  }
  trend.change = best.change;
  trend.since = series.time[best.place];
  trend.from = best.line.a;
  trend.to = best.line.a + best.line.b * h.back();
  trend.p = std::min(1.0, student_both_tails(least, scatter.freedom) * static_cast<double>(forms.size()));
  return trend;
}

}  // namespace hysteron::fleet
