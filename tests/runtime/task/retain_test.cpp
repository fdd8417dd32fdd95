// No damage to a slot is taken for a value, and none costs more than the newest slot.
#include "runtime/task/retain.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/fs.h>
#include <sys/ioctl.h>

#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <system_error>

#include "support/descriptor.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/runtime/task/retain_kill.hpp"
#include "tests/support/own_disk.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using testing::HasSubstr;

RetainedValues some_values(std::uint64_t sequence) {
  return {.sequence = sequence,
          .layout = "9f3c",
          .parameters = {1.5, -0.0, 1e-300},
          .state = std::vector<std::byte>(61, static_cast<std::byte>(sequence))};
}

/// A disk in memory that can refuse.
class MemoryFiles final : public RetainFiles {
 public:
  std::optional<std::vector<std::byte>> read(std::size_t slot) override {
    return slots.contains(slot) ? std::optional(slots[slot]) : std::nullopt;
  }
  std::string write(std::size_t slot, std::span<const std::byte> bytes) override {
    if (full) {
      return "no space";
    }
    slots[slot] = {bytes.begin(), bytes.end()};
    return {};
  }
  std::string copy_aside(std::size_t slot) override {
    if (full) {
      return "no space";
    }
    aside.push_back(slots[slot]);
    return {};
  }
  std::string put_aside(std::size_t slot) override {
    if (full) {
      return "no space";
    }
    aside.push_back(slots[slot]);
    slots.erase(slot);
    return {};
  }
  std::map<std::size_t, std::vector<std::byte>> slots;
  std::vector<std::vector<std::byte>> aside;
  std::atomic<bool> full{false};
};

/// Inputs come last, and a file of before they were kept is whole without them.
TEST(Retain, InputsComeBackAndOlderFilesHaveNone) {
  RetainedValues values = some_values(7);
  values.inputs = {1500.0, 0.0, -2.5};
  const Slot slot = decode_slot(encode_slot(values));
  EXPECT_EQ(slot.status, SlotStatus::whole);
  EXPECT_EQ(slot.values.inputs, values.inputs);
  EXPECT_EQ(slot.values.state, values.state);
  auto older = encode_slot(some_values(7));
  older.erase(older.end() - 2 * sizeof(std::uint32_t), older.end());  // the count of inputs, and the sum
  const std::uint32_t sum = crc32c(older);
  const auto* const bytes = reinterpret_cast<const std::byte*>(&sum);
  older.insert(older.end(), bytes, bytes + sizeof(sum));
  EXPECT_EQ(decode_slot(older).status, SlotStatus::whole);
  EXPECT_TRUE(decode_slot(older).values.inputs.empty());
}

TEST(Retain, AFolderThatIsDeletedIsMadeAgainAndHeldAgain) {
  const hysteron::test::ScratchFolder scratch;
  const auto folder = scratch.path() / "kept";
  RetainFolder files(folder);
  files.open();
  const auto bytes = encode_slot(some_values(7));
  EXPECT_EQ(files.write(0, bytes), "");
  EXPECT_EQ(files.take_remark(), "");
  std::filesystem::remove_all(folder);
  {
    const auto before = std::filesystem::current_path();
    std::filesystem::create_directory(scratch.path() / "gone");
    std::filesystem::current_path(scratch.path() / "gone");
    std::filesystem::remove(scratch.path() / "gone");
    RetainFolder nowhere("kept");
    EXPECT_EQ(nowhere.write(0, bytes), "kept: No such file or directory");
    EXPECT_EQ(nowhere.mend(), "Make the folder that is missing");
    std::filesystem::current_path(before);
  }
  {
    RetainFolder other(folder);
    other.open();
    EXPECT_EQ(files.write(1, bytes), folder.string() + ": another task retains its values there by now");
    EXPECT_EQ(other.read(1), std::nullopt);
  }
  EXPECT_EQ(files.write(1, bytes), "");
  EXPECT_EQ(files.read(1), bytes);
  EXPECT_EQ(files.take_remark(), folder.string() + " was deleted or moved. It is there again, with the newest state.");
  EXPECT_EQ(files.take_remark(), "");
  RetainFolder other(folder);
  EXPECT_THROW(other.open(), std::system_error);
}

