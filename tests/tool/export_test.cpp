// hysteron export, as a user runs it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view axis_to_export = R"(FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT
    I : LREAL;  (* @unit A *)
  END_VAR
  VAR_OUTPUT
    OMEGA : LREAL;  (* @unit rad/s *)
  END_VAR
  VAR
    KT      : HY_GAIN             := (K := 0.05);
    TORQUE  : LREAL;  (* @unit N*m *)
    DRY     : HY_COULOMB_FRICTION := (LEVEL := 0.002, PRESLIDE := 0.00002);
    INERTIA : HY_GAIN             := (K := 5000.0);
    SPEED   : HY_INTEGRAL_FORWARD;
  END_VAR

  KT(XIN := I);
  TORQUE := KT.XOUT;
  DRY(XIN := TORQUE, V := SPEED.XOUT);
  INERTIA(XIN := DRY.XOUT);
  OMEGA := SPEED.XOUT;
  SPEED(XIN := INERTIA.XOUT);
END_FUNCTION_BLOCK
)";

struct ExportBench : test::Workbench {
  ExportBench() {
    write("axis.st", axis_to_export);
    write("tuned.toml", "[parameters.DRY]\nLEVEL = 0.004\n");
    write("arm.xml",
          "<mujoco>\n  <worldbody><body><joint name=\"elbow\"/><geom size=\".1\"/></body></worldbody>\n</mujoco>\n");
  }
};

TEST(Export, WritesABenchAndSaysHowFarItIsFromTheDiagram) {
  const ExportBench bench;
  ASSERT_EQ(bench
                .shell("awk 'BEGIN { print \"t,I\"; for (k = 0; k < 1000; ++k) printf \"%.3f,%.5f\\n\", 0.001 * k, "
                       "0.5 * sin(0.01 * k) }' > log.csv")
                .code,
            0);
  const auto done = bench.shell("hysteron export axis.st --params tuned.toml --in log.csv --out bench.xml");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("joint frictionloss = \"0.004\""), HasSubstr("left out:\n  DRY"),
                              HasSubstr("over log.csv: the joint differs")));
  EXPECT_THAT(bench.read("bench.xml"), HasSubstr("armature=\"0.0002\""));
}

TEST(Export, SaysWhetherTheStepIsWhatTheyDifferBy) {
  const ExportBench bench;
  const auto line_of = [&](const std::string& added, const std::string& spring) {
    bench.write("spring.st",
                "FUNCTION_BLOCK AXIS  (* @ts 1ms *)\n  VAR_INPUT\n    I : LREAL;\n  END_VAR\n"
                "  VAR_OUTPUT\n    PHI : LREAL;  (* @unit rad *)\n  END_VAR\n  VAR\n"
                "    TORQUE : LREAL;  (* @unit N*m *)\n    OMEGA : LREAL;  (* @unit rad/s *)\n" +
                    added +
                    "    INERTIA : HY_GAIN := (K := 4000.0);\n    SPEED : HY_INTEGRAL_FORWARD;\n"
                    "    POS : HY_INTEGRAL_FORWARD;\n  END_VAR\n\n" +
                    spring +
                    "  OMEGA := SPEED.XOUT;\n  PHI := POS.XOUT;\n  POS(XIN := OMEGA);\n"
                    "  SPEED(XIN := INERTIA.XOUT);\nEND_FUNCTION_BLOCK\n");
    const auto done = bench.shell(
        "awk 'BEGIN { print \"t,I\"; for (k = 0; k < 1000; ++k) printf \"%.3f,%.5f\\n\", 0.001 * k, sin(0.03 * k) }' "
        "> log.csv && hysteron export spring.st --in log.csv --out bench.xml");
    EXPECT_EQ(done.code, 0) << done.err;
    return done.out.substr(std::min(done.out.find("over log.csv"), done.out.size()));
  };
  // A forward integral of a spring gains energy at each step: that is the step's doing.
  EXPECT_THAT(line_of("    C : HY_GAIN := (K := 0.3);\n    B : HY_GAIN := (K := 0.001);\n",
                      "  TORQUE := 0.05 * I;\n  C(XIN := POS.XOUT);\n  B(XIN := SPEED.XOUT);\n"
                      "  INERTIA(XIN := TORQUE - C.XOUT - B.XOUT);\n"),
              HasSubstr("the step of 1 ms makes most of it"));
  // Of a dead time of 20 ms the joint knows nothing, whatever the step is.
  EXPECT_THAT(line_of("    LATE : HY_DEAD_TIME := (DEAD_TIME := 0.02);\n"
                      "    B : HY_GAIN := (K := 0.01);\n",
                      "  LATE(XIN := 0.05 * I);\n  TORQUE := LATE.XOUT;\n  B(XIN := SPEED.XOUT);\n"
                      "  INERTIA(XIN := TORQUE - B.XOUT);\n"),
              HasSubstr("the step of 1 ms is not the cause"));
}

