#include "runtime/task/carry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "runtime/task/staged_parameters.hpp"
#include "support/name_index.hpp"
#include "support/whole_number.hpp"

namespace hysteron::runtime {
namespace {

struct TypeName {
  PointType type;
  std::string_view name;
  std::size_t size;
};

/// The types that a state or a parameter has.
constexpr std::array type_names{TypeName{PointType::boolean, "BOOL", sizeof(bool)},
                                TypeName{PointType::uint16, "WORD", sizeof(std::uint16_t)},
                                TypeName{PointType::int32, "DINT", sizeof(std::int32_t)},
                                TypeName{PointType::uint64, "ULINT", sizeof(std::uint64_t)},
                                TypeName{PointType::real32, "REAL", sizeof(float)},
                                TypeName{PointType::real64, "LREAL", sizeof(double)}};

const TypeName& about(PointType type) {
  const auto* const found = std::ranges::find(type_names, type, &TypeName::type);
  return found == type_names.end() ? type_names.back() : *found;
}

std::optional<PointType> type_of(std::string_view name) {
  const auto* const found = std::ranges::find(type_names, name, &TypeName::name);
  return found == type_names.end() ? std::nullopt : std::optional(found->type);
}

bool is_count(PointType type) {
  return type == PointType::int32 || type == PointType::uint64;
}
/// One engine computes with float what another does with double, and one counts steps in a DINT what another does not.
bool is_alike(PointType a, PointType b) {
  return a == b || (is_real(a) && is_real(b)) || (is_count(a) && is_count(b));
}

template <class T>
T value_at(std::span<const std::byte> bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/// Every number of these types is a double to the last bit, but for counts beyond 2^53, which no run reaches.
double number_at(std::span<const std::byte> bytes, PointType type, std::size_t at) {
  switch (type) {
    case PointType::boolean:
      return value_at<std::uint8_t>(bytes, at) != 0 ? 1.0 : 0.0;
    case PointType::uint16:
      return value_at<std::uint16_t>(bytes, at);
    case PointType::int32:
      return value_at<std::int32_t>(bytes, at);
    case PointType::uint64:
      return static_cast<double>(value_at<std::uint64_t>(bytes, at));
    case PointType::real32:
      return static_cast<double>(value_at<float>(bytes, at));
    default:
      return value_at<double>(bytes, at);
  }
}

template <class T>
void put(std::span<std::byte> bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

void put_number(std::span<std::byte> bytes, PointType type, std::size_t at, double value) {
  switch (type) {
    case PointType::boolean:
      put(bytes, at, value != 0.0);
      break;
    case PointType::uint16:
      put(bytes, at, static_cast<std::uint16_t>(value));
      break;
    case PointType::int32:
      put(bytes, at, static_cast<std::int32_t>(value));
      break;
    case PointType::uint64:
      put(bytes, at, static_cast<std::uint64_t>(value));
      break;
    case PointType::real32:
      put(bytes, at, static_cast<float>(value));
      break;
    default:
      put(bytes, at, value);
  }
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find('\t', begin);
    cells.push_back(line.substr(begin, end - begin));
    if (end == std::string_view::npos) {
      return cells;
    }
    begin = end + 1;
  }
}

/// Infinite, too.
bool read_real(std::string_view text, double& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

bool read_line(std::string_view line, std::size_t state_size, KeptLayout& layout) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells[0] == "t" && cells.size() == 2) {
    const auto period = whole_number<std::int64_t>(cells[1], 0);
    layout.period = period.value_or(0);
    return period.has_value();
  }
  if ((cells[0] == "p" || cells[0] == "i") && cells.size() == 7) {
    const auto type = type_of(cells[2]);
    double low = 0.0;
    double high = 0.0;
    const bool is_read = type && read_real(cells[4], low) && read_real(cells[5], high);
    (cells[0] == "p" ? layout.parameters : layout.inputs)
        .push_back({.name = std::string(cells[1]),
                    .type = type.value_or(PointType::real64),
                    .unit = std::string(cells[3]),
                    .low = low,
                    .high = high,
                    .low_excluded = cells[6] == "1"});
    return is_read;
  }
  if (cells[0] != "s" || cells.size() != 7) {
    return false;
  }
  const auto type = type_of(cells[3]);
  StateField field{.name = std::string(cells[1]), .block = std::string(cells[2]), .unit = std::string(cells[6])};
  const auto length = whole_number<std::size_t>(cells[4]);
  const auto offset = whole_number<std::size_t>(cells[5], 0, state_size);
  if (!type || !length || !offset || *length > (state_size - *offset) / about(*type).size) {
    return false;
  }
  field.type = *type;
  field.length = *length;
  field.offset = *offset;
  layout.state.push_back(std::move(field));
  return true;
}

/// The reason of what the program alone has.
constexpr std::string_view only_here = "new";

std::string unit_text(const std::string& unit) {
  return unit.empty() ? "no unit" : unit;
}

/// Why a value with one type and unit is none of another's; empty where it is.
std::string difference(PointType type, const std::string& unit, PointType wanted, const std::string& wanted_unit) {
  if (!is_alike(type, wanted)) {
    return fmt::format("{} there, {} here", about(type).name, about(wanted).name);
  }
  return unit == wanted_unit ? "" : fmt::format("{} there, {} here", unit_text(unit), unit_text(wanted_unit));
}

std::string left(std::string_view name, std::string_view reason) {
  return fmt::format("{} ({})", name, reason);
}

/// Names count without regard to case, as in a diagram.
template <class Named>
NameIndex by_name(const std::vector<Named>& named) {
  NameIndex places;
  for (std::size_t i = 0; i < named.size(); ++i) {
    places.add(named[i].name, static_cast<std::uint32_t>(i));
  }
  return places;
}

/// The names in `kept` that the program has no more.
template <class Kept, class Own>
void tell_gone(const std::vector<Kept>& kept, const std::vector<Own>& own, std::vector<std::string>& told) {
  const auto here = by_name(own);
  for (const Kept& one : kept) {
    if (!here.contains(one.name)) {
      told.push_back(left(one.name, "gone"));
    }
  }
}

/// Why a number of the state is another one; empty where it is the same.
std::string refusal_of(const StateField& was, const StateField& is) {
  if (was.block != is.block) {
    return fmt::format("of {} there, of {} here", was.block, is.block);
  }
  if (std::string why = difference(was.type, was.unit, is.type, is.unit); !why.empty()) {
    return why;
  }
  if (was.length != is.length) {
    return fmt::format("{} values there, {} here", was.length, is.length);
  }
  return "";
}

}  // namespace

bool is_new(std::string_view one) {
  return one == left(without_reason(one), only_here);
}

std::string without_reason(std::string_view one) {
  return std::string(one.substr(0, one.find(" (")));
}

std::string describe(const ProgramShape& shape, std::span<const std::size_t> inputs) {
  std::string text;
  text += fmt::format("t\t{}\n", shape.period);
  const auto add = [&](char kind, const ProgramSignal& one) {
    text += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\n", kind, one.name, about(one.type).name, one.unit, one.low,
                        one.high, one.low_excluded ? 1 : 0);
  };
  for (const ProgramSignal& one : shape.parameters) {
    add('p', one);
  }
  for (const StateField& one : shape.state) {
    text += fmt::format("s\t{}\t{}\t{}\t{}\t{}\t{}\n", one.name, one.block, about(one.type).name, one.length,
                        one.offset, one.unit);
  }
  for (const std::size_t input : inputs) {
    add('i', shape.inputs[input]);
  }
  return text;
}

