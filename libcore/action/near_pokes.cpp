// SPDX-License-Identifier: BSD-3-Clause
#include "action/near_pokes.hpp"

namespace tactus::action {
namespace {

constexpr double aside[] = {0.04, 0.1};  // m
constexpr double beyond = 0.1;           // m farther in than the tool was

/// `path` and the straight way on by `way` (base frame); null if the world or the limits are in it.
std::optional<JointPath> gone_on(const Task& task, JointPath path, const Vector3& way,
                                 const support::Cancellation& cancellation, bool keep_free_part = false) {
  const Pose here = task.base_from_tool(path.back());
  Pose goal = here;
  goal.translation() += way;
  const auto leg = task.straight_path(path.back(), task.at_site(here, goal), task.options().motion.step, cancellation,
                                      keep_free_part);
  if (!leg) return std::nullopt;
  return joined(std::move(path), *leg);
}

MotionPtr near_poke(const Task& task, const JointPath& retreat, const Vector3& way, const Vector3& in,
                    const support::Cancellation& cancellation) {
  auto path = gone_on(task, retreat, way, cancellation);
  if (path) path = gone_on(task, std::move(*path), (near_back + beyond) * in, cancellation, true);
  if (!path) return nullptr;
  Motion motion;
  motion.kind = Kind::poke;
  motion.path = std::move(*path);
  return finished(task, std::move(motion));
}

}  // namespace

std::vector<MotionPtr> near_pokes(const Task& task, const JointVector& q, const support::Cancellation& cancellation) {
  std::vector<MotionPtr> motions;
  const Eigen::Matrix3d axes = task.frame().tool_axes(task.base_from_tool(q));
  const Vector3 in = axes.col(2);
  const auto retreat = gone_on(task, {q}, -near_back * in, cancellation);
  if (!retreat) return motions;
  for (const int axis : {0, 1})
    for (const double sign : {1.0, -1.0})
      for (const double way : aside) {
        if (MotionPtr motion = near_poke(task, *retreat, sign * way * axes.col(axis), in, cancellation))
          motions.push_back(std::move(motion));
      }
  return motions;
}

}  // namespace tactus::action
