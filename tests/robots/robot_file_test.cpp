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
              AllOf(HasSubstr("<general joint='slider' gear='2' gainprm='4' dyntype='filter' dynprm=\"0.01\" "
                              "ctrlrange=\"-5 5\" forcerange=\"-10 10\"/>"),
                    HasSubstr("stiffness=\"200\" springref=\"0.005\"")));
  const RobotFile servoed = merged(joint_of_text(table), {.joint = "slider"}, "arm.xml", robot);
  EXPECT_THAT(servoed.text, HasSubstr("<position joint=\"slider\" kp=\"3\"/>"));
  EXPECT_THAT(all_of(servoed.unmapped),
              AllOf(HasSubstr("the actuator <position>; 8 N for each V; its law is another than the diagram's"),
                    HasSubstr("lag of the actuator; 0.01 s"), HasSubstr("range of the control; -5 to 5 V"),
                    HasSubstr("range of the force; -20 to 20 N")));
  const std::string motor = with(robot, "<position joint=\"slider\" kp=\"3\"/>", "<motor joint='shoulder'/>");
  EXPECT_THAT(merged(joint_of_text(servo), {.joint = "shoulder"}, "arm.xml", motor).text,
              HasSubstr("<motor joint='shoulder' gear=\"0.05\" ctrlrange=\"-4 4\"/>"));
  const std::string none = without(robot, {"  <actuator>\n    <position joint=\"slider\" kp=\"3\"/>\n  </actuator>\n"});
  EXPECT_THAT(merged(joint_of_text(servo), {.joint = "shoulder"}, "arm.xml", none).text,
              HasSubstr("<mujoco model = \"arm\">\n  <actuator><general name=\"shoulder_I\""));
}

/// The servo with a constant torque of 0.01 N·m beside its spring of 0.3 N·m/rad.
Joint sprung() {
  Joint joint = joint_of_text(servo);
  joint.stiffness = 0.3;
  joint.offset = 0.03;
  return joint;
}

std::string robot_of(const std::string& before, const std::string& joint, const std::string& actuators) {
  return "<mujoco>" + before + "<worldbody><body childclass='big'><joint name=\"a\"" + joint +
         "/></body></worldbody><actuator>" + actuators + "</actuator></mujoco>";
}

TEST(RobotFile, LetsNoDefaultOfTheRobotChangeTheJoint) {
  const std::string defaults =
      "<default><joint stiffness='7'/><default class='big'><joint springref='20' springdamper='1 1' limited='false'/>"
      "</default></default>";
  const Joint joint = sprung();
  EXPECT_THAT(merged(joint, {.joint = "a"}, "arm.xml", robot_of(defaults, "", "")).text,
              AllOf(HasSubstr("stiffness=\"0.3\" springdamper=\"0 0\" springref=\"5.72957795\""),
                    testing::Not(HasSubstr("biasprm"))));
  Joint plain = joint;
  plain.offset = 0.0;
  plain.position = {.low = -1.0, .high = 1.0};
  EXPECT_THAT(merged(plain, {.joint = "a"}, "arm.xml", robot_of("", " springref=\"3\"", "")).text,
              HasSubstr("springref=\"0\""));
  EXPECT_THAT(merged(plain, {.joint = "a"}, "arm.xml", robot_of(defaults, "", "")).text,
              AllOf(HasSubstr("springref=\"0\""), HasSubstr("limited=\"true\"")));
  EXPECT_THAT(merged(joint_of_text(servo), {.joint = "a"}, "arm.xml", robot_of(defaults, "", "")).text,
              HasSubstr("stiffness=\"0\""));
  EXPECT_THAT(merged(plain, {.joint = "a"}, "arm.xml", robot_of("<compiler autolimits='false'/>", "", "")).text,
              AllOf(HasSubstr("limited=\"true\""), HasSubstr("ctrllimited=\"true\"")));
}

TEST(RobotFile, LetsNoDefaultOfTheRobotChangeTheActuator) {
  Joint joint = joint_of_text(servo);
  const auto actuator_in = [&](const std::string& defaults, const std::string& actuators) {
    const std::string text =
        merged(joint, {.joint = "a"}, "arm.xml", robot_of("<default>" + defaults + "</default>", "", actuators)).text;
    return text.substr(text.find("<actuator>"));
  };
  EXPECT_THAT(actuator_in("<general gear='4'/>", ""), AllOf(HasSubstr("gainprm=\"0.05\""), HasSubstr("gear=\"1\"")));
  EXPECT_THAT(actuator_in("<motor gear='4'/>", "<general joint='a'/>"), HasSubstr("gainprm=\"0.0125\""));
  EXPECT_THAT(actuator_in("<default class='x'><motor gear='4'/></default>", "<general class='x' joint='a'/>"),
              HasSubstr("gainprm=\"0.0125\""));
  EXPECT_THAT(actuator_in("<general biastype='affine' biasprm='0 -1 -2' dyntype='integrator'/>", ""),
              AllOf(HasSubstr("biastype=\"none\""), HasSubstr("dyntype=\"none\"")));
  EXPECT_THAT(
      actuator_in("<position kp='3' forcerange='-1 1'/>", ""),
      AllOf(HasSubstr("gaintype=\"fixed\""), HasSubstr("biastype=\"none\""), HasSubstr("forcelimited=\"false\"")));
  EXPECT_THAT(actuator_in("<general ctrllimited='false'/>", "<motor joint='a'/>"),
              HasSubstr("<motor joint='a' gear=\"0.05\" ctrlrange=\"-4 4\" ctrllimited=\"true\"/>"));
  joint.offset = 0.01;
  EXPECT_THAT(actuator_in("<general biasprm='0 -1 -2'/>", ""), HasSubstr("biasprm=\"0.01 0 0\""));
}

