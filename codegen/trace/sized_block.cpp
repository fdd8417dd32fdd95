#include "codegen/trace/sized_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "blocks/sized_catalogue.hpp"
#include "codegen/trace/traced.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

/// A sized block as its functions see it where they are recorded.
class TraceView {
 public:
  using Real = trace::Real;

  TraceView(const SizedBlock& block, Tape& tape) : block_(block) {
    for (std::uint32_t pin = 0; pin < block.inputs.size() + block.params.size(); ++pin) {
      const Field& field = pin < block.inputs.size() ? block.inputs[pin] : block.params[pin - block.inputs.size()];
      pins_.push_back(tape.leaf(Op::Pin, field.type, pin));
    }
    for (std::uint32_t cell = 0; cell < block.states.size(); ++cell) {
      states_.push_back(tape.leaf(Op::Cell, Type::Real, cell));
    }
    ts_ = tape.leaf(Op::SampleTime, Type::Real, 0);
    outputs.assign(block.outputs.size(), no_value);
    next.assign(block.states.size(), no_value);
  }

  [[nodiscard]] Real in(std::size_t field, std::size_t k) const {
    return Real::of(pins_[block_.first_input[field] + k]);
  }
  [[nodiscard]] trace::Bool flag(std::size_t field) const { return trace::Bool::of(pins_[block_.first_input[field]]); }
  [[nodiscard]] Real param(std::size_t field, std::size_t k) const {
    const std::size_t pin = block_.first_param[field];
    if (block_.params[pin - block_.inputs.size()].length == 1) {
      return Real::of(pins_[pin]);
    }
    return Real::of(trace::apply(Op::At, pins_[pin], trace::Int(static_cast<std::int32_t>(k)).id));
  }
  [[nodiscard]] Real state(std::size_t k) const { return Real::of(states_[k]); }
  [[nodiscard]] Real out(std::size_t k) const { return Real::of(outputs[k]); }
  [[nodiscard]] Real ts() const { return Real::of(ts_); }
  void set_out(std::size_t k, Real value) { outputs[k] = value.id; }
  void set_state(std::size_t k, Real value) { next[k] = value.id; }

  std::vector<ValueId> outputs;
  std::vector<ValueId> next;

 private:
  const SizedBlock& block_;
  std::vector<ValueId> pins_;
  std::vector<ValueId> states_;
  ValueId ts_ = no_value;
};

template <class B>
BlockTrace trace_of_sized(const SizedBlock& block) {
  BlockTrace result;
  const trace::Recording recording(result.tape);
  TraceView view(block, result.tape);
  B::output(block.sizes, view);
  if (!block.states.empty()) {
    TraceView start = view;
    B::initial(block.sizes, start);
    result.initial = start.next;
    B::update(block.sizes, view);
    result.next = view.next;
  }
  result.outputs = view.outputs;
  derive_reach(result);
  return result;
}

std::vector<Field> sized_fields(std::span<const SizedField> described, const Sizes& sizes, bool pins,
                                std::array<std::uint16_t, 8>* first, std::size_t before, SizedBlock& block) {
  std::vector<Field> fields;
  for (std::size_t i = 0; i < described.size(); ++i) {
    const SizedField& one = described[i];
    if (first != nullptr) {
      (*first)[i] = static_cast<std::uint16_t>(before + fields.size());
    }
    if (one.direct && !sizes.direct) {
      continue;
    }
    const std::size_t length = one.length(sizes);
    Field field = one.field;
    if (!pins || !one.vector || length == 1) {
      field.length = pins && one.vector ? 1 : static_cast<std::uint16_t>(length);
      fields.push_back(field);
      continue;
    }
    for (std::size_t k = 0; k < length; ++k) {
      field.name = block.names.emplace_back(fmt::format("{}[{}]", one.field.name, k));
      fields.push_back(field);
    }
  }
  return fields;
}

const GivenNumbers* given_numbers(std::span<const GivenNumbers> given, std::string_view name) {
  const auto found = std::ranges::find_if(given, [&](const auto& one) { return equal_ignoring_case(one.name, name); });
  return found == given.end() ? nullptr : &*found;
}

SizeProblem missing_list(const SizedKind& kind, std::string_view name, std::string mend) {
  return {
      .name = {}, .cause = fmt::format("{} needs {} to know its size", kind.about.name, name), .mend = std::move(mend)};
}

/// How many rows of a length a list has.
std::variant<std::size_t, SizeProblem> whole_rows(const GivenNumbers& list, std::size_t length, std::string_view of) {
  if (list.numbers.size() % length != 0) {
    return SizeProblem{.name = list.name,
                       .cause = fmt::format("{} has {} numbers, which are no whole number of rows of {}", list.name,
                                            list.numbers.size(), length),
                       .mend = fmt::format("{} has {}.", list.name, of)};
  }
  return list.numbers.size() / length;
}

