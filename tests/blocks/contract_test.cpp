// What every block owes in its description, held over the whole catalogue.
#include "tests/blocks/contract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

namespace hysteron::testing {
namespace {

bool in_range(const Field& field, double value) {
  return value >= field.minimum && value <= field.maximum && !(field.above_minimum && value == field.minimum);
}

bool is_name(std::string_view name) {
  return !name.empty() && std::isupper(static_cast<unsigned char>(name.front())) != 0 &&
         std::ranges::all_of(name,
                             [](unsigned char c) { return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_'; });
}

/// Names that no IEC compiler takes as a variable, or that the language gives a meaning of its own.
const std::set<std::string_view> reserved{
    "DT",   "TOD",    "DATE",  "TIME",   "STEP",  "TASK",   "ON",      "EN",      "ENO",    "AND",    "OR",   "XOR",
    "NOT",  "MOD",    "ABS",   "SQRT",   "LN",    "LOG",    "EXP",     "SIN",     "COS",    "TAN",    "ASIN", "ACOS",
    "ATAN", "EXPT",   "SEL",   "MAX",    "MIN",   "MUX",    "LIMIT",   "ADD",     "SUB",    "MUL",    "DIV",  "GT",
    "GE",   "EQ",     "LE",    "LT",     "NE",    "MOVE",   "TRUE",    "FALSE",   "IF",     "FOR",    "TO",   "BY",
    "DO",   "OF",     "AT",    "VAR",    "TYPE",  "STRUCT", "ARRAY",   "R_EDGE",  "F_EDGE", "RETAIN", "WITH", "CASE",
    "EXIT", "RETURN", "WHILE", "REPEAT", "UNTIL", "ACTION", "PROGRAM", "CONSTANT"};

TEST(Contract, EveryBlockIsAFunctionBlock) {
  for_each_block([]<class B> {
    EXPECT_TRUE(FunctionBlock<B>);
    EXPECT_TRUE(std::is_trivially_copyable_v<typename B::template State<double>>);
    EXPECT_TRUE(std::is_trivially_copyable_v<DoubleParams<B>>);
  });
}

TEST(Contract, EveryBlockIsDescribed) {
  std::set<std::string_view> names;
  for_each_block([&]<class B> {
    const About& about = B::about;
    EXPECT_TRUE(names.insert(about.name).second) << "two blocks of one name";
    EXPECT_TRUE(about.name.starts_with("HY_") && is_name(about.name));
    EXPECT_GE(about.title.size(), 2U);
    EXPECT_FALSE(about.equation.empty());
    EXPECT_GE(about.meaning.size(), 30U);
    EXPECT_TRUE(about.meaning.ends_with('.'));
  });
}

template <class Struct>
void expect_described(std::set<std::string_view>& names, bool has_presets) {
  for (const Field& field : fields_of<Struct>()) {
    SCOPED_TRACE(std::string(field.name));
    EXPECT_TRUE(is_name(field.name));
    EXPECT_FALSE(reserved.contains(field.name)) << "a reserved name";
    EXPECT_TRUE(names.insert(field.name).second) << "pins, parameters and states share one scope in ST";
    EXPECT_GE(field.meaning.size(), 3U);
    EXPECT_LE(field.minimum, field.maximum);
    if (field.type == Type::Real) {
      EXPECT_TRUE(!field.unit.empty() || field.meaning.find("unit") != std::string_view::npos)
          << "a real field has a unit, or its meaning says why not";
    }
    if (has_presets && !field.required) {
      EXPECT_TRUE(in_range(field, field.preset)) << "preset " << field.preset;
    }
    if (!field.effect.empty()) {
      EXPECT_TRUE(field.has_neutral()) << "an effect can be switched off";
      EXPECT_TRUE(std::ranges::all_of(field.effect, [](unsigned char c) { return std::islower(c) != 0 || c == '_'; }))
          << field.effect;
    }
    if (field.has_neutral()) {
      EXPECT_TRUE(in_range(field, field.neutral)) << "neutral " << field.neutral;
    }
  }
}

TEST(Contract, EveryFieldIsDescribed) {
  for_each_block([]<class B> {
    std::set<std::string_view> names;
    expect_described<DoubleIn<B>>(names, true);
    expect_described<DoubleParams<B>>(names, true);
    expect_described<typename B::template Out<double>>(names, false);
    expect_described<typename B::template State<double>>(names, true);
    EXPECT_GT(fields_of<typename B::template Out<double>>().size(), 0U);
    EXPECT_EQ(names.contains("ERROR"), names.contains("ERRORID")) << "an error comes as ERROR and ERRORID";
  });
}

TEST(Contract, OnlyEffectsHaveANeutralSetting) {
  for_each_block([]<class B> {
    if (B::about.effect.empty()) {
      const auto fields = fields_of<DoubleParams<B>>();
      for (const Field& field : fields) {
        // A further parameter of an effect begins with the name of the first: ASYMMETRY, ASYMMETRY_EXPONENT.
        const bool further = std::ranges::any_of(fields, [&](const Field& first) {
          return !first.effect.empty() && field.name.starts_with(std::string(first.name) + "_");
        });
        EXPECT_TRUE(field.has_neutral() ? further || !field.effect.empty() : field.effect.empty()) << field.name;
      }
    }
  });
}

}  // namespace
}  // namespace hysteron::testing
