// Joints in MJCF and URDF: what is set, and that nothing else of a file is touched.
#include "robots/robot_file.hpp"

#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "support/errors.hpp"
#include "tests/robots/axes.hpp"

namespace hysteron::robots {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* robot = R"(<?xml version='1.0'?>
<!-- my arm <joint name="shoulder"/> -->
<mujoco model = "arm">
	<compiler autolimits="true"/>   <!-- degrees -->
  <worldbody>
    <body name='upper'>
      <joint  name='shoulder'   axis="0 0 1"
              damping = '9'  range="-10 10" />  <!-- keep > me -->
      <geom size=".1"/>
      <body><joint name="slider" type="slide"/><geom size=".1"/></body>
    </body>
  </worldbody>
  <actuator>
    <position joint="slider" kp="3"/>
  </actuator>
</mujoco>
)";

/// What is left of a text where pieces of it are taken out, one after the other.
std::string without(std::string text, const std::vector<std::string>& pieces) {
  for (const std::string& piece : pieces) {
    const auto at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece << " in\n" << text;
    if (at != std::string::npos) {
      text.erase(at, piece.size());
    }
  }
  return text;
}

TEST(RobotFile, SetsAJointAndLeavesEveryOtherByte) {
  const RobotFile file = merged(joint_of_text(servo), {.joint = "shoulder"}, "arm.xml", robot);
  const std::string rest = without(
      file.text, {" armature=\"0.0002\"", " frictionloss=\"0.004\"", "0.0006",
                  "\n    <general name=\"shoulder_I\" joint=\"shoulder\" gainprm=\"0.05\" ctrlrange=\"-4 4\"/>"});
  EXPECT_EQ(rest, without(robot, {"9"}));
  pugi::xml_document read;
  ASSERT_TRUE(read.load_string(file.text.c_str()));
  const auto joint = read.select_node("//body/joint[@name='shoulder']").node();
  EXPECT_EQ(joint.attribute("damping").as_double(), 6e-4);
  EXPECT_EQ(joint.attribute("armature").as_double(), 2e-4);
  EXPECT_STREQ(joint.attribute("range").value(), "-10 10");
  EXPECT_THAT(file.changes, testing::Contains("joint armature = \"0.0002\""));
  ASSERT_FALSE(file.unmapped.empty());
  EXPECT_THAT(file.unmapped.back().size, HasSubstr("up to 0.021 rad/s"));
}

TEST(RobotFile, CountsAnglesAsTheRobotDoes) {
  const std::string turning =
      with(with(with(table, "@unit mm *", "@unit rad *"), "@unit mm/s", "@unit rad/s"), "@unit N *", "@unit N*m *");
  Joint joint = joint_of_text(turning);
  joint.actuator.reset();
  const auto in_degrees = merged(joint, {.joint = "shoulder"}, "arm.xml", robot).text;
  EXPECT_THAT(in_degrees, AllOf(HasSubstr("range=\"-1718.87339 2864.78898\""), HasSubstr("springref=\"286.478898\"")));
  const auto in_radians =
      merged(joint, {.joint = "shoulder"}, "arm.xml", with(robot, "autolimits", "angle=\"radian\" autolimits")).text;
  EXPECT_THAT(in_radians, AllOf(HasSubstr("range=\"-30 50\""), HasSubstr("springref=\"5\"")));
}

TEST(RobotFile, SetsTheActuatorThatIsThere) {
  const std::string general = with(robot, "<position joint=\"slider\" kp=\"3\"/>",
                                   "<general joint='slider' gear='2' gainprm='1' dyntype='none'/>");
  EXPECT_THAT(merged(joint_of_text(table), {.joint = "slider"}, "arm.xml", general).text,
              AllOf(HasSubstr("<general joint='slider' gear='2' gainprm='4' dyntype='filter' biastype=\"affine\" "
                              "biasprm=\"0.5\" dynprm=\"0.01\" ctrlrange=\"-5 5\" forcerange=\"-10 10\"/>")));
  const RobotFile servoed = merged(joint_of_text(table), {.joint = "slider"}, "arm.xml", robot);
  EXPECT_THAT(servoed.text, HasSubstr("<position joint=\"slider\" kp=\"3\"/>"));
  EXPECT_THAT(servoed.unmapped.back().why, HasSubstr("its law is another than the diagram's"));
  const std::string motor = with(robot, "<position joint=\"slider\" kp=\"3\"/>", "<motor joint='shoulder'/>");
  EXPECT_THAT(merged(joint_of_text(servo), {.joint = "shoulder"}, "arm.xml", motor).text,
              HasSubstr("<motor joint='shoulder' gear=\"0.05\" ctrlrange=\"-4 4\"/>"));
  const std::string none = without(robot, {"  <actuator>\n    <position joint=\"slider\" kp=\"3\"/>\n  </actuator>\n"});
  EXPECT_THAT(merged(joint_of_text(servo), {.joint = "shoulder"}, "arm.xml", none).text,
              HasSubstr("<mujoco model = \"arm\">\n  <actuator><general name=\"shoulder_I\""));
}

