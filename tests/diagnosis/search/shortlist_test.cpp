// Which of the candidates that were screened are followed.
#include "diagnosis/search/shortlist.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace hysteron::diagnosis {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Screened screened(const std::string& effect, const std::string& edge, double gain) {
  Screened one;
  one.candidate.variant.effects.push_back({.effect = effect, .edge = edge});
  one.starts.push_back({.gain = gain});
  return one;
}

std::vector<std::string> places(const std::vector<Screened>& list) {
  std::vector<std::string> result;
  for (const Screened& one : list) {
    result.push_back(one.candidate.own().place());
  }
  return result;
}

const std::vector<Screened>& list() {
  static const std::vector<Screened> list{screened("saturation", "KP.XOUT", 9.0), screened("lag", "U", 8.0),
                                          screened("saturation", "U", 7.0),       screened("lag", "Y", 6.0),
                                          screened("saturation", "E", 5.0),       screened("saturation", "Y", 4.0)};
  return list;
}

TEST(OnUntriedEdges, LeavesOutWhatWasFittedAndItsTwins) {
  EXPECT_THAT(places(on_untried_edges(list(), {"saturation"}, {}, 8)),
              ElementsAre("saturation@KP.XOUT", "saturation@U", "saturation@E", "saturation@Y"));
  EXPECT_THAT(places(on_untried_edges(
                  list(), {"saturation", "lag"},
                  {{.effect = "saturation", .edge = "KP.XOUT", .twins = {"E"}}, {.effect = "lag", .edge = "Y"}}, 8)),
              ElementsAre("lag@U", "saturation@U", "saturation@Y"));
  EXPECT_THAT(places(on_untried_edges(list(), {"saturation", "lag"}, {{.effect = "lag", .edge = "U"}}, 2)),
              ElementsAre("saturation@KP.XOUT", "saturation@U", "lag@Y"));
  EXPECT_THAT(on_untried_edges(list(), {}, {}, 8), IsEmpty());
}

TEST(OnUntriedEdges, OfTwoThatGainAlikeTakesOne) {
  std::vector<Screened> alike = list();
  alike.push_back(screened("saturation", "MOTOR.XIN", 4.0));
  alike.back().candidate.upstream = 1;
  const std::vector<Screened> found = on_untried_edges(alike, {"saturation"}, {}, 8);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found.back().candidate.own().edge, "Y");
  EXPECT_THAT(found.back().candidate.own().twins, ElementsAre("MOTOR.XIN"));
}

TEST(KeepBest, GivesEachEffectItsTurn) {
  std::vector<Screened> kept = list();
  keep_best(kept, 2, 1);
  EXPECT_THAT(places(kept), ElementsAre("saturation@KP.XOUT", "lag@U"));
  kept = list();
  keep_best(kept, 6, 1, 2);
  EXPECT_THAT(places(kept), ElementsAre("saturation@KP.XOUT", "lag@U", "saturation@U", "lag@Y"));
  kept = {screened("saturation", "KP.XOUT", 9.0), screened("saturation", "U", 7.0), screened("lag", "U", 1.0)};
  keep_best(kept, 1, 1);
  EXPECT_THAT(places(kept), ElementsAre("saturation@KP.XOUT", "lag@U"));
}

}  // namespace
}  // namespace hysteron::diagnosis