std::variant<Sizes, SizeProblem> matrix_gain_sizes(const SizedKind& kind, std::span<const GivenNumbers> given) {
  const GivenNumbers* const k = given_numbers(given, "K");
  const GivenNumbers* const count = given_numbers(given, "ROWS");
  constexpr std::string_view example = "Write := (K := [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], ROWS := 2): two rows of three.";
  if (k == nullptr || count == nullptr) {
    return missing_list(kind, k == nullptr ? "K" : "ROWS", std::string(example));
  }
  const double number = count->numbers.size() == 1 ? count->numbers.front() : 0.0;
  if (!(number >= 1.0) || number > most_elements_of_pin || number != static_cast<double>(static_cast<int>(number))) {
    return SizeProblem{.name = count->name,
                       .cause = "ROWS is not a number of rows",
                       .mend = fmt::format("Write a whole number from 1 to {}.", most_elements_of_pin)};
  }
  const auto p = static_cast<std::size_t>(number);
  if (k->numbers.size() % p != 0 || k->numbers.size() / p > most_elements_of_pin) {
    return SizeProblem{.name = k->name,
                       .cause = fmt::format("K has {} numbers, which are not {} rows of 1 to {}", k->numbers.size(), p,
                                            most_elements_of_pin),
                       .mend = std::string(example)};
  }
  return Sizes{.n = 0, .m = k->numbers.size() / p, .p = p};
}

std::variant<Sizes, SizeProblem> state_space_sizes(const SizedKind& kind, std::span<const GivenNumbers> given) {
  for (const std::string_view name : {"A", "B", "C"}) {
    if (given_numbers(given, name) == nullptr) {
      return missing_list(kind, name, "Write := (A := [0.9, 0.1, 0.0, 0.8], B := [0.0, 1.0], C := [1.0, 0.0]).");
    }
  }
  Sizes sizes;
  const GivenNumbers& a = *given_numbers(given, "A");
  while (sizes.n * sizes.n < a.numbers.size()) {
    ++sizes.n;
  }
  if (sizes.n * sizes.n != a.numbers.size() || sizes.n > most_states) {
    return SizeProblem{
        .name = a.name,
        .cause = fmt::format("A has {} numbers, which are no square of 1 to {} states", a.numbers.size(), most_states),
        .mend = "A has n rows of n numbers: 1, 4, 9, 16, …"};
  }
  const auto m =
      whole_rows(*given_numbers(given, "B"), sizes.n, fmt::format("n = {} rows, one number for each input", sizes.n));
  const auto p =
      whole_rows(*given_numbers(given, "C"), sizes.n, fmt::format("a row of n = {} for each output", sizes.n));
  for (const auto* const one : {&m, &p}) {
    if (const auto* const problem = std::get_if<SizeProblem>(one)) {
      return *problem;
    }
  }
  sizes.m = std::get<std::size_t>(m);
  sizes.p = std::get<std::size_t>(p);
  if (sizes.m > most_elements_of_pin || sizes.p > most_elements_of_pin) {
    return SizeProblem{.name = sizes.m > most_elements_of_pin ? "B" : "C",
                       .cause = fmt::format("here are {} inputs and {} outputs", sizes.m, sizes.p),
                       .mend = fmt::format("{} of each are the most.", most_elements_of_pin)};
  }
  if (const GivenNumbers* const d = given_numbers(given, "D"); d != nullptr) {
    if (d->numbers.size() != sizes.p * sizes.m) {
      return SizeProblem{.name = d->name,
                         .cause = fmt::format("D has {} numbers, B and C speak of {} inputs and {} outputs",
                                              d->numbers.size(), sizes.m, sizes.p),
                         .mend = fmt::format("D has {} rows of {} numbers.", sizes.p, sizes.m)};
    }
    sizes.direct = true;
  }
  if (const GivenNumbers* const x0 = given_numbers(given, "X0"); x0 != nullptr && x0->numbers.size() != sizes.n) {
    return SizeProblem{.name = x0->name,
                       .cause = fmt::format("X0 has {} numbers, A speaks of {} states", x0->numbers.size(), sizes.n),
                       .mend = "Give each state one number, or leave X0 out: it is then 0."};
  }
  return sizes;
}

std::variant<Sizes, SizeProblem> transfer_function_sizes(const SizedKind& kind, std::span<const GivenNumbers> given) {
  const GivenNumbers* const num = given_numbers(given, "NUM");
  const GivenNumbers* const den = given_numbers(given, "DEN");
  if (num == nullptr || den == nullptr) {
    return missing_list(kind, num == nullptr ? "NUM" : "DEN",
                        fmt::format("Write literals in the declaration: := ({}).", kind.example));
  }
  const Sizes sizes{.n = den->numbers.size() - 1,
                    .m = num->numbers.size(),
                    .p = den->numbers.size(),
                    .direct = num->numbers.size() == den->numbers.size()};
  if (sizes.n < 1 || sizes.n > most_states) {
    return SizeProblem{.name = den->name,
                       .cause = fmt::format("DEN has {} number{}", sizes.p, sizes.p == 1 ? "" : "s"),
                       .mend = sizes.n < 1
                                   ? "It has two or more; a factor alone is HY_GAIN."
                                   : fmt::format("{} poles, {} numbers, are the most.", most_states, most_states + 1)};
  }
  if (sizes.m > sizes.p) {
    return SizeProblem{.name = num->name,
                       .cause = fmt::format("NUM has degree {} and DEN degree {}: the transfer function is improper",
                                            sizes.m - 1, sizes.n),
                       .mend =
                           "It would answer to what is still to come. Give DEN at least as many numbers as NUM: add "
                           "the pole of a filter."};
  }
  if (den->numbers.front() == 0.0) {
    return SizeProblem{.name = den->name,
                       .cause = "DEN begins with 0, which it is divided by",
                       .mend = "Leave leading zeros out: the first number belongs to the highest power."};
  }
  return sizes;
}

