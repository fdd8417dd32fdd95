#include "diagnosis/findings/control_loop.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "blocks/families.hpp"
#include "diagnosis/policy.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

/// Costs alone: a swing has come again a thousand times by then.
constexpr std::size_t longest = std::size_t{1} << 16U;
/// Samples of the past that a regression has of each signal: what a controller and a prediction need.
constexpr Index past = 5;
/// Of its size, the spread of a signal that stands still.
constexpr double still = 1e-9;

/// Without its straight line, of unit spread; zero where it stands still.
VectorXd centred(std::span<const double> values) {
  const auto count = std::ssize(values);
  VectorXd result = Eigen::Map<const VectorXd>(values.data(), count);
  const double size = result.cwiseAbs().maxCoeff();
  const VectorXd along = VectorXd::LinSpaced(count, -1.0, 1.0);
  result.array() -= result.mean();
  result -= along * (along.dot(result) / along.squaredNorm());
  const double spread = result.norm() / std::sqrt(static_cast<double>(count));
  if (!(spread > still * size) || !std::isfinite(spread)) {
    return VectorXd::Zero(count);
  }
  return result / spread;
}

bool is_long_enough(std::span<const double> input, std::span<const double> output) {
  constexpr std::size_t fewest = 4 * static_cast<std::size_t>(past) + 4;
  return input.size() == output.size() && input.size() >= fewest;
}

/// By Hann's window, so that a change between begin and end is no swing; followed by as many zeros.
std::vector<std::complex<double>> spectrum(const VectorXd& signal, Eigen::FFT<double>& fft) {
  const auto count = static_cast<std::size_t>(signal.size());
  std::vector<double> values(2 * count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count - 1);
    values[k] = 0.5 * (1.0 - std::cos(turn)) * signal[static_cast<Index>(k)];
  }
  std::vector<std::complex<double>> result;
  fft.fwd(result, values);
  return result;
}

/// Squares of a signal that five samples of its own past do not tell, nor as many of another one from `lag` ago on.
struct Untold {
  double by_itself = 0.0;
  double with_other = 0.0;
};
Untold untold(const VectorXd& signal, const VectorXd& other, Index lag) {
  const Index rows = signal.size() - past;
  MatrixXd known(rows, 2 * past + 1);
  known.col(past).setOnes();
  for (Index i = 0; i < past; ++i) {
    known.col(i) = signal.segment(past - 1 - i, rows);
    known.col(past + 1 + i) = other.segment(past - i - lag, rows);
  }
  const VectorXd wanted = signal.tail(rows);
  const auto left_by = [&](const MatrixXd& list) {
    return (wanted - list * list.colPivHouseholderQr().solve(wanted)).squaredNorm();
  };
  return {.by_itself = left_by(known.leftCols(past + 1)), .with_other = left_by(known)};
}

/// Of one stretch.
double feedback_in(std::span<const double> input, std::span<const double> output) {
  if (!is_long_enough(input, output)) {
    return 0.0;
  }
  const VectorXd u = centred(input);
  const VectorXd y = centred(output);
  if (u.isZero(0.0) || y.isZero(0.0)) {
    return 0.0;
  }
  const Untold left = untold(u, y, 0);
  // Of a line, a sine or a staircase without noise its own past tells all: there is nothing to follow.
  const double nothing = still * static_cast<double>(u.size());
  return left.by_itself > nothing ? std::clamp(1.0 - left.with_other / left.by_itself, 0.0, 1.0) : 0.0;
}

bool moves(const records::Record& record, const Port& input) {
  const records::Column* const column = record.find(input.name);
  return column != nullptr &&
         std::ranges::adjacent_find(column->values, std::ranges::not_equal_to()) != column->values.end();
}

/// The input that columns drive and that moves; nothing where there are several, or where a record has no column for
/// it.
const Port* lone_input(const Task& task, const Graph& graph) {
  const Port* result = nullptr;
  for (const Port& input : graph.inputs) {
    const auto moves_in = [&](const records::Record& record) { return moves(record, input); };
    if (input.type == Type::Real && std::ranges::any_of(task.records, moves_in)) {
      if (result != nullptr) {
        return nullptr;
      }
      result = &input;
    }
  }
  const bool is_everywhere = result != nullptr && std::ranges::all_of(task.records, [&](const records::Record& record) {
                               return record.find(result->name) != nullptr;
                             });
  return is_everywhere ? result : nullptr;
}

/// What the output of the diagram does in the very sample in which the input moves by 1, after a rest. The input moves
/// in the record.
double answer_at_once(const Program& program, const Port& input, const records::Record& record,
                      const std::string& output) {
  constexpr std::size_t rest = 10;  // a block may take its first sample for what was before
  const auto at = static_cast<std::size_t>(&input - program.graph.inputs.data());
  const auto [low, high] = std::ranges::minmax(record.column(input.name).values);
  Drive drive{.steps = rest + 1, .sample_time = record.sample_time()};
  for (const Port& one : program.graph.inputs) {
    drive.inputs.push_back({one.preset});
  }
  const std::vector<Wire> watched{find_port(program.graph.outputs, output)->wire};
  drive.inputs[at] = {low};
  const double before = interpret(program, drive, watched).front().back();
  drive.inputs[at].assign(drive.steps, low);
  drive.inputs[at].back() = high;
  return (interpret(program, drive, watched).front().back() - before) / (high - low);
}

