// hysteron online-change as an operator gives it, to a task that runs in real time; and the pages of its errors.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "runtime/task/trace_file.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"
#include "tests/tool/workbench.hpp"
#include "tool/change_channel.hpp"
#include "tool/serve_program.hpp"

namespace hysteron {
namespace {

using test::soon;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::string_view online_run_file = R"([task]
scheduling = "other"
lock_memory = false
missed = "skip"
[outputs.U]
safe = 0.0
low = 0.0
high = 10.0
bump = 0.01
[online_change]
socket = "online-change.socket"
[retain]
folder = "kept"
every = "1h"
[trace]
file = "run.trace"
)";

/// The limiter comes between, and does nothing as long as the amplifier gives no more than its bounds.
std::string stage(bool has_limiter, const std::string& gain = "0.25") {
  return fmt::format(R"(FUNCTION_BLOCK STAGE  (* @ts 2ms *)
  VAR_INPUT
    Y_REF : LREAL := 20.0;  (* @unit um *)
  END_VAR
  VAR_OUTPUT
    U : LREAL;  (* @unit V *)
  END_VAR
  VAR
    AMP : HY_GAIN := (K := {});
    SUM : HY_INTEGRAL;
    LAG : HY_LAG := (T1 := 0.05);{}
  END_VAR

  SUM(XIN := Y_REF);
  AMP(XIN := Y_REF);
  LAG(XIN := AMP.XOUT);
{}END_FUNCTION_BLOCK
)",
                     gain, has_limiter ? "\n    TOP : HY_LIMIT := (MN := 0.0, MX := 8.0);" : "",
                     has_limiter ? "  TOP(XIN := LAG.XOUT);\n  U := TOP.XOUT;\n" : "  U := LAG.XOUT;\n");
}

/// A folder with the stage and its run file.
class StageBench : public test::Workbench {
 public:
  StageBench() {
    write("stage.st", stage(false));
    write("run.toml", online_run_file);
  }
};

