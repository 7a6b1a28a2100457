// SPDX-License-Identifier: BSD-3-Clause
#include "robot/kinematics.hpp"

#include <algorithm>

#include "robot/joint_motion.hpp"
#include "support/error.hpp"

namespace tactus::robot {
namespace {

using geometry::Vector3;
using support::Error;
using support::Status;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

void check_size(const RobotModel& model, const JointVector& q) {
  if (q.size() != model.dof())
    throw Error(Status::invalid_argument,
                "joint vector: found " + std::to_string(q.size()) + " values, expected " + std::to_string(model.dof()));
}

void check_link(const RobotModel& model, int link) {
  if (link < 0 || at(link) >= model.links.size())
    throw Error(Status::invalid_argument, "link: found index " + std::to_string(link) + ", expected 0 .. " +
                                              std::to_string(model.links.size() - 1));
}

/// How far a point of link `i` can get from where it is at `poses` when every joint moves by at most `step`: as if they
/// moved one after the other, the base's first, so that each one finds the links beyond it as they stand in `poses`.
double displacement(const RobotModel& model, const std::vector<Pose>& poses, const JointVector& step, int i,
                    double reach) {
  double sum = 0.0;
  for (int k = i; k >= 0; k = model.links[at(k)].parent) {
    const Link& link = model.links[at(k)];
    if (link.joint < 0) continue;
    const double move = std::abs(link.multiplier * step[link.joint]);
    if (turns(link.joint_kind)) {
      const Vector3 arm = poses[at(i)].translation() - poses[at(k)].translation();
      sum += move * ((poses[at(k)].linear() * link.axis).cross(arm).norm() + reach);
    } else {
      sum += move;
    }
  }
  return sum;
}

}  // namespace

void forward(const RobotModel& model, const JointVector& q, std::vector<Pose>& root_from_link) {
  check_size(model, q);
  root_from_link.resize(model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Link& link = model.links[i];
    root_from_link[i] =
        link.parent < 0 ? Pose::Identity() : root_from_link[at(link.parent)] * parent_from_link(link, q);
  }
}

Pose forward(const RobotModel& model, const JointVector& q, int link) {
  check_size(model, q);
  check_link(model, link);
  Pose pose = Pose::Identity();
  for (int i = link; model.links[at(i)].parent >= 0; i = model.links[at(i)].parent)
    pose = parent_from_link(model.links[at(i)], q) * pose;
  return pose;
}

Eigen::MatrixXd jacobian(const RobotModel& model, const JointVector& q, int link, const Pose& link_from_tip) {
  check_link(model, link);
  std::vector<Pose> poses;
  forward(model, q, poses);
  const Vector3 tip = poses[at(link)] * Vector3(link_from_tip.translation());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(6, model.dof());
  for (int i = link; i >= 0; i = model.links[at(i)].parent) {
    const Link& mover = model.links[at(i)];
    if (mover.joint < 0) continue;
    const Vector3 axis = mover.multiplier * (poses[at(i)].linear() * mover.axis);
    if (turns(mover.joint_kind)) {
      columns.block<3, 1>(0, mover.joint) += axis.cross(tip - poses[at(i)].translation());
      columns.block<3, 1>(3, mover.joint) += axis;
    } else {
      columns.block<3, 1>(0, mover.joint) += axis;
    }
  }
  return columns;
}

bool inside_limits(const RobotModel& model, const JointVector& q, double tolerance) {
  check_size(model, q);
  for (int j = 0; j < model.dof(); ++j)
    if (!(q[j] >= model.joints[at(j)].lower - tolerance && q[j] <= model.joints[at(j)].upper + tolerance)) return false;
  return true;
}

double motion_bound(const RobotModel& model, const std::vector<double>& reach, const JointVector& from,
                    const JointVector& to) {
  if (reach.size() != model.links.size())
    throw Error(Status::invalid_argument, "reach: found " + std::to_string(reach.size()) + " values, expected " +
                                              std::to_string(model.links.size()));
  check_size(model, from);
  check_size(model, to);
  thread_local std::vector<Pose> poses;
  thread_local JointVector step;
  step = to - from;
  double bound = 0.0;
  for (const JointVector* q : {&from, &to}) {
    forward(model, *q, poses);
    for (std::size_t i = 0; i < reach.size(); ++i)
      if (reach[i] >= 0.0) bound = std::max(bound, displacement(model, poses, step, static_cast<int>(i), reach[i]));
  }
  return bound;
}

}  // namespace tactus::robot
