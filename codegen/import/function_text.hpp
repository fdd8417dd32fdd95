// What elements of a network are as text: their order, and the call of a function.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/import/drawing.hpp"
#include "codegen/import/types.hpp"
#include "codegen/plcopen/functions.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::import {

struct Value {
  std::string text{};
  std::optional<Carried> type{};
};

/// The elements that do something, by their place in the POU. Those with an order come first, then what assigns, then
/// the blocks, each from the top, as editors do it.
[[nodiscard]] std::vector<std::size_t> order_of_execution(const DrawnPou& pou);

/// A function, or its operator where it has one, on its arguments.
[[nodiscard]] Value applied(const plcopen::OperatorFunction* own, const std::string& name,
                            const std::vector<Value>& arguments);

/// What is wrong with this number of arguments; empty where nothing is, or where the check of the text tells it.
[[nodiscard]] std::string wrong_count(const plcopen::OperatorFunction* own, std::string_view name, std::size_t count);

/// Where an input of a function belongs: by its name, or behind those before it where editors give it none of its own.
/// Nothing where the function has no such input.
[[nodiscard]] std::optional<std::size_t> place_of_input(std::string_view function, std::string_view input,
                                                        std::size_t next);

[[nodiscard]] std::string negated(const std::string& text);

/// The type of an output of a block of the library, by the names of type and pin; nothing where it is none.
[[nodiscard]] std::optional<Type> output_type(std::string_view block, std::string_view pin);

/// The variables of a POU, by name in capitals.
using Variables = std::map<std::string, const DrawnVariable*>;

/// What a variable, an element of one, or a literal carries.
[[nodiscard]] std::optional<Carried> type_of_text(const Variables& variables, const std::string& text);

/// What a function gives, by the variables that are connected to it.
[[nodiscard]] std::optional<Carried> result_type(const DrawnPou& pou, const Variables& variables,
                                                 const DrawnElement& function);

/// Whether a POU of the project, or else a block of the library, has an input.
[[nodiscard]] bool has_input(const DrawnPou* own, const BlockType* block, std::string_view pin);

}  // namespace hysteron::import
