// SPDX-License-Identifier: BSD-3-Clause
#include "bench/carrier.hpp"

#include "support/error.hpp"

namespace tactus::bench {
namespace {

using geometry::Vector3;
using Paths = std::vector<std::vector<JointVector>>;

double share(std::size_t i, std::size_t n) { return static_cast<double>(i) / static_cast<double>(n); }

Paths fly(const Carrier& carrier, const std::vector<ToolMotion>& motions, std::size_t n) {
  Paths paths;
  for (const ToolMotion& motion : motions) {
    paths.emplace_back();
    for (std::size_t i = 0; i <= n; ++i) {
      const auto [x, y, z, roll, pitch, yaw] =
          geometry::pose_vector(carrier.base_from_motions * geometry::interpolate(motion.from, motion.to, share(i, n)));
      paths.back().emplace_back(6);
      paths.back().back() << x, y, z, yaw, pitch, roll;
    }
  }
  return paths;
}

/// The posture nearest to `seed` that holds the tool there.
JointVector reach(const Carrier& carrier, const Pose& motions_from_tool, const JointVector& seed, double farthest) {
  const auto q = robot::inverse(*carrier.model, carrier.tool_link, carrier.base_from_motions * motions_from_tool, seed,
                                {1e-9, 1e-9, 200});
  if (!q || (*q - seed).cwiseAbs().maxCoeff() > farthest)
    throw support::Error(support::Status::motion_infeasible, "the arm cannot follow one of the motions");
  return *q;
}

Paths reach_along(const Carrier& carrier, const std::vector<ToolMotion>& motions, std::size_t n) {
  constexpr double first = 6.0, step = 0.5;  // rad, of a joint
  JointVector posture(6);
  posture << -0.5, -1.9, 2.2, -0.3, 1.07, 0.0;
  Paths paths;
  for (const ToolMotion& motion : motions) {
    std::vector<JointVector> path{reach(carrier, motion.from, posture, first)};
    for (std::size_t i = 1; i <= n; ++i)
      path.push_back(reach(carrier, geometry::interpolate(motion.from, motion.to, share(i, n)), path.back(), step));
    if (paths.size() % 2 == 1)
      for (std::size_t i = 1; i < n; ++i) path[i] = path[0] + share(i, n) * (path[n] - path[0]);
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace

Carrier free_flyer() {
  robot::RobotModel model;
  model.links.emplace_back().name = "base";
  const auto add = [&model](const std::string& name, robot::JointKind kind, const Vector3& axis) {
    robot::Link link;
    link.name = name;
    link.parent = static_cast<int>(model.links.size()) - 1;
    link.joint_kind = kind;
    link.axis = axis;
    link.joint = model.dof();
    model.joints.push_back({name, kind, -4.0, 4.0, 1.0});
    model.links.push_back(link);
  };
  add("x", robot::JointKind::prismatic, Vector3::UnitX());
  add("y", robot::JointKind::prismatic, Vector3::UnitY());
  add("z", robot::JointKind::prismatic, Vector3::UnitZ());
  add("yaw", robot::JointKind::revolute, Vector3::UnitZ());
  add("pitch", robot::JointKind::revolute, Vector3::UnitY());
  add("roll", robot::JointKind::revolute, Vector3::UnitX());
  return {std::make_shared<const robot::RobotModel>(model), 6, Pose::Identity(), fly};
}

Carrier shelf_arm() {
  const auto model = std::make_shared<const robot::RobotModel>(
      robot::load_model({TACTUS_SOURCE_DIR "/examples/models/ur10e/ur10e.urdf", {}, {}}));
  return {model, model->find_link("tool0"), Pose(Eigen::Translation3d(0.9, 0.0, 0.5)), reach_along};
}

}  // namespace tactus::bench