/// A task of its own process in the folder of the bench.
class Served {
 public:
  explicit Served(const test::Workbench& bench, const std::string& options = "", const std::string& environment = "")
      : bench_(&bench) {
    (void)bench.shell("rm -f said.txt; " + environment + "hysteron serve stage.st --config run.toml " + options +
                      " > said.txt 2> told.txt & echo $! > pid.txt");
    has_begun_ = soon([&] { return bench.has("said.txt") && bench.read("said.txt").find('\n') != std::string::npos; });
    process_ = std::stoi(bench.read("pid.txt"));
  }
  ~Served() { end(SIGKILL); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;
  Served(Served&&) = delete;
  Served& operator=(Served&&) = delete;

  [[nodiscard]] bool has_begun() const { return has_begun_; }
  void end(int signal) {
    if (process_ > 0) {
      (void)::kill(process_, signal);
      (void)soon([&] { return ::kill(process_, 0) != 0; });
      process_ = 0;
    }
  }
  [[nodiscard]] std::string told() const { return bench_->read("told.txt"); }
  [[nodiscard]] std::string said() const { return bench_->read("said.txt"); }

 private:
  const test::Workbench* bench_;
  bool has_begun_ = false;
  pid_t process_ = 0;
};

std::uint64_t replayed(const test::Workbench& bench, const std::string& trace, const std::string& text,
                       tool::Engine engine) {
  const auto program = tool::step_program(compile_text(text), engine, false);
  runtime::ReplayResult result;
  EXPECT_EQ(runtime::replay(bench.read(trace), *program, result), "") << trace;
  EXPECT_EQ(result.different + result.without_state + result.dropped, 0U) << trace;
  return result.steps;
}

/// There, back, and there again; the trace of each version is replayed to the bit, and no cycle is missing in them.
TEST(OnlineChangeCommand, ChangesAndChangesBackByBothEngines) {
  for (const auto engine : {tool::Engine::interpreter, tool::Engine::compiled}) {
    const StageBench bench;
    Served task(bench, engine == tool::Engine::compiled ? "--engine compiled" : "--engine interpreter");
    ASSERT_TRUE(task.has_begun()) << task.told();
    EXPECT_THAT(task.said(), HasSubstr("; online change on online-change.socket; "));
    bench.write("stage.st", stage(true, "0.3"));
    const auto checked = bench.shell("hysteron online-change run.toml --check");
    EXPECT_EQ(checked.code, 0) << checked.err;
    EXPECT_THAT(checked.out, StartsWith("STAGE: nothing stands against it; version 1 runs on\n"
                                        "3 of 5 parameters and 5 of 5 states would be carried over\n  U: "));
    const auto changed = bench.shell("hysteron online-change run.toml");
    EXPECT_EQ(changed.code, 0) << changed.err;
    EXPECT_THAT(changed.out, StartsWith("STAGE: version 2 runs\n3 of 5 parameters and 5 of 5 states were carried"));
    EXPECT_THAT(changed.out, HasSubstr("\nnot carried over: TOP.MN (new), TOP.MX (new)\n"));
    EXPECT_THAT(changed.out, HasSubstr("AMP.K = 0.25 V/um (0.3 in the files)\n"));
    const auto back = bench.shell("hysteron online-change run.toml --back");
    EXPECT_EQ(back.code, 0) << back.err;
    EXPECT_THAT(back.out, StartsWith("STAGE: back; version 3 runs\n"));
    EXPECT_EQ(bench.read("stage.st"), stage(false));
    EXPECT_EQ(bench.read("stage.st.undone"), stage(true, "0.3"));
    const auto again = bench.shell("hysteron online-change run.toml --back --json");
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(bench.read("stage.st"), stage(true, "0.3"));
    EXPECT_EQ(bench.read("stage.st.undone.2"), stage(false));
    EXPECT_THAT(task.told(), HasSubstr("Online change: version 2 of STAGE runs; 3 of 5 parameters and 5 of 5 states"));
    task.end(SIGTERM);
    const std::uint64_t steps = replayed(bench, "run.trace.3", stage(false), engine) +
                                replayed(bench, "run.trace.2", stage(true, "0.3"), engine) +
                                replayed(bench, "run.trace.1", stage(false), engine) +
                                replayed(bench, "run.trace", stage(true, "0.3"), engine);
    EXPECT_THAT(task.said(), HasSubstr(fmt::format("; {} cycles, ", steps)));
    EXPECT_FALSE(bench.has("online-change.socket"));
  }
}

/// The same files a second time would be a version of their own, and the way back would lead to the same text.
TEST(OnlineChangeCommand, FilesThatRunAlreadyLeaveVersionAndWayBack) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  EXPECT_EQ(bench.shell("hysteron online-change run.toml").out, "STAGE: nothing changed; version 1 runs on\n")
      << "there is no version before";
  bench.write("stage.st", stage(true));
  ASSERT_EQ(bench.shell("hysteron online-change run.toml").code, 0);
  const auto same = bench.shell("hysteron online-change run.toml");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(same.out, "STAGE: nothing changed; version 2 runs on, and --back goes where it went before\n");
  EXPECT_THAT(bench.shell("hysteron online-change run.toml --json").out,
              AllOf(HasSubstr("\"changed\": false"), HasSubstr("\"version\": 2")));
  EXPECT_THAT(bench.shell("hysteron online-change run.toml --as-given AMP.K").out,
              StartsWith("STAGE: version 3 runs\n"))
      << "more is wished than the files say";
  EXPECT_THAT(bench.shell("hysteron online-change run.toml --back").out, StartsWith("STAGE: back; version 4 runs\n"));
  EXPECT_EQ(bench.shell("hysteron online-change run.toml").out.substr(0, 22), "STAGE: nothing changed");
  bench.write("stage.st", stage(false));
  ASSERT_EQ(bench.shell("hysteron online-change run.toml").code, 0);
  EXPECT_EQ(bench.shell("hysteron online-change run.toml").code, 0);
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --back").code, 0);
  EXPECT_EQ(bench.read("stage.st"), stage(true));
}

