// SPDX-License-Identifier: BSD-3-Clause
#include "action/insertion.hpp"

namespace tactus::action {
namespace {

Pose backed_off(const Pose& base_from_seated, const Vector3& axis, double distance) {
  Pose pose = base_from_seated;
  pose.translation() -= distance * axis;
  return pose;
}

}  // namespace

MotionPtr insertion(const Task& task, const Pose& base_from_target, const JointVector& near, std::size_t seat,
                    std::optional<double> plane) {
  const MotionOptions& options = task.options().motion;
  const scene::Scene& scene = task.scene();
  const Pose base_from_seated = scene.seated(base_from_target, seat);
  const Vector3 axis = base_from_target.linear() * scene.target.approach_axis;
  const Vector3 seated = task.frame().base_from_search.inverse() * base_from_seated.translation();
  const Vector3 along = task.frame().base_from_search.linear().transpose() * axis;
  const double to_plane = (seated.z() - plane.value_or(task.frame().standoff)) / along.z();
  if (!(to_plane > scene.target.approach_depth)) return nullptr;

  const auto start = task.posture(backed_off(base_from_seated, axis, to_plane), near);
  if (!start) return nullptr;
  const auto approach =
      task.straight_path(*start, backed_off(base_from_seated, axis, scene.target.approach_depth), options.step);
  if (!approach) return nullptr;
  const auto entry = task.straight_path(approach->back(), base_from_seated, options.insertion_step);
  if (!entry) return nullptr;

  Motion motion;
  motion.kind = Kind::insertion;
  motion.anchored = true;
  motion.supposed_target = base_from_target;
  motion.pace = {{0, {options.approach_speed, options.acceleration, options.joint_acceleration}},
                 {approach->size() - 1, {options.insertion_speed, options.acceleration, options.joint_acceleration}}};
  motion.path = joined(*approach, *entry);
  return finished(task, std::move(motion));
}

}  // namespace tactus::action
