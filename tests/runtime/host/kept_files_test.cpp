// What a run keeps on the disk, the trace and the retained state: no other task writes it, no start loses it, and what
// could not be written is said.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/host/host.hpp"
#include "runtime/host/new_places.hpp"
#include "runtime/host/notices.hpp"
#include "runtime/host/served_map.hpp"
#include "runtime/task/trace_output.hpp"
#include "support/diagnostic.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using hysteron::test::contents_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct HostRun {
  bool well = false;
  std::string out{};
  std::string err{};  ///< or the error that it was refused with
};

HostRun host_run(const std::string& rest, double a = 1.0, const std::string& unit = "") {
  test::Accumulator program;
  program.mutable_shape().parameters[0].unit = unit;
  program.set_parameter(0, a);
  HostRun outcome;
  testing::internal::CaptureStderr();
  try {
    const auto config =
        parse_run_config("RUN.toml", "[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n" + rest, program.shape());
    outcome.well = run_host(program, config, {.how = "linked", .cycles = 20, .virtual_time = true},
                            [&](std::string_view text) { outcome.out += text; });
  } catch (const InputError& refused) {
    const Diagnostic& first = refused.diagnostics().all().front();
    outcome.out = fmt::format("HY{}:{}: {} {}", first.number, first.place.line, first.cause, first.mend);
  }
  outcome.err = testing::internal::GetCapturedStderr();
  return outcome;
}

class KeptFiles : public testing::Test {
 protected:
  [[nodiscard]] std::string retain(const std::string& rest = "") const {
    return fmt::format("[retain]\nfolder = \"{}\"\n{}", folder / "kept", rest);
  }
  [[nodiscard]] std::string trace() const { return fmt::format("[trace]\nfile = \"{}\"\n", folder / "run.trace"); }

  hysteron::test::ScratchFolder folder{};
};

TEST_F(KeptFiles, TheTraceOfTheRunBeforeIsKept) {
  std::string before;
  for (const double a : {1.0, 2.0, 3.0}) {
    EXPECT_TRUE(host_run(trace(), a).well);
    EXPECT_EQ(contents_of(folder / "run.trace.1"), before);
    before = contents_of(folder / "run.trace");
    EXPECT_NE(before, "");
  }
  EXPECT_THAT(folder.names(), testing::ElementsAre("run.trace", "run.trace.1", "run.trace.2"));
  for (int run = 0; run < 3; ++run) {
    EXPECT_TRUE(host_run(trace() + "files = 2\n").well);
  }
  EXPECT_EQ(contents_of(folder / "run.trace.2").empty(), false) << "what more files were asked for stays";
}

TEST_F(KeptFiles, WhatIsNoTraceIsNotPutAside) {
  folder.write("run.trace", "FUNCTION_BLOCK PRECIOUS");
  EXPECT_THAT(host_run(trace()).out, AllOf(StartsWith("HY812:"), HasSubstr("is there already, and is no trace.")));
  EXPECT_EQ(contents_of(folder / "run.trace"), "FUNCTION_BLOCK PRECIOUS");
  // A disk was full; a power cut came between a file's size and its bytes.
  for (const std::string& rest : {std::string(), std::string("hysteron tr"), std::string(5000, '\0')}) {
    folder.write("run.trace", rest);
    EXPECT_TRUE(host_run(trace()).well) << rest;
  }
}

TEST_F(KeptFiles, OfATaskThatRunsAreRefusedAndLeftAlone) {
  EXPECT_TRUE(host_run(retain() + trace()).well);
  {
    RetainFolder held(folder / "kept");
    held.open();
    EXPECT_THAT(host_run(retain()).out,
                HasSubstr("HY815:6: Another task that runs retains its values in " + (folder / "kept")));
  }
  const TraceOutput other(folder / "run.trace");
  const auto names = folder.names();
  EXPECT_THAT(host_run(trace()).out, HasSubstr("HY815:6: Another task that runs writes its trace to "));
  EXPECT_EQ(folder.names(), names);
  EXPECT_EQ(contents_of(folder / "run.trace"), "");
}