TEST(Retain, TheSumIsTheStandardsOwn) {
  // RFC 3720, B.4: 32 bytes of zeros, of ones, and 0 to 31.
  std::vector<std::byte> bytes(32, std::byte{0});
  EXPECT_EQ(crc32c(bytes), 0x8A9136AAU);
  bytes.assign(32, std::byte{0xFF});
  EXPECT_EQ(crc32c(bytes), 0x62A8AB43U);
  for (std::size_t i = 0; i < 32; ++i) {
    bytes[i] = static_cast<std::byte>(i);
  }
  EXPECT_EQ(crc32c(bytes), 0x46DD794EU);
}

TEST(Retain, ASlotComesBackAsItWas) {
  const auto values = some_values(7);
  const Slot slot = decode_slot(encode_slot(values));
  ASSERT_EQ(slot.status, SlotStatus::whole);
  EXPECT_EQ(slot.values.sequence, 7U);
  EXPECT_EQ(slot.values.layout, values.layout);
  EXPECT_EQ(slot.values.parameters, values.parameters);
  EXPECT_EQ(slot.values.state, values.state);
}

TEST(Retain, EveryTruncationAndEverySingleBitFlipIsSeen) {
  const auto bytes = encode_slot(some_values(7));
  const auto result = test::damage(bytes);
  EXPECT_EQ(result.tried, bytes.size() + 8 * bytes.size());
  EXPECT_EQ(result.taken, 0U);
  auto longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_EQ(decode_slot(longer).status, SlotStatus::broken);
}

TEST(Retain, ABrokenNewestSlotCostsThatSlotAlone) {
  MemoryFiles files;
  files.slots[0] = encode_slot(some_values(4));
  files.slots[1] = encode_slot(some_values(5));
  auto recovery = recover(files, "9f3c", MismatchPolicy::refuse);
  EXPECT_EQ(recovery.values->sequence, 5U);
  EXPECT_EQ(recovery.next_slot, 0U);
  EXPECT_EQ(recovery.note, "");
  files.slots[1].resize(40);
  recovery = recover(files, "9f3c", MismatchPolicy::refuse);
  EXPECT_EQ(recovery.refused, "");
  EXPECT_EQ(recovery.values->sequence, 4U);
  EXPECT_EQ(recovery.next_slot, 1U);  // the whole one is not overwritten first
  EXPECT_EQ(recovery.note, "one retain slot was broken; the other was taken");
}

TEST(Retain, AnotherLayoutIsRefusedOrPutAside) {
  MemoryFiles files;
  EXPECT_EQ(recover(files, "other", MismatchPolicy::refuse).refused, "");  // a first start
  files.slots[0] = encode_slot(some_values(4));
  const auto kept = files.slots[0];
  EXPECT_EQ(recover(files, "other", MismatchPolicy::refuse).refused, "The retained values are of another diagram.");
  EXPECT_EQ(files.slots[0], kept);
  auto cold = recover(files, "other", MismatchPolicy::cold);
  EXPECT_EQ(cold.refused, "");
  EXPECT_FALSE(cold.values);
  EXPECT_EQ(files.slots[0], kept) << "a start that is refused for another reason changes nothing";
  EXPECT_EQ(put_aside(files, cold), "");
  ASSERT_EQ(files.aside.size(), 1U);
  EXPECT_EQ(files.aside[0], kept);
  files.slots[0] = {std::byte{1}};
  EXPECT_EQ(recover(files, "other", MismatchPolicy::refuse).refused, "No retain slot is whole.");
}

/// The same values lie in other bytes, whatever is to be done with those of another diagram.
TEST(Retain, AnotherEngineOfTheSameDiagramIsNoOtherDiagram) {
  MemoryFiles files;
  auto described = some_values(4);
  described.layout = "9f3c-interpreter";
  described.described = "p\tG.A\tLREAL\tum\n";
  files.slots[0] = encode_slot(described);
  for (const MismatchPolicy policy : {MismatchPolicy::refuse, MismatchPolicy::cold, MismatchPolicy::carry}) {
    const auto recovery = recover(files, "9f3c-compiled", policy);
    ASSERT_TRUE(recovery.values);
    EXPECT_TRUE(recovery.by_name);
    EXPECT_FALSE(recovery.aside[0]) << "nothing of it is lost";
    EXPECT_EQ(recovery.note, "");
  }
  EXPECT_NE(recover(files, "9f3c-compiled-float32", MismatchPolicy::refuse).refused, "") << "other numbers";
  EXPECT_NE(recover(files, "9f3d-compiled", MismatchPolicy::refuse).refused, "");
}

