// An effect with its strengths at their neutral values, from XIN to XOUT.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "tests/blocks/contract.hpp"

namespace hysteron::testing {

class NeutralRun {
 public:
  NeutralRun(std::string_view name, double ts)
      : block_(contract_block(name)),
        xin_(real_place(block_.in, "XIN").value()),
        xout_(real_place(block_.out, "XOUT").value()),
        out_(places(block_.out).back()) {
    auto params = preset_numbers(block_.params);
    EXPECT_GT(neutralise(block_.params, params), 0);
    run_ = block_.in_double(params, ts);
  }

  /// XOUT of a step with the other inputs as given.
  double step(std::vector<double> in, double xin) {
    in[xin_] = xin;
    run_->step(in, out_);
    return out_[xout_];
  }
  [[nodiscard]] std::span<const Field> inputs() const { return block_.in; }

 private:
  const ContractBlock& block_;
  std::size_t xin_;
  std::size_t xout_;
  std::vector<double> out_;
  std::unique_ptr<AnyRunInDouble> run_{};
};

}  // namespace hysteron::testing
