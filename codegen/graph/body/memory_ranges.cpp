#include "codegen/graph/body/memory_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;

namespace {

constexpr int most_passes = 24;
constexpr int exact_passes = 2;     // then a bound that moves goes on to the next number of the text
constexpr int patient_passes = 12;  // then to the end of its type

/// The whole numbers that the text names, and their neighbours: where a comparison can hold a variable.
std::vector<std::int64_t> landmarks(const syntax::Library& library) {
  std::vector<std::int64_t> list;
  for (const syntax::Expression& one : library.expressions) {
    const auto* literal = std::get_if<syntax::Literal>(&one.node);
    if (literal != nullptr && literal->kind == syntax::Literal::Kind::Whole && std::abs(literal->value) < 2e9) {
      for (const std::int64_t sign : {-1, 1}) {
        const auto number = sign * static_cast<std::int64_t>(literal->value);
        list.insert(list.end(), {number - 1, number, number + 1});
      }
    }
  }
  std::ranges::sort(list);
  return list;
}

/// A run of the body beside the graph that it is for. False where it has an error.
bool tried(const syntax::Library& library, const syntax::Unit& unit, const Surroundings& around,
           const std::map<std::string, Wire>& inputs, const MemoryRanges* memory, std::vector<Kept>& kept) {
  Graph scratch;
  GraphBuilder builder(scratch);
  bool right = true;
  std::uint32_t parameters = 0;
  Body body(library, unit,
            {.builder = builder,
             .report = [&](int number, auto&&...) { right = right && number == error::other_meaning_elsewhere; },
             .add_parameter =
                 [&](const Parameter& parameter) {
                   return Wire{Wire::From::Parameter, parameter.field.type, 0, parameters++};
                 },
             .path = around.path,
             .rate = around.rate,
             .sample_time_ns = around.sample_time_ns,
             .memory = memory,
             .proving = memory != nullptr});
  body.run(inputs);
  kept = body.kept();
  return right;
}

}  // namespace

MemoryRanges memory_ranges(const syntax::Library& library, const syntax::Unit& unit, const Surroundings& around,
                           const std::map<std::string, Wire>& inputs) {
  std::map<std::string, Wire> any;  // whatever the inputs are wired to
  for (const auto& [name, wire] : inputs) {
    any[name] = {Wire::From::Input, wire.type, 0, static_cast<std::uint32_t>(any.size())};
  }
  std::vector<Kept> kept;
  if (!library.has_open_loops || tried(library, unit, around, any, nullptr, kept)) {
    return {};
  }
  const std::vector<std::int64_t> marks = landmarks(library);
  MemoryRanges assumed;
  for (int pass = 0; pass < most_passes; ++pass) {
    tried(library, unit, around, any, &assumed, kept);
    bool grew = false;
    for (const Kept& one : kept) {
      MemoryRange& range = assumed.try_emplace(one.path, MemoryRange{one.initial, one.initial}).first->second;
      if (one.next.low < range.low) {
        const auto mark = std::ranges::upper_bound(marks, one.next.low);
        range.low = pass < exact_passes                              ? one.next.low
                    : pass < patient_passes && mark != marks.begin() ? std::max(*std::prev(mark), one.type.low)
                                                                     : one.type.low;
        grew = true;
      }
      if (one.next.high > range.high) {
        const auto mark = std::ranges::lower_bound(marks, one.next.high);
        range.high = pass < exact_passes                            ? one.next.high
                     : pass < patient_passes && mark != marks.end() ? std::min(*mark, one.type.high)
                                                                    : one.type.high;
        grew = true;
      }
    }
    if (!grew) {
      return assumed;
    }
  }
  return {};
}

}  // namespace hysteron::bodies