TEST(Retain, ParametersThatTheProgramCannotTakeAreRefusedOrPutAside) {
  MemoryFiles files;
  files.slots[0] = encode_slot(some_values(4));
  const RetainChecks check{.refusal = [&](const RetainedValues& values) {
    EXPECT_EQ(values.parameters, some_values(4).parameters);
    return std::string("L.MX = 1 must be at least L.MN = 5.");
  }};
  const std::string layout = some_values(4).layout;
  EXPECT_EQ(recover(files, layout, MismatchPolicy::refuse, check).refused,
            "The retained parameters cannot be: L.MX = 1 must be at least L.MN = 5.");
  const auto cold = recover(files, layout, MismatchPolicy::cold, check);
  EXPECT_FALSE(cold.values);
  EXPECT_TRUE(cold.aside[0]);
}

TEST(Retain, TheSameLayoutInOtherUnitsIsAnotherDiagram) {
  MemoryFiles files;
  auto described = some_values(4);
  described.layout = "9f3c-interpreter";
  described.described = "p\tG.A\tLREAL\tum\n";
  files.slots[0] = encode_slot(described);
  const RetainChecks check{.other_unit = [&](const RetainedValues& values) {
    EXPECT_EQ(values.described, described.described);
    return std::string("G.A is in um there, mm here");
  }};
  for (const char* const layout : {"9f3c-interpreter", "9f3c-compiled"}) {
    EXPECT_EQ(recover(files, layout, MismatchPolicy::refuse, check).refused,
              "The retained values are of other units: G.A is in um there, mm here.");
    const auto cold = recover(files, layout, MismatchPolicy::cold, check);
    EXPECT_FALSE(cold.values);
    EXPECT_TRUE(cold.aside[0]);
    const auto carried = recover(files, layout, MismatchPolicy::carry, check);
    EXPECT_TRUE(carried.values.has_value());
    EXPECT_TRUE(carried.by_name);
    EXPECT_TRUE(carried.aside[0]) << "the diagram of before can go on from it";
  }
}

TEST(Retain, AnEditedDiagramCarriesWhatHasNames) {
  MemoryFiles files;
  auto described = some_values(4);
  files.slots[0] = encode_slot(described);
  EXPECT_EQ(recover(files, "other", MismatchPolicy::carry).refused, "The retained values are of another diagram.")
      << "a file without names";
  described.described = "p\tG.A\tLREAL\tum\n";
  files.slots[0] = encode_slot(described);
  const auto kept = files.slots[0];
  auto recovery = recover(files, "other", MismatchPolicy::carry);
  EXPECT_EQ(recovery.refused, "");
  EXPECT_TRUE(recovery.by_name);
  ASSERT_TRUE(recovery.values);
  EXPECT_EQ(recovery.values->described, described.described);
  EXPECT_EQ(recovery.next_slot, 1U) << "a power cut at the first writing leaves the old one";
  EXPECT_EQ(put_aside(files, recovery), "");
  EXPECT_EQ(files.slots[0], kept) << "copied, not taken away";
  ASSERT_EQ(files.aside.size(), 1U);
  EXPECT_EQ(files.aside[0], kept);
  EXPECT_FALSE(recover(files, some_values(4).layout, MismatchPolicy::carry).by_name);
  const RetainChecks shrunk{.refusal = [](const RetainedValues&) { return std::string("G.A = 8 is above 5."); }};
  EXPECT_TRUE(recover(files, some_values(4).layout, MismatchPolicy::carry, shrunk).by_name)
      << "limits that an edit has shrunk cost the values beyond them, and no start";
}

