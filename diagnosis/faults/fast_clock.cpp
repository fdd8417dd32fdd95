#include "diagnosis/faults/fast_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "codegen/trace/block_type.hpp"
#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/projection.hpp"

namespace hysteron::diagnosis {
namespace {

/// In floors' energy: what a gap has at least, and what the mended record may leave.
constexpr double least_open = 4.0;
constexpr double most_open_then = 1.3;
/// Of what the calibrated diagram leaves, what the first mend may; and what is next to nothing, where the noise is less
/// than what reading between samples misses.
constexpr double most_left_first = 0.5;
constexpr double next_to_nothing = 0.01;
/// Samples that the clock is ahead at the end of the longest record.
constexpr double fewest_ahead = 0.5;
constexpr double most_ahead = 512.0;
constexpr int halvings = 24;
/// How often parameters and share are fitted in turn.
constexpr int rounds = 3;

/// By what share a clock may run fast and still be one.
double most_share() {
  const BlockType& clock = *find_block_type("HY_CLOCK");
  return -std::ranges::find(clock.params, "SKEW", &Field::name)->effect_minimum;
}

/// The signal at t/(1 + ahead), in samples.
Signal read_later(const Signal& signal, double ahead) {
  Signal result(signal.size());
  const auto last = std::ssize(signal) - 1;
  const auto at = [&](std::ptrdiff_t k) {
    return signal[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last))];
  };
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const double place = static_cast<double>(k) / (1.0 + ahead);
    const auto below = static_cast<std::ptrdiff_t>(place);
    const double u = place - static_cast<double>(below);
    const double a = at(below - 1);
    const double b = at(below);
    const double c = at(below + 1);
    const double d = at(below + 2);
    result[k] = b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
  }
  return result;
}

/// One output of a record, mended.
class Mend {
 public:
  Mend(const Task& task, std::size_t output) : task_(task), output_(output) {}

  [[nodiscard]] Task mended(double ahead) const {
    Task result = task_;
    for (records::Record& record : result.records) {
      record.replace(task_.outputs[output_], read_later(record.column(task_.outputs[output_]).values, ahead));
    }
    return result;
  }

  /// What the mend adds to residuals (model − measured)/scale.
  [[nodiscard]] VectorXd change(double ahead, Index rows) const {
    VectorXd result = VectorXd::Zero(rows);
    Index at = static_cast<Index>(output_) * (rows / std::ssize(task_.outputs));
    for (const records::Record& record : task_.records) {
      const Signal& measured = record.column(task_.outputs[output_]).values;
      const Signal later = read_later(measured, ahead);
      for (std::size_t k = 0; k < measured.size(); ++k) {
        result[at++] = (measured[k] - later[k]) / task_.scales[output_];
      }
    }
    return result;
  }

  [[nodiscard]] const std::string& name() const { return task_.outputs[output_]; }
  [[nodiscard]] std::size_t output() const { return output_; }

 private:
  const Task& task_;
  std::size_t output_;
};

struct Ahead {
  double share = 0.0;
  double left = std::numeric_limits<double>::infinity();  ///< beside what the known parameters make up
};

/// The share by which the clock is ahead that leaves least: from a grid, then between its neighbours.
Ahead best_ahead(const Mend& mend, const VectorXd& residuals, const Projection& known, double samples) {
  const auto left = [&](double share) {
    return known.rest(residuals + mend.change(share, residuals.size())).squaredNorm();
  };
  Ahead best;
  const double most = std::min(most_ahead, most_share() * samples);
  for (double ahead = fewest_ahead; ahead <= most; ahead *= std::sqrt(2.0)) {
    if (const double there = left(ahead / samples); there < best.left) {
      best = {.share = ahead / samples, .left = there};
    }
  }
  double low = best.share / std::sqrt(2.0);
  double high = best.share * std::sqrt(2.0);
  for (int i = 0; i < halvings; ++i) {
    const double first = low + (high - low) / 3.0;
    const double second = high - (high - low) / 3.0;
    if (left(first) < left(second)) {
      high = second;
    } else {
      low = first;
    }
  }
  const double share = 0.5 * (low + high);
  return {.share = share, .left = left(share)};
}

}  // namespace

std::optional<FastClock> fast_clock(const Task& task, const Program& program) {
  if (!task.left_out.empty()) {
    return std::nullopt;
  }
  Model model(task, program);
  const auto rows = static_cast<double>(model.rows());
  VectorXd as_tuned;
  if (!model.residuals(model.start(), as_tuned) || as_tuned.squaredNorm() < least_open * rows) {
    return std::nullopt;  // a fit leaves no more
  }
  Fit at = fit(model, model.start(), {.iterations = 20});
  const double open = at.residuals.squaredNorm();
  if (!std::isfinite(at.cost) || open < least_open * rows) {
    return std::nullopt;
  }
  const auto samples = static_cast<double>(std::ranges::max(model.samples()));
  const auto known = [&] { return Projection(at.jacobian, model.prior()); };
  std::optional<Mend> best;
  Ahead ahead;
  // About the parameters as tuned, too: a record ahead of its time bends those that are fitted to it.
  for (const VectorXd& about : {at.x, model.start()}) {
    if (!model.residuals(about, at.residuals, &at.jacobian)) {
      continue;
    }
    const Projection beside = known();
    for (std::size_t output = 0; output < task.outputs.size(); ++output) {
      const Mend mend(task, output);
      if (const Ahead found = best_ahead(mend, at.residuals, beside, samples); found.left < ahead.left) {
        best.emplace(mend);
        ahead = found;
        at.x = about;
      }
    }
  }
  if (!(ahead.left < most_left_first * open)) {
    return std::nullopt;
  }
  for (int round = 0; round < rounds; ++round) {
    const Task mended = best->mended(ahead.share);
    Model beside(mended, program);
    at = fit(beside, at.x, {.iterations = 20});
    if (!std::isfinite(at.cost) || !model.residuals(at.x, at.residuals, &at.jacobian)) {
      return std::nullopt;
    }
    ahead = best_ahead(*best, at.residuals, known(), samples);
  }
  if (!(ahead.left < std::max(most_open_then * rows, next_to_nothing * open))) {
    return std::nullopt;
  }
  const VectorXd change = best->change(ahead.share, at.residuals.size());
  const double step = 0.01 * ahead.share;
  const VectorXd slope = (best->change(ahead.share + step, at.residuals.size()) - change) / step;
  const double error = 1.96 / std::max(known().rest(slope).norm(), 1e-300);
  const double scale = task.scales[best->output()];
  return FastClock{
      .task = best->mended(ahead.share),
      .finding = {
          .effect = "clock",
          .output = best->output(),
          .rms = scale * change.norm() / std::sqrt(rows / static_cast<double>(task.outputs.size())),
          .remark = fmt::format("The clock of {} runs fast by {:.3g} %, {:.2g} samples at the end of the record. "
                                "No diagram knows what comes: the record is mended before the fits, and improved.st "
                                "is for one with the right time stamps.",
                                best->name(), 100.0 * ahead.share, ahead.share * samples),
          .parameters = {{.name = "SKEW",
                          .value = -ahead.share,
                          .low = -ahead.share - error,
                          .high = -ahead.share + error,
                          .unit = "1"}}}};
}

}  // namespace hysteron::diagnosis