KeptLayout read_description(std::string_view text, std::size_t state_size) {
  KeptLayout layout;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos || !read_line(text.substr(0, end), state_size, layout)) {
      return {};
    }
    text.remove_prefix(end + 1);
  }
  return layout;
}

std::string other_unit(const KeptLayout& kept, const ProgramShape& shape, std::span<const std::size_t> inputs) {
  const auto of_named = [](const auto& all, const NameIndex& places, const auto& own) -> std::string {
    const std::uint32_t* const found = places.find(own.name);
    if (found == nullptr || all[*found].unit == own.unit) {
      return "";
    }
    return fmt::format("{} is in {} there, {} here", own.name, unit_text(all[*found].unit), unit_text(own.unit));
  };
  const NameIndex parameters = by_name(kept.parameters);
  for (const ProgramSignal& own : shape.parameters) {
    if (std::string told = of_named(kept.parameters, parameters, own); !told.empty()) {
      return told;
    }
  }
  const NameIndex states = by_name(kept.state);
  for (const StateField& own : shape.state) {
    if (std::string told = of_named(kept.state, states, own); !told.empty()) {
      return told;
    }
  }
  const NameIndex retained = by_name(kept.inputs);
  for (const std::size_t input : inputs) {
    if (std::string told = of_named(kept.inputs, retained, shape.inputs[input]); !told.empty()) {
      return told;
    }
  }
  return "";
}

