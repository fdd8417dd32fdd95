// A disk that takes nothing, since it is full or read-only after an error, ends no start: the task controls, says what
// it cannot write, and writes it once it can.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "tests/tool/workbench.hpp"
#include "tool/built_program.hpp"

namespace hysteron {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* traced_run = R"([task]
scheduling = "other"
lock_memory = false
[outputs.Y]
safe = 0.0
[outputs.BUSY]
safe = 0.0
[retain]
folder = "disk/kept"
every = "10ms"
[trace]
file = "disk/run.trace"
[history]
file = "disk/history.sqlite"
[modbus]
port = 0
lock_file = "disk/registers"
[online_change]
socket = "disk/change.socket"
)";

/// As root of a file system of one's own, with an empty disk of these options at the folder `disk`. Ends by 77 where
/// the machine lets nobody have one, as in a chroot.
std::string with_disk(const std::string& options, const std::string& commands) {
  return "unshare -rm true 2>&- || exit 77; unshare -rm sh -c '(mkdir disk && mount -t tmpfs -o " + options +
         " none disk) || exit 77; " + commands + "'";
}

constexpr const char* serve = "hysteron serve plant.st --config RUN.toml --engine interpreter --cycles ";

TEST(TroubledDisk, AReadOnlyOneEndsNoStart) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  bench.write("RUN.toml", traced_run);
  const std::string once = serve;
  const auto served = bench.shell(
      with_disk("size=10m", once + "50 && mount -o remount,ro none disk && { " + once + "50; echo ended by $?; }; " +
                                "(sleep 3; mount -o remount,rw none disk) & " + once + "15000"));
  if (served.code == 77) {
    GTEST_SKIP() << "this machine lets nobody have a disk of his own";
  }
  EXPECT_EQ(served.code, 0) << served.err;
  EXPECT_THAT(served.out, AllOf(HasSubstr(", from retained state "), HasSubstr("PLANT: done; 50 cycles"),
                                HasSubstr("the last state is not retained: disk/kept/retain_"), HasSubstr("ended by 1"),
                                HasSubstr("PLANT: done; 15000 cycles")));
  for (const char* const line :
       {"Retain: the newest state on the disk stays ", "Trace: ends here: disk/run.trace: Read-only file system.",
        "History: nothing is written any more: ",
        "there can be no socket disk/change.socket yet: Read-only file system."}) {
    EXPECT_THAT(served.err, HasSubstr(line));
  }
  for (const char* const line :
       {"Retain: written again, state ", "Trace: written again, into another file; ", "History: written again; ",
        "Online change: the socket disk/change.socket is there now."}) {
    EXPECT_THAT(served.err, HasSubstr(line));
  }
}

/// The first start: nothing can be made there.
TEST(TroubledDisk, AFullOneEndsNoStart) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  bench.write("RUN.toml", traced_run);
  for (const char* const disk : {"nr_inodes=1", "size=10m,ro"}) {
    const auto served = bench.shell(with_disk(disk, std::string(serve) + "50; code=$?; rmdir disk 2>&-; exit $code"));
    if (served.code == 77) {
      GTEST_SKIP() << "this machine lets nobody have a disk of his own";
    }
    EXPECT_EQ(served.code, 1) << served.err;
    EXPECT_THAT(served.out, HasSubstr("PLANT: done; 50 cycles"));
    EXPECT_THAT(served.err, HasSubstr("Modbus: The file disk/registers cannot be written: "));
    (void)bench.shell("rmdir disk");
  }
}

/// A compiled program needs room for temporary files.
TEST(TroubledDisk, WithoutRoomForTheCompilerATaskIsInterpreted) {
  if (!tool::has_compiler()) {
    return;  // then each is interpreted
  }
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  bench.write(
      "RUN.toml",
      "[outputs.Y]\nsafe = 0.0\n[outputs.BUSY]\nsafe = 0.0\n[retain]\nfolder = \"kept\"\nmismatch = \"refuse\"\n");
  const std::string line = "hysteron serve plant.st --config RUN.toml --virtual --cycles 20";
  EXPECT_THAT(bench.shell(line).out, HasSubstr("PLANT: compiled; "));
  const auto served =
      bench.shell(with_disk("size=10m,ro", "export TMPDIR=$PWD/disk; " + line + "; code=$?; " + line +
                                               " --engine compiled; echo asked by name: $?; exit $code"));
  if (served.code == 77) {
    GTEST_SKIP() << "this machine lets nobody have a disk of his own";
  }
  EXPECT_EQ(served.code, 0) << served.err;
  EXPECT_THAT(served.out, HasSubstr("PLANT: interpreted, from retained state "));
  EXPECT_THAT(served.err,
              AllOf(HasSubstr("Engine: this run is interpreted, with the same bits in a longer step. It cannot be "
                              "compiled: HY700: "),
                    HasSubstr("set TMPDIR to a folder that can be written to.")));
  EXPECT_THAT(served.out, HasSubstr("asked by name: 2")) << "who asks for it by name gets it, or a reason";
  EXPECT_THAT(served.err, HasSubstr("HY700 error: "));
}

}  // namespace
}  // namespace hysteron