TEST(RobotFile, ListsAllThatAnActuatorThatStaysDoesNotHave) {
  Joint joint = joint_of_text(servo);
  joint.offset = 0.01;
  const auto left = [&](const std::string& actuators) {
    return all_of(merged(joint, {.joint = "a"}, "arm.xml", robot_of("", "", actuators)).unmapped);
  };
  for (const char* const actuators : {"<motor joint='a'/><motor jointinparent='a'/>", "<motor joint='a'/>"}) {
    EXPECT_THAT(left(actuators), AllOf(HasSubstr("a constant force; 0.01 N*m"), HasSubstr("-4 to 4 A")));
  }
  EXPECT_THAT(all_of(merged(joint, {.joint = "a"}, "arm.xml", robot_of("<include file='more.xml'/>", "", "")).unmapped),
              HasSubstr("a file that the robot includes; more.xml"));
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
  EXPECT_THAT(all_of(file.unmapped),
              AllOf(HasSubstr("inertia of rotor and gear; 3 kg"), HasSubstr("stiffness; 200 N/m"),
                    HasSubstr("gain of U; 8 N for each V"), HasSubstr("lag of the actuator; 0.01 s")));
  EXPECT_THAT(
      merged(joint_of_text(servo), {.format = Format::Urdf, .joint = "turn"}, "arm.urdf", arm).text,
      HasSubstr("<joint name=\"turn\" type=\"continuous\">\n    <dynamics damping=\"0.0006\" friction=\"0.004\"/>\n"
                "    <limit effort=\"0.2\" velocity=\"1e+16\"/>\n  </joint>\n</robot>"));
}

TEST(RobotFile, GivesUrdfEachNumberThatItRequires) {
  const auto joint_in = [](const RobotFile& file) {
    pugi::xml_document read;
    EXPECT_TRUE(read.load_string(file.text.c_str()));
    const pugi::xml_node limit = read.select_node("//joint/limit").node();
    std::string text;
    for (const char* const name : {"lower", "upper", "effort", "velocity"}) {
      text += std::string(limit.attribute(name).as_string("none")) + " ";
    }
    const pugi::xml_node inertial = read.select_node("//inertial").node();
    return text + inertial.child("mass").attribute("value").value() + " " +
           inertial.child("inertia").attribute("ixx").value();
  };
  Joint joint = joint_of_text(table);
  EXPECT_EQ(joint_in(bench_of(joint, {.format = Format::Urdf})), "-0.03 0.05 20 1e+16 3 0.012");
  joint.position = {};
  joint.actuator->force = {.low = -10.0, .high = 15.0};
  const RobotFile endless = bench_of(joint, {.format = Format::Urdf});
  EXPECT_THAT(all_of(endless.unmapped), testing::Not(HasSubstr("inertia of rotor")));
  EXPECT_EQ(joint_in(endless), "-1e+16 1e+16 15 1e+16 3 0.012");
  EXPECT_THAT(all_of(endless.unmapped), AllOf(HasSubstr("limit velocity; 1e+16 m/s"), HasSubstr("limit lower"),
                                              HasSubstr("range of the force; -10 to 15 N")));
  joint = joint_of_text(servo);
  EXPECT_EQ(joint_in(bench_of(joint, {.format = Format::Urdf})), "none none 0.2 1e+16 1 0.0002");
  joint.position = {.low = -1.0, .high = 1.0};
  const RobotFile turning = merged(joint, {.format = Format::Urdf, .joint = "turn"}, "arm.urdf",
                                   "<robot><joint name='turn' type='continuous'/></robot>");
  EXPECT_EQ(joint_in(turning), "none none 0.2 1e+16  ");
  EXPECT_THAT(all_of(turning.unmapped), HasSubstr("range of the position; -1 to 1 rad; a continuous joint has none"));
  joint.actuator.reset();
  joint.position = {};
  EXPECT_EQ(joint_in(bench_of(joint, {.format = Format::Urdf})), "none none none none 1 0.0002");
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
  EXPECT_THAT(said("<mujoco>\n<joint damping='1' damping='2'/></mujoco>", {.joint = "shoulder"}),
              HasSubstr("is no XML, line 2: the attribute damping of <joint> stands twice"));
  EXPECT_THAT(said("<mujoco/><mujoco/>", {.joint = "shoulder"}), HasSubstr("<mujoco> is a second root"));
  EXPECT_THAT(
      said("<mujoco><worldbody><joint name='a'/><body><joint name='a'/></body></worldbody></mujoco>", {.joint = "a"}),
      HasSubstr("has two joints with the name a"));
}

}  // namespace
}  // namespace hysteron::robots
