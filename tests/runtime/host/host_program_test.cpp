// The main function of a generated host, with a program in the place of the generated step.
#include "runtime/host/host_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/host/host.hpp"
#include "runtime/modbus/map_text.hpp"
#include "support/text_file.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Y := X + 1 in each step; its state is Y.
class Counting final : public StepProgram {
 public:
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override { y_ = 0.0; }
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    y_ += inputs[0] + 1.0;
    outputs[0] = y_;
  }
  void set_parameter(std::size_t /*parameter*/, double /*value*/) noexcept override {}
  [[nodiscard]] double parameter(std::size_t /*parameter*/) const noexcept override { return 0.0; }
  [[nodiscard]] std::size_t state_size() const noexcept override { return 0; }
  void save(std::span<std::byte> /*bytes*/) const noexcept override {}
  void restore(std::span<const std::byte> /*bytes*/) noexcept override {}

 private:
  ProgramShape shape_{.name = "COUNTING",
                      .period = 1'000'000,
                      .inputs = {{.name = "X"}},
                      .outputs = {{.name = "Y"}},
                      .layout = "counting"};
  double y_ = 0.0;
};

struct Outcome {
  int code = 0;
  std::string out{};
  std::string err{};
};

class HostProgramTest : public testing::Test {
 protected:
  HostProgramTest() { folder.write("run.toml", "[outputs.Y]\nsafe = 0.0\n"); }

  static Outcome run(std::vector<std::string> words, const std::string& addresses = "") {
    std::vector<const char*> argv{"counting_host"};
    for (const std::string& word : words) {
      argv.push_back(word.c_str());
    }
    Counting program;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Outcome outcome;
    outcome.code = host_program(program, {.name = "counting_host", .addresses = addresses},
                                static_cast<int>(argv.size()), argv.data());
    outcome.out = testing::internal::GetCapturedStdout();
    outcome.err = testing::internal::GetCapturedStderr();
    return outcome;
  }

  const test::ScratchFolder folder;
  const std::string run_file = folder / "run.toml";
};

TEST_F(HostProgramTest, RunsOnTheVirtualClockAndSaysHow) {
  const Outcome ran = run({run_file, "--virtual", "--cycles", "500"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(StartsWith("COUNTING: generated; virtual clock\nCOUNTING: done; 500 cycles, 0 skipped; "),
                             HasSubstr("; fault: none\n")));
}

TEST_F(HostProgramTest, PrintsItsRegisters) {
  const Outcome map = run({"--map", run_file});
  EXPECT_EQ(map.code, 0) << map.err;
  EXPECT_THAT(map.out, AllOf(StartsWith("area,address,registers,type,name,"), HasSubstr("\nholding,0,4,real64,X,")));
}

TEST_F(HostProgramTest, KeepsTheAddressesThatItWasGeneratedWithUntilTheLockFileIsThere) {
  const std::string lock = folder / "registers.lock";
  folder.write("run.toml", "[outputs.Y]\nsafe = 0.0\n[modbus]\nlock_file = \"" + lock + "\"\n");
  const std::string generated = "holding 40 real64 X\n";
  EXPECT_THAT(run({run_file, "--map"}, generated).out, HasSubstr("\nholding,40,4,real64,X,"));
  EXPECT_THAT(read_text_file(lock), HasSubstr("holding 40 real64 X\n")) << "and leaves it for the next start";
  folder.write("registers.lock", "holding 80 real64 X\n");
  EXPECT_THAT(run({run_file, "--map"}, generated).out, HasSubstr("\nholding,80,4,real64,X,"));
}

TEST_F(HostProgramTest, RefusesWhatItDoesNotUnderstand) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& said) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << said;
    EXPECT_EQ(outcome.out, "") << said;
    EXPECT_THAT(outcome.err, AllOf(StartsWith("HY"), HasSubstr(said)));
  };
  refused({}, "HY730 error: No run file is given.");
  refused({run_file, "--fast"}, "counting_host does not take --fast.");
  refused({run_file, run_file}, "does not take " + run_file);
  refused({run_file, "--cycles"}, "--cycles needs a whole number from 1 on, and has \"\".");
  refused({run_file, "--cycles", "0"}, "has \"0\".");
  refused({run_file, "--cycles", "12x"}, "has \"12x\".");
  refused({folder / "missing.toml"}, "HY100");
  folder.write("run.toml", "[outputs.Z]\nsafe = 0.0\n");
  refused({run_file}, "HY807");
}

TEST_F(HostProgramTest, OverwritesNoneOfItsInputs) {
  for (const std::string& keys :
       {"[trace]\nfile = \"" + run_file + "\"\n", "[modbus]\nport = 0\nlock_file = \"" + run_file + "\"\n"}) {
    const std::string text = "[outputs.Y]\nsafe = 0.0\n" + keys;
    folder.write("run.toml", text);
    const Outcome outcome = run({run_file, "--virtual", "--cycles", "5"});
    EXPECT_EQ(outcome.code, 2) << keys;
    EXPECT_THAT(outcome.err, StartsWith("HY709 error: " + run_file + ":")) << keys;
    EXPECT_EQ(read_text_file(run_file), text) << keys;
  }
}

TEST_F(HostProgramTest, HelpNamesItselfAndItsDiagram) {
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, AllOf(StartsWith("COUNTING as a cyclic task.\n"), HasSubstr("  counting_host RUN.toml --map")));
}

}  // namespace
}  // namespace hysteron::runtime
