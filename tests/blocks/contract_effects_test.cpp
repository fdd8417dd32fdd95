// What a block owes that adds an effect to a signal, to another block, or to a border between rates: held over the
// whole catalogue.
#include <gtest/gtest.h>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>

#include "tests/blocks/contract.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Contract, AnEffectPassesItsInputThroughWhereNeutral) {
  for_each_block([]<class B> {
    if (B::about.effect.empty()) {
      return;
    }
    if constexpr (requires(DoubleIn<B> in, typename B::template Out<double> out) {
                    { in.XIN } -> std::same_as<double&>;
                    { out.XOUT } -> std::same_as<double&>;
                  }) {
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
  To::fields().apply([&](const auto&... target) {
    const auto each = [&](const auto& one) {
      From::fields().apply([&](const auto&... source) { (set(one, source), ...); });
    };
    (each(target), ...);
  });
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
    if constexpr (!Rich::about.enriches.empty()) {
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
      EXPECT_EQ(found, 1) << Rich::about.enriches << " is no block";
    }
  });
}

TEST(Contract, ABorderBetweenRatesOnlyPassesOn) {
  int borders = 0;
  for_each_block([&]<class B> {
    if (!B::about.rate_transition) {
      return;
    }
    ++borders;
    if constexpr (requires(DoubleIn<B> in, typename B::template Out<double> out) {
                    { in.XIN } -> std::same_as<double&>;
                    { out.XOUT } -> std::same_as<double&>;
                  }) {
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
