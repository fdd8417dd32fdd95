// hysteron library, and generate --structured: which files, which refusals, and nothing half-written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::HasSubstr;

constexpr std::string_view loop = R"(FUNCTION_BLOCK LOOP  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL;
    B : BOOL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    LAST : HY_DELAY;
  END_VAR

  Y := 0.5 * LAST.XOUT + X;
  LAST(XIN := Y);
END_FUNCTION_BLOCK
)";

TEST(Library, IsOneFileOrAFileForEachBlock) {
  const test::Workbench bench;
  const auto one = bench.shell("hysteron library --target st --ts 50us --out plc");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(one.out, "plc/hysteron_library.st\n");
  EXPECT_THAT(bench.read("plc/hysteron_library.st"), HasSubstr("TS : LREAL := 0.00005;"));
  const auto each = bench.shell("hysteron library --target st --ts 1ms --dialect twincat --float32 --out tc");
  EXPECT_EQ(each.code, 0) << each.err;
  EXPECT_THAT(each.out, HasSubstr("tc/hy_lag.TcPOU\n"));
  EXPECT_THAT(bench.read("tc/hy_lag.TcPOU"), HasSubstr("XIN : REAL;"));
}

TEST(Library, SaysWhatItDoesNotKnow) {
  const test::Workbench bench;
  for (const auto& [arguments, cause] : {std::pair{"--target rust --ts 1ms", "not written in rust"},
                                         std::pair{"--target st --ts 1ms --dialect x", "no dialect x"},
                                         std::pair{"--target st --ts 0ms", "0ms is no sample time"},
                                         std::pair{"--target st --ts -1ms", "is no sample time"},
                                         std::pair{"--target st --ts 0.5ns", "0.5ns is no sample time"},
                                         std::pair{"--target st --ts soon", "soon is no sample time"}}) {
    const auto outcome = bench.shell(fmt::format("hysteron library {} --out none", arguments));
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(cause));
    EXPECT_FALSE(bench.has("none"));
  }
}

TEST(Structured, IsOneFileThatIsReadBack) {
  const test::Workbench bench;
  bench.write("loop.st", std::string(loop));
  const auto outcome = bench.shell("hysteron generate loop.st --target st --structured --out plc");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "plc/loop.st\n");
  EXPECT_EQ(bench.shell("hysteron check plc/loop.st").code, 0);
  bench.write("in.csv", "t,x,b,reset\n0,1,0,0\n0.001,0,0,0\n0.002,0,0,1\n0.003,2,0,0\n");
  EXPECT_EQ(bench.shell("hysteron run plc/loop.st --top LOOP --in in.csv --out out.csv").code, 0);
  EXPECT_EQ(bench.read("out.csv"), "t,Y\n0,1\n0.001,0.5\n0.002,0\n0.003,2\n");
}

TEST(Structured, BelongsToStructuredText) {
  const test::Workbench bench;
  bench.write("loop.st", std::string(loop));
  const auto outcome = bench.shell("hysteron generate loop.st --target c --structured --out none");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("leave out --structured"));
  EXPECT_FALSE(bench.has("none"));
}

}  // namespace
}  // namespace hysteron
