#include "support/text_file.hpp"

#include <gmock/gmock.h>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron {
namespace {

using test::ScratchFolder;
using testing::HasSubstr;

Diagnostic refusal(const std::string& path) {
  try {
    (void)read_text_file(path);
  } catch (const InputError& refused) {
    return refused.diagnostics().all().front();
  }
  return {};
}

TEST(TextFile, ReadsEveryByte) {
  const ScratchFolder folder;
  std::string bytes;
  for (int i = 0; i < 300000; ++i) {
    bytes += static_cast<char>(i * 7);
  }
  EXPECT_EQ(read_text_file(folder.write("bytes", bytes)), bytes);
  EXPECT_EQ(read_text_file(folder.write("empty", "")), "");
}

TEST(TextFile, SaysWhyItCannotBeRead) {
  const ScratchFolder folder;
  folder.write("plant.st", "");
  const auto missing = refusal(folder / "palnt.st");
  EXPECT_EQ(missing.number, error::unreadable_file);
  EXPECT_EQ(missing.place.file, folder / "palnt.st");
  EXPECT_THAT(missing.cause, HasSubstr("No such file"));
  EXPECT_EQ(missing.mend, "did you mean " + (folder / "plant.st") + "?");
  // Of another name, it is the file of this kind.
  folder.write("machine.toml", "");
  EXPECT_EQ(refusal(folder / "p.toml").mend, "did you mean " + (folder / "machine.toml") + "?");
  EXPECT_THAT(refusal(folder / "p.csv").mend, HasSubstr("an existing file"));
  EXPECT_THAT(refusal(folder.path().string()).cause, HasSubstr("Is a directory"));
  EXPECT_THAT(refusal(folder / "plant.st/x").cause, HasSubstr("Not a directory"));
  EXPECT_EQ(refusal("").number, error::unreadable_file);
}

// The page speaks of a command line; its last word is the file.
TEST(ErrorPages, HY100) {
  const auto page = test::read_error_page("HY100");
  EXPECT_EQ(page.number, "HY100");
  EXPECT_EQ(page.title, error_titles().front().title);
  const auto file = [](const std::string& command) {
    const auto begin = command.rfind(' ') + 1;
    return command.substr(begin, command.find_last_not_of('\n') + 1 - begin);
  };
  const ScratchFolder folder;
  folder.write(file(page.mended.text), "");
  EXPECT_EQ(refusal(folder / file(page.fails.text)).mend, "did you mean " + (folder / file(page.mended.text)) + "?");
  EXPECT_EQ(read_text_file(folder / file(page.mended.text)), "");
}

}  // namespace
}  // namespace hysteron