TEST(Retain, AStateThatIsNotFiniteIsAsABrokenSlot) {
  MemoryFiles files;
  files.slots[0] = encode_slot(some_values(4));
  files.slots[1] = encode_slot(some_values(5));
  const RetainChecks newest{
      .not_finite = [](const RetainedValues& values) { return std::string(values.sequence == 5 ? "LAG.Y" : ""); }};
  const auto recovery = recover(files, some_values(4).layout, MismatchPolicy::carry, newest);
  ASSERT_TRUE(recovery.values);
  EXPECT_EQ(recovery.values->sequence, 4U);
  EXPECT_EQ(recovery.next_slot, 1U);
  EXPECT_EQ(recovery.note, "in one retain slot LAG.Y was not finite; the other was taken");
  const RetainChecks both{.not_finite = [](const RetainedValues&) { return std::string("LAG.Y"); }};
  EXPECT_EQ(recover(files, some_values(4).layout, MismatchPolicy::carry, both).refused,
            "No retain slot can be taken: LAG.Y is not finite.");
}

TEST(Retain, TheThreadWritesTheNewestAndCountsRefusals) {
  test::Accumulator program;
  MemoryFiles files;
  {
    Retainer retainer(files, program, recover(files, "accumulator", MismatchPolicy::refuse));
    for (int i = 1; i <= 50; ++i) {
      program.set_parameter(0, i);
      retainer.offer(program);
    }
  }
  auto recovery = recover(files, "accumulator", MismatchPolicy::refuse);
  ASSERT_TRUE(recovery.values);
  EXPECT_EQ(recovery.values->parameters[0], 50.0);
  const auto before = recovery.sequence;
  files.full = true;
  {
    Retainer retainer(files, program, recovery);
    program.set_parameter(0, 51.0);
    retainer.offer(program);
    while (retainer.failures() == 0) {
      std::this_thread::yield();
    }
    EXPECT_EQ(retainer.written(), before);
  }
  EXPECT_EQ(recover(files, "accumulator", MismatchPolicy::refuse).values->parameters[0], 50.0);
}

TEST(Retain, KilledAtAnyMomentNothingConfirmedIsLost) {
  const hysteron::test::ScratchFolder scratch;
  std::mt19937_64 random(5);
  std::uint64_t last = 0;
  for (int i = 0; i < 20; ++i) {
    const auto after = static_cast<std::int64_t>(1'000'000 + random() % 20'000'000);
    const auto result = test::kill_while_retaining(scratch / "retain", after);
    EXPECT_TRUE(result.consistent);
    EXPECT_GE(result.recovered, result.confirmed);
    EXPECT_GE(result.recovered, last);
    last = result.recovered;
  }
  EXPECT_GT(last, 0U);
}

TEST(Retain, AFullDiskKeepsNoFolderFromBeingThereLater) {
  const hysteron::test::ScratchFolder scratch;
  const std::string disk = scratch.path();
  hysteron::test::with_own_disk(disk, "nr_inodes=1", [&] {  // no file to spare
    RetainFolder files(disk + "/retain");
    files.open();
    RetainFolder late(disk + "/retain");
    late.open();
    EXPECT_FALSE(files.read(0));
    EXPECT_THAT(files.write(0, encode_slot(some_values(1))), HasSubstr("retain"));
    hysteron::test::change_disk(disk, "nr_inodes=100");
    EXPECT_EQ(files.write(0, encode_slot(some_values(2))), "");
    EXPECT_TRUE(files.read(0));
    // The first of two tasks holds it, however often the other tries.
    EXPECT_NE(late.write(1, encode_slot(some_values(3))), "");
    EXPECT_NE(late.write(1, encode_slot(some_values(3))), "");
    EXPECT_FALSE(files.read(1));
    RetainFolder second(disk + "/retain");
    EXPECT_THROW(second.open(), std::system_error) << "it is held by now";
  });
}

