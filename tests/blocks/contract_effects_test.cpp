// What a block owes that adds an effect to a signal, to another block, or to a border between rates: held over the
// whole catalogue.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/blocks/contract.hpp"
#include "tests/blocks/random_io.hpp"

namespace hysteron::testing {
namespace {

TEST(Contract, AnEffectPassesItsInputThroughWhereNeutral) {
  for_each_block([](const ContractBlock& block) {
    if (block.about->effect.empty()) {
      return;
    }
    const auto xin = real_place(block.in, "XIN");
    const auto xout = real_place(block.out, "XOUT");
    ASSERT_TRUE(xin && xout) << "an effect stands between XIN and XOUT";
    auto params = preset_numbers(block.params);
    EXPECT_GT(neutralise(block.params, params), 0) << "an effect has a neutral setting";

    std::vector<double> out(places(block.out).back());
    for (const double ts : sample_times) {
      RandomIo random(1, ts);
      const auto run = block.in_double(params, ts);
      auto in = preset_numbers(block.in);
      for (int k = 0; k < steps; ++k) {
        in[*xin] = (random.unit() - 0.5) * std::pow(10.0, 40.0 * (random.unit() - 0.5));
        run->step(in, out);
        ASSERT_TRUE(same_bits(out[*xout], in[*xin])) << "step " << k << ", XIN " << in[*xin];
      }
    }
  });
}

void expect_fields_of_both(std::span<const Field> rich_fields, std::span<const Field> plain_fields) {
  std::map<std::string_view, Field> rich;
  for (const Field& field : rich_fields) {
    rich.emplace(field.name, field);
  }
  for (const Field& plain : plain_fields) {
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

/// Numbers of a structure, with those of another one written over the fields that have the same name, type and length.
void copy_by_name(std::span<const Field> to_fields, std::vector<double>& to, std::span<const Field> from_fields,
                  const std::vector<double>& from) {
  const auto to_places = places(to_fields);
  const auto from_places = places(from_fields);
  for (std::size_t i = 0; i < to_fields.size(); ++i) {
    for (std::size_t j = 0; j < from_fields.size(); ++j) {
      const Field& target = to_fields[i];
      const Field& source = from_fields[j];
      if (target.name == source.name && target.type == source.type && target.length == source.length) {
        for (std::size_t k = 0; k < target.length; ++k) {
          to[to_places[i] + k] = from[from_places[j] + k];
        }
      }
    }
  }
}

/// A block that enriches another, beside that one, on the same random inputs and parameters.
void expect_enriched(const ContractBlock& rich, const ContractBlock& plain, std::uint64_t seed, double ts) {
  RandomIo random(seed, ts);
  auto rich_params = random.numbers(rich.params);
  EXPECT_GT(neutralise(rich.params, rich_params), 0);
  const auto plain_params = random.numbers(plain.params);
  copy_by_name(rich.params, rich_params, plain.params, plain_params);
  const auto rich_run = rich.in_double(rich_params, ts);
  const auto plain_run = plain.in_double(plain_params, ts);
  std::vector<double> rich_out(places(rich.out).back());
  std::vector<double> expected(places(plain.out).back());
  for (int k = 0; k < steps; ++k) {
    auto rich_in = random.numbers(rich.in);
    const auto plain_in = random.numbers(plain.in);
    copy_by_name(rich.in, rich_in, plain.in, plain_in);
    plain_run->step(plain_in, expected);
    rich_run->step(rich_in, rich_out);
    auto common = expected;
    copy_by_name(plain.out, common, rich.out, rich_out);
    ASSERT_EQ(bits(common), bits(expected)) << "step " << k;
  }
}

TEST(Contract, AnEnrichingBlockIsTheBlockItReplacesWhereNeutral) {
  int enriching = 0;
  for_each_run([&](const ContractBlock& rich, std::uint64_t seed, double ts) {
    if (rich.about->enriches.empty()) {
      return;
    }
    ++enriching;
    int found = 0;
    for (const ContractBlock& plain : contract_blocks()) {
      if (plain.about->name == rich.about->enriches) {
        ++found;
        expect_fields_of_both(rich.in, plain.in);
        expect_fields_of_both(rich.params, plain.params);
        expect_fields_of_both(rich.out, plain.out);
        expect_enriched(rich, plain, seed, ts);
      }
    }
    EXPECT_EQ(found, 1) << rich.about->enriches << " is no block";
  });
  EXPECT_GT(enriching, 0);
}

TEST(Contract, ABorderBetweenRatesOnlyPassesOn) {
  int borders = 0;
  for_each_block([&](const ContractBlock& block) {
    if (!block.about->rate_transition) {
      return;
    }
    ++borders;
    const auto xin = real_place(block.in, "XIN");
    const auto xout = real_place(block.out, "XOUT");
    ASSERT_TRUE(xin && xout) << "a border has XIN and XOUT";
    EXPECT_TRUE(block.state.empty());
    auto in = preset_numbers(block.in);
    in[*xin] = 0.1;
    std::vector<double> out(places(block.out).back());
    block.in_double(preset_numbers(block.params), 1.0)->step(in, out);
    EXPECT_EQ(out[*xout], 0.1);
  });
  EXPECT_EQ(borders, 2);
}

}  // namespace
}  // namespace hysteron::testing