TEST_F(KeptFiles, ThePageOfThoseOfAnotherTaskKeepsItsWord) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  RetainFolder held("retained");
  held.open();
  const auto page = hysteron::test::read_error_page("HY815");
  const auto table = [](const std::string& text) { return text.substr(text.find("[retain]")); };
  EXPECT_TRUE(host_run(table(page.fails.text)).out.starts_with("HY815:"));
  EXPECT_TRUE(host_run(table(page.mended.text)).well);
  std::filesystem::current_path(before);
}

TEST_F(KeptFiles, ASlotThatCannotBeReadIsNotTakenForMissing) {
  for (int slot = 0; slot < 2; ++slot) {
    EXPECT_TRUE(host_run(retain()).well);
  }
  for (const char* const slot : {"kept/retain_a", "kept/retain_b"}) {
    const hysteron::test::ScratchFolder elsewhere;
    std::filesystem::rename(folder / slot, elsewhere / "slot");
    std::filesystem::create_directory(folder / slot);
    const auto names = folder.names();
    EXPECT_THAT(
        host_run(retain("mismatch = \"cold\"\n")).out,
        AllOf(HasSubstr("HY816:6: "), HasSubstr((folder / slot) + ": Is a directory"), HasSubstr("remove what")));
    EXPECT_EQ(folder.names(), names);
    std::filesystem::remove(folder / slot);
    std::filesystem::rename(elsewhere / "slot", folder / slot);
  }
  EXPECT_TRUE(host_run(retain()).well);
}

/// Each slot, damaged by a byte, leaves the other; both leave nothing to run on.
TEST_F(KeptFiles, ADamagedSlotIsToldOfAndTwoAreRefusedWithTheirMend) {
  for (int run = 0; run < 2; ++run) {
    EXPECT_TRUE(host_run(retain()).well);
  }
  const auto damage = [&](const std::string& slot) {
    std::string bytes = contents_of(folder / ("kept/" + slot));
    bytes.at(bytes.size() / 2) ^= 1;
    folder.write("kept/" + slot, bytes);
  };
  damage("retain_b");
  EXPECT_THAT(
      host_run(retain()).err,
      HasSubstr((folder / "kept") + ": one slot is damaged: see to the disk. The other was taken, state 1: what "
                                    "was set after it may be lost."));
  damage("retain_a");
  damage("retain_b");
  EXPECT_THAT(host_run(retain()).out,
              AllOf(StartsWith("HY811:6: No retain slot is whole."),
                    HasSubstr("put copies of retain_a and retain_b back into " + (folder / "kept"))));
  EXPECT_THAT(host_run(retain("mismatch = \"cold\"\n")).err,
              HasSubstr("Retain: " + (folder / "kept") +
                        ": No retain slot is whole. The task begins without them, and the files are put aside."));
}

/// An edit of units alone leaves the layout: 250 V/mm must not become 250 V/um.
TEST_F(KeptFiles, AParameterOfAnotherUnitIsNotTakenOver) {
  EXPECT_TRUE(host_run(retain(), 250.0, "V/mm").well);
  EXPECT_THAT(host_run(retain("mismatch = \"refuse\"\n"), 0.25, "V/um").out,
              StartsWith("HY811:6: The retained values are of other units: G.A is in V/mm there, V/um here."));
  EXPECT_THAT(host_run(retain("mismatch = \"refuse\"\n"), 2.0, "V/mm").out,
              HasSubstr("with 1 parameter as retained and not as given: G.A"));
  const HostRun carried = host_run(retain(), 0.25, "V/um");
  EXPECT_TRUE(carried.well);
  EXPECT_THAT(carried.err, HasSubstr("G.A (V/mm there, V/um here)"));
  EXPECT_THAT(carried.out, Not(HasSubstr("as retained and not as given")));
  const HostRun cold = host_run(retain("mismatch = \"cold\"\n"), 2.0, "V/mm");
  EXPECT_TRUE(cold.well);
  EXPECT_THAT(cold.out, AllOf(HasSubstr("started cold"), Not(HasSubstr("as retained"))));
}