/// As a disk is after an error: what it holds is gone on from, and kept aside once that can be.
TEST(Retain, AReadOnlyDiskIsReadAndIsWrittenOnceItCanBe) {
  const hysteron::test::ScratchFolder scratch;
  const std::string disk = scratch.path();
  hysteron::test::with_own_disk(disk, "nr_inodes=100", [&] {
    {
      RetainFolder before(disk + "/retain");
      before.open();
      auto described = some_values(4);
      described.described = "p\tG.A\tLREAL\tum\n";
      EXPECT_EQ(before.write(0, encode_slot(described)), "");
    }
    hysteron::test::change_disk(disk, "nr_inodes=100", true);
    RetainFolder missing(disk + "/other");
    missing.open();
    EXPECT_FALSE(missing.read(0));
    RetainFolder files(disk + "/retain");
    files.open();
    Recovery recovery = recover(files, "edited", MismatchPolicy::carry);
    EXPECT_TRUE(recovery.values);
    EXPECT_THAT(put_aside(files, recovery), HasSubstr("retain_a.aside1: Read-only file system"));
    test::Accumulator program;
    Retainer retainer(files, program, recovery);
    retainer.offer(program);
    EXPECT_TRUE(hysteron::test::soon([&] { return !retainer.problem().empty(); }));
    EXPECT_THAT(retainer.problem(), HasSubstr("retain_a.aside1: Read-only file system"));
    hysteron::test::change_disk(disk, "nr_inodes=100");
    retainer.offer(program);
    EXPECT_TRUE(hysteron::test::soon([&] { return retainer.written() == 5; }));
    EXPECT_TRUE(std::filesystem::exists(disk + "/retain/retain_a.aside1"));
    EXPECT_TRUE(std::filesystem::exists(disk + "/retain/retain_b"));
  });
}

TEST(Retain, NothingIsWrittenBeforeWhatIsThereIsPutAside) {
  for (const MismatchPolicy policy : {MismatchPolicy::carry, MismatchPolicy::cold}) {
    MemoryFiles files;
    auto described = some_values(4);
    described.described = "p\tG.A\tLREAL\tum\n";
    files.slots[0] = encode_slot(described);
    files.slots[1] = encode_slot(some_values(3));
    const auto kept = files.slots;
    Recovery recovery = recover(files, "edited", policy);
    files.full = true;
    EXPECT_EQ(put_aside(files, recovery), "no space");
    test::Accumulator program;
    Retainer retainer(files, program, recovery);
    retainer.offer(program);
    EXPECT_TRUE(hysteron::test::soon([&] { return retainer.failures() == 1; }));
    EXPECT_EQ(files.slots, kept);
    files.full = false;
    retainer.offer(program);
    retainer.finish();
    EXPECT_EQ(retainer.written(), 5U);
    EXPECT_EQ(files.aside.size(), policy == MismatchPolicy::carry ? 1U : 2U);
    EXPECT_EQ(files.aside[0], kept.at(0));
  }
}

/// A file system of a memory card gives no second name; nor does one give it to a file that may not be changed.
TEST(Retain, WhereAFileCanHaveNoSecondNameItIsCopied) {
  const hysteron::test::ScratchFolder scratch;
  RetainFolder files(scratch / "retain");
  ASSERT_EQ(files.write(0, encode_slot(some_values(7))), "");
  const Descriptor slot(::open(files.path_of(0).c_str(), O_RDONLY | O_CLOEXEC));
  int flags = FS_IMMUTABLE_FL;
  if (::ioctl(slot.number(), FS_IOC_SETFLAGS, &flags) != 0) {
    return;  // no file here can be kept from having a second name
  }
  const std::string problem = files.copy_aside(0);
  flags = 0;
  EXPECT_EQ(::ioctl(slot.number(), FS_IOC_SETFLAGS, &flags), 0);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(hysteron::test::contents_of(files.path_of(0).string() + ".aside1"),
            hysteron::test::contents_of(files.path_of(0)));
}

TEST(Retain, FilesPutAsideAreNeverOverwritten) {
  const hysteron::test::ScratchFolder scratch;
  RetainFolder files(scratch / "retain");
  for (std::uint64_t i = 1; i <= 3; ++i) {
    ASSERT_EQ(files.write(0, encode_slot(some_values(i))), "");
    ASSERT_EQ(files.put_aside(0), "");
    EXPECT_FALSE(files.read(0));
  }
  const auto names = scratch.names();
  for (const char* const name : {"retain/retain_a.aside1", "retain/retain_a.aside2", "retain/retain_a.aside3"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  EXPECT_EQ(names.size(), 4U);
}

}  // namespace
}  // namespace hysteron::runtime
