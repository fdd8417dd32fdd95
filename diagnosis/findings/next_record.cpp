#include "diagnosis/findings/next_record.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

namespace hysteron::diagnosis {

std::optional<NextRecord> next_record(const HeldOut& unseen, double noise, double scale) {
  std::vector<double> logs;
  double squares = 0.0;
  double rows = 0.0;
  for (std::size_t b = 0; b < unseen.squares.size(); ++b) {
    if (unseen.counts[b] > 0.0 && unseen.squares[b] > 0.0) {
      logs.push_back(0.5 * std::log(std::max(unseen.squares[b] / unseen.counts[b], noise * noise)));
    }
    squares += unseen.squares[b];
    rows += unseen.counts[b];
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
  return NextRecord{.rms = scale * std::sqrt(squares / rows),
                    .low = scale * std::exp(mean - half),
                    .high = scale * std::exp(mean + half)};
}

}  // namespace hysteron::diagnosis
