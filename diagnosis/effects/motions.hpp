// Which signals of a diagram may be a velocity or a position, by their units and by the integrals on the way to them:
// a friction depends on the one, a ripple on the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron::diagnosis {

/// Whether a unit is known and is none of a velocity: a position, a force, a voltage, a power. Angles have no
/// dimension.
[[nodiscard]] bool is_no_velocity(std::string_view unit);

/// Whether a unit is known and is neither a length nor an angle, nor without dimension: a velocity, a current, a
/// temperature.
[[nodiscard]] bool is_no_position(std::string_view unit);

/// Whether an output of a block may be a velocity at all: its main one, or the rate that it gives beside it. Of no
/// block, whatever it is.
[[nodiscard]] bool may_be_velocity(const Node* node, std::size_t output);

/// Whether `driver` may be the velocity of what a force moves, where the node `changed` changes the signal `input` to
/// that force. A friction opposes the motion that it slows: its velocity comes from what it changes, as the integral of
/// that force and not as a position, the integral of the integral; and what it changes is neither that velocity nor a
/// position.
[[nodiscard]] bool is_velocity(const Graph& graph, const Wire& driver, const Wire& changed, const Wire& input);

/// Whether a signal is the integral of another one: a speed, a position, a level. A force is none, and no friction.
[[nodiscard]] bool is_integral(const Graph& graph, const Wire& signal);

/// What a signal is a constant times of: back through gains and signs.
[[nodiscard]] Wire without_gains(const Graph& graph, Wire signal);

/// The input that a signal is the motion of: a constant times it or its rates, however these are smoothed; null where
/// it has other sources.
[[nodiscard]] const Port* followed_input(const Graph& graph, const Wire& signal);

/// Whether all that reads what a node gives takes the rate of it.
[[nodiscard]] bool leads_to_rates(const Graph& graph, std::string_view path);

/// Whether a signal is a sum, and what a node of that path passes on of it is integrated: a balance of forces, of
/// flows, of heats, whose excess is stored.
[[nodiscard]] bool is_balance(const Graph& graph, const Wire& signal, const std::string& passed_on_by);

/// What no wire leads to.
inline constexpr std::size_t unconnected = std::numeric_limits<std::size_t>::max();

/// How many wires behind some nodes each node is; these themselves 0.
[[nodiscard]] std::vector<std::size_t> steps_behind(const Graph& graph, const std::vector<std::uint32_t>& nodes);

}  // namespace hysteron::diagnosis
