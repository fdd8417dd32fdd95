// The layout of the diagram in the report: boxes apart, signals to the right, feedback below.
#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/report/layered_layout.hpp"

namespace hysteron::diagnosis::report {
namespace {

bool overlap(const LayoutBox& a, Point at_a, const LayoutBox& b, Point at_b) {
  return at_a.x < at_b.x + b.width && at_b.x < at_a.x + a.width && at_a.y < at_b.y + b.height &&
         at_b.y < at_a.y + a.height;
}

/// A chain of 30 boxes with shortcuts and feedback, by a rule.
void chain(std::vector<LayoutBox>& boxes, std::vector<LayoutEdge>& edges) {
  for (std::size_t i = 0; i < 30; ++i) {
    boxes.push_back({60.0 + 7.0 * static_cast<double>(i % 5), 30.0 + 14.0 * static_cast<double>(i % 3), Side::Any});
  }
  boxes.front().side = Side::Left;
  boxes.back().side = Side::Right;
  for (std::size_t i = 0; i + 1 < 30; ++i) {
    edges.push_back({i, 10.0, i + 1, 10.0});
    if (i + 7 < 30) {
      edges.push_back({i, 20.0, i + 3 + i % 4, 24.0});
    }
    if (i % 6 == 5) {
      edges.push_back({i, 12.0, i - 4, 20.0});
    }
  }
}

TEST(Layout, NoTwoBoxesOverlapAndAllLieWithinThePicture) {
  std::vector<LayoutBox> boxes;
  std::vector<LayoutEdge> edges;
  chain(boxes, edges);
  const Layout layout = layered_layout(boxes, edges);
  ASSERT_EQ(layout.boxes.size(), boxes.size());
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    EXPECT_GE(layout.boxes[a].x, 0.0);
    EXPECT_GE(layout.boxes[a].y, 0.0);
    EXPECT_LE(layout.boxes[a].x + boxes[a].width, layout.width);
    EXPECT_LE(layout.boxes[a].y + boxes[a].height, layout.height);
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      EXPECT_FALSE(overlap(boxes[a], layout.boxes[a], boxes[b], layout.boxes[b])) << a << " and " << b;
    }
  }
}

TEST(Layout, CurvesBeginAndEndAtTheirPorts) {
  std::vector<LayoutBox> boxes;
  std::vector<LayoutEdge> edges;
  chain(boxes, edges);
  const Layout layout = layered_layout(boxes, edges);
  ASSERT_EQ(layout.curves.size(), edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& curve = layout.curves[e];
    ASSERT_EQ(curve.size() % 3, 1U);
    EXPECT_DOUBLE_EQ(curve.front().x, layout.boxes[edges[e].from].x + boxes[edges[e].from].width);
    EXPECT_DOUBLE_EQ(curve.front().y, layout.boxes[edges[e].from].y + edges[e].from_height);
    EXPECT_DOUBLE_EQ(curve.back().x, layout.boxes[edges[e].to].x);
    EXPECT_DOUBLE_EQ(curve.back().y, layout.boxes[edges[e].to].y + edges[e].to_height);
  }
}

/// REF → SUM → CONTROL → PLANT → Y, and back from PLANT to SUM; another input joins before PLANT.
TEST(Layout, ALoopIsCutAtItsSummingPointAndRunsBackBelow) {
  const std::vector<LayoutBox> boxes{{40, 30, Side::Left}, {40, 30, Side::Left}, {60, 40, Side::Any},
                                     {60, 40, Side::Any},  {60, 40, Side::Any},  {40, 30, Side::Right}};
  const std::vector<LayoutEdge> edges{{1, 15, 4, 30}, {0, 15, 2, 10}, {2, 20, 3, 20},
                                      {3, 20, 4, 10}, {4, 20, 5, 15}, {4, 20, 2, 30}};
  const Layout layout = layered_layout(boxes, edges);
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    EXPECT_LT(layout.boxes[edges[e].from].x + boxes[edges[e].from].width, layout.boxes[edges[e].to].x) << e;
  }
  double lowest_box = 0.0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    lowest_box = std::max(lowest_box, layout.boxes[i].y + boxes[i].height);
  }
  const auto& back = layout.curves.back();
  EXPECT_TRUE(std::any_of(back.begin(), back.end(), [&](Point point) { return point.y > lowest_box; }));
}

TEST(Layout, AChainRunsStraight) {
  const std::vector<LayoutBox> boxes{
      {40, 30, Side::Left}, {60, 42, Side::Any}, {60, 60, Side::Any}, {40, 30, Side::Right}};
  const std::vector<LayoutEdge> edges{{0, 15, 1, 21}, {1, 21, 2, 30}, {2, 30, 3, 15}};
  const Layout layout = layered_layout(boxes, edges);
  for (const auto& curve : layout.curves) {
    EXPECT_NEAR(curve.front().y, curve.back().y, 1e-6);
  }
}

TEST(Layout, NothingIsLaidOutWithoutFault) {
  EXPECT_TRUE(layered_layout({}, {}).boxes.empty());
  const Layout self = layered_layout({{40, 30, Side::Any}}, {{0, 10, 0, 20}});
  EXPECT_EQ(self.curves.size(), 1U);
}

}  // namespace
}  // namespace hysteron::diagnosis::report
