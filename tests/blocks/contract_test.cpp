// What every block owes, held over the whole catalogue.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "blocks/catalogue.hpp"
#include "tests/blocks/explicit_double.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"
#include "tests/support/counted_new.hpp"

namespace hysteron::testing {
namespace {

constexpr int steps = 400;
constexpr std::array<double, 3> sample_times{50e-6, 1e-3, 1.0};

template <class B>
using DoubleParams = typename B::template Params<double>;
template <class B>
using DoubleIn = typename B::template In<double>;

/// Runs visit.operator()<B>() for every block, with the block's name in every failure.
template <class Visit>
void for_each_block(Visit visit) {
  Catalogue::for_each([&]<class B> {
    SCOPED_TRACE(std::string(B::about.name));
    visit.template operator()<B>();
  });
}

/// Runs visit.operator()<B>(seed, ts) for every block with several sample times and seeds.
template <class Visit>
void for_each_run(Visit visit) {
  for_each_block([&]<class B> {
    for (const double ts : sample_times) {
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", TS " + std::to_string(ts));
        visit.template operator()<B>(seed, ts);
      }
    }
  });
}

/// The bits of all outputs of a run on random inputs, with the block in scalar S.
template <class B, class S>
std::vector<std::vector<std::uint64_t>> run_in(std::uint64_t seed, double ts) {
  RandomIo random(seed, ts);
  Stepper<B, S> block(S(ts), convert<typename B::template Params<S>>(random.make<DoubleParams<B>>()));
  std::vector<std::vector<std::uint64_t>> result;
  for (int k = 0; k < steps; ++k) {
    result.push_back(bits(block(convert<typename B::template In<S>>(random.make<DoubleIn<B>>()))));
  }
  return result;
}

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

TEST(Contract, ResetStartsAnew) {
  for_each_run([]<class B>(std::uint64_t seed, double ts) {
    RandomIo random(seed, ts);
    Stepper<B> block(ts, random.make<DoubleParams<B>>());
    std::vector<DoubleIn<B>> inputs;
    for (int k = 0; k < steps; ++k) {
      inputs.push_back(random.make<DoubleIn<B>>());
    }
    std::vector<std::vector<std::uint64_t>> first;
    for (const auto& in : inputs) {
      first.push_back(bits(block(in)));
    }
    block.reset();
    for (int k = 0; k < steps; ++k) {
      const auto i = static_cast<std::size_t>(k);
      ASSERT_EQ(bits(block(inputs[i])), first[i]) << "step " << k;
    }
  });
}

TEST(Contract, OutputLeavesTheStateAlone) {
  for_each_run([]<class B>(std::uint64_t seed, double ts) {
    RandomIo random(seed, ts);
    Stepper<B> block(ts, random.make<DoubleParams<B>>());
    for (int k = 0; k < steps; ++k) {
      const auto in = random.make<DoubleIn<B>>();
      const auto once = B::output(block.params, block.state, in, ts);
      ASSERT_EQ(bits(block(in)), bits(once)) << "step " << k;
    }
  });
}

TEST(Contract, AStepAllocatesNothing) {
  for_each_block([]<class B> {
    RandomIo random(1, 1e-3);
    Stepper<B> block(1e-3, random.make<DoubleParams<B>>());
    const auto in = random.make<DoubleIn<B>>();
    const std::size_t before = hysteron::test::allocations;
    block.reset();
    block(in);
    block(in);
    EXPECT_EQ(hysteron::test::allocations, before);
  });
  const std::size_t before = hysteron::test::allocations;
  delete new int(1);
  EXPECT_EQ(hysteron::test::allocations, before + 1) << "the counter counts";
}

template <class B, class S>
void expect_finite(std::uint64_t seed, double ts) {
  RandomIo random(seed, ts);
  Stepper<B, S> block(static_cast<S>(ts), convert<typename B::template Params<S>>(random.make<DoubleParams<B>>()));
  for (int k = 0; k < steps; ++k) {
    const auto out = block(convert<typename B::template In<S>>(random.make<DoubleIn<B>>()));
    for (const double value : reals(out)) {
      ASSERT_TRUE(std::isfinite(value)) << "step " << k;
    }
  }
}

TEST(Contract, OutputsAreFiniteInDouble) {
  for_each_run([]<class B>(std::uint64_t seed, double ts) { expect_finite<B, double>(seed, ts); });
}

TEST(Contract, OutputsAreFiniteInFloat) {
  for_each_block([]<class B> {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      expect_finite<B, float>(seed, 1e-3);
    }
  });
}

TEST(Contract, ExplicitDoubleGivesTheBitsOfDouble) {
  for_each_run([]<class B>(std::uint64_t seed, double ts) {
    ASSERT_EQ((run_in<B, ExplicitDouble>(seed, ts)), (run_in<B, double>(seed, ts)));
  });
}