template <class B>
SizedKind sized_kind_of() {
  return {.about = B::about,
          .inputs = B::inputs,
          .params = B::params,
          .outputs = B::outputs,
          .states = B::states,
          .example = B::example,
          .example_sizes = B::example_sizes,
          .size_rule = B::size_rule,
          .settings = B::settings,
          .is_discretised = B::is_discretised};
}

}  // namespace

std::span<const SizedKind> sized_kinds() {
  static const std::vector<SizedKind> kinds = [] {
    std::vector<SizedKind> list;
    SizedCatalogue::for_each([&]<class B> { list.push_back(sized_kind_of<B>()); });
    return list;
  }();
  return kinds;
}

const SizedKind* find_sized_kind(std::string_view name) {
  const auto found = std::ranges::find_if(
      sized_kinds(), [&](const SizedKind& kind) { return equal_ignoring_case(kind.about.name, name); });
  return found == sized_kinds().end() ? nullptr : &*found;
}

const BlockType& sized_block(const SizedKind& kind, const Sizes& sizes) {
  using Key = std::tuple<std::string_view, std::size_t, std::size_t, std::size_t, bool>;
  static std::mutex mutex;
  static std::map<Key, std::unique_ptr<SizedBlock>> made;
  const std::lock_guard lock(mutex);
  auto& block = made[{kind.about.name, sizes.n, sizes.m, sizes.p, sizes.direct}];
  if (block == nullptr) {
    block = std::make_unique<SizedBlock>();
    block->kind = &kind;
    block->sizes = sizes;
    block->inputs = sized_fields(kind.inputs, sizes, true, &block->first_input, 0, *block);
    block->params = sized_fields(kind.params, sizes, false, &block->first_param, block->inputs.size(), *block);
    block->outputs = sized_fields(kind.outputs, sizes, true, nullptr, 0, *block);
    block->states = sized_fields(kind.states, sizes, true, nullptr, 0, *block);
    BlockType& type = block->type;
    type.about = kind.about;
    type.inputs = block->inputs;
    type.params = block->params;
    type.outputs = block->outputs;
    type.states = block->states;
    type.sized = block.get();
    SizedCatalogue::for_each([&]<class B> {
      if (kind.about.name == B::about.name) {
        type.trace = trace_of_sized<B>(*block);
      }
    });
  }
  return block->type;
}

std::vector<const BlockType*> documented_blocks() {
  std::vector<const BlockType*> list;
  for (const BlockType& block : block_types()) {
    list.push_back(&block);
  }
  for (const SizedKind& kind : sized_kinds()) {
    list.push_back(&sized_block(kind, kind.example_sizes));
  }
  return list;
}

const BlockType* find_documented_block(std::string_view name) {
  const SizedKind* const kind = find_sized_kind(name);
  return kind != nullptr ? &sized_block(*kind, kind->example_sizes) : find_block_type(name);
}

std::string sized_type_text(const SizedKind& kind, const Sizes& sizes) {
  return fmt::format("{}[{},{},{}{}]", kind.about.name, sizes.n, sizes.m, sizes.p, sizes.direct ? ",1" : ",0");
}

const BlockType* find_sized_block(std::string_view text) {
  const auto bracket = text.find('[');
  const SizedKind* const kind = bracket == std::string_view::npos ? nullptr : find_sized_kind(text.substr(0, bracket));
  if (kind == nullptr) {
    return nullptr;
  }
  std::array<std::size_t, 4> numbers{};
  const char* at = text.data() + bracket;
  for (std::size_t& number : numbers) {
    at = std::from_chars(at + 1, text.data() + text.size(), number).ptr;
  }
  return &sized_block(*kind, {.n = numbers[0], .m = numbers[1], .p = numbers[2], .direct = numbers[3] != 0});
}

std::size_t scaling_numbers(const BlockType& block, std::size_t param) {
  if (block.sized == nullptr) {
    return 0;
  }
  const auto& described = block.sized->kind->params;
  const auto found =
      std::ranges::find(described, block.params[param].name, [](const auto& one) { return one.field.name; });
  return found != described.end() && found->scaled ? 1 : 0;
}

std::variant<Sizes, SizeProblem> sizes_of(const SizedKind& kind, std::span<const GivenNumbers> given) {
  switch (kind.size_rule) {
    case SizeRule::Matrix:
      return matrix_gain_sizes(kind, given);
    case SizeRule::StateSpace:
      return state_space_sizes(kind, given);
    case SizeRule::TransferFunction:
      break;
  }
  return transfer_function_sizes(kind, given);
}

}  // namespace hysteron
