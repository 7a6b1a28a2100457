// SPDX-License-Identifier: BSD-3-Clause
#include "robot/chain.hpp"

#include <algorithm>

#include "robot/joint_motion.hpp"
#include "support/error.hpp"

namespace tactus::robot {
namespace {

using geometry::Vector3;

std::vector<int> links_from_root(const RobotModel& model, int link) {
  if (link < 0 || link >= static_cast<int>(model.links.size()))
    throw support::Error(support::Status::invalid_argument,
                         "link: found index " + std::to_string(link) + ", expected one of the robot's links");
  std::vector<int> links;
  for (int i = link; model.links[static_cast<std::size_t>(i)].parent >= 0;
       i = model.links[static_cast<std::size_t>(i)].parent)
    links.push_back(i);
  std::reverse(links.begin(), links.end());
  return links;
}

bool turns_alone(const RobotModel& model, int joint) {
  const auto follows = [joint](const Link& link) { return link.joint == joint; };
  const auto mover = std::find_if(model.links.begin(), model.links.end(), follows);
  return turns(mover->joint_kind) && mover->multiplier == 1.0 &&
         std::find_if(mover + 1, model.links.end(), follows) == model.links.end();
}

}  // namespace

Chain::Chain(const RobotModel& model, int link) {
  Pose fixed = Pose::Identity();
  for (const int i : links_from_root(model, link)) {
    const Link& part = model.links[static_cast<std::size_t>(i)];
    fixed = fixed * part.parent_from_joint;
    if (part.joint < 0) continue;
    if (count_ == most_joints)
      throw support::Error(support::Status::invalid_argument,
                           "link " + model.links[static_cast<std::size_t>(link)].name + ": found more than " +
                               std::to_string(most_joints) + " joints that move it, expected fewer");
    const int column = column_of(part.joint);
    turns_freely_[static_cast<std::size_t>(column)] = turns_alone(model, part.joint);
    segments_[static_cast<std::size_t>(count_++)] = {fixed,  part.axis,       turns(part.joint_kind),
                                                     column, part.multiplier, part.offset};
    fixed = Pose::Identity();
  }
  tip_ = fixed;
}

int Chain::column_of(int joint) {
  const auto end = joints_.begin() + columns_;
  const auto known = std::find(joints_.begin(), end, joint);
  if (known == end) joints_[static_cast<std::size_t>(columns_++)] = joint;
  return static_cast<int>(known - joints_.begin());
}

Pose Chain::through(const Segment& segment, double value) const {
  return segment.before * joint_motion(segment.turning, segment.axis, segment.multiplier * value + segment.offset);
}

Pose Chain::forward(const Values& values) const {
  Pose pose = Pose::Identity();
  for (int s = 0; s < count_; ++s) {
    const Segment& segment = segments_[static_cast<std::size_t>(s)];
    pose = pose * through(segment, values[segment.column]);
  }
  return pose * tip_;
}

Pose Chain::forward(const Values& values, Jacobian& jacobian) const {
  std::array<Vector3, most_joints> axes, origins;
  Pose pose = Pose::Identity();
  for (int s = 0; s < count_; ++s) {
    const Segment& segment = segments_[static_cast<std::size_t>(s)];
    pose = pose * through(segment, values[segment.column]);
    axes[static_cast<std::size_t>(s)] = segment.multiplier * (pose.linear() * segment.axis);
    origins[static_cast<std::size_t>(s)] = pose.translation();
  }
  pose = pose * tip_;
  jacobian.setZero(6, columns_);
  for (int s = 0; s < count_; ++s) {
    const Segment& segment = segments_[static_cast<std::size_t>(s)];
    const Vector3& axis = axes[static_cast<std::size_t>(s)];
    if (segment.turning) {
      jacobian.col(segment.column).head<3>() += axis.cross(pose.translation() - origins[static_cast<std::size_t>(s)]);
      jacobian.col(segment.column).tail<3>() += axis;
    } else {
      jacobian.col(segment.column).head<3>() += axis;
    }
  }
  return pose;
}

}  // namespace tactus::robot