/// SIGKILL as soon as the change is told: the next start runs the new version with what was carried, though values are
/// retained by themselves once an hour only.
TEST(OnlineChangeCommand, ACrashJustAfterItLosesNothing) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  bench.write("stage.st", stage(true, "0.3"));
  EXPECT_EQ(bench.shell("hysteron online-change run.toml").code, 0);
  task.end(SIGKILL);
  EXPECT_THAT(bench.shell("hysteron retained kept").out, HasSubstr("  AMP.K        0.25 V/um\n"));
  EXPECT_TRUE(bench.has("online-change.socket"));
  // The socket of the one that is gone is no obstacle; the retained state is taken as of the same version.
  Served next(bench, "--engine interpreter");
  ASSERT_TRUE(next.has_begun()) << next.told();
  EXPECT_THAT(next.said(), HasSubstr(", from retained state "));
  EXPECT_THAT(next.said(), HasSubstr(" with 1 parameter as retained and not as given: AMP.K"));
  EXPECT_EQ(next.told(), "");
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --check").code, 0);
  // A second task cannot take the socket, nor one that is another's.
  bench.write("other.toml", "[outputs.U]\nsafe = 0.0\n[online_change]\nsocket = \"online-change.socket\"\n");
  EXPECT_THAT(bench.shell("hysteron serve stage.st --config other.toml --virtual --cycles 1").err,
              StartsWith("HY815 error: other.toml:4:10: Another task that runs listens on online-change.socket."));
}

/// A clean-up of old files may delete the name while the task runs; a file that is there by then stays.
TEST(OnlineChangeCommand, ADeletedSocketComesBack) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  std::filesystem::remove(bench.path() / "online-change.socket");
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --check").code, 2);
  ASSERT_TRUE(soon([&] { return bench.has("online-change.socket"); })) << task.told();
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --check").code, 0);
  EXPECT_THAT(task.told(), HasSubstr("the socket online-change.socket was deleted, and is there again.\n"));
  std::filesystem::remove(bench.path() / "online-change.socket");
  bench.write("online-change.socket", "somebody's");
  task.end(SIGTERM);
  EXPECT_EQ(bench.read("online-change.socket"), "somebody's");
}

/// What is refused leaves the task, its version and the files as they are.
TEST(OnlineChangeCommand, WhatIsRefusedChangesNothing) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  bench.write("stage.st", "FUNCTION_BLOCK STAGE\n  VAR_OUTPUT U : LREAL; END_VAR\n  U := 1.0\nEND_FUNCTION_BLOCK\n");
  const auto wrong = bench.shell("hysteron online-change run.toml");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, StartsWith("HY103 error: stage.st:3:11:"));
  EXPECT_THAT(wrong.err, HasSubstr("  U := 1.0\n"));
  bench.write("stage.st", stage(false));
  for (const char* const line : {"--bump U", "--bump U=-1", "--bump U=x", "--bump U=1 --bump U=2"}) {
    EXPECT_THAT(bench.shell(std::string("hysteron online-change run.toml ") + line).err, StartsWith("HY730 error: "));
  }
  // From the same state towards 9 V instead of 5 V: the lag takes 2 % of the 4 V between them, in whatever step.
  bench.write("stage.st", stage(false, "0.45"));
  const auto jumps = bench.shell("hysteron online-change run.toml --as-given AMP.K");
  EXPECT_THAT(jumps.err, StartsWith("HY851 error: The output U would jump by 0.0789"));
  EXPECT_THAT(jumps.err, HasSubstr(" V from 5 to 5.0789"));
  EXPECT_THAT(jumps.err, HasSubstr("; its limit is 0.01 V (bump in the run file at the start).\n"));
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --as-given AMP.K --bump U=0.3").code, 0);
  EXPECT_THAT(bench.shell("hysteron online-change run.toml --back").err, StartsWith("HY851 error: The output U"));
  EXPECT_EQ(bench.read("stage.st"), stage(false, "0.45"));
  EXPECT_FALSE(bench.has("stage.st.undone"));
  task.end(SIGTERM);
  EXPECT_THAT(task.told(), HasSubstr("Online change: refused, HY103: "));
}

