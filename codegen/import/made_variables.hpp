// The variables that the text of a network has and its drawing has not: names that nobody has taken, and delays.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "blocks/description.hpp"

namespace hysteron::import {

/// A value as a part of a name: F.Y[-1] is F_Y_m1.
[[nodiscard]] std::string identifier_of(std::string_view value);

class MadeVariables {
 public:
  /// A name of the drawing: no variable is made of it.
  void take(const std::string& name);

  /// The name itself, or the first of NAME_1, NAME_2, … that is free. It is taken from then on.
  [[nodiscard]] std::string new_name(const std::string& base);

  /// What a value was a cycle ago, as the output of a delay that starts at `start`.
  [[nodiscard]] std::string delayed(const std::string& value, Type type, const std::string& start);

  /// The delays, behind all other statements, and their declarations.
  [[nodiscard]] std::string statements() const;
  [[nodiscard]] std::string declarations() const;

 private:
  struct Delay {
    std::string instance{};
    std::string value{};
    std::string start{};
    Type type = Type::Real;
  };
  std::set<std::string> taken_;          ///< in capitals
  std::map<std::string, Delay> delays_;  ///< by their value, in capitals
};

}  // namespace hysteron::import