TEST_F(KeptFiles, ParametersThatAreRetainedAndNotAsGivenAreSaid) {
  EXPECT_TRUE(host_run(retain(), 1.5).well);
  EXPECT_THAT(host_run(retain(), 1.5).out, AllOf(HasSubstr(", from retained state 1;"), Not(HasSubstr("as given"))));
  EXPECT_THAT(
      host_run(retain(), 2.5).out,
      HasSubstr(fmt::format(", from retained state 2 with 1 parameter as retained and not as given: G.A (an empty "
                            "{} gives those given); ",
                            folder / "kept")));
}

TEST_F(KeptFiles, AStateThatCannotBeWrittenIsAFaultOfTheRun) {
  for (const char* const slot : {"kept/retain_a.new", "kept/retain_b.new"}) {
    std::filesystem::create_directories(folder / slot);
  }
  const auto refused = host_run(retain("every = 1\n"));
  EXPECT_FALSE(refused.well);
  const std::string cause = (folder / "kept/retain_a.new") + ": Is a directory";
  EXPECT_THAT(refused.out, HasSubstr("; the last state is not retained: " + cause + "; fault: none\n"));
}

TEST_F(KeptFiles, ALockFileThatCannotBeOneIsRefusedAtItsKey) {
  const auto with = [](const std::string& file) {
    return host_run("[modbus]\nport = 0\nlock_file = \"" + file + "\"\n").out;
  };
  EXPECT_TRUE(with(folder.path().string()).starts_with("HY100:7: ")) << with(folder.path().string());
  EXPECT_TRUE(with("/dev/null/a.lock").starts_with("HY700:7: ")) << with("/dev/null/a.lock");
  const std::string loop = folder / "loop";
  std::filesystem::create_symlink(loop, loop);
  for (const std::string& file : {loop, folder / std::string(300, 'a'), loop + "/a.lock"}) {
    EXPECT_THAT(with(file), AllOf(StartsWith("HY100:7: "), HasSubstr(file))) << file;
  }
}

/// A file that a power cut emptied has kept no address: who knows them from before has to hear of it.
TEST_F(KeptFiles, ALockFileWithoutAnAddressIsSaid) {
  const std::string table = fmt::format("[modbus]\nport = 0\nlock_file = \"{}\"\n", folder / "plant.registers");
  EXPECT_THAT(host_run(table).err, Not(HasSubstr("had no address"))) << "a first start";
  const std::string whole = contents_of(folder / "plant.registers");
  EXPECT_THAT(host_run(table).err, Not(HasSubstr("had no address")));
  for (const char* const rest : {"", "# Addresses of ACC", "\r\n\n"}) {
    folder.write("plant.registers", rest);
    EXPECT_THAT(host_run(table).err,
                HasSubstr("plant.registers was there and had no address: registers have them anew"));
    EXPECT_EQ(contents_of(folder / "plant.registers"), whole);
  }
}

TEST_F(KeptFiles, ALockFileThatHasNoRoomKeepsNoTaskFromStartingAndIsWrittenOnceThereIs) {
  test::Accumulator program;
  RunConfig config = parse_run_config(
      "RUN.toml",
      fmt::format("[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n[modbus]\nport = 0\nlock_file = \"{}\"\n",
                  folder / "plant.registers"),
      program.shape());
  config.task.loop.cycles = 1;
  Task task(program, config.task);
  const auto shortages = [&] {
    VirtualClock clock;
    const std::atomic<bool> stop{false};
    (void)task.run(clock, stop);  // one more cycle
    return static_cast<unsigned>(test::value(task.door(), "task.shortages"));
  };
  testing::internal::CaptureStderr();
  std::optional<ServedMap> served;
  {
    const hysteron::test::FileSizeLimit full(600);  // room for lines on standard error, and not for the file
    served.emplace(config, "PLANT", task, nullptr);
    EXPECT_EQ(shortages() & 512U, 512U);
    served->look(std::chrono::steady_clock::now() + std::chrono::seconds(11));
    EXPECT_FALSE(std::filesystem::exists(folder / "plant.registers"));
  }
  served->look(std::chrono::steady_clock::now());
  EXPECT_EQ(shortages() & 512U, 512U) << "not before its time";
  served->look(std::chrono::steady_clock::now() + std::chrono::seconds(11));
  EXPECT_EQ(shortages() & 512U, 0U);
  EXPECT_THAT(contents_of(folder / "plant.registers"), HasSubstr(" Y\n"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("plant.registers cannot be written: File too large. It is tried again every 10 s"),
                    HasSubstr("Modbus: the addresses of the registers are in ")));
}

