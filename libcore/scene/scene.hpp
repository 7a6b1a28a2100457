// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "robot/model.hpp"
#include "scene/prior.hpp"

namespace tactus::scene {

using geometry::Box;
using geometry::Mesh;
using geometry::Vector3;

/// What is searched for, and what "done" means. Const.
struct Target {
  Mesh mesh;                                               ///< in its own frame, metres
  std::vector<Pose> target_from_seated{Pose::Identity()};  ///< the tool link's poses at any of which the task is done;
                                                           ///< at least one; motions are laid out by the first
  Vector3 approach_axis = Vector3::UnitX();                ///< unit, in the target's frame: the way the tool goes in
  double approach_depth = 0.02;       ///< m of the last straight motion, along which the tool may be inside the target
  double position_tolerance = 0.003;  ///< m, of the tool against the seated pose, at the target's origin
  double angle_tolerance = 0.15;      ///< rad
};

struct StaticPart {
  std::string name;
  Mesh mesh;  ///< in the robot's base frame
};

/// Everything around the search that does not change: robot, tool, static world, target, prior. Frames: the robot's
/// base, unless named otherwise. Const, shared.
struct Scene {
  std::shared_ptr<const robot::RobotModel> robot;
  int tool_link = -1;
  Mesh tool;                 ///< in the tool link's frame
  robot::JointVector start;  ///< dof x 1
  std::vector<StaticPart> world;
  Target target;
  Prior prior;

  /// The tool link's pose, in the base frame, that completes the task for a target at `base_from_target`, by one of the
  /// target's seats.
  Pose seated(const Pose& base_from_target, std::size_t seat = 0) const {
    return base_from_target * target.target_from_seated[seat];
  }

  /// Whether a tool at `base_from_tool` is at one of the seats, within tolerance, of a target at `base_from_target`;
  /// with `half`, at the same seat of a target at every pose whose x, y, z, roll, pitch, yaw are each within that of
  /// `base_from_target`'s.
  bool is_seated(const Pose& base_from_tool, const Pose& base_from_target, const PoseVector& half = {}) const;
};

/// The frame in which motions are laid out: origin at the prior's central target, z along the approach axis there, x
/// and y as the seated tool's (made square to z). `region` holds every point that the target may occupy, in this frame.
struct SearchFrame {
  Pose base_from_search = Pose::Identity();
  Pose search_from_tool =
      Pose::Identity();  ///< orientation of the seated tool at the central pose, without translation
  Box region;
  Box tool_extent;  ///< of the tool in that orientation, about the tool frame's origin
  double standoff =
      0.0;  ///< z of the tool frame's origin at which the tool is clear of the region by the standoff distance

  /// The tool link's pose in the base frame whose origin stands at `position` (search frame), turned by `turn` rad
  /// about z.
  Pose base_from_tool(const Vector3& position, double turn = 0.0) const;

  /// The axes (base frame, columns) along which a tool at `base_from_tool` is moved by hand, so to speak: z is the way
  /// it goes in, whichever way it is tilted; x and y are the search frame's, tilted with it.
  Eigen::Matrix3d tool_axes(const Pose& base_from_tool) const;
};

/// `clearance` in metres between the tool at standoff and the region.
SearchFrame search_frame(const Scene& scene, double clearance);

/// The box, in the frame `frame_from_base`, of all points that the target may occupy under the prior.
Box target_region(const Scene& scene, const Pose& frame_from_base);

}  // namespace tactus::scene
