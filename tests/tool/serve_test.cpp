// hysteron serve, replay and map as a user runs them: the same bits by both engines, and safe outputs at the end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "runtime/task/task.hpp"
#include "runtime/task/task_door.hpp"
#include "tests/support/counted_new.hpp"
#include "tests/support/error_page.hpp"
#include "tests/tool/workbench.hpp"
#include "tool/serve_program.hpp"

namespace hysteron {
namespace {

constexpr const char* served_plant = R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL := 1.0;  (* @unit V *)
    RESET : BOOL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit um *)
    SLOW : LREAL;  (* @unit um *)
  END_VAR
  VAR
    HYST : HY_HYSTERESIS_RO := (C1 := 1.5, C2 := 0.1, C3 := 0.7);
    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 7.0);
    AT4 : HY_SAMPLE;  (* @every 4 *)
    BACK : HY_HOLD;
  END_VAR

  WAVE();
  HYST(XIN := X * WAVE.XOUT);
  AT4(XIN := HYST.XOUT);
  BACK(XIN := AT4.XOUT);
  Y := HYST.XOUT;
  SLOW := BACK.XOUT;
END_FUNCTION_BLOCK
)";
constexpr const char* run_file = "[outputs.Y]\nsafe = -1.0\n[outputs.SLOW]\nsafe = 0.0\n";

TEST(Serve, BothEnginesGiveTheSameBitsThroughNewParameters) {
  const Program program = compile_text(served_plant);
  std::vector<std::vector<double>> results;
  for (const auto engine : {tool::Engine::interpreter, tool::Engine::compiled}) {
    const auto step = tool::step_program(program, engine, false);
    std::vector<double> inputs{1.0, 0.0};
    std::vector<double> outputs(2);
    std::vector<double> all;
    std::vector<std::byte> state(step->state_size());
    for (int k = 0; k < 4000; ++k) {
      inputs[0] = 1.0 + 0.001 * k;
      if (k == 1234) {
        step->set_parameter(0, 1.75);  // the memory of the hysteresis is kept
      }
      if (k == 2000) {
        step->save(state);
      }
      if (k == 3000) {
        step->restore(state);
      }
      step->step(inputs, outputs);
      all.insert(all.end(), outputs.begin(), outputs.end());
    }
    results.push_back(std::move(all));
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(Serve, SavingTheStateAllocatesNothing) {
  const Program program = compile_text(served_plant);
  for (const auto engine : {tool::Engine::interpreter, tool::Engine::compiled}) {
    const auto step = tool::step_program(program, engine, false);
    std::vector<std::byte> state(step->state_size());
    const auto before = test::allocations;
    step->save(state);
    step->restore(state);
    EXPECT_EQ(test::allocations, before);
    std::vector<std::byte> again(step->state_size());
    step->save(again);
    EXPECT_EQ(again, state);
    EXPECT_GT(test::allocations, before) << "the count counts";
  }
}

TEST(Serve, AParameterKeepsTheMemoryOfTheHysteresis) {
  const Program program = compile_text(served_plant);
  const auto changed = tool::step_program(program, tool::Engine::interpreter, false);
  const auto plain = tool::step_program(program, tool::Engine::interpreter, false);
  std::vector<double> inputs{1.0, 0.0};
  std::vector<double> a(2);
  std::vector<double> b(2);
  const double value = changed->parameter(0);
  for (int k = 0; k < 500; ++k) {
    if (k == 250) {
      changed->set_parameter(0, 2.0 * value);
      changed->set_parameter(0, value);
    }
    changed->step(inputs, a);
    plain->step(inputs, b);
    ASSERT_EQ(a, b) << k;
  }
}

TEST(Serve, RunsOnTheVirtualClockAndReplaysToTheBit) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", std::string(run_file) + "[trace]\nfile = \"run.trace\"\n[retain]\nfolder = \"kept\"\n");
  for (const std::string engine : {"interpreter", "compiled"}) {
    const auto served =
        bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 20000 --engine " + engine);
    EXPECT_EQ(served.code, 0) << served.err;
    EXPECT_NE(served.out.find("20000 cycles, 0 skipped"), std::string::npos) << served.out;
    const auto replayed = bench.shell("hysteron replay plant.st --trace run.trace --out record.csv --engine " + engine);
    EXPECT_EQ(replayed.code, 0) << replayed.err;
    EXPECT_EQ(replayed.out, "20000 steps replayed, 0 with other bits; 0 dropped while recording\n");
    const auto run = bench.shell("hysteron run plant.st --in record.csv --out again.csv");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(bench.shell("rm -r kept").code, 0);
  }
}