/// Whoever cleans up takes no address from a client: the next start would give others after an edit.
TEST_F(KeptFiles, ALockFileThatIsDeletedIsThereAgain) {
  test::Accumulator program;
  const RunConfig config = parse_run_config(
      "RUN.toml",
      fmt::format("[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n[modbus]\nport = 0\nlock_file = \"{}\"\n",
                  folder / "disk/plant.registers"),
      program.shape());
  Task task(program, config.task);
  testing::internal::CaptureStderr();
  ServedMap served(config, "PLANT", task, nullptr);
  const std::string whole = contents_of(folder / "disk/plant.registers");
  EXPECT_THAT(whole, HasSubstr(" Y\n"));
  auto now = std::chrono::steady_clock::now();
  const auto look = [&] { served.look(now += std::chrono::seconds(11)); };
  look();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  std::filesystem::remove_all(folder / "disk");
  folder.write("disk", "in its way");
  for (int i = 0; i < 3; ++i) {
    look();
  }
  std::filesystem::remove(folder / "disk");
  look();
  EXPECT_EQ(contents_of(folder / "disk/plant.registers"), whole);
  std::filesystem::remove(folder / "disk/plant.registers");
  look();
  EXPECT_EQ(contents_of(folder / "disk/plant.registers"), whole);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(said, '\n'), 3) << said;
  EXPECT_THAT(said,
              AllOf(HasSubstr("plant.registers was deleted. The file "),
                    HasSubstr("Modbus: the addresses of the registers are in "),
                    HasSubstr("plant.registers was deleted, and is there again: registers keep their addresses.")));
}

TEST_F(KeptFiles, ALockFileMayBeginWithAByteOrderMark) {
  const std::string table = fmt::format("[modbus]\nport = 0\nlock_file = \"{}\"\n", folder / "plant.registers");
  EXPECT_TRUE(host_run(table).well);
  const std::string whole = contents_of(folder / "plant.registers");
  folder.write("plant.registers", "\xEF\xBB\xBF" + whole);
  EXPECT_TRUE(host_run(table).well);
  folder.write("plant.registers", "\xEF\xBB\xBF");
  EXPECT_THAT(host_run(table).err, HasSubstr("plant.registers was there and had no address"));
  EXPECT_EQ(contents_of(folder / "plant.registers"), whole);
}

TEST_F(KeptFiles, AWrongAddressIsRefusedAtItsKey) {
  EXPECT_THAT(host_run("[modbus]\nport = 0\n[registers.Y]\ntype = \"int16\"\nat = \"nowhere\"\n").out,
              StartsWith("HY824:9: nowhere is no address."));
  EXPECT_THAT(host_run("[modbus]\nport = 0\n[addresses]\nY = \"nowhere\"\n").out,
              StartsWith("HY824:8: nowhere is no address."));
}

TEST_F(KeptFiles, WhatWouldBeOverwrittenIsRefusedAtItsKey) {
  test::Accumulator program;
  const std::string start = "[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n";
  for (const char* const rest :
       {"[modbus]\nport = 0\nlock_file = \"IN\"\n", "[history]\nkeep = \"1d\"\nfile = \"IN\"\n",
        "[trace]\nfiles = 3\nfile = \"IN\"\n", "[online_change]\nload = 0.5\nsocket = \"IN\"\n",
        "[mqtt]\nbroker = \"127.0.0.1\"\nfile = \"IN\"\n"}) {
    const RunConfig config = parse_run_config("RUN.toml", start + rest, program.shape());
    try {
      refuse_to_overwrite_inputs(config, {{.file = "IN", .named_by = "the command"}});
      ADD_FAILURE() << rest;
    } catch (const InputError& refused) {
      EXPECT_EQ(refused.diagnostics().all().front().number, 709) << rest;
      EXPECT_EQ(refused.diagnostics().all().front().place.line, 7U) << rest;
    }
  }
}

