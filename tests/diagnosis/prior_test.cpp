// What siblings tell: weights of families, and the file that a fleet writes.
#include "diagnosis/prior.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "blocks/families.hpp"
#include "support/diagnostic.hpp"
#include "support/sha256.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::HasSubstr;

TEST(Prior, WithoutSiblingsAllIsAlike) {
  using Siblings = std::vector<Prior::Probabilities>;
  for (const Prior& none : {Prior(), Prior(Siblings{}), Prior(Siblings(2)), Prior(Siblings{{{"play", 0.0}}})}) {
    EXPECT_EQ(none.siblings(), 0U);
    EXPECT_EQ(none.weight("play"), 1.0);
    EXPECT_EQ(none.weight_of_set({"play", "offset"}), 1.0);
    EXPECT_EQ(none.weight_of_set({}), 1.0);
  }
}

/// Siblings that have each family alike say what the library says.
TEST(Prior, SiblingsThatHaveAllAlikeChangeNothing) {
  Prior::Probabilities all;
  for (const FamilyText& one : family_texts) {
    all[std::string(one.name)] = 0.2;
  }
  const Prior prior({all, all, all});
  for (const FamilyText& one : family_texts) {
    EXPECT_NEAR(prior.weight(std::string(one.name)), 1.0, 1e-12);
  }
}

/// 30 siblings of 30 have dry friction: r = (30 + r0)/31, r0 = 1/14 of one family in fourteen.
TEST(Prior, IsTheOddsOfARateOverThoseOfTheLibrary) {
  const Prior prior(std::vector<Prior::Probabilities>(30, {{"dry_friction", 1.0}}));
  const double mean = 1.0 / static_cast<double>(family_texts.size());
  const auto odds = [](double rate) { return rate / (1.0 - rate); };
  EXPECT_EQ(prior.siblings(), 30U);
  EXPECT_NEAR(prior.weight("dry_friction"), odds((30.0 + mean) / 31.0) / odds(mean), 1e-9);
  EXPECT_NEAR(prior.weight("play"), odds(mean / 31.0) / odds(mean), 1e-12);
  EXPECT_NEAR(prior.weight_of_set({"dry_friction", "play"}), prior.weight("dry_friction") * prior.weight("play"), 1e-9);
  EXPECT_GT(prior.weight("play"), 0.0) << "none is ruled out";
}

TEST(Prior, MoreSiblingsThatHaveItWeighMore) {
  double last = 1.0;
  for (std::size_t with = 1; with <= 20; ++with) {
    std::vector<Prior::Probabilities> siblings(20, {{"offset", 0.3}});
    for (std::size_t i = 0; i < with; ++i) {
      siblings[i]["play"] = 0.9;
    }
    const double weight = Prior(siblings).weight("play");
    EXPECT_GT(weight, with == 1 ? 0.0 : last);
    last = weight;
  }
}

class PriorFile : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) { return folder.write(name, text); }
  std::string machine(const std::string& name, const std::string& log, const std::string& families) {
    return R"({"machine": ")" + name + R"(", "records": [{"log": ")" + sha256(log) + R"(", "families": {)" + families +
           "}}]}";
  }
  test::ScratchFolder folder;
};

TEST_F(PriorFile, ARecordIsNoSiblingOfItself) {
  const std::string text = R"({"schema": "hysteron-prior/1", "machines": [)" +
                           machine("A", "t,U\n0,1\n", R"("play": 1.0)") + "," +
                           machine("B", "t,U\n0,2\n", R"("offset": 1.0)") + "]}";
  const std::string file = write("prior.json", text);
  const Prior all = read_prior(file, {write("c.csv", "t,U\n0,3\n")});
  EXPECT_EQ(all.siblings(), 2U);
  EXPECT_EQ(all.weight("play"), all.weight("offset"));
  const Prior others = read_prior(file, {write("copy.csv", "t,U\n0,1\n")});
  EXPECT_EQ(others.siblings(), 1U);
  EXPECT_LT(others.weight("play"), 1.0);
  EXPECT_GT(others.weight("offset"), 1.0);
}

TEST_F(PriorFile, RecordsOfOneMachineAreOneSibling) {
  std::string records;
  for (int i = 0; i < 9; ++i) {
    records += std::string(i == 0 ? "" : ",") + R"({"log": ")" + std::to_string(i) + R"(", "families": {"play": 1.0}})";
  }
  const std::string file = write(
      "prior.json", R"({"schema": "hysteron-prior/1", "machines": [{"machine": "A", "records": [)" + records + "]}]}");
  const Prior many = read_prior(file, {});
  EXPECT_EQ(many.siblings(), 1U);
  EXPECT_NEAR(many.weight("play"), Prior({{{"play", 1.0}}}).weight("play"), 1e-12);
}

TEST_F(PriorFile, WhatIsNoPriorIsRefused) {
  const auto refusal = [&](const std::string& text) {
    try {
      (void)read_prior(write("p.json", text), {});
    } catch (const InputError& problem) {
      return std::string(problem.what());
    }
    return std::string("taken");
  };
  for (const char* const text : {"", "[]", "{", "3", R"({"schema": "hysteron-verdict/1"})", R"({"schema": 1})"}) {
    EXPECT_THAT(refusal(text), HasSubstr("no prior of a fleet")) << text;
  }
  EXPECT_THAT(refusal(R"({"schema": "hysteron-prior/1"})"), HasSubstr("machines"));
  EXPECT_THAT(
      refusal(
          R"({"schema": "hysteron-prior/1", "machines": [{"records": [{"log": "a", "families": {"play": "x"}}]}]})"),
      HasSubstr("number"));
  EXPECT_THAT(refusal(R"({"schema": "hysteron-prior/1", "machines": [)" + machine("A", "x", R"("play": 2.0)") + "]}"),
              HasSubstr("the probability of play is 2"));
  EXPECT_THROW((void)read_prior("/nowhere/prior.json", {}), InputError);
}

}  // namespace
}  // namespace hysteron::diagnosis