/// The state of a trace lies in the bytes of the engine that recorded it; nobody has to know which that was.
TEST(Serve, ATraceIsReplayedByTheEngineThatRecordedIt) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", std::string(run_file) + "[trace]\nfile = \"run.trace\"\n");
  const std::string replay = "hysteron replay plant.st --trace run.trace";
  for (const std::string engine : {"interpreter", "compiled"}) {
    EXPECT_EQ(bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 100 --engine " + engine).code,
              0);
    EXPECT_THAT(bench.shell(replay).out, StartsWith("100 steps replayed, 0 with other bits;")) << engine;
    const bool is_compiled = engine == "compiled";
    EXPECT_THAT(bench.shell(replay + " --engine " + (is_compiled ? "interpreter" : "compiled")).err,
                AllOf(HasSubstr(is_compiled ? "the trace was recorded by the compiled engine."
                                            : "the trace was recorded by the interpreter."),
                      HasSubstr("mend: leave --engine out.")));
  }
  EXPECT_THAT(bench.shell(replay + " --float32").err, HasSubstr("the trace was recorded without --float32."));
  bench.write("plant.st", bench.read("plant.st") + "(* another *)");
  EXPECT_EQ(bench.shell(replay).code, 0) << "a comment is no edit";
}

/// What a parameter file may not say, a client may not commit, and the other way round.
TEST(Serve, ACommitIsJudgedAsAParameterFileIs) {
  constexpr const char* bounded = R"(FUNCTION_BLOCK BOUNDED  (* @ts 1ms *)
  VAR_INPUT X : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR
    L : HY_LIMIT := (MN := -1.0, MX := 1.0);
    T : HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, 2.0, 3.0], COUNT := 3);
    D : HY_DEAD_TIME := (DEAD_TIME := 0.5);
  END_VAR
  L(XIN := X);
  T(XIN := L.XOUT);
  D(XIN := T.XOUT);
  Y := D.XOUT;
END_FUNCTION_BLOCK
)";
  const test::Workbench bench;
  bench.write("plant.st", bounded);
  bench.write("RUN.toml", "[outputs.Y]\nsafe = 0.0\n");
  struct Set {
    std::string file;
    std::vector<std::pair<std::string, double>> writes;
    std::string refusal;
  };
  const std::vector<Set> sets{
      {"[parameters.L]\nMN = 5.0\n", {{"L.MN", 5.0}}, "L.MX = 1 must be at least L.MN = 5."},
      {"[parameters.L]\nMN = 5.0\nMX = 5.0\n", {{"L.MN", 5.0}, {"L.MX", 5.0}}, ""},
      {"[parameters.T]\nX = [0.0, 1.0, 1.0]\n", {{"T.X[2]", 1.0}}, "T.X[2] = 1 must be above T.X[1] = 1."},
      {"[parameters.T]\nX = [0.0, 1.0, 1.0]\nCOUNT = 2\n", {{"T.X[2]", 1.0}, {"T.COUNT", 2.0}}, ""},
      {"[parameters.D]\nDEAD_TIME = 1.024\n", {{"D.DEAD_TIME", 1.024}}, ""},
      {"[parameters.D]\nDEAD_TIME = 2.0\n", {{"D.DEAD_TIME", 2.0}}, "D.DEAD_TIME = 2 must be at most 1.02"}};
  for (const auto engine : {tool::Engine::interpreter, tool::Engine::compiled}) {
    for (const Set& set : sets) {
      const auto program = tool::step_program(compile_text(bounded), engine, false);
      runtime::TaskDoor door(*program, {{}}, {{}});
      std::vector<runtime::PointWrite> writes;
      const auto add = [&](const std::string& name, double value) {
        const auto points = door.points();
        const auto at = std::ranges::find(points, name, &runtime::Point::name);
        ASSERT_NE(at, points.end()) << name;
        writes.push_back({static_cast<std::size_t>(at - points.begin()), value});
      };
      for (const auto& [name, value] : set.writes) {
        add(name, value);
      }
      add("task.commit", 1.0);
      const std::string why = door.write(writes);
      EXPECT_TRUE(set.refusal.empty() ? why.empty() : why.starts_with(set.refusal)) << why;
    }
  }
  for (const Set& set : sets) {
    bench.write("p.toml", set.file);
    const auto served = bench.shell("hysteron serve plant.st --params p.toml --config RUN.toml --virtual --cycles 5");
    EXPECT_EQ(served.code, set.refusal.empty() ? 0 : 2) << set.file << served.err;
    EXPECT_EQ(served.err.find("HY214") == std::string::npos, set.refusal.empty()) << served.err;
  }
}

TEST(Serve, GoesOnFromWhatItRetained) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", std::string(run_file) + "[retain]\nfolder = \"kept\"\n");
  const std::string command = "hysteron serve plant.st --config RUN.toml --virtual --cycles 1000";
  EXPECT_EQ(bench.shell(command).code, 0);
  EXPECT_NE(bench.shell(command).out.find("from retained state"), std::string::npos);
}

