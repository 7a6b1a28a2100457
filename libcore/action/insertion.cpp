// SPDX-License-Identifier: BSD-3-Clause
#include "action/insertion.hpp"

#include <algorithm>

namespace tactus::action {
namespace {

constexpr double clear = 0.01;  // m that the tool goes back at least, from what it may touch

Pose backed_off(const Pose& base_from_seated, const Vector3& axis, double distance) {
  Pose pose = base_from_seated;
  pose.translation() -= distance * axis;
  return pose;
}

/// Where a near attempt turns towards the seat, and where it goes in.
struct NearWay {
  Pose base_from_back, base_from_ready;
};

NearWay near_way(const Task& task, const Pose& base_from_tool, const Pose& base_from_seated, const Vector3& axis) {
  const Pose ready = backed_off(base_from_seated, axis, task.scene().target.approach_depth);
  const double past = axis.dot(base_from_tool.translation() - ready.translation());
  return {backed_off(base_from_tool, axis, std::max(clear, past)), ready};
}

/// An attempt along `approach` and `entry`: slower, in finer steps, on the latter.
MotionPtr attempt(const Task& task, const Pose& base_from_target, const JointPath& approach, const JointPath& entry,
                  bool anchored) {
  const MotionOptions& options = task.options().motion;
  Motion motion;
  motion.kind = Kind::insertion;
  motion.anchored = anchored;
  motion.supposed_target = base_from_target;
  motion.pace = {{0, {options.approach_speed, options.acceleration, options.joint_acceleration}},
                 {approach.size() - 1, {options.insertion_speed, options.acceleration, options.joint_acceleration}}};
  motion.path = joined(approach, entry);
  return finished(task, std::move(motion));
}

}  // namespace

MotionPtr insertion(const Task& task, const Pose& base_from_target, const JointVector& near, std::size_t seat,
                    std::optional<double> plane, const support::Cancellation& cancellation) {
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
  const auto approach = task.straight_path(*start, backed_off(base_from_seated, axis, scene.target.approach_depth),
                                           options.step, cancellation);
  if (!approach) return nullptr;
  const auto entry = task.straight_path(approach->back(), base_from_seated, options.insertion_step, cancellation);
  if (!entry) return nullptr;
  return attempt(task, base_from_target, *approach, *entry, true);
}

MotionPtr near_insertion(const Task& task, const Pose& base_from_target, const JointVector& q, std::size_t seat,
                         const support::Cancellation& cancellation) {
  const MotionOptions& options = task.options().motion;
  const Pose base_from_seated = task.scene().seated(base_from_target, seat);
  const Vector3 axis = base_from_target.linear() * task.scene().target.approach_axis;
  const NearWay way = near_way(task, task.base_from_tool(q), base_from_seated, axis);
  const auto back = task.straight_path(q, way.base_from_back, options.step, cancellation);
  if (!back) return nullptr;
  const auto across = task.straight_path(back->back(), way.base_from_ready, options.step, cancellation);
  if (!across) return nullptr;
  const auto entry = task.straight_path(across->back(), base_from_seated, options.insertion_step, cancellation);
  if (!entry) return nullptr;
  return attempt(task, base_from_target, joined(*back, *across), *entry, false);
}

double near_insertion_cost(const Task& task, const Pose& base_from_tool, const Pose& base_from_seated,
                           const Vector3& axis) {
  const CostWeights& weights = task.options().cost;
  const NearWay way = near_way(task, base_from_tool, base_from_seated, axis);
  const auto metres = [](const Pose& from, const Pose& to) { return (to.translation() - from.translation()).norm(); };
  return weights.metre * (metres(base_from_tool, way.base_from_back) + metres(way.base_from_back, way.base_from_ready) +
                          metres(way.base_from_ready, base_from_seated)) +
         weights.radian * geometry::angle_between(base_from_tool, base_from_seated);
}

}  // namespace tactus::action