/// Of an output, the share that follows from the input's past, and of the rest what a plant that answers at once has
/// from the input.
struct Answered {
  double by_past = 0.0;
  double at_once = 0.0;
};
Answered answered_by(std::span<const double> input, std::span<const double> output, double at_once) {
  if (!is_long_enough(input, output)) {
    return {};
  }
  const auto as_it_is = [](std::span<const double> values) -> VectorXd {
    return Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
  };
  const VectorXd u = as_it_is(input);
  const VectorXd y = as_it_is(output);
  const double of_input = at_once * at_once * untold(u, y, 1).with_other;
  const Untold of_output = untold(y, u, 1);
  return {.by_past = of_output.by_itself > 0.0 ? 1.0 - of_output.with_other / of_output.by_itself : 0.0,
          .at_once = of_input > 0.0 ? of_input / std::max(of_input, of_output.with_other) : 0.0};
}

std::span<const double> part_of(const std::vector<double>& values) {
  return std::span(values).first(std::min(values.size(), longest));
}

}  // namespace

double feedback_share(std::span<const double> input, std::span<const double> output) {
  constexpr std::size_t stretches = 8;
  std::vector<double> shares;
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t begin = i * input.size() / stretches;
    const std::size_t size = (i + 1) * input.size() / stretches - begin;
    if (input.size() == output.size()) {
      shares.push_back(feedback_in(input.subspan(begin, size), output.subspan(begin, size)));
    }
  }
  std::ranges::sort(shares);
  return shares.empty() ? 0.0 : 0.5 * (shares[(stretches - 1) / 2] + shares[stretches / 2]);
}

double oddness(std::span<const double> input, std::span<const double> output) {
  constexpr double open = 0.5;
  constexpr std::size_t fewest = 4;  // periods: what came fewer times is no swing
  if (!is_long_enough(input, output)) {
    return open;
  }
  Eigen::FFT<double> fft;
  const std::vector<std::complex<double>> u = spectrum(centred(input), fft);
  const std::vector<std::complex<double>> y = spectrum(centred(output), fft);
  double odd = 0.0;
  double all = 0.0;
  for (std::size_t k = 2 * fewest; k <= input.size(); ++k) {  // two lines a period, by the zeros
    const std::complex<double> both = y[k] * std::conj(u[k]);
    odd += both.imag() * both.imag();
    all += std::norm(both);
  }
  return all > 0.0 ? odd / all : open;
}

std::optional<LoopFinding> control_loop(const Task& task, const Program& program, Rules& rules) {
  const Port* const input = lone_input(task, program.graph);
  if (input == nullptr || task.outputs.size() != 1) {
    return std::nullopt;
  }
  LoopFinding result{.input = input->name, .output = task.outputs.front()};
  const auto signals_of = [&](const records::Record& record) {
    return std::pair(part_of(record.column(result.input).values), part_of(record.column(result.output).values));
  };
  double samples = 0.0;
  for (const records::Record& record : task.records) {
    const auto [u, y] = signals_of(record);
    result.feedback += static_cast<double>(u.size()) * feedback_share(u, y);
    samples += static_cast<double>(u.size());
  }
  result.feedback /= samples;
  if (!rules.is_above(policy::fed_back, result.feedback, result.input)) {
    return std::nullopt;
  }
  const auto moving =
      std::ranges::find_if(task.records, [&](const records::Record& record) { return moves(record, *input); });
  const double at_once = answer_at_once(program, *input, *moving, result.output);
  Answered answered;
  result.oddness = 0.0;
  for (const records::Record& record : task.records) {
    const auto [u, y] = signals_of(record);
    const double part = static_cast<double>(u.size()) / samples;
    const Answered here = answered_by(u, y, at_once);
    answered.by_past += part * here.by_past;
    answered.at_once += part * here.at_once;
    result.oddness += part * oddness(u, y);
  }
  // Both shares are of squares.
  if (answered.by_past > result.feedback ||
      answered.at_once > policy::at_once.value * policy::at_once.value * result.feedback) {
    return std::nullopt;
  }
  return result;
}

bool is_sticking(std::string_view family) {
  return family == name_of(Family::DryFriction) || family == name_of(Family::Play);
}

double with_loop(const LoopFinding& loop, double probability, bool sticks) {
  const double own = sticks ? loop.oddness : 1.0 - loop.oddness;
  const double both = probability * own + (1.0 - probability) * (1.0 - own);
  return both > 0.0 ? probability * own / both : probability;
}

std::string sentence_of(const LoopFinding& loop) {
  constexpr double clear = 2.0 / 3.0;  // for words alone: two to one
  const bool is_slow = loop.oddness > clear;
  const bool is_fast = 1.0 - loop.oddness > clear;
  return fmt::format(
      "{} follows {}, as a controller sets it ({:.0f} % of what its own past does not tell). The loop swings {} the "
      "corner of "
      "that controller (odd share {:.2f}){}.",
      loop.input, loop.output, 100.0 * loop.feedback,
      is_slow   ? "more slowly than"
      : is_fast ? "faster than"
                : "near",
      loop.oddness,
      is_slow   ? ": as where a valve sticks, or a disturbance is as slow"
      : is_fast ? ": as where it is tightly tuned or disturbed, and hardly as where a valve sticks"
                : ", which tells little of the valve");
}

}  // namespace hysteron::diagnosis
