// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/small_task.hpp"
#include "contact/reference.hpp"

namespace tactus::test {

/// The world of a small task with its target at a hidden pose, as plainly as it can be written: it goes along a path in
/// fine steps, and tests every pair of triangles at each.
class PlainWorld {
 public:
  static constexpr int fineness = 16;  ///< steps from waypoint to waypoint

  PlainWorld(const action::Task& task, const Pose& base_from_target)
      : task_(task), shape_{{task.scene().target.mesh}, {}}, target_(shape_, base_from_target) {
    parts_.push_back({task.scene().tool_link, {tool_pieces(), {}}});
    const auto& links = task.scene().robot->links;
    for (std::size_t i = 0; i < links.size(); ++i)
      if (!links[i].shapes.empty()) parts_.push_back({static_cast<int>(i), {links[i].shapes, {}}});
  }

  PlainWorld(const PlainWorld&) = delete;
  PlainWorld& operator=(const PlainWorld&) = delete;

  bool touches(const JointVector& q) const {
    return std::any_of(parts_.begin(), parts_.end(), [&](const reference::Part& part) {
      return reference::touch({part.shape, robot::forward(*task_.scene().robot, q, part.link)}, target_,
                              task_.options().contact_margin);
    });
  }

  /// Where the robot stops and what it feels. It goes on for up to `overshoot` metres after the first contact, and
  /// stops of itself at `halt` (0 .. 1) of the path.
  belief::Observation execute(const action::Action& action, double overshoot = 0.0, double halt = 1.0) const {
    const auto last = static_cast<double>(action.path.size() - 1);
    const auto steps = static_cast<std::size_t>(halt * last * fineness);
    for (std::size_t step = 1; step <= steps; ++step)
      if (touches(at(action.path, step))) return {true, at(action.path, stop_after(action.path, step, overshoot))};
    return {false, at(action.path, steps)};
  }

  bool holds(const Vector3& p) const { return reference::holds(shape_, target_.pose.inverse() * p); }

 private:
  static JointVector at(const motion::JointPath& path, std::size_t step) {
    const std::size_t i = step / fineness;
    const double fraction = static_cast<double>(step % fineness) / fineness;
    return fraction == 0.0 ? path[i] : JointVector(path[i] + fraction * (path[i + 1] - path[i]));
  }

  std::size_t stop_after(const motion::JointPath& path, std::size_t contact, double overshoot) const {
    std::size_t stop = contact;
    while (stop < (path.size() - 1) * fineness &&
           robot::motion_bound(*task_.scene().robot, task_.known_world().link_reach(), at(path, contact - 1),
                               at(path, stop + 1)) <= overshoot)
      ++stop;
    return stop;
  }

  const action::Task& task_;
  reference::Shape shape_;
  reference::Placed target_;
  std::vector<reference::Part> parts_;
};

}  // namespace tactus::test
