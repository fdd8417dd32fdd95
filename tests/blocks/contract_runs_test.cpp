// What every block owes in a run, held over the whole catalogue.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/blocks/contract.hpp"
#include "tests/blocks/explicit_double.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"
#include "tests/support/counted_new.hpp"

namespace hysteron::testing {
namespace {

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

TEST(Contract, AStepAtOnceIsOutputAndUpdate) {
  int count = 0;
  for_each_run([&]<class B>(std::uint64_t seed, double ts) {
    if constexpr (StepsAtOnce<B>) {
      ++count;
      RandomIo random(seed, ts);
      Stepper<B> block(ts, random.make<DoubleParams<B>>());
      auto state = block.state;
      for (int k = 0; k < steps; ++k) {
        const auto in = random.make<DoubleIn<B>>();
        const auto out = B::template step<double>(block.params, state, in, ts);
        ASSERT_EQ(bits(block(in)), bits(out)) << "step " << k;
      }
      EXPECT_EQ(bits(state), bits(block.state));
    }
  });
  EXPECT_GT(count, 0);
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
  delete new volatile int(1);
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

}  // namespace
}  // namespace hysteron::testing