TEST(Contract, AnEffectPassesItsInputThroughWhereNeutral) {
  for_each_block([]<class B> {
    if (B::about.effect.empty()) {
      return;
    }
    if constexpr (requires(DoubleIn<B> in, typename B::template Out<double> out) { in.XIN = out.XOUT; }) {
      auto params = presets<DoubleParams<B>>();
      EXPECT_GT(neutralise(params), 0) << "an effect has a neutral setting";

      for (const double ts : sample_times) {
        RandomIo random(1, ts);
        Stepper<B> block(ts, params);
        auto in = presets<DoubleIn<B>>();
        for (int k = 0; k < steps; ++k) {
          in.XIN = (random.unit() - 0.5) * std::pow(10.0, 40.0 * (random.unit() - 0.5));
          ASSERT_TRUE(same_bits(block(in).XOUT, in.XIN)) << "step " << k << ", XIN " << in.XIN;
        }
      }
    } else {
      ADD_FAILURE() << "an effect stands between XIN and XOUT";
    }
  });
}

TEST(Contract, OnlyEffectsHaveANeutralSetting) {
  for_each_block([]<class B> {
    if (B::about.effect.empty()) {
      for (const Field& field : fields_of<DoubleParams<B>>()) {
        EXPECT_EQ(field.has_neutral(), !field.effect.empty()) << field.name;
      }
    }
  });
}

/// The fields of a structure by their names.
template <class Struct>
std::map<std::string_view, Field> by_name() {
  std::map<std::string_view, Field> fields;
  for (const Field& field : fields_of<Struct>()) {
    fields.emplace(field.name, field);
  }
  return fields;
}

template <class Rich, class Plain>
void expect_fields_of_both() {
  const auto rich = by_name<Rich>();
  for (const Field& plain : fields_of<Plain>()) {
    SCOPED_TRACE(std::string(plain.name));
    ASSERT_TRUE(rich.contains(plain.name));
    const Field& field = rich.at(plain.name);
    EXPECT_EQ(field.type, plain.type);
    EXPECT_EQ(field.length, plain.length);
    EXPECT_EQ(field.unit, plain.unit);
    EXPECT_EQ(field.required, plain.required);
    EXPECT_EQ(field.preset, plain.preset);
    EXPECT_EQ(field.minimum, plain.minimum);
    EXPECT_EQ(field.maximum, plain.maximum);
  }
}

/// Writes the members of one structure into those of the same name in another.
template <class To, class From>
void copy_by_name(To& to, const From& from) {
  const auto set = [&](const auto& target, const auto& source) {
    using Member = std::remove_reference_t<decltype(to.*(target.member))>;
    if constexpr (std::is_same_v<Member, std::remove_cvref_t<decltype(from.*(source.member))>>) {
      if (target.name == source.name) {
        to.*(target.member) = from.*(source.member);
      }
    }
  };
  std::apply(
      [&](const auto&... target) {
        const auto each = [&](const auto& one) {
          std::apply([&](const auto&... source) { (set(one, source), ...); }, From::fields());
        };
        (each(target), ...);
      },
      To::fields());
}

/// A block that enriches another, beside that one, on the same random inputs and parameters.
template <class Rich, class Plain>
void expect_enriched(std::uint64_t seed, double ts) {
  RandomIo random(seed, ts);
  auto rich_params = random.make<DoubleParams<Rich>>();
  EXPECT_GT(neutralise(rich_params), 0);
  const auto plain_params = random.make<DoubleParams<Plain>>();
  copy_by_name(rich_params, plain_params);
  Stepper<Rich> rich(ts, rich_params);
  Stepper<Plain> plain(ts, plain_params);
  for (int k = 0; k < steps; ++k) {
    auto rich_in = random.make<DoubleIn<Rich>>();
    const auto plain_in = random.make<DoubleIn<Plain>>();
    copy_by_name(rich_in, plain_in);
    const auto expected = plain(plain_in);
    auto common = expected;
    copy_by_name(common, rich(rich_in));
    ASSERT_EQ(bits(common), bits(expected)) << "step " << k;
  }
}

TEST(Contract, AnEnrichingBlockIsTheBlockItReplacesWhereNeutral) {
  for_each_run([]<class Rich>(std::uint64_t seed, double ts) {
    int found = 0;
    Catalogue::for_each([&]<class Plain> {
      if constexpr (Plain::about.name == Rich::about.enriches) {
        ++found;
        expect_fields_of_both<DoubleIn<Rich>, DoubleIn<Plain>>();
        expect_fields_of_both<DoubleParams<Rich>, DoubleParams<Plain>>();
        expect_fields_of_both<typename Rich::template Out<double>, typename Plain::template Out<double>>();
        expect_enriched<Rich, Plain>(seed, ts);
      }
    });
    EXPECT_EQ(found, Rich::about.enriches.empty() ? 0 : 1) << Rich::about.enriches << " is no block";
  });
}

TEST(Contract, ABorderBetweenRatesOnlyPassesOn) {
  int borders = 0;
  for_each_block([&]<class B> {
    if (!B::about.rate_transition) {
      return;
    }
    ++borders;
    if constexpr (requires(DoubleIn<B> in, typename B::template Out<double> out) { in.XIN = out.XOUT; }) {
      EXPECT_FALSE(HasMemory<B>);
      Stepper<B> block(1.0);
      auto in = presets<DoubleIn<B>>();
      in.XIN = 0.1;
      EXPECT_EQ(block(in).XOUT, 0.1);
    } else {
      ADD_FAILURE() << "a border has XIN and XOUT";
    }
  });
  EXPECT_EQ(borders, 2);
}

}  // namespace
}  // namespace hysteron::testing
