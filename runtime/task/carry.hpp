// Retained values of one diagram, taken over by name into another: the same one edited, or run by another engine.
//
// What a program keeps is bytes, as it lays them out. Beside them a slot has a description of these bytes: each
// parameter and each number of the state with its name, type and unit. So a later program finds what is its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// What the bytes of a slot mean.
struct KeptLayout {
  struct Parameter {
    std::string name{};
    PointType type = PointType::real64;
    std::string unit{};
    double low = 0.0;
    double high = 0.0;
    bool low_excluded = false;
  };
  std::int64_t period = 0;  ///< ns
  std::vector<Parameter> parameters{};
  std::vector<StateField> state{};
  std::vector<Parameter> inputs{};  ///< that clients wrote
};

/// As text: a line "t period", one for each parameter, "p name type unit low high excluded", each number of the state,
/// "s name block type length offset unit", and each retained input, "i" as "p", separated by tabs.
[[nodiscard]] std::string describe(const ProgramShape& shape, std::span<const std::size_t> inputs = {});
/// Empty where a line is not of that form, or where a number lies beyond `state_size` bytes.
[[nodiscard]] KeptLayout read_description(std::string_view text, std::size_t state_size);

/// What is taken over of retained values, and what is not.
struct CarriedValues {
  std::vector<double> parameters{};  ///< as the program's, those not taken over as they were given
  std::size_t parameters_taken = 0;
  std::size_t states_taken = 0;
  std::vector<std::string> left{};  ///< what was not taken over, with the reason: "LAG.Y (um there, mm here)"
};

/// Of what was not taken over: whether it is there for want of another of its name, and not for its kind or value.
[[nodiscard]] bool is_new(std::string_view one);
/// Its name: LAG.Y of "LAG.Y (um there, mm here)".
[[nodiscard]] std::string without_reason(std::string_view one);

/// What a layout and the program both have by one name, and in other units: "AMP.K is in V/mm there, V/um here". Empty
/// where there is none. `inputs`: those that are to be retained. Bytes of one diagram mean something else then.
[[nodiscard]] std::string other_unit(const KeptLayout& kept, const ProgramShape& shape,
                                     std::span<const std::size_t> inputs);

/// Parameters whose name, type and unit are the same, and whose value lies within the program's limits.
[[nodiscard]] CarriedValues carry_parameters(const KeptLayout& kept, std::span<const double> values,
                                             const ProgramShape& shape, std::span<const double> given);

/// Retained inputs that the program has by the same name, type and unit, whose value lies within its limits: by input
/// of the program, nothing where it begins as the diagram says. `wanted`: those that are to be retained. The reasons
/// for what is left are added.
[[nodiscard]] std::vector<std::optional<double>> carry_inputs(const KeptLayout& kept, std::span<const double> values,
                                                              const ProgramShape& shape,
                                                              std::span<const std::size_t> wanted,
                                                              std::vector<std::string>& left);

/// A number of the state, or a row of them, that two layouts have in common, as it lies in the bytes of each.
struct SharedNumber {
  PointType type_from = PointType::real64;
  PointType type_into = PointType::real64;
  std::size_t from = 0;  ///< in bytes
  std::size_t into = 0;
  std::size_t length = 1;
  std::size_t field = 0;  ///< of the shape's state
};

/// Numbers of the state whose instance, block, type and unit are the same; none where the period is another, in which a
/// delay of so many steps is another time. The reasons are added to `left`.
[[nodiscard]] std::vector<SharedNumber> shared_state(const KeptLayout& kept, const ProgramShape& shape,
                                                     std::vector<std::string>& left);
/// Copies what is finite; a row of which one number is not stays as it is in `into`. False then. Allocates nothing.
bool copy_shared(const SharedNumber& shared, std::span<const std::byte> from, std::span<std::byte> into) noexcept;

/// Copies what shared_state finds and is finite; gives back all that it finds. `into` is the state of the program after
/// its reset; the count and the reasons are added to `carried`.
std::vector<SharedNumber> carry_state(const KeptLayout& kept, std::span<const std::byte> from,
                                      const ProgramShape& shape, std::span<std::byte> into, CarriedValues& carried);

/// The name of the first number of a state that is infinite or not a number, though it is finite in `after_reset`;
/// empty where there is none. Both are of the program.
[[nodiscard]] std::string not_finite(const ProgramShape& shape, std::span<const std::byte> state,
                                     std::span<const std::byte> after_reset);

}  // namespace hysteron::runtime
