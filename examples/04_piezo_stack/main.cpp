// Example 4: from a measured log of a real piezo stack to a feedforward in C++, and how well it would do.
#include <fmt/format.h>

#include <array>

#include "examples/04_piezo_stack/piezo_stack.hpp"
#include "examples/example.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

constexpr std::size_t shown = 201;  ///< samples of a cycle, closed

void print_model(const char* what, const TunedDiagram& model) {
  fmt::print("  {:<48} {:6.2f} %  {:6.2f} %   {:3} iterations, {:.2f} s\n", what, 100.0 * model.train_share(),
             100.0 * model.test_share(), model.fit.solution.iterations, model.fit.seconds);
}

records::Column last_cycle(const char* name, const std::vector<double>& values) {
  return {.name = name, .values = std::vector<double>(values.end() - shown, values.end())};
}

void write_loops(const std::filesystem::path& folder, const records::Record& record, const TunedDiagram& line,
                 const TunedDiagram& plant, const TunedDiagram& bent) {
  const std::array columns{last_cycle("u", record.column("u").values), last_cycle("y", record.column("y").values),
                           last_cycle("line", line.fit.model[0][0]), last_cycle("model", plant.fit.model[0][0]),
                           last_cycle("bent", bent.fit.model[0][0])};
  write_table(folder / "loop.csv", columns);
}

void write_tracking(const std::filesystem::path& folder, const records::Record& record, const Prediction& ours) {
  const std::vector<double>& ref = record.column("ref").values;
  const std::vector<double>& y = record.column("y").values;
  records::Column time{.name = "t"};
  for (std::size_t k = 0; k < window; ++k) {
    time.values.push_back(static_cast<double>(k) * record.sample_time());
  }
  const std::array columns{time,
                           records::Column{.name = "without", .values = tracking_errors(ref, y, row_without_inverse)},
                           records::Column{.name = "published", .values = tracking_errors(ref, y, row_with_inverse)},
                           records::Column{.name = "ours", .values = tracking_errors(ref, ours.y, row_with_inverse)}};
  write_table(folder / "tracking.csv", columns);
}

void identify(const std::filesystem::path& folder, const records::Record& record) {
  fmt::print("RMSE over the range of y, identify_1hz.csv              cycles 2-21  the rest\n");
  const TunedDiagram line = tune("line", "line", record);
  const TunedDiagram plant = tune("plant", "plant", record);
  const TunedDiagram late = tune("plant", "late_plant", record);
  const TunedDiagram bent = tune("bent_plant", "bent_plant", record);
  print_model("straight line", line);
  print_model("the paper's model", plant);
  print_model("  with a dead time", late);
  print_model("  and a bend, which is not in the paper's model", bent);
  fmt::print("  C1 = {:.4g} um/V, C2 = {:.4g}, C3 = {:.3g}, dead time {:.1f} ms\n\n", late.parameter("HYST.C1"),
             late.parameter("HYST.C2"), late.parameter("HYST.C3"), 1e3 * late.parameter("LATE.DEAD_TIME"));
  write_loops(folder, record, line, late, bent);
}

void print_prediction(const char* what, const Prediction& prediction) {
  fmt::print("  {:<48} {:6.2f} um {:6.2f} um\n", what, prediction.without_inverse, prediction.with_inverse);
}

void feed_forward(const std::filesystem::path& folder, const records::Record& record, const TunedDiagram& plant,
                  const TunedDiagram& bent) {
  const std::vector<double>& ref = record.column("ref").values;
  const std::vector<double>& theirs = record.column("u").values;
  const Program feedforward = feedforward_of("feedforward", plant);
  const Program bent_feedforward = feedforward_of("bent_feedforward", bent);
  const auto u = run_generated(feedforward, record, folder / "generated");
  const auto bent_u = run_generated(bent_feedforward, record, folder / "generated_bent");
  fmt::print("Feedforward, generated to C++, compiled and driven by ref of feedforward_test.csv:\n");
  fmt::print("  the interpreter's bits: {}\n",
             u == simulate(feedforward, record).front() && bent_u == simulate(bent_feedforward, record).front()
                 ? "equal"
                 : "DIFFERENT");
  const double range_of_u = range(std::span(theirs).subspan(first_row_of_inverse - 1));
  const auto print_u = [&](const char* what, const std::vector<double>& ours) {
    const double rms_of_u = difference(ours, theirs, first_row_of_inverse);
    fmt::print("  {:<48} {:.4f} V, {:.2f} % of its range\n", what, rms_of_u, 100.0 * rms_of_u / range_of_u);
  };
  print_u("its voltage less the published inverse's, RMS", u);
  print_u("  with the bend", bent_u);

  const TunedDiagram judge = tune("judge", "judge", record);
  const std::vector<double>& y = record.column("y").values;
  const Prediction ours = predict(judge.program, u, record);
  const Prediction bent_ours = predict(judge.program, bent_u, record);
  fmt::print("\nTracking error, RMSE over 1000 samples from row         5052      11152\n");
  fmt::print("  {:<48} {:6.2f} um {:6.2f} um\n", "measured: without, and with the published inverse",
             tracking_error(ref, y, row_without_inverse), tracking_error(ref, y, row_with_inverse));
  print_prediction("predicted for the same voltage, as a check", predict(judge.program, theirs, record));
  print_prediction("predicted for our feedforward, the paper's model", ours);
  print_prediction("predicted for our feedforward with the bend", bent_ours);
  fmt::print(
      "  (The predictions are those of a second model, play operators fitted to this record's own voltage;\n"
      "  it leaves {:.2f} um of the measured y. Nobody has driven the stack with our voltage.)\n",
      judge.fit.scores.front().train);
  write_tracking(folder, record, bent_ours);
}

void example(const std::filesystem::path& folder) {
  const auto identification = stack_record("identify_1hz.csv");
  const auto test = stack_record("feedforward_test.csv");
  if (!identification || !test) {
    fmt::print(
        "The measured records are not at hand. They come from a public repository: README.md of this example says\n"
        "which files, and how to put them where HYSTERON_DATA points.\n");
    return;
  }
  identify(folder, *identification);
  feed_forward(folder, *test, tune("plant", "one_sample", *identification),
               tune("bent_plant", "bent_one_sample", *identification));
  draw("04_piezo_stack/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