TEST(Serve, AFileAtTheLimitOfItsSizeIsSaidAndEndsNothing) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", std::string(run_file) + "[trace]\nfile = \"run.trace\"\n");
  const auto served = bench.shell(
      "ulimit -f 40 && hysteron serve plant.st --config RUN.toml --virtual --cycles 5000 --engine interpreter");
  EXPECT_EQ(served.code, 1);
  EXPECT_NE(served.out.find("5000 cycles, 0 skipped"), std::string::npos) << served.out;
  EXPECT_NE(served.out.find("the trace was cut short, "), std::string::npos) << served.out;
  EXPECT_NE(served.out.find("run.trace: File too large; fault: none\n"), std::string::npos) << served.out;
  const auto before = bench.read("run.trace");
  const auto none = bench.shell(
      "(ulimit -f 0; hysteron serve plant.st --config RUN.toml --virtual --cycles 5 --engine interpreter; echo ended "
      "$?) "
      "2>&1 | cat");
  EXPECT_NE(none.out.find("; 5 cycles, 0 skipped; "), std::string::npos)
      << "a full disk refuses no start: " << none.out;
  EXPECT_NE(none.out.find("the trace was cut short, 5 steps are not in it: "), std::string::npos) << none.out;
  EXPECT_NE(none.out.find("ended 1\n"), std::string::npos) << none.out;
  EXPECT_TRUE(bench.read("run.trace") == before) << "the trace of the run before has its name again";
}

TEST(Serve, AReplayThatComparesNothingIsNoSuccess) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", std::string(run_file) + "[trace]\nfile = \"run.trace\"\ntrigger = \"fault\"\n");
  const std::string engine = " --engine interpreter";
  EXPECT_EQ(bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 50" + engine).code, 0);
  const auto replayed = bench.shell("hysteron replay plant.st --trace run.trace" + engine);
  EXPECT_EQ(replayed.code, 1);
  EXPECT_EQ(replayed.out,
            "0 steps replayed, 0 with other bits; 0 dropped while recording; there is nothing to compare\n");
}

TEST(Serve, EndsInSafeOutputsAtSigterm) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", std::string(run_file) + "[task]\nscheduling = \"other\"\nlock_memory = false\n");
  for (const std::string signal : {"TERM", "INT", "HUP"}) {
    const auto served =
        bench.shell("timeout --preserve-status -s " + signal + " 1 hysteron serve plant.st --config RUN.toml");
    EXPECT_EQ(served.code, 0) << served.err;
    EXPECT_NE(served.out.find("PLANT: stopped; "), std::string::npos) << served.out;
    EXPECT_NE(served.out.find("fault: none\n"), std::string::npos) << served.out;
  }
}

TEST(Serve, PrintsTheMapOfItsPoints) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  const auto map = bench.shell("hysteron map plant.st --format csv");
  EXPECT_EQ(map.code, 0) << map.err;
  for (const char* const name :
       {",X,V,", ",RESET,", ",HYST.Y0,um,", ",Y,um,", ",HYST.C1,", ",task.commit,", ",task.cycles,"}) {
    EXPECT_NE(map.out.find(name), std::string::npos) << name;
  }
}

TEST(Serve, RefusesAnOutputWithoutASafeValueAtItsPlace) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("RUN.toml", "[outputs.Y]\nsafe = 0.0\n");
  const auto served = bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 10");
  EXPECT_EQ(served.code, 2);
  EXPECT_TRUE(served.err.starts_with("HY806 error: RUN.toml: The output SLOW has no safe value.")) << served.err;
}