/// What a restart would be refused with refuses the change: a restart has to come up with the version that runs.
TEST(OnlineChangeCommand, ARunFileThatCouldNotStartTheNewVersionRefusesIt) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  EXPECT_THAT(bench.shell("hysteron online-change run.toml --check").out, Not(HasSubstr("run file was edited")));
  bench.write("run.toml", std::string(online_run_file) + "[modbus]\nport = 0\nlissten = \"127.0.0.1\"\n");
  for (const char* const line : {"hysteron online-change run.toml --check", "hysteron online-change run.toml"}) {
    const auto misspelt = bench.shell(line);
    EXPECT_EQ(misspelt.code, 2);
    EXPECT_THAT(misspelt.err, StartsWith("HY803 error: run.toml:19:"));
  }
  // An address of a parameter that only the new version lacks.
  bench.write("run.toml", std::string(online_run_file) + "[modbus]\nport = 0\n[addresses]\nTOP.MX = \"holding 100\"\n");
  EXPECT_THAT(bench.shell("hysteron online-change run.toml").err, StartsWith("HY826 error: run.toml:20:"));
  bench.write("stage.st", stage(true));
  const auto edited = bench.shell("hysteron online-change run.toml");
  EXPECT_EQ(edited.code, 0) << edited.err;
  EXPECT_THAT(edited.out,
              HasSubstr("the run file was edited since the start of the task: what it says now counts from the "
                        "next start on\n"));
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --back").code, 0) << "no file stands in the way back";
}

/// A file that was deleted is brought back, and nothing is kept of what was not there.
TEST(OnlineChangeCommand, AFileThatIsMissingAtTheWayBackLeavesNoEmptyOne) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  bench.write("stage.st", stage(true));
  ASSERT_EQ(bench.shell("hysteron online-change run.toml").code, 0);
  std::filesystem::remove(bench.path() / "stage.st");
  const auto back = bench.shell("hysteron online-change run.toml --back");
  EXPECT_EQ(back.code, 0) << back.err;
  EXPECT_THAT(back.out, HasSubstr("stage.st was missing, and is as before\n"));
  EXPECT_EQ(bench.read("stage.st"), stage(false));
  EXPECT_FALSE(bench.has("stage.st.undone"));
}

/// What is refused whatever its steps do is refused before a compiler is started; what takes longer says what it does.
TEST(OnlineChangeCommand, WhoWaitsIsToldForWhat) {
  const StageBench bench;
  // Each call of this compiler takes its time, and is noted.
  bench.write("slow.sh", "#!/bin/sh\necho called >> compiler.txt\nsleep 2\nexec c++ \"$@\"\n");
  (void)bench.shell("chmod +x slow.sh");
  Served slow(bench, "--engine compiled", "CXX=\"$PWD/slow.sh\" ");
  ASSERT_TRUE(slow.has_begun()) << slow.told();
  (void)bench.shell("rm -f compiler.txt");
  std::string other = stage(true, "0.2501");
  other.replace(other.find("@unit um"), 8, "@unit mm");
  bench.write("stage.st", other);
  const auto refused = bench.shell("hysteron online-change run.toml");
  EXPECT_THAT(refused.err, StartsWith("HY850 error: The input Y_REF in um has another unit: mm."));
  EXPECT_FALSE(bench.has("compiler.txt"));
  bench.write("stage.st", stage(true, "0.2501"));
  const auto compiled = bench.shell("hysteron online-change run.toml --check");
  EXPECT_EQ(compiled.code, 0) << compiled.err;
  EXPECT_TRUE(bench.has("compiler.txt"));
  EXPECT_THAT(compiled.err, HasSubstr("note: run.toml: waits; the task compiles the new version\n"));
}