TEST(Export, ReadsARecordAsTheParameterFileSays) {
  const ExportBench bench;
  bench.write("log.csv", "t,current\n0.000,100\n0.001,200\n0.002,300\n");
  bench.write("tuned.toml", "[parameters.DRY]\nLEVEL = 0.004\n\n[record.columns]\nI = \"current[mA]\"\n");
  const auto done = bench.shell("hysteron export axis.st --params tuned.toml --in log.csv --out bench.xml");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("was converted to A"));
}

/// Two axes of one kind, each with what was fitted to it, in one go: what two exports one behind the other would write.
TEST(Export, WritesSeveralJointsIntoOneRobot) {
  const ExportBench bench;
  bench.write("two.xml",
              "<mujoco>\n  <worldbody><body><joint name=\"elbow\"/><geom size=\".1\"/>\n"
              "    <body><joint name=\"wrist\"/><geom size=\".1\"/></body></body></worldbody>\n</mujoco>\n");
  bench.write("wrist.toml", "[parameters.DRY]\nLEVEL = 0.001\n");
  const auto done = bench.shell(
      "hysteron export axis.st --joint elbow=tuned.toml --joint wrist=wrist.toml --gear elbow=10 --link-inertia 0.0001 "
      "--into two.xml --out both.xml && hysteron export axis.st --params tuned.toml --joint elbow --gear 10 "
      "--link-inertia 0.0001 --into two.xml --out one.xml && hysteron export axis.st --params wrist.toml --joint wrist "
      "--link-inertia 0.0001 --into one.xml --out then.xml");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(bench.read("both.xml"), bench.read("then.xml"));
  EXPECT_THAT(bench.read("both.xml"), AllOf(HasSubstr("frictionloss=\"0.04\""), HasSubstr("frictionloss=\"0.001\"")));
  EXPECT_THAT(done.out, AllOf(HasSubstr("joint elbow, from SPEED.XOUT of AXIS with tuned.toml"),
                              HasSubstr("joint wrist, from SPEED.XOUT of AXIS with wrist.toml")));
}

TEST(Export, ReadsTheDiagramOnceForAllJoints) {
  const ExportBench bench;
  bench.write("two.xml",
              "<mujoco>\n  <worldbody><body><joint name=\"elbow\"/><geom size=\".1\"/>\n"
              "    <body><joint name=\"wrist\"/><geom size=\".1\"/></body></body></worldbody>\n</mujoco>\n");
  // A pipe can be read once.
  const auto piped = bench.shell(
      "mkfifo pipe.st; cat axis.st > pipe.st & timeout 20 hysteron export pipe.st --joint elbow=tuned.toml "
      "--joint wrist --into two.xml --out piped.xml && hysteron export axis.st --joint elbow=tuned.toml --joint wrist "
      "--into two.xml --out read.xml");
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(bench.read("piped.xml"), bench.read("read.xml"));
  EXPECT_THAT(bench.read("piped.xml"), AllOf(HasSubstr("frictionloss=\"0.004\""), HasSubstr("frictionloss=\"0.002\"")));
}

