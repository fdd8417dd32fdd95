// Eight sets of parameters side by side: each lane has the bits of a machine by itself.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/interpreter/machine_lanes.hpp"
#include "codegen/interpreter/registers.hpp"
#include "tests/codegen/random_program.hpp"

namespace hysteron::testing {
namespace {

std::uint64_t bits_of(double value) {
  return std::isnan(value) ? UINT64_MAX : std::bit_cast<std::uint64_t>(value);
}

/// A parameter of a lane: another number, and as far as its range allows another truth value or integer.
double in_lane(const Parameter& parameter, std::size_t element, std::size_t lane) {
  const double value = parameter.value[element];
  const auto k = static_cast<double>(lane);
  switch (parameter.field.type) {
    case Type::Real:
      return value * (1.0 + 0.02 * k);
    case Type::Bool:
      return lane % 3 == 2 ? 1.0 - value : value;
    default:
      return std::clamp(value + k, std::min(value, parameter.field.minimum),
                        std::max(value, std::min(parameter.field.maximum, value + 3.0)));
  }
}

class SideBySide {
 public:
  explicit SideBySide(const Program& program) : program_(program), lanes_(program, 1e-2) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      alone_.emplace_back(program, 1e-2);
    }
    for (std::size_t i = 0; i < program.graph.parameters.size(); ++i) {
      const Parameter& parameter = program.graph.parameters[i];
      for (std::size_t element = 0; element < parameter.value.size(); ++element) {
        Lanes values(0.0);
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          values.set_lane(lane, in_lane(parameter, element, lane));
          alone_[lane].set_parameter(i, values.lane(lane), element);
        }
        lanes_.set_parameter(i, values, element);
      }
    }
    lanes_.reset();
    for (Machine<double>& machine : alone_) {
      machine.reset();
    }
  }

  void step(const std::vector<double>& inputs) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      lanes_.set_input(i, inputs[i]);
      for (Machine<double>& machine : alone_) {
        machine.set_input(i, inputs[i]);
      }
    }
    lanes_.step();
    for (Machine<double>& machine : alone_) {
      machine.step();
    }
  }

  /// The node of which an output differs in any lane; empty where none does.
  [[nodiscard]] std::string differing() const {
    for (std::uint32_t n = 0; n < program_.graph.nodes.size(); ++n) {
      const Node& node = program_.graph.nodes[n];
      const std::size_t ports = node.block != nullptr ? node.block->outputs.size() : 1;
      for (std::uint16_t port = 0; port < ports; ++port) {
        const Type type = node.block != nullptr ? node.block->outputs[port].type : info(node.op).result;
        const Wire wire{.from = Wire::From::Node, .type = type, .port = port, .index = n};
        const Lanes values = lanes_.value(wire);
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          if (const double alone = alone_[lane].value(wire); bits_of(values.lane(lane)) != bits_of(alone)) {
            return fmt::format("{} {} port {} lane {}: {:.17g}, alone {:.17g}", node.path,
                               node.block != nullptr ? node.block->about.name : info(node.op).name, port, lane,
                               values.lane(lane), alone);
          }
        }
      }
    }
    return {};
  }

 private:
  const Program& program_;
  Machine<Lanes> lanes_;
  std::vector<Machine<double>> alone_{};
};

TEST(Lanes, EachHasTheBitsOfAMachineByItself) {
  if (!has_registers_of_four()) {
    GTEST_SKIP() << "this processor has no registers of 256 bits";
  }
  std::set<std::string_view> blocks;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const RandomDiagram diagram(seed, "LANES", 24,
                                {.rates = seed % 4 == 3, .types = true, .functions = true, .vectors = seed % 2 == 0});
    const Program program = diagram.program();
    for (const Node& node : program.graph.nodes) {
      if (node.block != nullptr && node.block->sized == nullptr) {
        blocks.insert(node.block->about.name);
      }
    }
    SideBySide machines(program);
    std::mt19937_64 random(seed);
    for (int step = 0; step < 60; ++step) {
      std::vector<double> inputs;
      for (const Port& input : program.graph.inputs) {
        const double unit = static_cast<double>(random() >> 11U) * 0x1p-53;
        inputs.push_back(input.type == Type::Real   ? 6.0 * unit - 3.0
                         : input.type == Type::Bool ? static_cast<double>(unit < 0.2)
                                                    : std::floor(20.0 * unit));
      }
      machines.step(inputs);
      ASSERT_EQ(machines.differing(), "") << "step " << step << " of\n" << diagram.text();
    }
  }
  EXPECT_EQ(blocks.size(), static_cast<std::size_t>(std::ranges::count_if(
                               block_types(), [](const BlockType& block) { return block.sized == nullptr; })))
      << "every block of the catalogue is among the diagrams";
}

}  // namespace
}  // namespace hysteron::testing
