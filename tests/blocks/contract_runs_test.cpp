// What every block owes in a run, held over the whole catalogue.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/blocks/contract.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/support/counted_new.hpp"

namespace hysteron::testing {
namespace {

/// A run with random parameters, and what it is given and gives.
template <class Run>
class RandomRun {
 public:
  RandomRun(const ContractBlock& block, MakeRun<Run> make, std::uint64_t seed, double ts)
      : block_(block),
        random_(seed, ts),
        run_(make(random_.numbers(block.params), ts)),
        out_(places(block.out).back()) {}

  std::vector<double> draw() { return random_.numbers(block_.in); }
  std::vector<std::uint64_t> step(const std::vector<double>& in) {
    run_->step(in, out_);
    return bits(out_);
  }
  std::vector<double>& out() { return out_; }
  Run& operator*() { return *run_; }

 private:
  const ContractBlock& block_;
  RandomIo random_;
  std::unique_ptr<Run> run_;
  std::vector<double> out_;
};

TEST(Contract, ResetStartsAnew) {
  for_each_run([](const ContractBlock& block, std::uint64_t seed, double ts) {
    RandomRun run(block, block.in_double, seed, ts);
    std::vector<std::vector<double>> inputs;
    std::vector<std::vector<std::uint64_t>> first;
    for (int k = 0; k < steps; ++k) {
      inputs.push_back(run.draw());
      first.push_back(run.step(inputs.back()));
    }
    (*run).reset();
    for (int k = 0; k < steps; ++k) {
      const auto i = static_cast<std::size_t>(k);
      ASSERT_EQ(run.step(inputs[i]), first[i]) << "step " << k;
    }
  });
}

TEST(Contract, OutputLeavesTheStateAlone) {
  for_each_run([](const ContractBlock& block, std::uint64_t seed, double ts) {
    RandomRun run(block, block.in_double, seed, ts);
    std::vector<double> once(run.out().size());
    for (int k = 0; k < steps; ++k) {
      const auto in = run.draw();
      (*run).output(in, once);
      ASSERT_EQ(run.step(in), bits(once)) << "step " << k;
    }
  });
}

TEST(Contract, AStepAtOnceIsOutputAndUpdate) {
  int count = 0;
  for_each_run([&](const ContractBlock& block, std::uint64_t seed, double ts) {
    if (block.steps_at_once) {
      ++count;
      RandomRun run(block, block.in_double, seed, ts);
      RandomRun at_once(block, block.in_double, seed, ts);
      for (int k = 0; k < steps; ++k) {
        const auto in = run.draw();
        (*at_once).step_at_once(in, at_once.out());
        ASSERT_EQ(run.step(in), bits(at_once.out())) << "step " << k;
      }
      EXPECT_EQ(bits((*at_once).memory()), bits((*run).memory()));
    }
  });
  EXPECT_GT(count, 0);
}

TEST(Contract, AStepAllocatesNothing) {
  for_each_block([](const ContractBlock& block) {
    RandomRun run(block, block.in_double, 1, 1e-3);
    const auto in = run.draw();
    const std::size_t before = hysteron::test::allocations;
    (*run).reset();
    (*run).step(in, run.out());
    (*run).step(in, run.out());
    EXPECT_EQ(hysteron::test::allocations, before);
  });
  const std::size_t before = hysteron::test::allocations;
  delete new volatile int(1);
  EXPECT_EQ(hysteron::test::allocations, before + 1) << "the counter counts";
}

template <class Run>
void expect_finite(const ContractBlock& block, MakeRun<Run> make, std::uint64_t seed, double ts) {
  RandomRun run(block, make, seed, ts);
  for (int k = 0; k < steps; ++k) {
    run.step(run.draw());
    for (const double value : run.out()) {
      ASSERT_TRUE(std::isfinite(value)) << "step " << k;
    }
  }
}

TEST(Contract, OutputsAreFiniteInDouble) {
  for_each_run([](const ContractBlock& block, std::uint64_t seed, double ts) {
    expect_finite(block, block.in_double, seed, ts);
  });
}

TEST(Contract, OutputsAreFiniteInFloat) {
  for_each_block([](const ContractBlock& block) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      expect_finite(block, block.in_float, seed, 1e-3);
    }
  });
}

TEST(Contract, ExplicitDoubleGivesTheBitsOfDouble) {
  for_each_run([](const ContractBlock& block, std::uint64_t seed, double ts) {
    RandomRun run(block, block.in_double, seed, ts);
    RandomRun explicitly(block, block.in_explicit_double, seed, ts);
    for (int k = 0; k < steps; ++k) {
      const auto in = run.draw();
      ASSERT_EQ(explicitly.step(in), run.step(in)) << "step " << k;
    }
  });
}

}  // namespace
}  // namespace hysteron::testing
