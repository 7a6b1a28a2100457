// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "robot/model.hpp"

namespace tactus::robot {

inline bool turns(JointKind kind) { return kind == JointKind::revolute || kind == JointKind::continuous; }

/// Value of the joint that carries `link`, which is not fixed.
inline double joint_value(const Link& link, const JointVector& q) {
  return link.multiplier * q[link.joint] + link.offset;
}

/// What a moving joint of value `value` does: the pose after it in the frame before it.
inline Pose joint_motion(bool turning, const geometry::Vector3& axis, double value) {
  Pose motion = Pose::Identity();
  if (turning)
    motion.linear() = Eigen::AngleAxisd(value, axis).toRotationMatrix();
  else
    motion.translation() = value * axis;
  return motion;
}

inline Pose parent_from_link(const Link& link, const JointVector& q) {
  if (link.joint < 0) return link.parent_from_joint;
  return link.parent_from_joint * joint_motion(turns(link.joint_kind), link.axis, joint_value(link, q));
}

}  // namespace tactus::robot
