// Example 6: from the paper's model of a real piezo stack to what remains, one named effect after the other.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <numeric>
#include <span>
#include <vector>

#include "examples/04_piezo_stack/piezo_stack.hpp"
#include "examples/06_piezo_diagnosis/piezo_diagnosis.hpp"
#include "examples/example.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

constexpr std::size_t most_rounds = 4;
constexpr std::ptrdiff_t cycle = 200;  ///< samples

struct Step {
  Round round{};
  StackGap gap{};
};

void print_step(const Step& step, std::size_t number) {
  fmt::print("  {}  {:<38} {:6.2f} %  {:6.2f} %   {}\n", number,
             step.round.named() ? step.round.effect() : "the paper's model", 100.0 * step.gap.fitted,
             100.0 * step.gap.held_out, fmt::join(step.round.rivals(), ", "));
  std::fflush(stdout);
}

/// The mean of each cycle.
std::vector<double> means(const std::vector<double>& values) {
  std::vector<double> result;
  for (auto begin = values.begin(); values.end() - begin >= cycle; begin += cycle) {
    result.push_back(std::accumulate(begin, begin + cycle, 0.0) / static_cast<double>(cycle));
  }
  return result;
}

/// What is left of the last cycle over the voltage, its mean over each cycle, and its size by rounds.
void write_tables(const std::filesystem::path& folder, const StackCycles& cycles, const std::vector<Step>& steps) {
  const auto last = [](const std::vector<double>& values) {
    return std::vector<double>(values.end() - cycle - 1, values.end());
  };
  std::vector<records::Column> loop{{.name = "u", .values = last(cycles.whole.column("u").values)}};
  const std::span<const double> time = cycles.whole.time();
  std::vector<records::Column> drift{{.name = "t", .values = means({time.begin(), time.end()})}};
  std::vector<records::Column> sizes{{.name = "effects"}, {.name = "fitted"}, {.name = "held_out"}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const StackGap& gap = steps[i].gap;
    loop.push_back({.name = fmt::format("after{}", i), .values = last(gap.residual)});
    drift.push_back({.name = fmt::format("after{}", i), .values = means(gap.residual)});
    sizes[0].values.push_back(static_cast<double>(i));
    sizes[1].values.push_back(100.0 * gap.fitted);
    sizes[2].values.push_back(100.0 * gap.held_out);
  }
  write_table(folder / "last_cycle.csv", loop);
  write_table(folder / "means.csv", drift);
  write_table(folder / "rounds.csv", sizes);
}

void example(const std::filesystem::path& folder) {
  const auto identification = stack_record("identify_1hz.csv");
  if (!identification) {
    fmt::print(
        "The measured records are not at hand. They come from a public repository: README.md of example 4 says\n"
        "which files, and how to put them where HYSTERON_DATA points.\n");
    return;
  }
  const StackCycles cycles = cycles_of(*identification);
  fmt::print("RMSE over the range of y, {:.1f} um, identify_1hz.csv\n", cycles.range);
  fmt::print("     {:<38} {:>8}  {:>8}   {}\n", "effect", "2 to 21", "the rest", "not ruled out in its place");
  std::vector<Step> steps{
      {.round = tuned_model("04_piezo_stack/plant.st", "04_piezo_stack/plant.toml", *identification)}};
  steps.back().gap = gap_of(steps.back().round, cycles);
  print_step(steps.back(), 0);
  while (steps.size() <= most_rounds) {
    Round round = next_round(steps.back().round, cycles.fitted, effects_of_a_stack(),
                             folder / fmt::format("round_{}", steps.size()));
    if (!round.named()) {
      fmt::print("     {}\n", round.found.summary);
      break;
    }
    StackGap gap = gap_of(round, cycles);
    steps.push_back({.round = std::move(round), .gap = std::move(gap)});
    print_step(steps.back(), steps.size() - 1);
  }
  fmt::print("  From one cycle to the next y differs by {:.2f} %.\n",
             100.0 * steps.back().round.found.gap.floor.value / cycles.range);
  write_tables(folder, cycles, steps);
  draw("06_piezo_diagnosis/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
