#include "codegen/program_hash.hpp"

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

#include "codegen/cosimulation/fmu.hpp"
#include "support/numbers.hpp"
#include "support/sha256.hpp"

namespace hysteron {

namespace {

/// The text that is hashed: words and whole numbers, by hand, since a large diagram has a million of them.
class HashedText {
 public:
  HashedText& operator<<(std::string_view text) {
    text_ += text;
    return *this;
  }
  template <class Integer>
  requires std::is_integral_v<Integer> HashedText& operator<<(Integer number) {
    std::array<char, 24> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    text_.append(digits.data(), written.ptr);
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

std::string program_hash(const Program& program) {
  const Graph& graph = program.graph;
  HashedText text;
  const auto wire = [&](const Wire& one) {
    text << " " << static_cast<int>(one.from) << ":" << one.index << ":" << one.port;
    if (one.from == Wire::From::Literal) {
      text << "=" << number_text(graph.literals[one.index]);
    }
  };
  text << "ts " << graph.sample_time_ns << "\n";
  for (const Port& input : graph.inputs) {
    text << "input " << language::upper(input.name) << " " << static_cast<int>(input.type) << "\n";
  }
  for (const Parameter& parameter : graph.parameters) {
    text << "parameter " << parameter.path;
    for (const double value : parameter.value) {
      text << " " << number_text(value);
    }
    text << "\n";
  }
  for (const Node& node : graph.nodes) {
    text << "node " << (node.block != nullptr ? node.block->about.name : info(node.op).name) << " " << node.rate.every
         << " " << node.rate.phase;
    if (node.block != nullptr && node.block->fmu != nullptr) {
      text << " " << node.block->fmu->hash();
    }
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      wire(graph.wire(node, pin));
    }
    text << "\n";
  }
  for (const InitialState& given : graph.initial_states) {
    text << "initial " << given.node << " " << given.state << " " << number_text(given.value) << "\n";
  }
  for (const Port& output : graph.outputs) {
    text << "output " << language::upper(output.name) << " " << static_cast<int>(output.type);
    wire(output.wire);
    text << "\n";
  }
  return sha256(text.text()).substr(0, 16);
}

}  // namespace hysteron