/// What a run file has written takes the place of nothing that is read; nothing runs before that is known.
TEST(Serve, OverwritesNoneOfItsInputs) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("p.toml", "");
  bench.write("token", "a-token-of-some-length");
  bench.write("kept/retain_a", served_plant);
  EXPECT_EQ(bench.shell("chmod 600 token && ln -s plant.st link.st").code, 0);
  const std::string web = " --web 127.0.0.1:0 --web-token-file token";
  const auto refused = [&](const std::string& keys, const std::string& output, const std::string& command,
                           const std::string& diagram = "plant.st") {
    bench.write("RUN.toml", run_file + keys);
    const auto before = bench.names();
    const auto outcome = bench.shell("hysteron " + command);
    EXPECT_EQ(outcome.code, 2) << keys;
    EXPECT_TRUE(outcome.err.starts_with("HY709 error: RUN.toml:")) << keys << outcome.err;
    EXPECT_NE(outcome.err.find("The output " + output + " would overwrite the input "), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find(" in the run file."), std::string::npos) << outcome.err;
    EXPECT_EQ(bench.read(diagram), served_plant) << keys;
    EXPECT_EQ(bench.read("RUN.toml"), run_file + keys);
    EXPECT_EQ(bench.names(), before) << keys;
  };
  const std::string serve = "serve plant.st --params p.toml --config RUN.toml --virtual --cycles 5" + web;
  for (const std::string output : {"plant.st", "./plant.st", "link.st", "RUN.toml", "p.toml", "token"}) {
    refused("[trace]\nfile = \"" + output + "\"\n", output, serve);
    refused("[modbus]\nport = 0\nlock_file = \"" + output + "\"\n", output, serve);
  }
  refused("[modbus]\nport = 0\nlock_file = \"a.lock\"\n[trace]\nfile = \"./a.lock\"\n", "./a.lock", serve);
  bench.write("run.trace.1", served_plant);
  refused("[trace]\nfile = \"run.trace\"\n", "run.trace.1", "serve run.trace.1 --config RUN.toml --virtual --cycles 5",
          "run.trace.1");
  refused("[retain]\nfolder = \"fresh\"\n[trace]\nfile = \"fresh/retain_b\"\n", "fresh/retain_b", serve);
  refused("[retain]\nfolder = \"kept\"\n", "kept/retain_a",
          "serve kept/retain_a --config RUN.toml --virtual --cycles 5", "kept/retain_a");
  const std::string lock = "[modbus]\nlock_file = \"p.toml\"\n";
  refused(lock, "p.toml", "map plant.st --params p.toml --config RUN.toml");
  refused(lock, "p.toml", "generate plant.st --params p.toml --host --config RUN.toml --out host");
}

/// Runs a page's run file, or its command.
test::Outcome run_page(const test::Workbench& bench, const test::FencedBlock& block) {
  if (block.kind == "sh") {
    return bench.shell(block.text.substr(0, block.text.find('\n')));
  }
  bench.write("RUN.toml", block.text);
  return bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 100");
}

TEST(Serve, ErrorPagesKeepTheirWord) {
  constexpr const char* small =
      "FUNCTION_BLOCK PLANT (* @ts 1ms *)\n  VAR_INPUT X : LREAL := 1.0; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
      "  VAR A : HY_GAIN := (K := 2.0); END_VAR\n  A(XIN := X);\n  Y := A.XOUT;\nEND_FUNCTION_BLOCK\n";
  for (const int number : {811, 812, 816, 840, 841, 842, 843, 844}) {
    const test::Workbench bench;
    bench.write("plant.st", served_plant);
    bench.write("RUN.toml", std::string(run_file) + "[retain]\nfolder = \"of_another_diagram\"\n");
    EXPECT_EQ(bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 10").code, 0);
    bench.write("plant.st", small);
    bench.write("RUN.toml", "[outputs.Y]\nsafe = 0.0\n[trace]\nfile = \"good.trace\"\n");
    EXPECT_EQ(bench.shell("hysteron serve plant.st --config RUN.toml --virtual --cycles 10").code, 0);
    auto bytes = bench.read("good.trace");
    // The lowest bit of what step 5 of 10 computed: a record has 20 + 3 · 8 bytes behind its head, the end 16.
    auto& bit = bytes[bytes.size() - 21 - 5 * (5 + 44) + 5 + 20 + 8];
    bit = static_cast<char>(bit ^ 1);
    bench.write("changed.trace", bytes);
    const auto page = test::read_error_page("HY" + std::to_string(number));
    const auto failed = run_page(bench, page.fails);
    EXPECT_NE(failed.code, 0);
    EXPECT_TRUE(failed.err.starts_with("HY" + std::to_string(number) + " error: ")) << failed.err;
    const auto mended = run_page(bench, page.mended);
    EXPECT_EQ(mended.code, 0) << mended.err;
    EXPECT_EQ(mended.err, "");
  }
}

/// An editor that saves, or a copy that is under way: no start ends by it.
TEST(ServeCommand, ADiagramThatIsWrittenMeanwhileEndsNoStart) {
  const test::Workbench bench;
  bench.write("plant.st", served_plant);
  bench.write("a.st", served_plant);
  bench.write("b.st", std::string(served_plant) + "\n");
  bench.write("RUN.toml", run_file);
  const auto served = bench.shell(
      "(for i in $(seq 300); do cp a.st next.st; mv next.st plant.st; cp b.st next.st; mv next.st plant.st; done) & "
      "writer=$!; for i in 1 2 3 4 5; do hysteron serve plant.st --config RUN.toml --virtual --cycles 5 "
      "--engine interpreter || exit 9; done; wait $writer");
  EXPECT_EQ(served.code, 0) << served.err;
  // From a pipe it is read once.
  const auto piped = bench.shell(
      "mkfifo pipe.st; cat plant.st > pipe.st & timeout 20 hysteron serve pipe.st --config RUN.toml "
      "--virtual --cycles 5 --engine interpreter");
  EXPECT_EQ(piped.code, 0) << piped.err;
}

}  // namespace
}  // namespace hysteron
