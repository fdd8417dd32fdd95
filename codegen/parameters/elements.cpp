#include "codegen/parameters/elements.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "codegen/parameters/apply.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::parameters {
namespace {

class ByElement {
 public:
  ByElement(const Graph& graph, Diagnostics& diagnostics) : diagnostics_(diagnostics) {
    for (const Parameter& parameter : graph.parameters) {
      if (const auto element = element_of(parameter.path)) {
        vectors_[std::string(element->vector)].push_back(&parameter.field);
      }
    }
  }

  [[nodiscard]] std::vector<ParameterValue> values(const std::vector<ParameterValue>& all) {
    std::vector<ParameterValue> result;
    for (const ParameterValue& given : all) {
      if (const auto* const fields = fields_of(given.path)) {
        add_elements(given, *fields, result);
      } else {
        result.push_back(given);
      }
    }
    return without_doubles(std::move(result));
  }

  [[nodiscard]] std::vector<FitSetting> fits(const std::vector<FitSetting>& all) {
    std::vector<FitSetting> result;
    for (const FitSetting& given : all) {
      const auto* const fields = fields_of(given.path);
      for (std::size_t i = 0; fields != nullptr && i < fields->size(); ++i) {
        result.push_back(given);
        result.back().path = element_name(given.path, static_cast<std::int64_t>(i));
      }
      if (fields == nullptr) {
        result.push_back(given);
      }
    }
    return without_doubles(std::move(result));
  }

 private:
  using Fields = std::vector<const Field*>;

  [[nodiscard]] const Fields* fields_of(const std::string& path) const {
    const auto found = vectors_.find(in_capitals(path));
    return found == vectors_.end() ? nullptr : &found->second;
  }

  void add_elements(const ParameterValue& given, const Fields& fields, std::vector<ParameterValue>& result) {
    std::vector<Value> values;
    if (const auto* const numbers = std::get_if<std::vector<double>>(&given.value)) {
      for (const double number : *numbers) {
        // A number is no BOOL, whichever it is: the message of a single value says so.
        const bool truth = fields.front()->type == Type::Bool;
        values.push_back(truth ? Value(number) : value_for(*fields.front(), number));
      }
    } else if (const auto* const truths = std::get_if<std::vector<bool>>(&given.value)) {
      values.assign(truths->begin(), truths->end());
    } else {
      wrong_length(given, fields, "a single value");
      return;
    }
    if (values.size() != fields.size()) {
      wrong_length(given, fields, fmt::format("{}", values.size()));
      return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      result.push_back(given);
      result.back().path = element_name(given.path, static_cast<std::int64_t>(i));
      result.back().value = std::move(values[i]);
    }
  }

  void wrong_length(const ParameterValue& given, const Fields& fields, const std::string& here) {
    diagnostics_.error(
        error::wrong_value_type, given.value_place,
        fmt::format("{} is a vector of {} elements, and here is {}.", given.path, fields.size(), here),
        fmt::format("give each element a value, as in {} = [{}, …].", given.path.substr(given.path.rfind('.') + 1),
                    fields.front()->type == Type::Bool   ? "true"
                    : fields.front()->type == Type::Real ? "1.0"
                                                         : "1"));
  }

  static std::string key_of(const ParameterValue& value) { return in_capitals(value.path); }
  /// Who has taken records apart has a fit of one path for each.
  static std::string key_of(const FitSetting& fit) {
    return fit.record ? fmt::format("{} of {}", in_capitals(fit.path), *fit.record) : in_capitals(fit.path);
  }
  /// The reader has refused a name that stands twice; here two names may mean one element.
  template <class Item>
  std::vector<Item> without_doubles(std::vector<Item> items) {
    std::map<std::string, Place> seen;
    std::vector<Item> result;
    for (Item& item : items) {
      const auto [first, fresh] = seen.emplace(key_of(item), item.place);
      if (fresh) {
        result.push_back(std::move(item));
        continue;
      }
      diagnostics_.error(error::duplicate_key, item.place,
                         fmt::format("{} is given twice: alone, and with its whole vector.", item.path),
                         "keep one of the two.", {{.place = first->second, .text = "the first"}});
    }
    return result;
  }

  std::map<std::string, Fields> vectors_;  // by path in capitals; elements in order
  Diagnostics& diagnostics_;
};

/// Outputs by name; of a vector, each of its elements.
std::vector<PlacedText> outputs_of(const std::vector<PlacedText>& wanted, const Graph& graph,
                                   Diagnostics& diagnostics) {
  std::vector<PlacedText> result;
  std::set<std::string> seen;
  for (const PlacedText& one : wanted) {
    bool known = false;
    for (const Port& output : graph.outputs) {
      if (is_or_is_element_of(output.name, one.text)) {
        known = true;
        const bool same = equal_ignoring_case(output.name, one.text);  // then as the user writes it
        if (seen.insert(output.name).second) {
          result.push_back({.text = same ? one.text : output.name, .place = one.place});
        } else {
          diagnostics.error(error::duplicate_key, one.place,
                            fmt::format("{} stands in the list twice: alone, and with its whole vector.", output.name),
                            "keep one of the two.");
        }
      }
    }
    if (!known) {
      result.push_back(one);  // told by who looks for it
    }
  }
  return result;
}

}  // namespace

ParameterFile by_element(ParameterFile file, const Graph& graph, Diagnostics& diagnostics) {
  ByElement rewrite(graph, diagnostics);
  file.values = rewrite.values(file.values);
  file.fits = rewrite.fits(file.fits);
  file.tune.outputs = outputs_of(file.tune.outputs, graph, diagnostics);
  return file;
}

ParameterFile by_element(ParameterFile file, const Graph& graph) {
  Diagnostics diagnostics;
  file = by_element(std::move(file), graph, diagnostics);
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
  return file;
}

}  // namespace hysteron::parameters