CarriedValues carry_parameters(const KeptLayout& kept, std::span<const double> values, const ProgramShape& shape,
                               std::span<const double> given) {
  CarriedValues carried{.parameters = {given.begin(), given.end()}};
  const auto places = by_name(kept.parameters);
  for (std::size_t i = 0; i < shape.parameters.size(); ++i) {
    const ProgramSignal& own = shape.parameters[i];
    const std::uint32_t* const found = places.find(own.name);
    if (found == nullptr) {
      carried.left.push_back(left(own.name, only_here));
      continue;
    }
    const KeptLayout::Parameter& was = kept.parameters[*found];
    std::string why = difference(was.type, was.unit, own.type, own.unit);
    if (why.empty() && !refusal_of(own, values[*found]).empty()) {
      why = fmt::format("{:.6g} is outside of its limits", values[*found]);
    }
    if (why.empty()) {
      carried.parameters[i] = values[*found];
      ++carried.parameters_taken;
    } else {
      carried.left.push_back(left(own.name, why));
    }
  }
  tell_gone(kept.parameters, shape.parameters, carried.left);
  return carried;
}

std::vector<std::optional<double>> carry_inputs(const KeptLayout& kept, std::span<const double> values,
                                                const ProgramShape& shape, std::span<const std::size_t> wanted,
                                                std::vector<std::string>& left_out) {
  std::vector<std::optional<double>> carried(shape.inputs.size());
  const auto places = by_name(kept.inputs);
  for (const std::size_t input : wanted) {
    const ProgramSignal& own = shape.inputs[input];
    const std::uint32_t* const found = places.find(own.name);
    if (found == nullptr || *found >= values.size()) {
      continue;  // it was not retained before: it begins as the diagram says
    }
    const KeptLayout::Parameter& was = kept.inputs[*found];
    const double value = values[*found];
    std::string why = difference(was.type, was.unit, own.type, own.unit);
    if (why.empty() && !refusal_of(own, value).empty()) {
      why = fmt::format("{:.6g} is outside of its limits", value);
    }
    if (why.empty()) {
      carried[input] = value;
    } else {
      left_out.push_back(left(own.name, why));
    }
  }
  tell_gone(kept.inputs, shape.inputs, left_out);
  return carried;
}

std::vector<SharedNumber> shared_state(const KeptLayout& kept, const ProgramShape& shape,
                                       std::vector<std::string>& left_out) {
  std::vector<SharedNumber> shared;
  if (kept.period != shape.period) {
    left_out.push_back(
        left("the state", fmt::format("of steps of {} ns there, {} ns here", kept.period, shape.period)));
    return shared;
  }
  const auto places = by_name(kept.state);
  for (std::size_t i = 0; i < shape.state.size(); ++i) {
    const StateField& own = shape.state[i];
    const std::uint32_t* const found = places.find(own.name);
    if (found == nullptr) {
      left_out.push_back(left(own.name, only_here));
      continue;
    }
    const StateField& was = kept.state[*found];
    if (std::string why = refusal_of(was, own); !why.empty()) {
      left_out.push_back(left(own.name, why));
      continue;
    }
    shared.push_back({.type_from = was.type,
                      .type_into = own.type,
                      .from = was.offset,
                      .into = own.offset,
                      .length = own.length,
                      .field = i});
  }
  tell_gone(kept.state, shape.state, left_out);
  return shared;
}

bool copy_shared(const SharedNumber& shared, std::span<const std::byte> from, std::span<std::byte> into) noexcept {
  const std::size_t size_from = about(shared.type_from).size;
  const std::size_t size_into = about(shared.type_into).size;
  for (std::size_t i = 0; i < shared.length; ++i) {
    if (!std::isfinite(number_at(from, shared.type_from, shared.from + i * size_from))) {
      return false;
    }
  }
  for (std::size_t i = 0; i < shared.length; ++i) {
    put_number(into, shared.type_into, shared.into + i * size_into,
               number_at(from, shared.type_from, shared.from + i * size_from));
  }
  return true;
}

std::vector<SharedNumber> carry_state(const KeptLayout& kept, std::span<const std::byte> from,
                                      const ProgramShape& shape, std::span<std::byte> into, CarriedValues& carried) {
  std::vector<SharedNumber> shared = shared_state(kept, shape, carried.left);
  for (const SharedNumber& one : shared) {
    if (copy_shared(one, from, into)) {
      ++carried.states_taken;
    } else {
      carried.left.push_back(left(shape.state[one.field].name, "not finite"));
    }
  }
  return shared;
}

std::string not_finite(const ProgramShape& shape, std::span<const std::byte> state,
                       std::span<const std::byte> after_reset) {
  for (const StateField& field : shape.state) {
    for (std::size_t i = 0; is_real(field.type) && i < field.length; ++i) {
      const std::size_t at = field.offset + i * about(field.type).size;
      if (!std::isfinite(number_at(state, field.type, at)) && std::isfinite(number_at(after_reset, field.type, at))) {
        return field.name;
      }
    }
  }
  return "";
}

}  // namespace hysteron::runtime
