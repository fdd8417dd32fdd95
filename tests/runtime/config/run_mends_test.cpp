// The mends of a run file's errors fit what stands there.
#include <gtest/gtest.h>

#include <string>

#include "runtime/config/run_config.hpp"
#include "tests/runtime/config/run_file.hpp"

namespace hysteron::runtime {
namespace {

/// No mend is an example that means something else.
TEST(RunMends, FitWhatWasWritten) {
  const std::string y = "[outputs.Y]\nsafe = 0\n";
  EXPECT_EQ(error_of(y + "[task]\nmissed = \"stopp\"\n"),
            "804@4:10 missed must be one of: skip, catch_up, stop. | did you mean \"stop\"?");
  EXPECT_EQ(
      error_of(y + "[task]\nmissed = \"ignore\"\n"),
      "804@4:10 missed must be one of: skip, catch_up, stop. | write missed = \"skip\", \"catch_up\" or \"stop\".");
  const std::string retain = y + "[retain]\nfolder = \"kept\"\n";
  EXPECT_EQ(
      error_of(retain + "every = 0\n"),
      "805@5:9 A whole number at every counts cycles, and there is none of less than 1. | write every = 1 for each "
      "cycle, or a time as every = \"1s\"; what a client commits is written at once besides.");
  EXPECT_EQ(error_of(retain + "every = 2.5\n"),
            "804@5:9 every is a length of time, and 2.5 has no unit. | write it with its unit, in quotes: every = "
            "\"2.5s\"; units are ns, us, ms, s, min, h and d.");
  const std::string history = y + "[history]\nfile = \"h.sqlite\"\n";
  EXPECT_EQ(error_of(history + "keep = 30\n"),
            "804@5:8 keep is a length of time, and 30 has no unit. | write it with its unit, in quotes: keep = "
            "\"30min\"; units are ns, us, ms, s, min, h and d.");
  EXPECT_EQ(error_of(history + "keep = \"long\"\n"),
            "804@5:8 keep must be a length of time in ns, us, ms, s, min, h or d. | write it as in keep = \"30d\".");
}

}  // namespace
}  // namespace hysteron::runtime
