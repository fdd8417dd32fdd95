// Samples that no fit saw, beside the explanation that was chosen.
#include "diagnosis/faults/left_out.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double noise_of_speed = 0.002;
constexpr double leap = 40.0 * noise_of_speed;

/// How many glitches of ten stay, each a leap, where the explanation leaves as much in every so many samples.
std::size_t stay_where_it_misses(std::size_t every) {
  const std::string text = test::axis();
  records::Record record =
      test::measured(test::program_of(text), test::record_of("FORCE", test::rich_force()), noise_of_speed);
  std::vector<double> speed = record.column("V").values;
  LeftOut glitches{.effect = "glitches", .rms = 1.0};
  for (std::size_t k = 103; k < speed.size() && glitches.glitches.size() < 10; k += 187) {
    glitches.glitches.push_back(k);
    speed[k] += leap;
  }
  for (std::size_t k = 0; k < speed.size(); k += every) {
    speed[k] += leap;
  }
  record.replace("V", std::move(speed));
  Task task = task_of(test::input_of(text, test::axis_parameters, {record}));
  task.scales = {noise_of_speed};
  for (const std::size_t row : glitches.glitches) {
    task.left_out.push_back(static_cast<Index>(row));
  }
  Explanation chosen{.variant = {.text = text, .program = std::make_shared<const Program>(test::program_of(text))}};
  Model model(task, *chosen.variant.program);
  chosen.fit.x = model.start();
  EXPECT_TRUE(model.residuals(chosen.fit.x, chosen.fit.residuals));
  std::vector<LeftOut> found{glitches};
  forget_explained(found, task, chosen);
  return found.empty() ? 0 : found.front().glitches.size();
}

TEST(LeftOut, GlitchesStandOutOfAllThatIsLeft) {
  EXPECT_EQ(stay_where_it_misses(5000), 10U);
  EXPECT_EQ(stay_where_it_misses(50), 10U) << "glitches that were not found are such";
  EXPECT_EQ(stay_where_it_misses(12), 0U) << "a poor fit leaves as much in one sample of twelve";
}

}  // namespace
}  // namespace hysteron::diagnosis
