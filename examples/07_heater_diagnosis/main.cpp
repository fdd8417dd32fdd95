// Example 7: two heaters that warm each other, and no hysteresis, though each draws a wide loop.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <vector>

#include "examples/07_heater_diagnosis/heater_diagnosis.hpp"
#include "examples/example.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

void print_line(const char* what, const std::string& effect, const Round& round, const records::Record& record) {
  std::string gaps;
  for (const double gap : heater_gaps(round, record)) {
    gaps += fmt::format("{:6.3f} degC", gap);
  }
  fmt::print("  {:<10} {:<32} {:<24} {}\n", what, effect, gaps, fmt::join(round.rivals(), ", "));
  std::fflush(stdout);
}

/// A diagram before and after its rounds.
struct Story {
  std::vector<double> before{};
  std::vector<double> after{};
};

/// Tunes a diagram and diagnoses it until nothing more is named, in as many rounds at most.
Story tell(const char* name, const char* settings, std::size_t most_rounds, const records::Record& record,
           const std::filesystem::path& folder) {
  Round round = tuned_model(fmt::format("07_heater_diagnosis/{}.st", name),
                            fmt::format("07_heater_diagnosis/{}", settings), record);
  print_line(name, "tuned", round, record);
  Story story{.before = residuals_of(round, record).front()};
  for (std::size_t number = 1; number <= most_rounds; ++number) {
    Round next = next_round(round, record, effects_of_heaters(), folder / fmt::format("{}_{}", name, number));
    if (!next.named()) {
      fmt::print("  {:<10} {}\n", "", next.found.summary);
      break;
    }
    round = std::move(next);
    print_line("", round.effect(), round, record);
  }
  story.after = residuals_of(round, record).front();
  return story;
}

void example(const std::filesystem::path& folder) {
  const auto record = heater_record();
  if (!record) {
    fmt::print(
        "The measured record is not at hand. It comes from a public repository: README.md of this example says\n"
        "which file, and how to put it where HYSTERON_DATA points.\n");
    return;
  }
  fmt::print("A straight line from the power leaves {:.0f} % of the range of y1 and {:.0f} % of y2: wide loops.\n",
             100.0 * left_by_a_line(*record, "u1", "y1"), 100.0 * left_by_a_line(*record, "u2", "y2"));
  fmt::print("  {:<10} {:<32} {:<24} {}\n", "diagram", "effect", "RMSE", "not ruled out in its place");
  (void)tell("heaters", "heaters.toml", 3, *record, folder);
  const Story first = tell("heater1", "heater.toml", 2, *record, folder);
  const Story second = tell("heater2", "heater.toml", 2, *record, folder);
  std::vector<records::Column> columns{{.name = "t", .values = {record->time().begin(), record->time().end()}}};
  for (const char* const name : {"u1", "u2", "y1", "y2"}) {
    columns.push_back({.name = name, .values = record->column(name).values});
  }
  columns.push_back({.name = "before1", .values = first.before});
  columns.push_back({.name = "after1", .values = first.after});
  columns.push_back({.name = "before2", .values = second.before});
  columns.push_back({.name = "after2", .values = second.after});
  write_table(folder / "heaters.csv", columns);
  draw("07_heater_diagnosis/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
