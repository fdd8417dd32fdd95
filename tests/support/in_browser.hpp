// A page in a browser without a screen, after its scripts have run.
#pragma once

#include <gmock/gmock.h>

#include <cstdlib>
#include <string>

#include "tests/support/scratch_folder.hpp"

namespace hysteron::test {

class InBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << "chromium is not installed: scripts/install-dependencies test";
    }
  }
};

struct Shown {
  std::string page{};  ///< after its script has run
  std::string log{};
};

inline Shown shown(std::string html, const std::string& script = {}, int width = 1280) {
  const ScratchFolder folder;
  html.insert(html.rfind("</body>"), "<script>" + script + "</script>");
  const std::string file = folder.write("page.html", html);
  const std::string command =
      "timeout 120 chromium --headless --no-sandbox --disable-gpu --enable-logging=stderr --window-size=" +
      std::to_string(width) + ",1000 --virtual-time-budget=5000 --user-data-dir=" + folder.path().string() +
      "/profile --dump-dom file://" + file + " > " + (folder / "dom") + " 2> " + (folder / "log");
  const int status = std::system(command.c_str());
  Shown result{contents_of(folder / "dom"), contents_of(folder / "log")};
  EXPECT_EQ(status, 0) << result.log;
  return result;
}

inline void expect_no_fault(const Shown& shown) {
  EXPECT_THAT(shown.log, ::testing::Not(::testing::HasSubstr("Uncaught")));
  EXPECT_THAT(shown.log, ::testing::Not(::testing::HasSubstr("CONSOLE")));
  EXPECT_THAT(shown.page, ::testing::Not(::testing::HasSubstr("class=\"box fault\"")));
}

}  // namespace hysteron::test
