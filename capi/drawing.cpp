// SPDX-License-Identifier: BSD-3-Clause
#include "drawing.hpp"

#include "robot/kinematics.hpp"

namespace tactus::capi {

std::vector<DrawnBody> drawn_bodies(const scenario::Scenario& scenario) {
  const scene::Scene& scene = scenario.task->scene();
  std::vector<DrawnBody> bodies;
  for (int l = 0; l < static_cast<int>(scene.robot->links.size()); ++l) {
    const robot::Link& link = scene.robot->links[l];
    DrawnBody body{link.name, TACTUS_BODY_ROBOT, {}, l};
    for (const geometry::Mesh& shape : link.shapes) geometry::append(body.mesh, shape);
    if (!body.mesh.triangles.empty()) bodies.push_back(std::move(body));
  }
  bodies.push_back({"tool", TACTUS_BODY_TOOL, scene.tool, scene.tool_link});
  for (const scene::StaticPart& part : scene.world) bodies.push_back({part.name, TACTUS_BODY_WORLD, part.mesh});
  bodies.push_back({"target", TACTUS_BODY_TARGET, scene.target.mesh});
  return bodies;
}

std::vector<geometry::Pose> body_poses(const std::vector<DrawnBody>& bodies, const robot::RobotModel& robot,
                                       const robot::JointVector& q, const geometry::Pose& base_from_target) {
  std::vector<geometry::Pose> base_from_link, poses;
  robot::forward(robot, q, base_from_link);
  for (const DrawnBody& body : bodies) {
    if (body.link >= 0)
      poses.push_back(base_from_link[body.link]);
    else
      poses.push_back(body.kind == TACTUS_BODY_TARGET ? base_from_target : geometry::Pose::Identity());
  }
  return poses;
}

}  // namespace tactus::capi
