#include "diagnosis/model/limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

using Limits = std::vector<std::pair<std::string, double>>;

class LimitReader {
 public:
  explicit LimitReader(const Graph& graph) {
    for (const Port& input : graph.inputs) {
      if (input.type == Type::Real) {
        inputs_.push_back(input.name);
      }
    }
  }

  Limits read(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      add(text);
    }
    for (const auto& [name, low] : limits_) {
      const double* const high = name.ends_with(".low") ? find(name.substr(0, name.size() - 3) + "high") : nullptr;
      if (high != nullptr && !(low < *high)) {
        refuse(fmt::format("--limit {} is {}, and its upper end {}.", name, low, *high),
               "give a range: low below high.");
      }
    }
    return std::move(limits_);
  }

 private:
  [[noreturn]] static void refuse(std::string cause, std::string mend) {
    throw InputError(error::bad_usage, {}, std::move(cause), std::move(mend));
  }

  [[nodiscard]] const double* find(std::string_view name) const {
    const auto found =
        std::ranges::find_if(limits_, [&](const auto& limit) { return equal_ignoring_case(limit.first, name); });
    return found == limits_.end() ? nullptr : &found->second;
  }

  void add(const std::string& text) {
    const auto equals = text.find('=');
    const ParsedNumber number =
        parse_number(equals == std::string::npos ? std::string_view() : std::string_view(text).substr(equals + 1));
    if (equals == std::string::npos || equals == 0 || number.status != NumberStatus::Finite) {
      refuse(fmt::format("--limit {} is no limit.", text), "write --limit U=5.0: the input and its largest size.");
    }
    const std::string name = text.substr(0, equals);
    const auto dot = name.rfind('.');
    const std::string part = in_capitals(dot == std::string::npos ? "" : name.substr(dot + 1));
    if (!part.empty() && part != "LOW" && part != "HIGH" && part != "RATE") {
      refuse(fmt::format("--limit {} limits no part of an input.", text), "write U, U.low, U.high or U.rate.");
    }
    const std::string input = name.substr(0, dot);
    if (std::ranges::none_of(inputs_, [&](const std::string& one) { return equal_ignoring_case(one, input); })) {
      const std::string_view near = nearest_name(input, inputs_);
      refuse(fmt::format("--limit {}: the diagram has no real input {}.", text, input),
             near.empty() ? fmt::format("its inputs are {}.", fmt::join(inputs_, ", "))
                          : fmt::format("did you mean {}?", near));
    }
    if (find(name) != nullptr) {
      refuse(fmt::format("--limit names {} twice.", name), "give each limit once.");
    }
    if ((part.empty() || part == "RATE") && !(number.value > 0.0)) {
      refuse(fmt::format("--limit {} leaves the input no room.", text),
             "give a size above 0: it counts in both directions, U.low and U.high give an end each.");
    }
    limits_.emplace_back(name, number.value);
  }

  std::vector<std::string> inputs_{};
  Limits limits_{};
};

}  // namespace

std::vector<std::pair<std::string, double>> read_limits(const Graph& graph, const std::vector<std::string>& texts) {
  return LimitReader(graph).read(texts);
}

}  // namespace hysteron::diagnosis
