#include "tuning/free_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "codegen/parameters/apply.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

using parameters::FitSetting;

class FreeParameters {
 public:
  FreeParameters(const Graph& graph, const parameters::ParameterFile& file, std::size_t records,
                 const std::vector<std::string>& units, Diagnostics& diagnostics)
      : graph_(graph), file_(file), records_(records), units_(units), diagnostics_(diagnostics) {}

  std::vector<FreeParameter> all() {
    for (const FitSetting& fit : file_.fits) {
      add_parameter(fit);
    }
    return std::move(result_);
  }

 private:
  void add_parameter(const FitSetting& fit) {
    const std::int64_t found = find_parameter(graph_, fit.path);
    if (found < 0) {
      return;  // reported where the file was applied
    }
    const Parameter& parameter = graph_.parameters[static_cast<std::size_t>(found)];
    const Field& field = parameter.field;
    if (field.type != Type::Real) {
      diagnostics_.error(error::wrong_value_type, fit.place,
                         fmt::format("{} is no real number and cannot be fitted.", parameter.path),
                         "try its few values one by one, each with a fit of the others.");
      return;
    }
    if (field.length > 1 && fit.start) {
      diagnostics_.error(error::wrong_value_type, fit.start->place,
                         fmt::format("{} is a list, and a start is a single number.", parameter.path),
                         "leave the start out and give the list under [parameters].");
      return;
    }
    for (std::size_t element = first_free(static_cast<std::uint32_t>(found)); element < elements_of(fit, parameter);
         ++element) {
      FreeParameter free{.parameter = static_cast<std::size_t>(found),
                         .element = element,
                         .name = field.length > 1 ? fmt::format("{}[{}]", parameter.path, element) : parameter.path,
                         .unit = units_[static_cast<std::size_t>(found)],
                         .place = fit.place,
                         .start = fit.start ? fit.start->value : parameter.value[element]};
      set_bounds(free, fit, field);
      add_for_records(std::move(free), fit);
    }
  }

  /// The first number that a record can tell: those before it only scale the others.
  [[nodiscard]] std::size_t first_free(std::uint32_t parameter) const {
    for (const Node& node : graph_.nodes) {
      for (std::size_t pin = node.block == nullptr ? 0 : node.block->inputs.size();
           node.block != nullptr && pin < node.wire_count; ++pin) {
        const Wire& wire = graph_.wire(node, pin);
        if (wire.from == Wire::From::Parameter && wire.index == parameter) {
          return scaling_numbers(*node.block, pin - node.block->inputs.size());
        }
      }
    }
    return 0;
  }

  /// Once, or once for each record.
  void add_for_records(FreeParameter free, const FitSetting& fit) {
    free.record = fit.record;
    if (!fit.by_record || records_ < 2) {
      result_.push_back(std::move(free));
      return;
    }
    for (std::size_t record = 0; record < records_; ++record) {
      FreeParameter own = free;
      own.record = record;
      own.name += fmt::format(" of record {}", record + 1);
      result_.push_back(std::move(own));
    }
  }

  /// Of a list, the elements that the file gives; all where it gives none.
  [[nodiscard]] std::size_t elements_of(const FitSetting& fit, const Parameter& parameter) const {
    const auto* const given = file_.find(fit.path);
    const auto* const list = given == nullptr ? nullptr : std::get_if<std::vector<double>>(&given->value);
    return list == nullptr ? parameter.value.size() : std::min(list->size(), parameter.value.size());
  }

  void set_bounds(FreeParameter& free, const FitSetting& fit, const Field& field) {
    free.lower = fit.minimum ? std::max(fit.minimum->value, field.minimum) : field.minimum;
    free.upper = fit.maximum ? std::min(fit.maximum->value, field.maximum) : field.maximum;
    if (!(free.lower <= free.start && free.start <= free.upper) ||
        !parameters::range_fault(field, free.start).empty()) {
      diagnostics_.error(error::contradicting_range, fit.start ? fit.start->place : fit.place,
                         fmt::format("The fit of {} would start at {}, outside of {} to {}.", free.name,
                                     number_text(free.start), number_text(free.lower), number_text(free.upper)),
                         "start inside of its range, or widen the range of the fit.");
      return;
    }
    if (field.above_minimum && free.lower <= field.minimum) {
      free.lower = field.minimum + 1e-6 * (free.start - field.minimum);  // the minimum itself is out of range
    }
    const double width = free.upper - free.lower;
    if (fit.scale) {
      free.typical = fit.scale->value;
    } else if (free.start != 0.0) {
      free.typical = std::fabs(free.start);
    } else if (std::isfinite(width) && width > 0.0) {
      free.typical = 0.5 * width;
    }
  }

  const Graph& graph_;
  const parameters::ParameterFile& file_;
  std::size_t records_;
  const std::vector<std::string>& units_;
  Diagnostics& diagnostics_;
  std::vector<FreeParameter> result_{};
};

}  // namespace

std::vector<FreeParameter> free_parameters(const Graph& graph, const parameters::ParameterFile& file,
                                           std::size_t records, const std::vector<std::string>& units,
                                           Diagnostics& diagnostics) {
  return FreeParameters(graph, file, records, units, diagnostics).all();
}

}  // namespace hysteron