TEST(RobotFile, TakesOffWhatTheBodiesHave) {
  EXPECT_THAT(merged(joint_of_text(servo), {.joint = "shoulder", .link_inertia = 1.5e-4}, "arm.xml", robot).text,
              HasSubstr("armature=\"5e-05\""));
  EXPECT_THROW((void)merged(joint_of_text(servo), {.joint = "shoulder", .link_inertia = 3e-4}, "arm.xml", robot),
               InputError);
}

TEST(RobotFile, MakesABenchThatIsWellFormed) {
  for (const Format format : {Format::Mujoco, Format::Urdf}) {
    const RobotFile file = bench_of(joint_of_text(table), {.format = format, .model = "A<B", .sample_time = 1e-3});
    pugi::xml_document read;
    ASSERT_TRUE(read.load_string(file.text.c_str())) << file.text;
    EXPECT_STREQ(read.first_child().name(), format == Format::Mujoco ? "mujoco" : "robot");
  }
}

TEST(RobotFile, SetsDynamicsAndLimitsOfUrdf) {
  constexpr const char* arm =
      "<robot name=\"arm\">\n  <joint name=\"lift\" type=\"prismatic\">\n"
      "    <limit effort=\"1\" velocity=\"2\"/> <!-- > -->\n  </joint>\n"
      "  <joint name=\"turn\" type=\"continuous\"/>\n</robot>\n";
  const RobotFile file = merged(joint_of_text(table), {.format = Format::Urdf, .joint = "lift"}, "arm.urdf", arm);
  EXPECT_EQ(file.text,
            "<robot name=\"arm\">\n  <joint name=\"lift\" type=\"prismatic\">\n"
            "    <dynamics damping=\"40\" friction=\"0\"/>\n"
            "    <limit effort=\"20\" velocity=\"2\" lower=\"-0.03\" upper=\"0.05\"/> <!-- > -->\n  </joint>\n"
            "  <joint name=\"turn\" type=\"continuous\"/>\n</robot>\n");
  std::string left;
  for (const Neglected& one : file.unmapped) {
    left += one.what + " " + one.size + "\n";
  }
  EXPECT_THAT(left, AllOf(HasSubstr("inertia of rotor and gear 3 kg"), HasSubstr("stiffness 200 N/m"),
                          HasSubstr("gain of U 8 N for each V"), HasSubstr("lag of the actuator 0.01 s")));
  EXPECT_THAT(
      merged(joint_of_text(servo), {.format = Format::Urdf, .joint = "turn"}, "arm.urdf", arm).text,
      HasSubstr("<joint name=\"turn\" type=\"continuous\">\n    <dynamics damping=\"0.0006\" friction=\"0.004\"/>\n"
                "    <limit effort=\"0.2\"/>\n  </joint>\n</robot>"));
}

TEST(RobotFile, RefusesWhatIsNoSuchRobot) {
  const auto said = [](const char* text, const FileOptions& options) -> std::string {
    try {
      (void)merged(joint_of_text(servo), options, "arm.xml", text);
    } catch (const InputError& refused) {
      const Diagnostic& one = refused.diagnostics().all().front();
      return one.cause + " " + one.mend;
    }
    return "accepted";
  };
  EXPECT_THAT(said(robot, {.joint = "sholder"}), HasSubstr("did you mean --joint shoulder?"));
  EXPECT_THAT(said(robot, {.joint = "slider"}), HasSubstr("is of type slide, and what the diagram moves turns"));
  EXPECT_THAT(said(robot, {.format = Format::Urdf, .joint = "shoulder"}), HasSubstr("has no element <robot>"));
  EXPECT_THAT(said("<mujoco><worldbody>", {.joint = "shoulder"}), HasSubstr("is no XML"));
  EXPECT_THAT(said("<mujoco/>", {.joint = "shoulder"}), HasSubstr("files that it includes are not read"));
}

}  // namespace
}  // namespace hysteron::robots
