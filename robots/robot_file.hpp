// A joint in a file of a simulator of robots: MuJoCo's MJCF, or URDF. Alone, or merged into a robot that is there.
//
// MJCF, of a joint and its actuator (mujoco.readthedocs.io, XML reference and Computation):
//
//   armature           inertia that is added to that of the bodies
//   damping            −damping·q'
//   stiffness          −stiffness·(q − springref)
//   frictionloss       dry friction, held by a soft constraint
//   general            force = gear·(gainprm·a + biasprm), a the control or, with dyntype "filter", its lag
//
// URDF, of a joint (wiki.ros.org/urdf/XML/joint): dynamics damping and friction, limit effort, velocity, lower, upper.
#pragma once

#include <string>
#include <vector>

#include "robots/joint.hpp"

namespace hysteron::robots {

enum class Format : std::uint8_t { Mujoco, Urdf };

struct FileOptions {
  Format format = Format::Mujoco;
  std::string joint = "axis";  ///< its name in the file
  std::string model{};         ///< the name of a robot that is made
  double link_inertia = 0.0;   ///< of J, what the bodies of the robot have already
  double sample_time = 0.0;    ///< of the diagram, s; 0: none is stated
};

struct RobotFile {
  std::string text{};
  std::vector<std::string> changes{};  ///< armature = "0.0002", of the joint or of its actuator
  std::vector<Neglected> unmapped{};   ///< what this format has no word for
};

/// A robot of this one joint, which the simulator loads: a bench to try it on.
[[nodiscard]] RobotFile bench_of(const Joint& joint, const FileOptions& options);

/// The robot with the joint's numbers in it. Every byte stays but the values that are set, and what is put in beside
/// them. `file` stands in the places of errors. Throws InputError HY730 where it is no such file, or has no such joint.
[[nodiscard]] RobotFile merged(const Joint& joint, const FileOptions& options, const std::string& file,
                               const std::string& text);

}  // namespace hysteron::robots
