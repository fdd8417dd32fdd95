// The rules of a diagnosis: what they answer, what is kept of it, and that one of them can be left out.
#include "diagnosis/rules.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <string>

#include "support/diagnostic.hpp"

namespace hysteron::diagnosis {
namespace {

TEST(Rules, AnswerAgainstTheirThresholdAndKeepIt) {
  Rules rules;
  EXPECT_TRUE(rules.is_above(policy::named, 0.7, "dry_friction"));
  EXPECT_FALSE(rules.is_above(policy::named, 0.5));  // at the threshold is not above it
  ASSERT_EQ(rules.decisions().size(), 2U);
  EXPECT_EQ(rules.decisions()[0].rule, "named");
  EXPECT_EQ(rules.decisions()[0].about, "dry_friction");
  EXPECT_EQ(rules.decisions()[0].measured, 0.7);
  EXPECT_EQ(rules.decisions()[0].threshold, policy::named.value);
  EXPECT_EQ(rules.decisions()[0].outcome, "above");
  EXPECT_EQ(rules.decisions()[1].outcome, "below");
}

TEST(Rules, ACapIsKeptWhereItHoldsDown) {
  Rules rules;
  EXPECT_EQ(rules.capped(policy::sure_of_one_motion, 0.3), 0.3);
  EXPECT_TRUE(rules.decisions().empty());
  EXPECT_EQ(rules.capped(policy::sure_of_one_motion, 0.95), policy::sure_of_one_motion.value);
  EXPECT_EQ(rules.decisions().size(), 1U);
}

TEST(Rules, EachCanBeLeftOutAndThenChangesNothing) {
  for (const Threshold& one : policy::all) {
    if (!one.is_rule()) {
      continue;
    }
    Rules rules({std::string(one.name)});
    EXPECT_EQ(rules[one], one.neutral) << one.name;
    EXPECT_TRUE(one.neutral == policy::anything || one.neutral == policy::nothing || one.neutral == 0.0) << one.name;
    for (const Threshold& other : policy::all) {
      if (&other != &one && other.is_rule()) {
        EXPECT_EQ(rules[other], other.value) << one.name << " left out, " << other.name;
      }
    }
  }
  Rules sure({"sure-of-one-motion"});
  EXPECT_EQ(sure.capped(policy::sure_of_one_motion, 0.95), 0.95);
  Rules any({"relevant"});
  EXPECT_TRUE(any.is_above(policy::relevant, -1.0));
}

TEST(Rules, WhatIsNoneIsRefusedWithThoseThatAre) {
  for (const std::string name : {"relevance", "blocks", ""}) {  // no name, a setting, nothing
    try {
      const Rules rules({name});
      FAIL() << name;
    } catch (const InputError& error) {
      const Diagnostic& told = error.diagnostics().all().front();
      EXPECT_EQ(told.number, 730);
      EXPECT_THAT(told.mend, testing::HasSubstr("relevant"));
      EXPECT_THAT(told.mend, testing::Not(testing::HasSubstr("blocks")));
    }
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