TEST_F(KeptFiles, ATraceThatIsNoOrdinaryFileIsRefusedAtOnce) {
  const std::string pipe = folder / "run.trace";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(host_run(trace()).out, AllOf(StartsWith("HY812:"), HasSubstr("name an ordinary file, ")));
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  EXPECT_THAT(host_run(trace()).out, StartsWith("HY812:")) << "with a reader as without";
  ::close(reader);
}

TEST_F(KeptFiles, ADeviceThatNothingIsOnIsSaid) {
  EXPECT_EQ(host_run("[devices.stage]\nport = 1\n").err,
            "Run file: no input and no output is on the device stage. Write device = \"stage\" below one, or remove "
            "[devices.stage].\n");
}

/// A disk that can be full.
class Disk final : public RetainFiles {
 public:
  std::optional<std::vector<std::byte>> read(std::size_t /*slot*/) override { return std::nullopt; }
  std::string write(std::size_t /*slot*/, std::span<const std::byte> /*bytes*/) override {
    return full ? "kept/retain_a.new: No space left on device" : "";
  }
  std::string put_aside(std::size_t /*slot*/) override { return {}; }
  std::string copy_aside(std::size_t /*slot*/) override { return {}; }
  std::atomic<bool> full{false};
};

TEST(WriteNotices, AFailureIsSaidOnceAndOnceThatItIsOver) {
  Disk disk;
  test::Accumulator program;
  Retainer retainer(disk, program, {});
  WriteNotices notices(&retainer, nullptr);
  const auto said = [&](bool full) {
    disk.full = full;
    testing::internal::CaptureStderr();
    for (int i = 0; i < 3; ++i) {
      const auto tried = retainer.written() + retainer.failures();
      retainer.offer(program);
      EXPECT_TRUE(hysteron::test::soon([&] { return retainer.written() + retainer.failures() > tried; }));
      EXPECT_TRUE(hysteron::test::soon([&] { return retainer.problem().empty() != full; }));
      notices.look();
    }
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said(false), "");
  for (const std::string newest : {"3", "6"}) {
    EXPECT_EQ(said(true),
              "Retain: the newest state on the disk stays " + newest +
                  ": kept/retain_a.new: No space left on device. Clear what is in the way there; each further "
                  "state is tried again.\n");
    EXPECT_THAT(notices.at_the_end(), HasSubstr("; the last state is not retained: kept/retain_a.new: "));
    EXPECT_EQ(said(false), fmt::format("Retain: written again, state {}.\n", std::stoi(newest) + 1));
    EXPECT_EQ(notices.at_the_end(), "");
  }
  EXPECT_EQ(retainer.failures(), 6U);
}

TEST(WriteNotices, FailuresAreAmongTheStatusOfTheTask) {
  Disk disk;
  disk.full = true;
  test::Accumulator program;
  Retainer retainer(disk, program, {});
  Task task(program, {.loop = {.cycles = 20}, .inputs = {{}}, .outputs = {{}, {}}, .retain_every = 1},
            {.retainer = &retainer});
  program.during_step = [&, step = 0](std::span<double>) mutable {
    EXPECT_TRUE(++step < 10 || hysteron::test::soon([&] { return retainer.failures() > 0; }));
  };
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  EXPECT_GT(test::value(task.door(), "task.write_failures"), 0.0);
}

TEST(NewPlaces, AreToldWhereTheirPathIsRelativeAndNothingIsThere) {
  const test::ScratchFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  RunConfig config;
  config.retain = RetainConfig{.folder = "kept"};
  config.modbus = ModbusConfig{.lock_file = "stage.registers"};
  config.history = HistoryConfig{.file = (folder.path() / "far.history").string()};
  EXPECT_EQ(new_places(config),
            "nothing is there yet of kept ([retain] folder), stage.registers ([modbus] lock_file) in " +
                std::filesystem::canonical(folder.path()).string() +
                ", the folder in which the task was started. If it ran before, start it in the same folder, or write "
                "absolute paths.");
  std::filesystem::create_directory("kept");
  std::ofstream("stage.registers") << "\n";
  EXPECT_EQ(new_places(config), "") << "what is there is gone on with, and an absolute path is always the same";
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace hysteron::runtime
