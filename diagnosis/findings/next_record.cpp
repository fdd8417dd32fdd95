#include "diagnosis/findings/next_record.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <vector>

namespace hysteron::diagnosis {

std::optional<NextRecord> next_record(const HeldOut& unseen, double noise, double scale) {
  const double squares = std::accumulate(unseen.squares.begin(), unseen.squares.end(), 0.0);
  const double rows = std::accumulate(unseen.counts.begin(), unseen.counts.end(), 0.0);
  const double least = noise * noise * rows <= squares ? noise * noise : 0.0;
  std::vector<double> logs;
  for (std::size_t b = 0; b < unseen.squares.size(); ++b) {
    if (unseen.counts[b] > 0.0 && unseen.squares[b] > 0.0) {
      logs.push_back(0.5 * std::log(std::max(unseen.squares[b] / unseen.counts[b], least)));
    }
  }
  constexpr std::size_t fewest = 3;
  if (logs.size() < fewest) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(logs.size());
  double mean = 0.0;
  for (const double one : logs) {
    mean += one / n;
  }
  double variance = 0.0;
  for (const double one : logs) {
    variance += (one - mean) * (one - mean) / (n - 1.0);
  }
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 0.975);
  const double half = t * std::sqrt(variance * (1.0 + 1.0 / n));
  const double rms = std::sqrt(squares / rows);
  return NextRecord{.rms = scale * rms,
                    .low = scale * std::min(std::exp(mean - half), rms),
                    .high = scale * std::max(std::exp(mean + half), rms)};
}

}  // namespace hysteron::diagnosis
