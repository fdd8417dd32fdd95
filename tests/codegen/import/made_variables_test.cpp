#include "codegen/import/made_variables.hpp"

#include <gtest/gtest.h>

namespace hysteron::import {
namespace {

TEST(MadeVariables, AFreeNameStaysWhateverItEndsWith) {
  MadeVariables made;
  EXPECT_EQ(made.new_name("ADD_1"), "ADD_1");
  EXPECT_EQ(made.new_name("ADD_2"), "ADD_2");
  EXPECT_EQ(made.new_name("SUM"), "SUM");
}

TEST(MadeVariables, ATakenNameGetsTheFirstFreeNumber) {
  MadeVariables made;
  made.take("Sum");
  made.take("SUM_2");
  EXPECT_EQ(made.new_name("SUM"), "SUM_1");
  EXPECT_EQ(made.new_name("sum"), "sum_3");
  made.take("ADD_1");
  EXPECT_EQ(made.new_name("ADD_1"), "ADD_1_1");
}

TEST(MadeVariables, AWordOfTheLanguageIsNoName) {
  MadeVariables made;
  EXPECT_EQ(made.new_name("IF"), "IF_1");
}

}  // namespace
}  // namespace hysteron::import