TEST(Export, RefusesWhatIsOfNoJointOrOfTwo) {
  const ExportBench bench;
  for (const auto& [options, text] :
       {std::pair("--joint elbow --joint wrist", "no robot that they belong to"),
        {"--joint elbow --joint elbow --into arm.xml", "--joint elbow is stated twice"},
        {"--joint elbow=tuned.toml --params tuned.toml --into arm.xml", "is of no joint"},
        {"--joint elbow= --into arm.xml", "names no file"},
        {"--joint elbow --gear wrist=5 --into arm.xml", "no --joint is called wrist"},
        {"--joint elbow --gear 5 --gear 6 --into arm.xml", "--gear is stated twice"},
        {"--joint elbow --gear elbow=5 --gear elbow=6 --into arm.xml", "--gear is stated twice for elbow"},
        {"--joint elbow --gear elbow=0 --into arm.xml", "a number above 0 is needed, not 0"},
        {"--link-inertia lots", "a number from 0 on is needed, not lots"}}) {
    const auto refused = bench.shell(std::string("hysteron export axis.st --out none.xml ") + options);
    EXPECT_EQ(refused.code, 2) << options;
    EXPECT_THAT(refused.err, AllOf(HasSubstr("HY730"), HasSubstr(text))) << options;
    EXPECT_FALSE(bench.has("none.xml"));
  }
}

TEST(Export, PrintsTheJointAsJson) {
  const ExportBench bench;
  const auto done = bench.shell("hysteron export axis.st --params tuned.toml --gear 10 --out bench.xml --json");
  EXPECT_EQ(done.code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out);
  const auto& joint = json.at("joints").at(0);
  EXPECT_EQ(joint.at("name"), "axis");
  EXPECT_DOUBLE_EQ(joint.at("inertia").get<double>(), 0.02);
  EXPECT_DOUBLE_EQ(joint.at("friction").get<double>(), 0.04);
  EXPECT_DOUBLE_EQ(joint.at("actuator").at("gain").get<double>(), 0.5);
  EXPECT_TRUE(joint.at("position").at(0).is_null()) << "open";
  EXPECT_THAT(joint.at("left_out").at(0).at("what").get<std::string>(), HasSubstr("DRY"));
  EXPECT_TRUE(joint.at("compared").is_null());
}

TEST(Export, MergesIntoARobotAndNeverOverIt) {
  const ExportBench bench;
  const auto done = bench.shell("hysteron export axis.st --into arm.xml --joint elbow --gear 10 --out new.xml");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(bench.read("new.xml"), AllOf(HasSubstr("armature=\"0.02\""), HasSubstr("gainprm=\"0.5\"")));
  EXPECT_THAT(done.out, HasSubstr("state --link-inertia"));
  const std::string before = bench.read("arm.xml");
  EXPECT_THAT(bench.shell("hysteron export axis.st --into arm.xml --joint elbow --out arm.xml").err,
              HasSubstr("HY709"));
  EXPECT_EQ(bench.read("arm.xml"), before);
  for (const auto& [options, text] : {std::pair("--into arm.xml --joint elbo", "did you mean --joint elbow?"),
                                      {"--into arm.xml --joint elbow --format urdf", "has no element <robot>"},
                                      {"--velocity KT.XOUT", "is no output of an integral"},
                                      {"--link-inertia 1", "is larger than all that the diagram moves"}}) {
    const auto refused = bench.shell(std::string("hysteron export axis.st --out none.xml ") + options);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("HY730"), HasSubstr(text)));
    EXPECT_FALSE(bench.has("none.xml"));
  }
}

}  // namespace
}  // namespace hysteron
