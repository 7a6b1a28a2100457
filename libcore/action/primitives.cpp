// SPDX-License-Identifier: BSD-3-Clause
#include "action/primitives.hpp"

#include <algorithm>

namespace tactus::action {
namespace {

/// One ray: the longest motion, and its prefixes at the shorter lengths. `extent(i)` is how far waypoint i is along it.
template <typename Extent>
void add_ray(const Task& task, Kind kind, const JointVector& q, const Pose& base_from_goal, std::vector<double> lengths,
             Extent extent, const support::Cancellation& cancellation, std::vector<MotionPtr>& motions) {
  auto path = task.straight_path(q, base_from_goal, task.options().motion.step, cancellation, true);
  if (!path || path->size() < 2) return;
  Motion longest;
  longest.kind = kind;
  longest.path = std::move(*path);
  const MotionPtr whole = finished(task, std::move(longest));
  std::sort(lengths.begin(), lengths.end());
  std::size_t last = 1;
  for (std::size_t i = 0; i + 1 < lengths.size(); ++i) {
    std::size_t waypoints = last;
    while (waypoints < whole->path.size() && extent(whole->path[waypoints - 1]) < lengths[i] - 1e-6) ++waypoints;
    if (waypoints >= whole->path.size() || waypoints < 2) continue;
    motions.push_back(truncated(task, *whole, waypoints));
    last = waypoints;
  }
  motions.push_back(whole);
}

}  // namespace

std::vector<MotionPtr> primitives(const Task& task, const JointVector& q, const support::Cancellation& cancellation) {
  const ActionOptions& options = task.options().actions;
  const Pose base_from_tool = task.base_from_tool(q);
  const Eigen::Matrix3d axes = task.frame().tool_axes(base_from_tool);
  std::vector<MotionPtr> motions;
  if (!options.primitive_lengths.empty()) {
    const double longest = *std::max_element(options.primitive_lengths.begin(), options.primitive_lengths.end());
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        Pose goal = base_from_tool;
        goal.translation() += sign * longest * axes.col(axis);
        const auto moved = [&](const JointVector& at) {
          return (task.base_from_tool(at).translation() - base_from_tool.translation()).norm();
        };
        add_ray(task, Kind::move, q, task.at_site(base_from_tool, goal), options.primitive_lengths, moved, cancellation,
                motions);
      }
  }
  if (!options.primitive_angles.empty()) {
    const double largest = *std::max_element(options.primitive_angles.begin(), options.primitive_angles.end());
    for (const double sign : {1.0, -1.0}) {
      Pose goal = base_from_tool;
      goal.linear() =
          Eigen::AngleAxisd(sign * largest, Vector3(axes.col(2))).toRotationMatrix() * base_from_tool.linear();
      const auto turned = [&](const JointVector& at) {
        return geometry::angle_between(base_from_tool, task.base_from_tool(at));
      };
      add_ray(task, Kind::turn, q, goal, options.primitive_angles, turned, cancellation, motions);
    }
  }
  return motions;
}

}  // namespace tactus::action
