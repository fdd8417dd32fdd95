// A working folder that is deleted and made again is the same folder to who did it, and to the task.
#include "runtime/host/working_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "runtime/host/new_places.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using testing::HasSubstr;

class WorkingFolders : public testing::Test {
 protected:
  WorkingFolders() {
    std::filesystem::create_directory(started);
    std::filesystem::current_path(started);
  }
  ~WorkingFolders() override { std::filesystem::current_path(before); }

  hysteron::test::ScratchFolder scratch{};  // NOLINT(misc-non-private-member-variables-in-classes)
  std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::path started = std::filesystem::canonical(scratch.path()) / "started";
};

TEST_F(WorkingFolders, OneThatIsMadeAgainIsGoneInto) {
  WorkingFolder folder(true);
  EXPECT_EQ(folder.look(), "");
  std::filesystem::remove(started);
  EXPECT_THAT(folder.look(), HasSubstr(started.string() + ", the folder in which the task was started, was deleted: "));
  EXPECT_EQ(folder.look(), "") << "once";
  std::filesystem::create_directory(started);
  EXPECT_THAT(folder.look(), HasSubstr("was deleted, and is there again"));
  EXPECT_EQ(folder.look(), "");
  std::ofstream("kept") << "1";
  EXPECT_TRUE(std::filesystem::exists(started / "kept"));
}

TEST_F(WorkingFolders, OneThatIsMovedIsTheSameFolder) {
  WorkingFolder folder(true);
  std::filesystem::rename(started, scratch.path() / "moved");
  std::filesystem::create_directory(started);
  EXPECT_EQ(folder.look(), "");
  std::ofstream("kept") << "1";
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "moved" / "kept"));
}

TEST_F(WorkingFolders, WhereNothingIsNamedByARelativePathNothingIsSaid) {
  WorkingFolder folder(false);
  std::filesystem::remove(started);
  EXPECT_EQ(folder.look(), "");
  std::filesystem::create_directory(started);
  EXPECT_EQ(folder.look(), "");
  RunConfig config;
  EXPECT_FALSE(names_relative_paths(config));
  config.trace = TraceSettings{.file = "/var/run.trace"};
  EXPECT_FALSE(names_relative_paths(config));
  config.trace->file = "run.trace";
  EXPECT_TRUE(names_relative_paths(config));
}

}  // namespace
}  // namespace hysteron::runtime
