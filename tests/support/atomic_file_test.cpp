#include "support/atomic_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/render.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron {
namespace {

namespace fs = std::filesystem;
using test::contents_of;
using test::ScratchFolder;
using testing::UnorderedElementsAre;

template <class Action>
int number_of_error(Action action) {
  try {
    action();
  } catch (const InputError& refused) {
    return refused.diagnostics().all().front().number;
  }
  return 0;
}

TEST(AtomicFile, WritesAndReplaces) {
  const ScratchFolder folder;
  write_file_atomically(folder / "a.csv", "first");
  EXPECT_EQ(contents_of(folder / "a.csv"), "first");
  const std::string long_text(3000000, 'x');
  write_file_atomically(folder / "a.csv", long_text);
  EXPECT_EQ(contents_of(folder / "a.csv"), long_text);
  EXPECT_THAT(folder.names(), UnorderedElementsAre("a.csv"));
}

TEST(AtomicFile, MakesMissingFolders) {
  const ScratchFolder folder;
  write_file_atomically(folder / "out/deep/a.csv", "text");
  EXPECT_EQ(contents_of(folder / "out/deep/a.csv"), "text");
}

TEST(AtomicFile, KeepsPermissionsAndLinks) {
  const ScratchFolder folder;
  folder.write("real.csv", "old");
  fs::permissions(folder / "real.csv", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real.csv", folder / "link.csv");
  write_file_atomically(folder / "link.csv", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
  EXPECT_EQ(contents_of(folder / "real.csv"), "new");
  EXPECT_EQ(fs::status(folder / "real.csv").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicFile, AFullDiskLeavesTheOldFileAndNothingElse) {
  const ScratchFolder folder;
  folder.write("a.csv", "old");
  const auto before = folder.names();
  {
    const test::FileSizeLimit limit(1000);
    EXPECT_EQ(number_of_error([&] { write_file_atomically(folder / "a.csv", std::string(5000, 'x')); }),
              error::unwritable_file);
    EXPECT_EQ(number_of_error([&] { write_file_atomically(folder / "new/b.csv", std::string(5000, 'x')); }),
              error::unwritable_file);
  }
  EXPECT_EQ(contents_of(folder / "a.csv"), "old");
  EXPECT_EQ(folder.names(), before);
}

TEST(AtomicFile, RefusesAFolderAndAFileAsFolder) {
  const ScratchFolder folder;
  fs::create_directory(folder / "d");
  folder.write("f", "text");
  EXPECT_EQ(number_of_error([&] { write_file_atomically(folder / "d", "x"); }), error::unwritable_file);
  EXPECT_EQ(number_of_error([&] { write_file_atomically(folder / "f/x", "x"); }), error::unwritable_file);
  EXPECT_EQ(number_of_error([&] { write_file_atomically("", "x"); }), error::unwritable_file);
  EXPECT_THAT(folder.names(), UnorderedElementsAre("d", "f"));
}

TEST(AtomicFile, ANameThatIsTooLongIsNoMatterOfRoom) {
  const test::ScratchFolder folder;
  try {
    write_file_atomically(folder / (std::string(300, 'A') + ".hpp"), "text");
    FAIL() << "it was written";
  } catch (const InputError& refused) {
    EXPECT_EQ(refused.diagnostics().all().front().number, error::unwritable_file);
    EXPECT_EQ(refused.diagnostics().all().front().mend,
              "give it a shorter name; a generated file is named after its block.");
  }
}

/// What the machine lacks is no matter of the name.
TEST(AtomicFile, WhatTheMachineLacksIsTheMend) {
  EXPECT_EQ(mend_of_machine(ENOSPC), "make room on the disk");
  EXPECT_TRUE(mend_of_machine(EROFS).starts_with("see to the disk: "));
  EXPECT_TRUE(mend_of_machine(EMFILE).starts_with("let more files be open: "));
  EXPECT_EQ(mend_of_machine(ENOENT), "");
  EXPECT_EQ(mend_of_machine(0), "");
  EXPECT_EQ(way_out(ENOSPC), "Make room on the disk");
  EXPECT_EQ(way_out(ENOENT), "Make the folder that is missing");
  EXPECT_EQ(way_out(EACCES), "Give this user the right to write there");
  EXPECT_EQ(way_out(EISDIR), "Clear what is in the way there");
}

TEST(AtomicFile, ADeviceIsWrittenInPlaceAndStays) {
  write_file_atomically("/dev/null", "text");
  struct stat status {};
  ASSERT_EQ(::stat("/dev/null", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
  EXPECT_EQ(number_of_error([] { write_file_atomically("/dev/full", "text"); }), error::unwritable_file);
}

TEST(AtomicFiles, AllOrNone) {
  const ScratchFolder folder;
  folder.write("a.hpp", "old a");
  const auto before = folder.names();
  {
    const test::FileSizeLimit limit(1000);
    EXPECT_EQ(number_of_error([&] {
                write_files_atomically({{folder / "a.hpp", "new a"}, {folder / "gen/b.hpp", std::string(5000, 'x')}});
              }),
              error::unwritable_file);
  }
  EXPECT_EQ(contents_of(folder / "a.hpp"), "old a");
  EXPECT_EQ(folder.names(), before);

  write_files_atomically({{folder / "a.hpp", "new a"}, {folder / "gen/b.hpp", "new b"}});
  EXPECT_EQ(contents_of(folder / "a.hpp"), "new a");
  EXPECT_EQ(contents_of(folder / "gen/b.hpp"), "new b");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("a.hpp", "gen", "gen/b.hpp"));
}

// A name that is too long can be staged under its temporary name and fails only when it is renamed.
TEST(AtomicFiles, AFailingRenamePutsTheEarlierOnesBack) {
  const ScratchFolder folder;
  folder.write("a.hpp", "old a");
  EXPECT_EQ(
      number_of_error([&] {
        write_files_atomically(
            {{folder / "a.hpp", "new a"}, {folder / "b.hpp", "new b"}, {folder / std::string(300, 'n'), "never"}});
      }),
      error::unwritable_file);
  EXPECT_EQ(contents_of(folder / "a.hpp"), "old a");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("a.hpp"));
}

// The page speaks of a command line; its last word is the output, and log.csv is there.
TEST(ErrorPages, HY700) {
  const auto page = test::read_error_page("HY700");
  EXPECT_EQ(page.number, "HY700");
  EXPECT_EQ(page.title, title_of(error::unwritable_file));
  const auto file = [](const std::string& command) {
    const auto begin = command.rfind(' ') + 1;
    return command.substr(begin, command.find_last_not_of('\n') + 1 - begin);
  };
  const ScratchFolder folder;
  folder.write("log.csv", "t,u\n");
  EXPECT_EQ(number_of_error([&] { write_file_atomically(folder / file(page.fails.text), "x"); }),
            error::unwritable_file);
  write_file_atomically(folder / file(page.mended.text), "x");
  EXPECT_EQ(contents_of(folder / file(page.mended.text)), "x");
}

TEST(AtomicFiles, TwoOfTheSamePathAreAMistakeOfTheCaller) {
  EXPECT_THROW(write_files_atomically({{"x/a", ""}, {"x/./a", ""}}), std::invalid_argument);
}

}  // namespace
}  // namespace hysteron