/// No other user: the file is its owner's alone, and who comes another way is not heard.
TEST(OnlineChangeCommand, NobodyElseIsHeard) {
  const StageBench bench;
  Served task(bench, "--engine interpreter");
  ASSERT_TRUE(task.has_begun()) << task.told();
  struct stat found {};
  const std::string path = (bench.path() / "online-change.socket").string();
  ASSERT_EQ(::stat(path.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0600U);
  if (::geteuid() == 0) {  // another user cannot be played by who is none but himself
    EXPECT_EQ(::chmod(path.c_str(), 0666), 0);
    EXPECT_EQ(::chmod(bench.path().c_str(), 0755), 0);
    const pid_t other = ::fork();
    if (other == 0) {
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      std::strncpy(static_cast<char*>(address.sun_path), path.c_str(), sizeof(address.sun_path) - 1);
      const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
      if (::setuid(65534) != 0 || ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
        ::_exit(3);
      }
      constexpr std::string_view request = "{\"what\": \"back\", \"bumps\": {}, \"as_given\": []}\n";
      (void)::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
      char byte = 0;
      ::_exit(::recv(socket, &byte, 1, 0) > 0 ? 1 : 0);
    }
    int status = 0;
    (void)::waitpid(other, &status, 0);
    EXPECT_EQ(test::exit_code(status), 0);
  }
  // Nor does a request that is none disturb the task, or one that never ends.
  EXPECT_THAT(bench
                  .shell("/usr/bin/python3 -c \"import socket; s = socket.socket(socket.AF_UNIX); "
                         "s.connect('online-change.socket'); s.sendall(b'nonsense\\n'); print(s.recv(4000))\"")
                  .out,
              HasSubstr("The request is not understood"));
  EXPECT_EQ(bench.shell("hysteron online-change run.toml --check").code, 0);
  EXPECT_THAT(task.told(), MatchesRegex("Start: nothing is there yet of kept[^\n]*\n"));  // and of none of these a word
}

/// Where no more files may be open, the name of the socket is not to blame.
TEST(OnlineChangeCommand, ASocketForWhichNoFileIsLeftIsAnsweredByThat) {
  const hysteron::test::ScratchFolder folder;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit none = before;
  none.rlim_cur = 3;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  std::string mend;
  try {
    const tool::ChangeListener listener(folder / "socket", {},
                                        [](const std::string&, const auto&) { return std::string(); }, {});
  } catch (const InputError& refused) {
    mend = refused.diagnostics().all().front().mend;
  }
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_THAT(mend, StartsWith("let more files be open: "));
}

std::string given(const std::string& page, const std::string& name) {
  const auto at = page.find("```" + name + "\n");
  const auto begin = at + name.size() + 4;
  return at == std::string::npos ? "" : page.substr(begin, page.find("```\n", begin) - begin);
}

/// The page's task runs; what a text of a kind is, is done to it.
TEST(OnlineChangeCommand, ThePagesOfItsErrorsKeepTheirWord) {
  for (const std::string number : {"HY850", "HY851", "HY852", "HY853", "HY854", "HY855"}) {
    const test::Workbench bench;
    const auto page = test::read_error_page(number);
    const std::string text = test::contents_of(std::string(HYSTERON_SOURCE_DIR) + "/docs/errors/" + number + ".md");
    bench.write("stage.st", given(text, "st stage.st"));
    bench.write("edited.st", given(text, "st edited.st"));
    const std::string run = given(text, "toml run.toml");
    bench.write("run.toml", run.empty() ? page.mended.text : run);
    Served task(bench, "--engine interpreter");
    ASSERT_TRUE(task.has_begun()) << number << task.told();
    const auto does = [&](const test::FencedBlock& block) {
      if (block.kind == "sh") {
        return bench.shell(block.text.substr(0, block.text.find('\n')));
      }
      bench.write(block.kind == "st" ? "stage.st" : "asked.toml", block.text);
      if (number == "HY854") {
        task.end(SIGTERM);
        return bench.shell("hysteron serve stage.st --config asked.toml --virtual --cycles 10");
      }
      return bench.shell(block.kind == "st" ? "hysteron online-change run.toml" : "hysteron online-change asked.toml");
    };
    const auto failed = does(page.fails);
    EXPECT_EQ(failed.code, 2) << number;
    EXPECT_TRUE(failed.err.starts_with(number + " error: ")) << number << failed.err;
    const auto mended = does(page.mended);
    EXPECT_EQ(mended.code, 0) << number << mended.err;
    EXPECT_EQ(mended.err, "");
  }
}

}  // namespace
}  // namespace hysteron
