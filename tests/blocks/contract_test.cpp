// What every block owes in its description, held over the whole catalogue.
#include "tests/blocks/contract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>

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
  for_each_block([](const ContractBlock& block) {
    EXPECT_TRUE(block.is_function_block);
    EXPECT_TRUE(block.is_trivially_copyable);
  });
}

TEST(Contract, EveryBlockIsDescribed) {
  std::set<std::string_view> names;
  for_each_block([&](const ContractBlock& block) {
    const About& about = *block.about;
    EXPECT_TRUE(names.insert(about.name).second) << "two blocks of one name";
    EXPECT_TRUE(about.name.starts_with("HY_") && is_name(about.name));
    EXPECT_GE(about.title.size(), 2U);
    EXPECT_FALSE(about.equation.empty());
    EXPECT_GE(about.meaning.size(), 30U);
    EXPECT_TRUE(about.meaning.ends_with('.'));
  });
}

void expect_described(std::span<const Field> fields, std::set<std::string_view>& names, bool has_presets) {
  for (const Field& field : fields) {
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
  for_each_block([](const ContractBlock& block) {
    std::set<std::string_view> names;
    expect_described(block.in, names, true);
    expect_described(block.params, names, true);
    expect_described(block.out, names, false);
    expect_described(block.state, names, true);
    EXPECT_GT(block.out.size(), 0U);
    EXPECT_EQ(names.contains("ERROR"), names.contains("ERRORID")) << "an error comes as ERROR and ERRORID";
  });
}

TEST(Contract, OnlyEffectsHaveANeutralSetting) {
  for_each_block([](const ContractBlock& block) {
    if (block.about->effect.empty()) {
      for (const Field& field : block.params) {
        const bool further = !field.shapes.empty();
        EXPECT_TRUE(field.has_neutral() ? further || !field.effect.empty() : field.effect.empty()) << field.name;
      }
    }
  });
}

TEST(Contract, EveryEffectIsOfAFamily) {
  std::map<std::string_view, Family> families;
  const auto expect = [&](std::string_view effect, Family family) {
    EXPECT_EQ(effect.empty(), family == Family::None) << effect;
    EXPECT_EQ(families.try_emplace(effect, family).first->second, family) << effect << " is of two families";
  };
  for_each_block([&](const ContractBlock& block) {
    expect(block.about->effect, block.about->family);
    EXPECT_TRUE(block.about->untried.empty() || !block.about->effect.empty());
    for (const Field& field : block.params) {
      expect(field.effect, field.family);
    }
  });
  EXPECT_EQ(families.at("creep"), families.at("relaxation"));
}

TEST(Families, AreNamedAndSaidWhatTheyAre) {
  std::set<std::string_view> names;
  for (const FamilyText& one : family_texts) {
    EXPECT_TRUE(names.insert(one.name).second);
    EXPECT_EQ(name_of(one.family), one.name);
    EXPECT_GE(one.meaning.size(), 10U) << one.name;
  }
  EXPECT_EQ(name_of(Family::None), "");
}

TEST(Contract, AParameterShapesAnEffectOfItsOwnBlock) {
  int count = 0;
  for_each_block([&](const ContractBlock& block) {
    const auto fields = block.params;
    for (const Field& field : fields) {
      if (!field.shapes.empty()) {
        ++count;
        const auto first = std::ranges::find(fields, field.shapes, &Field::name);
        ASSERT_NE(first, fields.end()) << field.name << " shapes " << field.shapes;
        EXPECT_FALSE(first->effect.empty()) << field.name << " shapes " << field.shapes;
      }
    }
  });
  EXPECT_GT(count, 0);
}

TEST(Contract, ARoleStandsWhereItMeansSomething) {
  for_each_block([](const ContractBlock& block) {
    const auto each = [](const auto& fields, bool are_params) {
      for (const Field& field : fields) {
        const bool of_params = text_of(field.role).stated || field.role == FieldRole::LowerBound ||
                               field.role == FieldRole::UpperBound || field.role == FieldRole::PointCount;
        // An input may be what a reset loads.
        EXPECT_TRUE(!of_params || are_params || field.role == FieldRole::StartValue) << field.name;
      }
    };
    each(block.params, true);
    each(block.in, false);
    each(block.out, false);
    each(block.state, false);
    const auto params = block.params;
    EXPECT_EQ(std::ranges::count(params, FieldRole::LowerBound, &Field::role),
              std::ranges::count(params, FieldRole::UpperBound, &Field::role));
  });
}

/// The names of a block's parameters that belong to an effect: all, or those of the field that has it.
std::set<std::string_view> names_of_effect(const ContractBlock& block, std::string_view effect) {
  std::set<std::string_view> names;
  for (const Field& field : block.params) {
    if (block.about->effect == effect ? field.role != FieldRole::StartValue && field.type == Type::Real
                                      : field.effect == effect) {
      names.insert(field.name);
    }
  }
  return names;
}

TEST(Contract, ASimplerEffectHasSomeOfTheParameters) {
  for_each_block([](const ContractBlock& rich) {
    if (rich.about->simpler.empty()) {
      return;
    }
    const auto own = names_of_effect(rich, rich.about->effect);
    int found = 0;
    for (const ContractBlock& plain : contract_blocks()) {
      const auto names = names_of_effect(plain, rich.about->simpler);
      if (!names.empty()) {
        ++found;
        EXPECT_TRUE(std::ranges::includes(own, names)) << plain.about->name;
      }
    }
    EXPECT_GT(found, 0) << rich.about->simpler;
  });
}

}  // namespace
}  // namespace hysteron::testing
