#include "tests/support/summarised_stderr.hpp"

#include <gtest/gtest.h>

#include <string>

namespace hysteron::test {
namespace {

TEST(SummarisedStderr, LinesOfOneKindAreOne) {
  EXPECT_EQ(summarised(""), "");
  EXPECT_EQ(summarised("a 1\nb\na 22\nb c\na 3"), "a 1 (and 2 more of its kind)\nb\nb c\n");
}

TEST(SummarisedStderr, WhatIsWrittenMeanwhileComesAtItsEnd) {
  testing::internal::CaptureStderr();
  {
    const SummarisedStderr summary;
    for (int version = 1; version <= 1000; ++version) {
      (void)std::fputs(("version " + std::to_string(version) + " runs\n").c_str(), stderr);
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "version 1 runs (and 999 more of its kind)\n");
}

}  // namespace
}  // namespace hysteron::test
