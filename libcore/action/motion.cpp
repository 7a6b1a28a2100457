// SPDX-License-Identifier: BSD-3-Clause
#include "action/motion.hpp"

#include <cmath>

namespace tactus::action {

MotionPtr finished(const Task& task, Motion motion) {
  const MotionOptions& options = task.options().motion;
  if (motion.pace.empty())
    motion.pace = {{0, {options.approach_speed, options.acceleration, options.joint_acceleration}}};
  motion.bodies = BodyPath(task.bodies(), motion.path);
  motion.cost_to.assign(1, 0.0);
  const CostWeights& weights = task.options().cost;
  for (std::size_t i = 1; i < motion.path.size(); ++i) {
    const Pose &from = motion.bodies.base_from_body(i - 1, 0), &to = motion.bodies.base_from_body(i, 0);
    motion.cost_to.push_back(motion.cost_to.back() + weights.metre * (to.translation() - from.translation()).norm() +
                             weights.radian * geometry::angle_between(from, to));
  }
  motion.base_from_start = motion.bodies.base_from_body(0, 0);
  return std::make_shared<const Motion>(std::move(motion));
}

MotionPtr truncated(const Task& task, const Motion& motion, std::size_t waypoints) {
  Motion part;
  part.kind = motion.kind;
  part.anchored = motion.anchored;
  part.path.assign(motion.path.begin(), motion.path.begin() + static_cast<std::ptrdiff_t>(waypoints));
  part.pace = motion.pace;
  return finished(task, std::move(part));
}

JointPath joined(JointPath first, const JointPath& then) {
  if (first.empty()) return then;
  first.insert(first.end(), then.begin() + 1, then.end());
  return first;
}

double transit_cost(const Task& task, const Pose& base_from_tool, const Pose& base_from_start) {
  const CostWeights& weights = task.options().cost;
  const Pose search_from_base = task.frame().base_from_search.inverse();
  const Vector3 from = search_from_base * base_from_tool.translation();
  const Vector3 to = search_from_base * base_from_start.translation();
  const double across = (to.head<2>() - from.head<2>()).norm(), back = std::abs(from.z() - to.z());
  return weights.metre * (across + back) + weights.radian * geometry::angle_between(base_from_tool, base_from_start);
}

}  // namespace tactus::action
