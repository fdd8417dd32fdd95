#include "diagnosis/evidence/driver_signals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "codegen/graph/units.hpp"
#include "diagnosis/effects/motions.hpp"
#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t widest = 256;

}  // namespace

double noise_of(const RecordSignals& values) {
  double sum = 0.0;
  double count = 0.0;
  for (const Signal& one : values) {
    for (std::size_t k = 3; k < one.size(); ++k) {
      const double third = one[k] - 3.0 * one[k - 1] + 3.0 * one[k - 2] - one[k - 3];
      sum += third * third / 20.0;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

namespace {

Signal slope(const Signal& values, std::size_t half, double sample_time) {
  const auto n = std::ssize(values);
  Signal result(values.size(), 0.0);
  const auto h = static_cast<std::ptrdiff_t>(half);
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const std::ptrdiff_t reach = std::min({h, k, n - 1 - k});
    if (reach == 0) {
      const std::ptrdiff_t a = std::clamp<std::ptrdiff_t>(k, 0, n - 2);
      result[static_cast<std::size_t>(k)] =
          n > 1 ? (values[static_cast<std::size_t>(a + 1)] - values[static_cast<std::size_t>(a)]) / sample_time : 0.0;
      continue;
    }
    double sum = 0.0;
    double squares = 0.0;
    for (std::ptrdiff_t i = 1; i <= reach; ++i) {
      const auto distance = static_cast<double>(i);
      sum += distance * (values[static_cast<std::size_t>(k + i)] - values[static_cast<std::size_t>(k - i)]);
      squares += 2.0 * distance * distance;
    }
    result[static_cast<std::size_t>(k)] = sum / (squares * sample_time);
  }
  return result;
}

double rms(const RecordSignals& values) {
  double sum = 0.0;
  double count = 0.0;
  for (const Signal& one : values) {
    for (const double value : one) {
      sum += value * value;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

/// Whether a straight line in other signals and their rates gives nine tenths of a signal's energy: the reference of a
/// loop beside the position that follows it.
bool is_follower(const RecordSignals& values, const std::vector<DriverSignal>& others) {
  Index rows = 0;
  for (const Signal& one : values) {
    rows += std::ssize(one);
  }
  MatrixXd columns(rows, std::ssize(others) + 1);
  VectorXd target(rows);
  const auto stack = [&](const RecordSignals& signals, auto&& into) {
    Index row = 0;
    for (const Signal& one : signals) {
      into.segment(row, std::ssize(one)) = Eigen::Map<const VectorXd>(one.data(), std::ssize(one));
      row += std::ssize(one);
    }
  };
  stack(values, target);
  for (std::size_t i = 0; i < others.size(); ++i) {
    VectorXd column(rows);
    stack(others[i].values, column);
    columns.col(static_cast<Index>(i)) = column / std::max(column.norm(), 1e-300);
  }
  columns.col(std::ssize(others)).setConstant(1.0 / std::sqrt(static_cast<double>(rows)));
  const double whole = (target.array() - target.mean()).matrix().squaredNorm();
  MatrixXd gram = columns.transpose() * columns;
  gram.diagonal().array() += 1e-10;
  const VectorXd weights = gram.ldlt().solve(columns.transpose() * target);
  return (target - columns * weights).squaredNorm() < (1.0 - policy::follower.value) * whole;
}

std::string rate_unit(const std::string& unit) {
  return unit.empty() ? std::string() : unit + "/s";
}

/// Whether two signals are one but for what a derivative filter or a sample makes of it: what the two differ by would
/// be a slope of it.
bool is_same(const DriverSignal& a, const DriverSignal& b) {
  double both = 0.0;
  double of_a = 0.0;
  double of_b = 0.0;
  for (std::size_t e = 0; e < a.values.size(); ++e) {
    for (std::size_t k = 0; k < a.values[e].size(); ++k) {
      both += a.values[e][k] * b.values[e][k];
      of_a += a.values[e][k] * a.values[e][k];
      of_b += b.values[e][k] * b.values[e][k];
    }
  }
  return a.unit == b.unit && both > 0.0 && both * both > policy::same_signal.value * of_a * of_b;
}

/// A signal and its rate; neither where it never moves.
void add(std::vector<DriverSignal>& list, DriverSignal signal, RecordSignals values, double sample_time) {
  signal.extent = extent_of(values, sample_time);
  if (!(signal.extent.range() > 0.0)) {
    return;
  }
  Rates rates = rates_of(values, sample_time);
  DriverSignal rate{.name = signal.name + "'",
                    .source = signal.source,
                    .is_rate = true,
                    .unit = rate_unit(signal.unit),
                    .of_unit = signal.unit,
                    .values = std::move(rates.values)};
  for (const Signal& one : rate.values) {
    rate.deviations.emplace_back(one.size(), rates.deviation);
  }
  rate.extent = extent_of(rate.values, sample_time);
  signal.values = std::move(values);
  for (DriverSignal* one : {&signal, &rate}) {
    if (std::ranges::none_of(list, [&](const DriverSignal& other) { return is_same(*one, other); })) {
      list.push_back(std::move(*one));
    }
  }
}

}  // namespace

Rates rates_of(const RecordSignals& values, double sample_time) {
  const double noise = noise_of(values);
  Rates result;
  for (std::size_t half = 1; half <= widest; half *= 2) {
    result.values.clear();
    for (const Signal& one : values) {
      result.values.push_back(slope(one, half, sample_time));
    }
    const auto h = static_cast<double>(half);
    result.deviation = noise / (sample_time * std::sqrt(h * (h + 1.0) * (2.0 * h + 1.0) / 3.0));
    if (result.deviation <= policy::quiet_slope.value * rms(result.values)) {
      break;
    }
  }
  return result;
}

std::vector<DriverSignal> measured_signals(const Task& task, const Program& program,
                                           const std::vector<std::string>& unused) {
  const Graph& graph = program.graph;
  const double sample_time = task.records.front().sample_time();
  std::vector<DriverSignal> result;
  const auto columns_of = [&](const std::string& name) {
    RecordSignals values;
    for (const records::Record& record : task.records) {
      values.push_back(record.column(name).values);
    }
    return values;
  };
  for (const Port& input : graph.inputs) {
    if (input.type == Type::Real && std::ranges::all_of(task.records, [&](const records::Record& record) {
          return record.find(input.name) != nullptr;
        })) {
      add(result, {.name = input.name, .source = DriverSignal::Source::Input, .unit = input.unit},
          columns_of(input.name), sample_time);
    }
  }
  for (const std::string& output : task.outputs) {
    const Port& port = *find_port(graph.outputs, output);
    add(result, {.name = port.name, .source = DriverSignal::Source::Output, .unit = port.unit}, columns_of(output),
        sample_time);
  }
  for (const std::string& column : unused) {
    const RecordSignals values = columns_of(column);
    const bool follows = is_follower(values, result);
    add(result, {.name = column, .source = DriverSignal::Source::Column, .is_follower = follows}, values, sample_time);
  }
  return result;
}

InnerSignals inner_signals(const Task& task, const Program& program) {
  const Graph& graph = program.graph;
  std::vector<Wire> told;  // by a column
  for (const std::string& output : task.outputs) {
    told.push_back(find_port(graph.outputs, output)->wire);
  }
  const std::vector<std::vector<std::string>> units = units::Solution(graph, program.schedule).outputs();
  InnerSignals result;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& node = graph.nodes[i];
    if (node.block == nullptr || node.block->states.empty() || node.block->about.group != Group::Dynamics ||
        node.block->about.name == "HY_DELAY") {
      continue;
    }
    for (std::size_t port = 0; port < node.block->outputs.size(); ++port) {
      const Wire wire{
          .from = Wire::From::Node, .port = static_cast<std::uint16_t>(port), .index = static_cast<std::uint32_t>(i)};
      if (node.block->outputs[port].type == Type::Real && std::ranges::find(told, wire) == told.end() &&
          may_be_velocity(&node, port)) {
        result.wires.push_back(wire);
        result.names.push_back(node.path + "." + std::string(node.block->outputs[port].name));
        result.units.push_back(units[i][port]);
      }
    }
  }
  return result;
}

void add_inner(std::vector<DriverSignal>& drivers, const InnerSignals& inner, std::vector<RecordSignals> values,
               double sample_time, std::vector<RecordSignals> deviations) {
  deviations.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    add(drivers,
        {.name = inner.names[i],
         .source = DriverSignal::Source::Wire,
         .unit = inner.units[i],
         .deviations = std::move(deviations[i])},
        std::move(values[i]), sample_time);
  }
}

}  // namespace hysteron::diagnosis
