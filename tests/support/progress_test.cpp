#include "support/progress.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace hysteron {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(ProgressLine, ShowsShareTimeLeftAndText) {
  EXPECT_EQ(progress_line("Fitting", 0.5, 12.0, "iteration 31", 200),
            "Fitting  [##########··········]  50 %  12 s left  iteration 31");
  EXPECT_EQ(progress_line("Fitting", 0.0, std::nullopt, "", 200), "Fitting  [····················]   0 %");
  EXPECT_THAT(progress_line("F", 1.0, 0.0, "", 200), HasSubstr("100 %  0 s left"));
  EXPECT_THAT(progress_line("F", 0.999, 0.0, "", 200), HasSubstr(" 99 %")) << "100 % is said when it is done";
  EXPECT_THAT(progress_line("F", 0.1, 601.0, "", 200), HasSubstr("11 min left"));
  EXPECT_THAT(progress_line("F", 0.1, 1e5, "", 200), HasSubstr("28 h left"));
  EXPECT_THAT(progress_line("F", -3.0, std::nullopt, "", 200), HasSubstr("  0 %"));
  EXPECT_THAT(progress_line("F", 0.0 / 0.0, std::nullopt, "", 200), HasSubstr("  0 %"));
}

TEST(ProgressLine, IsCutAtACharacter) {
  EXPECT_EQ(progress_line("F", 0.0, std::nullopt, "", 7), "F  [···");
  EXPECT_EQ(progress_line("F", 0.0, std::nullopt, "", 0), "");
}

/// A pseudo-terminal: what is written to the one end is read from the other.
class Terminal {
 public:
  Terminal() : master_(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    stream_ = std::fopen(ptsname(master_), "w");
    fcntl(master_, F_SETFL, O_NONBLOCK);
  }
  ~Terminal() {
    std::fclose(stream_);
    close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  Terminal(Terminal&&) = delete;
  Terminal& operator=(Terminal&&) = delete;

  [[nodiscard]] std::FILE* stream() const { return stream_; }
  std::string written() const {
    std::string text(10000, '\0');
    const auto count = read(master_, text.data(), text.size());
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return text;
  }

 private:
  int master_;
  std::FILE* stream_ = nullptr;
};

TEST(Progress, DrawsOnATerminalAtMostTenTimesASecond) {
  const Terminal terminal;
  double now = 100.0;
  Progress progress("Fitting", terminal.stream(), [&] { return now; });
  progress.update(0.0);
  EXPECT_EQ(terminal.written(), "") << "work that is done at once shows nothing";
  int drawn = 0;
  for (int i = 1; i <= 1000; ++i) {
    now = 100.0 + 0.002 * i;  // two seconds
    progress.update(0.001 * i, "step");
    drawn += terminal.written().empty() ? 0 : 1;
  }
  EXPECT_GE(drawn, 18);
  EXPECT_LE(drawn, 20);
  now = 104.0;
  progress.update(0.5, "half");
  const auto line = terminal.written();
  EXPECT_THAT(line, StartsWith("\r\033[K"));
  EXPECT_THAT(line, HasSubstr("50 %  4 s left  half")) << "four seconds for the first half";
  progress.finish();
  EXPECT_EQ(terminal.written(), "\r\033[K");
  progress.finish();
  EXPECT_EQ(terminal.written(), "");
}

TEST(Progress, LeavesOtherStreamsAlone) {
  std::FILE* const file = std::tmpfile();
  double now = 0.0;
  {
    Progress progress("Fitting", file, [&] { return now; });
    for (; now < 10.0; now += 0.5) {
      progress.update(now / 10.0, "text");
    }
  }
  EXPECT_EQ(std::ftell(file), 0);
  std::fclose(file);
}

}  // namespace
}  // namespace hysteron
